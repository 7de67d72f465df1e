//! Black rooms of CIE 171: walls, a roof with an opening, and light sources.

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::{Light, LightKind, Material, Rgb, SceneBuilder, Sky, SkyModel, Spread};

use crate::data::{Case, PointSource, Shape, Surface};
use crate::error::ValidateError;
use crate::light::{Paint, builder};
use crate::shape::SEGMENTS;

/// Returns the builder of a scene of these surfaces, all black, with the given exitances.
pub(crate) fn black(surfaces: &[&Surface], exitance: impl Fn(&Surface) -> f64) -> SceneBuilder {
    builder(surfaces, |i| Paint::gray(exitance(surfaces[i]), 0.0), SEGMENTS)
}

/// Adds a point light of this flux: isotropic, or Lambertian if it has an axis.
pub(crate) fn add_point(builder: &mut SceneBuilder, source: &PointSource, flux: f64) {
    let spread = match source.axis {
        None => Spread::Isotropic,
        Some(axis) => Spread::Lambertian { axis: DVec3::from_array(axis) },
    };
    let intensity = Rgb::splat(flux / spread.solid_angle());
    let kind = LightKind::Point { position: DVec3::from_array(source.position), intensity, spread };
    builder.add_light(Light { name: String::new(), kind });
}

/// Sets a uniform sky that gives the open ground the irradiance 1, and adds a black roof with an opening to a room.
pub(crate) fn open_to_sky(
    builder: &mut SceneBuilder,
    case: &Case,
    opening: &Surface,
) -> Result<(), ValidateError> {
    let sky = Sky::new(DVec3::Z, SkyModel::Uniform, Rgb::ONE, Rgb::ZERO);
    builder.set_sky(case.need("sky", sky.as_ref())?.clone());
    let floor = case.geometry.surfaces.iter().find(|surface| surface.name == "floor");
    let (floor, hole) = (corners(case, case.need("floor", floor)?)?, corners(case, opening)?);
    let middle = hole.iter().sum::<DVec3>() / hole.len() as f64;
    // Corner of the roof next to each corner of the hole: above the floor corner in the same direction.
    let edge = |inner: &DVec3| {
        let along = |corner: &DVec3| (*corner - middle).truncate().dot((*inner - middle).truncate());
        let nearest = floor.iter().max_by(|a, b| along(a).total_cmp(&along(b)));
        nearest.map_or(*inner, |corner| DVec3::new(corner.x, corner.y, inner.z))
    };
    let roof = builder.add_material(Material::diffuse("roof", Rgb::ZERO));
    for (i, inner) in hole.iter().enumerate() {
        let next = &hole[(i + 1) % hole.len()];
        let strip = [edge(inner), edge(next), *next, *inner];
        // A hole as large as the roof leaves strips of zero area.
        if (strip[1] - strip[3]).cross(strip[2] - strip[0]).length() > 1e-9 {
            let strip = strip.map(|corner| builder.add_vertex(corner));
            builder.add_polygon(&strip, roof);
        }
    }
    Ok(())
}

fn corners(case: &Case, surface: &Surface) -> Result<Vec<DVec3>, ValidateError> {
    let vertices = match &surface.shape {
        Shape::Polygon { vertices } => Some(vertices),
        _ => None,
    };
    Ok(case.need("flat floor and opening", vertices)?.iter().map(|&v| DVec3::from_array(v)).collect())
}

/// Returns the flux of a point light in lumens, from `inputs`.
pub(crate) fn flux(case: &Case) -> Result<f64, ValidateError> {
    #[derive(serde::Deserialize)]
    struct Inputs {
        luminous_flux_lm: f64,
    }
    Ok(case.inputs::<Inputs>()?.luminous_flux_lm)
}

/// Returns the exitance `M = πL` of a lamp, from its luminance in `inputs`.
pub(crate) fn exitance(case: &Case) -> Result<f64, ValidateError> {
    #[derive(serde::Deserialize)]
    struct Inputs {
        luminance_cd_per_m2: f64,
    }
    Ok(PI * case.inputs::<Inputs>()?.luminance_cd_per_m2)
}
