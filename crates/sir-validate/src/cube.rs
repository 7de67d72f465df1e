//! CIE 171, 5.8: a closed cube with an isotropic point light in its center.

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::shapes::quad;
use sir_geom::{Material, Rgb, Scene, SceneBuilder};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::Model;

use crate::data::{Case, FaceAverage, Point, Shape, Surface};
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::light::{Paint, builder, means, per_face, solve};
use crate::points::{irradiances, sensors};
use crate::room::{add_point, flux};
use crate::shape::SEGMENTS;
use crate::trial::{Quantity, Sample, Trial};

/// Numbers of patches and of lines per run for the averages of faces. The averages are exact for any patches, because
/// all faces are equal.
const AVERAGES: (u64, u64) = (2_400, 800_000);

/// Numbers of cells along an edge and of lines per run for the light at points. Cells measure a tenth of a meter in the
/// middle of a face and are smaller toward its edges. Half of the lines are global, and meet each cell about two
/// hundred times.
const POINTS: (u32, u64) = (48, 3_200_000);

/// The same for points close to an edge. They see little except the small cells next to it, which few lines meet, and
/// need more runs than others.
const CORNERS: (u32, u64) = (32, 2_000_000);

/// Largest distance of points that are close to an edge \[m\].
const CLOSE: f64 = 0.1;

/// Number of rays per point.
const RAYS: u64 = 20_000;

/// Adds the point light.
fn add_light(case: &Case, builder: &mut SceneBuilder) -> Result<(), ValidateError> {
    add_point(builder, case.need("source", case.geometry.source.as_ref())?, flux(case)?);
    Ok(())
}

/// Builds the cube as given, with a reflectance for each band.
fn plain(case: &Case, reflectance: Rgb) -> Result<Scene, ValidateError> {
    let surfaces: Vec<&Surface> = case.geometry.surfaces.iter().collect();
    let mut builder = builder(&surfaces, |_| Paint { exitance: Rgb::ZERO, reflectance }, SEGMENTS);
    add_light(case, &mut builder)?;
    Ok(builder.build()?.scene)
}

/// Builds the cube with faces of `cells` × `cells` rectangles, which are smaller closer to an edge.
fn graded(case: &Case, reflectance: Rgb, cells: u32) -> Result<Scene, ValidateError> {
    let mut builder = SceneBuilder::new();
    let material = builder.add_material(Material::diffuse("", reflectance));
    let at = |i: u32| {
        let u = f64::from(i) / f64::from(cells);
        0.5 * u + 0.25 * (1.0 - libm::cos(PI * u))
    };
    for surface in &case.geometry.surfaces {
        let corners = match &surface.shape {
            Shape::Polygon { vertices } => <[[f64; 3]; 4]>::try_from(vertices.as_slice()).ok(),
            _ => None,
        };
        let [a, b, _, d] = case.need("square faces", corners.as_ref())?.map(DVec3::from_array);
        let point = |i: u32, j: u32| a + (b - a) * at(i) + (d - a) * at(j);
        for i in 0..cells {
            for j in 0..cells {
                let corners = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
                quad(&mut builder, corners, material);
            }
        }
    }
    add_light(case, &mut builder)?;
    Ok(builder.build()?.scene)
}

/// Creates the trials for averages of faces and values at points, each with up to three reflectances, one per band.
pub(crate) fn cube(case: &Case) -> Result<Vec<Trial<'_>>, ValidateError> {
    let mut trials: Vec<Trial<'_>> = case.face_averages.chunks(3).map(|some| averages(case, some)).collect();
    let mut points = Vec::new();
    for (name, values) in &case.point_values {
        let reflectance = name.strip_prefix("rho=").and_then(|number| number.parse().ok());
        points.push((*case.need("point values named `rho=…`", reflectance.as_ref())?, values.as_slice()));
    }
    for some in points.chunks(3) {
        for close in [false, true] {
            trials.push(at_points(case, some, close)?);
        }
    }
    Ok(trials)
}

/// Returns reflectances as bands.
fn bands(reflectances: impl Iterator<Item = f64>) -> Rgb {
    let mut bands = Rgb::ZERO;
    reflectances.enumerate().for_each(|(band, reflectance)| bands[band] = reflectance);
    bands
}

fn averages<'a>(case: &'a Case, some: &'a [FaceAverage]) -> Trial<'a> {
    let mut quantities = Vec::new();
    for average in some {
        let rho = average.reflectance;
        for surface in &case.geometry.surfaces {
            let group = Some(format!("ρ = {rho}, all light"));
            quantities.push(Quantity { group, ..Quantity::new(surface.name.clone(), average.total) });
        }
        let name = format!("ρ = {rho}, reflected light: mean of all faces");
        let published = average.cie_published_indirect;
        quantities.push(Quantity { published, ..Quantity::new(name, average.indirect) });
    }
    let (patches, lines) = AVERAGES;
    let prepare = move |_: Effort| -> Result<Sample<'a>, ValidateError> {
        let scene = plain(case, bands(some.iter().map(|average| average.reflectance)))?;
        let model = Model::new(scene, Subdivision::Triangles(PatchSize::Count(patches)))?;
        Ok(Box::new(move |lines, seed, executor| {
            let light = solve(&model, lines, seed, executor)?;
            let (direct, all) = (means(&model, &light.direct), means(&model, &light.all));
            let mut values = Vec::new();
            for band in 0..some.len() {
                values.extend(all.iter().map(|mean| mean.irradiance[band]));
                let reflected =
                    all.iter().zip(&direct).map(|(all, direct)| all.irradiance - direct.irradiance);
                values.push(reflected.map(|rgb| rgb[band]).sum::<f64>() / all.len() as f64);
            }
            Ok(values)
        }))
    };
    Trial { quantities, lines, prepare: Box::new(prepare) }
}

/// Creates the trial for the light at points, which are the same for all reflectances: the points close to two edges,
/// or the others.
fn at_points<'a>(
    case: &'a Case,
    some: &[(f64, &'a [Point])],
    close: bool,
) -> Result<Trial<'a>, ValidateError> {
    let chosen = |points: &'a [Point]| {
        points.iter().filter(move |point| (point.position.iter().all(|&x| x < CLOSE)) == close)
    };
    let of = |&(rho, points): &(f64, &'a [Point])| {
        chosen(points).map(move |point| Quantity {
            published: point.cie_published,
            ..Quantity::new(format!("ρ = {rho}, all light: {}", point.name), point.exact)
        })
    };
    let quantities = some.iter().flat_map(of).collect();
    let (count, rho) = (some.len(), bands(some.iter().map(|&(rho, _)| rho)));
    let sensors = sensors(case, chosen(case.need("points", some.first())?.1))?;
    let (cells, lines) = if close { CORNERS } else { POINTS };
    let prepare = move |effort: Effort| -> Result<Sample<'a>, ValidateError> {
        let cells = if effort == Effort::Full { cells } else { cells / 2 };
        let model = per_face(graded(case, rho, cells)?)?;
        let sensors = sensors.clone();
        Ok(Box::new(move |lines, seed, executor| {
            let light = solve(&model, lines, seed, executor)?;
            let found = irradiances(&model, &light.all, &sensors, RAYS, seed, executor)?;
            Ok((0..count).flat_map(|band| found.iter().map(move |rgb| rgb[band])).collect())
        }))
    };
    Ok(Trial { quantities, lines, prepare: Box::new(prepare) })
}
