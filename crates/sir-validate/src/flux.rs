//! CIE 171, 5.4: distribution of the flux of a source in a closed black room.

use std::collections::BTreeMap;

use sir_geom::SceneBuilder;
use sir_parallel::Start;
use sir_radiosity::{FirstShot, Model, ShotSettings};

use crate::data::{Case, Surface};
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::light::{means, per_face};
use crate::room::{add_point, black, flux, open_to_sky};
use crate::trial::{Quantity, Sample, Trial};

/// Number of lines per run.
const LINES: u64 = 500_000;

/// Flux that arrives at the floor, the ceiling, each wall, and in total.
type Answers = BTreeMap<String, f64>;

/// Creates the trial of 5.4a: a point light.
pub(crate) fn of_point(case: &Case) -> Result<Vec<Trial<'_>>, ValidateError> {
    let source = case.need("source", case.geometry.source.as_ref())?;
    let surfaces: Vec<&Surface> = case.geometry.surfaces.iter().collect();
    let flux = flux(case)?;
    let build = move || -> Result<SceneBuilder, ValidateError> {
        let mut builder = black(&surfaces, |_| 0.0);
        add_point(&mut builder, source, flux);
        Ok(builder)
    };
    Ok(vec![trial(case, None, case.values()?, flux, build)])
}

/// Creates the trials of 5.4b: a uniform sky through an opening as large as the roof, and a lamp in place of a small
/// opening (through which only three of a hundred lines from the sky would pass).
pub(crate) fn of_openings(case: &Case) -> Result<Vec<Trial<'_>>, ValidateError> {
    let values: BTreeMap<String, Answers> = case.values()?;
    let mut trials = Vec::new();
    for opening in &case.geometry.openings {
        let answers = case.need("values for each opening", values.get(&opening.name))?;
        let walls: Vec<&Surface> = case.geometry.surfaces.iter().collect();
        let is_roof = opening.name == "opening 4x4";
        let build = move || -> Result<SceneBuilder, ValidateError> {
            if is_roof {
                let mut builder = black(&walls, |_| 0.0);
                open_to_sky(&mut builder, case, opening)?;
                Ok(builder)
            } else {
                let mut surfaces = walls.clone();
                surfaces.push(opening);
                Ok(black(&surfaces, |surface| if surface.name == opening.name { 1.0 } else { 0.0 }))
            }
        };
        // The flux through each square meter is 1.
        let flux = if is_roof { 16.0 } else { 1.0 };
        let shares = answers.iter().map(|(name, share)| (name.clone(), share * flux)).collect();
        trials.push(trial(case, Some(&opening.name), shares, flux, build));
    }
    Ok(trials)
}

/// Creates a trial of a first shot and the power that each surface receives. Quantities have the unit of `flux`.
fn trial<'a>(
    case: &'a Case,
    prefix: Option<&str>,
    answers: Answers,
    flux: f64,
    build: impl Fn() -> Result<SceneBuilder, ValidateError> + 'a,
) -> Trial<'a> {
    let mut quantities = Vec::new();
    for surface in &case.geometry.surfaces {
        let exact = answers.get(&surface.name).or_else(|| answers.get("each_wall"));
        let name = prefix.map_or(surface.name.clone(), |prefix| format!("{prefix}: {}", surface.name));
        quantities.extend(exact.map(|&exact| Quantity::new(name, exact)));
    }
    let name = prefix.map_or("received / emitted".into(), |prefix| format!("{prefix}: received / emitted"));
    quantities.push(Quantity { published: Some(1.0), ..Quantity::new(name, 1.0) });
    let walls = quantities.len() - 1;
    let prepare = move |_: Effort| -> Result<Sample<'a>, ValidateError> {
        let model: Model = per_face(build()?.build()?.scene)?;
        Ok(Box::new(move |lines, seed, executor| {
            let settings = ShotSettings::new(&model, lines, seed);
            let shot = executor.run::<FirstShot<'_>>(settings, Start::Fresh(()))?.outcome;
            let received = means(&model, &shot.solution(&model)).into_iter().map(|m| m.irradiance.x * m.area);
            let mut values: Vec<f64> = received.take(walls).collect();
            values.push(values.iter().sum::<f64>() / flux);
            Ok(values)
        }))
    };
    Trial { quantities, lines: LINES, prepare: Box::new(prepare) }
}
