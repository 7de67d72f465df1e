//! Cases of `radiosity-exact.json`: mean irradiance and radiosity of every surface.

use std::collections::BTreeMap;

use serde::Deserialize;
use sir_geom::Rgb;

use crate::data::{Case, Shape, Surface};
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::light::{Paint, means, per_face, scene, solve};
use crate::shape::SEGMENTS;
use crate::trial::{Quantity, Sample, Trial};

/// Number of lines per run in a room of flat walls.
const FLAT_LINES: u64 = 400_000;

/// Numbers of parts of a circle and of lines per run, for whole spheres.
const SPHERES: (u32, u64) = (48, 600_000);

/// The same for zones of a sphere.
const ZONES: (u32, u64) = (SEGMENTS, 1_000_000);

/// Returns the numbers of parts of a circle and of lines per run for the surfaces of a case.
fn resolution(surfaces: &[&Surface]) -> (u32, u64) {
    let has = |is: fn(&Shape) -> bool| surfaces.iter().any(|surface| is(&surface.shape));
    if has(|shape| matches!(shape, Shape::SphericalZone { .. })) {
        ZONES
    } else if has(|shape| matches!(shape, Shape::Sphere { .. })) {
        SPHERES
    } else {
        (SEGMENTS, FLAT_LINES)
    }
}

/// Exitance and reflectance of a surface.
#[derive(Clone, Copy, Debug, Deserialize)]
struct Light {
    #[serde(rename = "M")]
    exitance: f64,
    #[serde(rename = "rho")]
    reflectance: f64,
}

/// `inputs` of a case, by surface name.
#[derive(Deserialize)]
#[serde(untagged)]
enum Inputs {
    Numbered {
        #[serde(rename = "M1")]
        m1: f64,
        #[serde(rename = "M2")]
        m2: f64,
        rho1: f64,
        rho2: f64,
    },
    Named(BTreeMap<String, Light>),
}

impl Inputs {
    fn of(&self, name: &str) -> Option<Light> {
        match self {
            Self::Numbered { m1, rho1, .. } if name == "1" => {
                Some(Light { exitance: *m1, reflectance: *rho1 })
            }
            Self::Numbered { m2, rho2, .. } if name == "2" => {
                Some(Light { exitance: *m2, reflectance: *rho2 })
            }
            Self::Numbered { .. } => None,
            Self::Named(lights) => lights.get(name).copied(),
        }
    }
}

/// `values` of a case: `B` and `E` of each surface.
#[derive(Deserialize)]
#[serde(untagged)]
enum Values {
    Named {
        #[serde(rename = "B")]
        b: BTreeMap<String, f64>,
        #[serde(rename = "E")]
        e: BTreeMap<String, f64>,
    },
    /// Values named `B1`, `B zone 1`, or `E` if it is the same everywhere.
    Flat(BTreeMap<String, f64>),
}

impl Values {
    fn of(&self, name: &str) -> Option<[f64; 2]> {
        match self {
            Self::Named { b, e } => Some([*b.get(name)?, *e.get(name)?]),
            Self::Flat(values) => {
                let of = |what: &str| {
                    let keys = [format!("{what}{name}"), format!("{what} {name}"), what.to_owned()];
                    keys.iter().find_map(|key| values.get(key)).copied()
                };
                Some([of("B")?, of("E")?])
            }
        }
    }
}

/// Creates the trial of RE-03 to RE-09: surfaces with different exitance and reflectance.
pub(crate) fn surfaces(case: &Case) -> Result<Vec<Trial<'_>>, ValidateError> {
    let (inputs, values): (Inputs, Values) = (case.inputs()?, case.values()?);
    let surfaces: Vec<&Surface> = case.geometry.surfaces.iter().collect();
    let (mut paints, mut quantities) = (Vec::new(), Vec::new());
    for surface in &surfaces {
        let light = inputs.of(&surface.name);
        let light = *case.need("M and rho of each surface", light.as_ref())?;
        paints.push(Paint::gray(light.exitance, light.reflectance));
        let exact = values.of(&surface.name);
        let [b, e] = *case.need("B and E of each surface", exact.as_ref())?;
        quantities.push(Quantity::new(format!("B {}", surface.name), b));
        quantities.push(Quantity::new(format!("E {}", surface.name), e));
    }
    quantities.push(Quantity::new("absorbed / emitted", 1.0));
    let (segments, lines) = resolution(&surfaces);
    let prepare = move |effort: Effort| -> Result<Sample<'_>, ValidateError> {
        let model = per_face(scene(&surfaces, |i| paints[i], effort.segments(segments))?)?;
        Ok(Box::new(move |lines, seed, executor| {
            let means = means(&model, &solve(&model, lines, seed, executor)?.all);
            let (mut values, mut emitted, mut absorbed) = (Vec::new(), 0.0, 0.0);
            for (mean, material) in means.iter().zip(model.scene.materials()) {
                values.extend([mean.radiosity.x, mean.irradiance.x]);
                emitted += material.exitance.x * mean.area;
                absorbed += (1.0 - material.reflectance.x) * mean.irradiance.x * mean.area;
            }
            values.push(absorbed / emitted);
            Ok(values)
        }))
    };
    Ok(vec![Trial { quantities, lines, prepare: Box::new(prepare) }])
}

/// Creates the trials of RE-01: rooms whose surfaces all have the same exitance and reflectance. A run has three
/// reflectances, one per band.
pub(crate) fn enclosures(case: &Case) -> Result<Vec<Trial<'_>>, ValidateError> {
    #[derive(Deserialize)]
    struct Answer {
        #[serde(flatten)]
        light: Light,
        #[serde(rename = "B")]
        radiosity: f64,
        #[serde(rename = "E")]
        irradiance: f64,
    }
    let answers: Vec<Answer> = case.values()?;
    let mut trials = Vec::new();
    for (room, walls) in &case.geometry.enclosures {
        for bands in answers.chunks(3) {
            let of = |band: usize, what: fn(&Light) -> f64| bands.get(band).map_or(0.0, |a| what(&a.light));
            let all = |what| Rgb::from_array([0, 1, 2].map(|band| of(band, what)));
            let paint = Paint { exitance: all(|l| l.exitance), reflectance: all(|l| l.reflectance) };
            let mut quantities = Vec::new();
            for Answer { light: Light { exitance, reflectance }, radiosity, irradiance } in bands {
                let group = format!("{room}, M = {exitance}, ρ = {reflectance}");
                for wall in walls {
                    for (what, exact) in [("B", *radiosity), ("E", *irradiance)] {
                        let name = format!("{what} {}", wall.name);
                        quantities
                            .push(Quantity { group: Some(group.clone()), ..Quantity::new(name, exact) });
                    }
                }
            }
            let count = bands.len();
            let walls: Vec<&Surface> = walls.iter().collect();
            let prepare = move |effort: Effort| -> Result<Sample<'_>, ValidateError> {
                let model = per_face(scene(&walls, |_| paint, effort.segments(SEGMENTS))?)?;
                Ok(Box::new(move |lines, seed, executor| {
                    let means = means(&model, &solve(&model, lines, seed, executor)?.all);
                    let of_band = |band: usize| {
                        means.iter().flat_map(move |mean| [mean.radiosity[band], mean.irradiance[band]])
                    };
                    Ok((0..count).flat_map(of_band).collect())
                }))
            };
            trials.push(Trial { quantities, lines: FLAT_LINES, prepare: Box::new(prepare) });
        }
    }
    Ok(trials)
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroUsize;

    use super::*;
    use crate::data::Reference;
    use crate::estimate::Estimate;
    use sir_parallel::Executor;

    /// Returns the relative error of the irradiance of the first zone of RE-06 with circles cut into `segments` parts.
    fn facets(segments: u32) -> Estimate {
        let reference = Reference::built_in().unwrap();
        let case = reference.cases.iter().find(|case| case.id == "RE-06").unwrap();
        let (inputs, values): (Inputs, Values) = (case.inputs().unwrap(), case.values().unwrap());
        let surfaces: Vec<&Surface> = case.geometry.surfaces.iter().collect();
        let [_, exact] = values.of("zone 1").unwrap();
        let paint = |i: usize| {
            let light = inputs.of(&surfaces[i].name).unwrap();
            Paint::gray(light.exitance, light.reflectance)
        };
        let model = per_face(scene(&surfaces, paint, segments).unwrap()).unwrap();
        let run = |seed| {
            let executor = &mut Executor::new(NonZeroUsize::MIN);
            let light = solve(&model, 600_000, seed, executor).unwrap().all;
            means(&model, &light)[0].irradiance.x / exact - 1.0
        };
        Estimate::of(&(0..16).map(run).collect::<Vec<_>>())
    }

    /// The effect of facets falls with the square of their size, and is below a fifth of the largest standard error in
    /// full and in quick runs.
    #[test]
    fn facets_change_little() {
        let (coarse, fine) = (facets(12), facets(24));
        assert!(coarse.mean < -0.01 && coarse.sigma < 5e-4, "{coarse:?}");
        let ratio = coarse.mean / fine.mean;
        assert!((3.0..6.0).contains(&ratio), "{coarse:?}, {fine:?}");
        let bound = fine.mean.abs() + 4.0 * fine.sigma;
        for effort in [Effort::Full, Effort::Quick] {
            let finer = f64::from(effort.segments(SEGMENTS)) / 24.0;
            assert!(bound / (finer * finer) < 0.2 * effort.precision(), "{fine:?}");
        }
    }
}
