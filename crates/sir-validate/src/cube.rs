//! CIE 171, 5.8: a closed cube with an isotropic point light in its centre.

use sir_geom::{Rgb, Scene};
use sir_mesh::Subdivision;
use sir_radiosity::Model;

use crate::data::{Case, Point, Surface};
use crate::light::{Paint, builder, means, solve};
use crate::points::{irradiances, sensors};
use crate::room::{add_point, flux};
use crate::shape::SEGMENTS;
use crate::trial::{Quantity, Sample, Trial};
use crate::{Effort, ValidateError};

/// Patches and lines of a run for the averages of faces. Those are right whatever the patches, since all faces are alike.
const AVERAGES: (u64, u64) = (2_400, 800_000);

/// The same for the light at points, of which one is 5 cm from two walls: patches have edges of 6 cm. Half of the lines are global and meet
/// each patch some fifty times.
const POINTS: (u64, u64) = (50_000, 2_500_000);

/// Rays of a point.
const RAYS: u64 = 20_000;

/// The scene, with a reflectance for each band.
fn scene(case: &Case, reflectance: Rgb) -> Result<Scene, ValidateError> {
    let surfaces: Vec<&Surface> = case.geometry.surfaces.iter().collect();
    let mut builder = builder(&surfaces, |_| Paint { exitance: Rgb::ZERO, reflectance }, SEGMENTS);
    add_point(&mut builder, case.need("source", case.geometry.source.as_ref())?, flux(case)?);
    Ok(builder.build()?.scene)
}

/// Averages of faces and values at points, three reflectances at a time.
pub(crate) fn cube(case: &Case) -> Result<Vec<Trial<'_>>, ValidateError> {
    let mut trials: Vec<Trial<'_>> = case.face_averages.chunks(3).map(|some| averages(case, some)).collect();
    let mut points = Vec::new();
    for (name, values) in &case.point_values {
        let reflectance = name.strip_prefix("rho=").and_then(|number| number.parse().ok());
        points.push((*case.need("point values named `rho=…`", reflectance.as_ref())?, values.as_slice()));
    }
    for some in points.chunks(3) {
        trials.push(at_points(case, some)?);
    }
    Ok(trials)
}

/// Reflectances of the bands.
fn bands(reflectances: impl Iterator<Item = f64>) -> Rgb {
    let mut bands = Rgb::ZERO;
    reflectances.enumerate().for_each(|(band, reflectance)| bands[band] = reflectance);
    bands
}

fn averages<'a>(case: &'a Case, some: &'a [crate::data::FaceAverage]) -> Trial<'a> {
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
        let scene = scene(case, bands(some.iter().map(|average| average.reflectance)))?;
        let model = Model::new(scene, Subdivision::Patches(patches))?;
        Ok(Box::new(move |lines, seed, crew| {
            let light = solve(&model, lines, seed, crew)?;
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

/// The light at points, which are the same for all reflectances.
fn at_points<'a>(case: &'a Case, some: &[(f64, &'a [Point])]) -> Result<Trial<'a>, ValidateError> {
    let of = |&(rho, points): &(f64, &'a [Point])| {
        points.iter().map(move |point| Quantity {
            published: point.cie_published,
            ..Quantity::new(format!("ρ = {rho}, all light: {}", point.name), point.exact)
        })
    };
    let quantities = some.iter().flat_map(of).collect();
    let (count, rho) = (some.len(), bands(some.iter().map(|&(rho, _)| rho)));
    let sensors = sensors(case, case.need("points", some.first())?.1)?;
    let (patches, lines) = POINTS;
    let prepare = move |effort: Effort| -> Result<Sample<'a>, ValidateError> {
        let patches = effort.lines(patches);
        let model = Model::new(scene(case, rho)?, Subdivision::Patches(patches))?;
        let sensors = sensors.clone();
        Ok(Box::new(move |lines, seed, crew| {
            let light = solve(&model, lines, seed, crew)?;
            let found = irradiances(&model, &light.all, &sensors, RAYS, seed, crew)?;
            Ok((0..count).flat_map(|band| found.iter().map(move |rgb| rgb[band])).collect())
        }))
    };
    Ok(Trial { quantities, lines, prepare: Box::new(prepare) })
}
