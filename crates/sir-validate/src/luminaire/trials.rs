//! Trials of luminaires: the flux that surfaces receive, by lines from the luminaire and by shadow rays, and the light at
//! points.

use sir_geom::SceneBuilder;
use sir_lines::LocalLines;
use sir_mesh::{PatchSize, Subdivision};
use sir_parallel::{Executor, RunError, Start};
use sir_radiosity::{FirstShot, Model, Points, ShadowRaySettings, ShadowRays, Shot, ShotSettings, Solution};

use crate::data::{Case, Point, Surface};
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::light::{Paint, builder, means, per_face};
use crate::luminaire::file_kind::FileKind;
use crate::luminaire::setup::Setup;
use crate::points::{irradiances, sensors};
use crate::shape::SEGMENTS;
use crate::trial::{Quantity, Sample, Trial};

/// Number of lines per run.
const LINES: u64 = 200_000;

/// Number of shadow rays per run, which have much less noise.
const SHADOW_RAYS: u64 = 40_000;

/// Number of lines of the first shot before shadow rays, whose light they replace.
const FEW_LINES: u64 = 1000;

/// Number of rays per point, if a case does not state another.
const RAYS: u64 = 2_000;

/// Number of patches for shadow rays. Large patches next to a small lamp keep the light of the lines instead.
const PATCHES: u64 = 500;

/// Estimator of the flux that surfaces receive.
#[derive(Clone, Copy)]
enum Estimator {
    FirstShot,
    ShadowRays,
}

/// Creates the trials for all luminaires of a case, in all formats of their files.
pub(crate) fn luminaires(case: &Case) -> Result<Vec<Trial<'_>>, ValidateError> {
    let setups: Vec<Setup> = case.values()?;
    let mut trials = Vec::new();
    for setup in setups {
        for &file in &setup.files {
            if !setup.fluxes.is_empty() {
                for estimator in [Estimator::FirstShot, Estimator::ShadowRays] {
                    trials.push(fluxes(case, setup.clone(), file, estimator)?);
                }
            }
            if !setup.points.is_empty() {
                trials.push(at_points(case, setup.clone(), file)?);
            }
        }
    }
    Ok(trials)
}

/// Returns the builder of the scene of a luminaire, all black. Surface `i` has material `i`.
fn scene(case: &Case, setup: &Setup, file: FileKind, effort: Effort) -> Result<SceneBuilder, ValidateError> {
    let surfaces: Vec<&Surface> = setup.surfaces.iter().collect();
    let mut builder = builder(&surfaces, |_| Paint::gray(0.0, 0.0), effort.segments(SEGMENTS));
    setup.add(case, file, &mut builder)?;
    Ok(builder)
}

/// Creates the trial for the flux that surfaces receive.
fn fluxes<'a>(
    case: &'a Case,
    setup: Setup,
    file: FileKind,
    estimator: Estimator,
) -> Result<Trial<'a>, ValidateError> {
    let how = match estimator {
        Estimator::FirstShot => "first shot",
        Estimator::ShadowRays => "shadow rays",
    };
    let group = format!("{}, {}, {how}", setup.name, file.name());
    let (mut quantities, mut measured) = (Vec::new(), Vec::new());
    for (name, &exact) in &setup.fluxes {
        let surface = setup.surfaces.iter().position(|surface| surface.name == *name);
        measured.push(*case.need("surfaces for all fluxes", surface.as_ref())?);
        quantities
            .push(Quantity { group: Some(group.clone()), ..Quantity::new(format!("Φ {name}"), exact) });
    }
    let prepare = move |effort: Effort| -> Result<Sample<'a>, ValidateError> {
        let scene = scene(case, &setup, file, effort)?.build()?.scene;
        let model = match estimator {
            Estimator::FirstShot => per_face(scene)?,
            Estimator::ShadowRays => Model::new(scene, Subdivision::Triangles(PatchSize::Count(PATCHES)))?,
        };
        let (measured, points) = (measured.clone(), if setup.sobol { Points::Sobol } else { Points::Random });
        Ok(Box::new(move |lines, seed, executor| {
            let shot = match estimator {
                Estimator::FirstShot => first_shot(&model, lines, points, seed, executor)?,
                Estimator::ShadowRays => shadow_rays(&model, lines, points, seed, executor)?,
            };
            let means = means(&model, &shot.solution(&model));
            Ok(measured.iter().map(|&surface| means[surface].irradiance.x * means[surface].area).collect())
        }))
    };
    let lines = match estimator {
        Estimator::FirstShot => LINES,
        Estimator::ShadowRays => SHADOW_RAYS,
    };
    Ok(Trial { quantities, lines, prepare: Box::new(prepare) })
}

fn first_shot(
    model: &Model,
    lines: u64,
    points: Points,
    seed: u64,
    executor: &mut Executor<'_>,
) -> Result<Shot, RunError> {
    let settings = ShotSettings::new(model, lines, seed).with(points);
    Ok(executor.run::<FirstShot<'_>>(settings, Start::Fresh(()))?.outcome)
}

fn shadow_rays(
    model: &Model,
    rays: u64,
    points: Points,
    seed: u64,
    executor: &mut Executor<'_>,
) -> Result<Shot, RunError> {
    let shot = first_shot(model, FEW_LINES, points, seed, executor)?;
    let rays = LocalLines::from(rays);
    let settings = ShadowRaySettings { model, rays, seed, points, every: 1 };
    Ok(executor.run::<ShadowRays<'_>>(settings, Start::Fresh(shot))?.outcome.0)
}

/// Creates the trial for the light at points.
fn at_points<'a>(case: &'a Case, setup: Setup, file: FileKind) -> Result<Trial<'a>, ValidateError> {
    let group = format!("{}, {}, at points", setup.name, file.name());
    let quantity = |point: &Point| Quantity {
        group: Some(group.clone()),
        ..Quantity::new(format!("E {}", point.name), point.exact)
    };
    let quantities: Vec<Quantity> = setup.points.iter().map(quantity).collect();
    let sensors = sensors(case, &setup.points)?;
    let (count, rays) = (sensors.len() as u64, setup.rays.unwrap_or(RAYS));
    let prepare = move |effort: Effort| -> Result<Sample<'a>, ValidateError> {
        let model = Model::new(scene(case, &setup, file, effort)?.build()?.scene, Subdivision::PerTriangle)?;
        let sensors = sensors.clone();
        Ok(Box::new(move |lines, seed, executor| {
            // All surfaces are black, so the light that they receive is not needed.
            let solution = Solution::dark(model.mesh.side_count());
            let found = irradiances(&model, &solution, &sensors, lines / count, seed, executor)?;
            Ok(found.iter().map(|irradiance| irradiance.x).collect())
        }))
    };
    Ok(Trial { quantities, lines: rays * count, prepare: Box::new(prepare) })
}
