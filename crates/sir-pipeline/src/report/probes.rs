//! The file of probes: spherical harmonics for programs that light moving objects.

use std::f64::consts::PI;

use glam::DVec3;
use serde::Serialize;
use sir_geom::Rgb;
use sir_radiosity::{COSINE_FACTORS, HARMONICS, ProbeMeasurement};

use crate::prepare::probe_grid::ProbeGrid;
use crate::units::Units;

/// Description of the basis in the file.
const BASIS: &str = "real spherical harmonics Y_i(x, y, z) of the normal, orthonormal, without Condon-Shortley phase: \
    0.282095, 0.488603 y, 0.488603 z, 0.488603 x, 1.092548 x y, 1.092548 y z, 0.315392 (3 z^2 - 1), 1.092548 x z, \
    0.546274 (x^2 - y^2)";

/// Meaning of the fields of a probe in the file.
const MEANING: [(&str, &str); 5] = [
    ("coefficients", "irradiance of a surface with the unit normal n is the sum of coefficients[i] Y_i(n)"),
    ("errors", "standard errors of coefficients"),
    ("radiance", "coefficients / (pi, 2 pi/3 or pi/4): sh.coefficients of a LightProbe of three.js"),
    (
        "axes",
        "irradiance of surfaces with the normals +x, -x, +y, -y, +z, -z, measured, not from coefficients",
    ),
    ("axes_errors", "standard errors of axes"),
];

/// Content of the file. Numbers of probes have single precision.
#[derive(Serialize)]
pub(crate) struct ProbesFile {
    name: String,
    /// Unit of irradiance; radiance is per steradian.
    unit: &'static str,
    /// Up direction of the scene.
    up: [f64; 3],
    grid: GridReport,
    basis: &'static str,
    fields: serde_json::Map<String, serde_json::Value>,
    valid: usize,
    probes: Vec<ProbeReport>,
}

/// Positions of the probes: `origin + i x + j y + k z`, for the probe with the number
/// `i + counts[0] (j + counts[1] k)`.
#[derive(Serialize)]
struct GridReport {
    origin: [f64; 3],
    steps: [[f64; 3]; 3],
    counts: [usize; 3],
    order: &'static str,
}

type Bands = [f32; 3];

#[derive(Serialize)]
struct ProbeReport {
    position: [f64; 3],
    valid: bool,
    /// Share of the surfaces in view that show their backs; `null` on a surface.
    backs: Option<f64>,
    #[serde(flatten)]
    light: Option<ProbeLight>,
}

#[derive(Serialize)]
struct ProbeLight {
    coefficients: [Bands; HARMONICS],
    errors: [Bands; HARMONICS],
    radiance: [Bands; HARMONICS],
    axes: [Bands; 6],
    axes_errors: [Bands; 6],
}

impl ProbesFile {
    /// Creates the content. `measured` are the measurements of the valid probes, in order.
    pub(crate) fn new(
        name: &str,
        grid: &ProbeGrid,
        measured: &[ProbeMeasurement],
        units: Units,
        up: DVec3,
    ) -> Self {
        let [x, y, z] = grid.steps.to_array();
        let mut measured = measured.iter();
        let probes = (0..grid.len()).map(|i| {
            let valid = grid.is_valid(i);
            let light = if valid { measured.next().map(ProbeLight::of) } else { None };
            ProbeReport { position: grid.position(i).to_array(), valid, backs: grid.backs[i], light }
        });
        Self {
            name: name.into(),
            unit: units.irradiance(),
            up: up.to_array(),
            grid: GridReport {
                origin: grid.first.to_array(),
                steps: [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]],
                counts: grid.counts,
                order: "x varies fastest, then y, then z",
            },
            basis: BASIS,
            fields: MEANING.into_iter().map(|(field, meaning)| (field.into(), meaning.into())).collect(),
            valid: grid.valid.len(),
            probes: probes.collect(),
        }
    }
}

impl ProbeLight {
    fn of(measured: &ProbeMeasurement) -> Self {
        let single = |value: Rgb| value.to_array().map(|x| x as f32);
        let coefficients = measured.coefficients();
        Self {
            coefficients: coefficients.map(single),
            errors: measured.coefficient_errors().map(single),
            radiance: std::array::from_fn(|i| single(coefficients[i] / COSINE_FACTORS[i])),
            axes: measured.axes().map(single),
            axes_errors: measured.axis_errors().map(single),
        }
    }
}

/// Returns the root mean square over all directions of the standard error of the irradiance of a probe, per band
/// \[W/m²\].
pub(crate) fn error_over_directions(measured: &ProbeMeasurement) -> Rgb {
    let squares = measured.coefficient_errors().map(|error| error * error);
    (squares.into_iter().sum::<Rgb>() / (4.0 * PI)).map(f64::sqrt)
}
