//! Trials of glare: a luminaire in the wall of a sphere, rated by eyes in the center.
//!
//! The steps are those of the case by hand in `docs/method.md` (section *Glare*), without its approximations. The wall is
//! a sphere of radius `R` with a round hole, seen from the center under the angle `θ₁` from its axis. The luminaire, with
//! the flux `Φ`, fills the hole, and is black. All points of a sphere light each other equally, and `k = (1 − cos θ₁)/2`
//! of the sphere is missing, so the wall receives `E = Φ/[4πR² (1 − k) (1 − ρ (1 − k))]`. An eye whose line of sight has
//! the angle `β` to the luminaire receives `E_ind = ρE (1 − sin² θ₁ cos β)` from the wall. The sum `Σ L² ω/p²` of a disc of
//! uniform luminance is an integral of the position index alone.

use std::f64::consts::PI;

use glam::DVec3;
use serde::Deserialize;
use sir_radiosity::{GlareSources, Measurement, Model, Sensor, unified_glare_rating};

use crate::data::{Case, Surface};
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::light::{Paint, builder, per_face, solve};
use crate::luminaire::file_kind::FileKind;
use crate::luminaire::setup::Setup;
use crate::points::measurements;
use crate::shape::SEGMENTS;
use crate::trial::{Quantity, Sample, Trial};

/// Number of lines per run. With them the noise is three times the error of the sum over the elements of the luminaire.
const LINES: u64 = 400_000;

/// Number of lines per ray of a sensor.
const LINES_PER_RAY: u64 = 50;

/// A luminaire among gray surfaces, and eyes that see it.
#[derive(Clone, Debug, Deserialize)]
struct GlareSetup {
    #[serde(flatten)]
    setup: Setup,
    reflectance: f64,
    eye: [f64; 3],
    up: [f64; 3],
    views: Vec<View>,
}

/// A line of sight, with the exact answers.
#[derive(Clone, Debug, Deserialize)]
struct View {
    name: String,
    /// Direction of the line of sight, of unit length.
    direction: [f64; 3],
    /// Background luminance \[cd/m²\].
    background: f64,
    /// Unified glare rating; 0 if nothing glares.
    rating: f64,
}

/// Creates the trials of a case of glare, one for each format of the file.
pub(crate) fn glare(case: &Case) -> Result<Vec<Trial<'_>>, ValidateError> {
    let setups: Vec<GlareSetup> = case.values()?;
    let mut trials = Vec::new();
    for setup in setups {
        for &file in &setup.setup.files {
            trials.push(ratings(case, setup.clone(), file)?);
        }
    }
    Ok(trials)
}

/// Creates the trial for the background luminances and the ratings of all views.
fn ratings(case: &Case, glare: GlareSetup, file: FileKind) -> Result<Trial<'_>, ValidateError> {
    let (mut quantities, mut sensors) = (Vec::new(), Vec::new());
    for view in &glare.views {
        let quantity = |what: &str, exact| {
            Quantity::new(format!("{}, {}: {what} {}", glare.setup.name, file.name(), view.name), exact)
        };
        quantities.extend([quantity("L_b", view.background), quantity("UGR", view.rating)]);
        let sensor = Sensor::new(DVec3::from_array(glare.eye), DVec3::from_array(view.direction));
        sensors.push(*case.need("direction of a view", sensor.as_ref())?);
    }
    let prepare = move |effort: Effort| -> Result<Sample<'_>, ValidateError> {
        let model = model(case, &glare, file, effort)?;
        let sums = sums(&model, &glare, &sensors);
        let sensors = sensors.clone();
        Ok(Box::new(move |lines, seed, executor| {
            let light = solve(&model, lines, seed, executor)?.all;
            let measured = measurements(&model, &light, &sensors, lines / LINES_PER_RAY, seed, executor)?;
            let rate = |(measured, &sum): (&Measurement, &f64)| {
                let background = (measured.irradiance - measured.direct).x / PI;
                [background, unified_glare_rating(sum, background).unwrap_or(0.0)]
            };
            Ok(measured.iter().zip(&sums).flat_map(rate).collect())
        }))
    };
    Ok(Trial { quantities, lines: LINES, prepare: Box::new(prepare) })
}

/// Returns the model of the luminaire and of the surfaces around it.
fn model(case: &Case, glare: &GlareSetup, file: FileKind, effort: Effort) -> Result<Model, ValidateError> {
    let surfaces: Vec<&Surface> = glare.setup.surfaces.iter().collect();
    let paint = |_| Paint::gray(0.0, glare.reflectance);
    let mut builder = builder(&surfaces, paint, effort.segments(SEGMENTS));
    glare.setup.add(case, file, &mut builder)?;
    per_face(builder.build()?.scene)
}

/// Returns the sums `Σ L² ω/p²` of all views. They have no noise.
fn sums(model: &Model, glare: &GlareSetup, sensors: &[Sensor]) -> Vec<f64> {
    let sources = GlareSources::of(model, DVec3::from_array(glare.up));
    let mut tracer = model.accel.tracer();
    let views = sensors.iter();
    views.map(|sensor| sources.sum(sensor.position(), sensor.direction(), &mut tracer)).collect()
}
