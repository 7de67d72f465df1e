//! Unified glare ratings of sensors.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use sir_geom::luminance;
use sir_radiosity::{GlareSources, Measurement, Model, Sensor, error_of_rating, unified_glare_rating};

use crate::report::uncertain::Uncertain;

/// Summary of unified glare ratings (CIE 117).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GlareReport {
    /// Largest rating; `None` if no sensor sees anything that glares.
    pub maximum: Option<f64>,
    /// Standard error of the largest rating, from that of the background.
    pub maximum_error: f64,
    /// Number of sensors that see something that glares.
    pub rated: usize,
}

/// Returns the rating of an eye at each sensor, which looks where the sensor looks; `None` where nothing glares. The background
/// is the light that the sensor receives from surfaces, without that which comes straight from sources and the sky.
pub(crate) fn ratings(
    model: &Model,
    up: DVec3,
    sensors: &[Sensor],
    measured: &[Measurement],
) -> Vec<Option<Uncertain>> {
    let sources = GlareSources::of(model, up);
    let mut tracer = model.accel.tracer();
    let rate = |(sensor, measured): (&Sensor, &Measurement)| {
        let indirect = luminance(measured.irradiance - measured.direct);
        let sum = sources.sum(sensor.position(), sensor.direction(), &mut tracer);
        let value = unified_glare_rating(sum, indirect / std::f64::consts::PI)?;
        // The error of all light is an upper limit of that of the indirect light.
        Some(Uncertain { value, error: error_of_rating(measured.luminance_error() / indirect) })
    };
    sensors.iter().zip(measured).map(rate).collect()
}

impl GlareReport {
    pub(crate) fn of(ratings: &[Option<Uncertain>]) -> Self {
        let rated = || ratings.iter().flatten();
        let worst = rated().max_by(|a, b| a.value.total_cmp(&b.value));
        Self {
            maximum: worst.map(|rating| rating.value),
            maximum_error: worst.map_or(0.0, |rating| rating.error),
            rated: rated().count(),
        }
    }

    /// Returns the largest rating, or 0 if there is none: less than anybody notices.
    pub(crate) fn worst(&self) -> Uncertain {
        Uncertain { value: self.maximum.unwrap_or(0.0), error: self.maximum_error }
    }

    /// Returns the largest rating in words.
    #[must_use]
    pub fn in_short(&self) -> String {
        match self.maximum {
            Some(value) => format!("largest UGR {}", Uncertain { value, error: self.maximum_error }),
            None => "no glare".into(),
        }
    }
}
