//! Lamps given by formulas, and the angles at which their files have intensities.

use glam::DVec3;
use serde::Deserialize;

use crate::luminaire::file_kind::FileKind;

/// Intensity as a function of direction, in the frame of the luminaire, which is aimed at −z. Units are candelas.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(crate) enum Lamp {
    /// `I₀ cosⁿ θ` below, none above.
    Power { peak: f64, exponent: i32, step_deg: f64 },
    /// `I₀ (1 − θ/α)` up to the angle `α`: exactly the interpolation of its file.
    Cone { peak: f64, half_angle_deg: f64 },
    /// Bilinear in the angles of the file between the directions of the axes: exactly the interpolation of its file.
    Axes {
        down: f64,
        up: f64,
        /// Intensities along +x and −x.
        x: [f64; 2],
        /// Intensities along +y and −y.
        y: [f64; 2],
    },
    /// `−2 I₀ x z (1 + y/2)` where `x > 0` and `z < 0`, without a symmetry between +y and −y.
    Product { peak: f64, step_deg: f64 },
}

/// Angles of a table \[°\]: those of its planes, and those in a plane.
pub(crate) struct Angles {
    pub(crate) horizontal: Vec<f64>,
    pub(crate) vertical: Vec<f64>,
}

/// Returns angles from one to another.
fn steps(from: f64, to: f64, step: f64) -> Vec<f64> {
    let count = ((to - from) / step).round().max(1.0);
    (0..=count as u32).map(|i| from + (to - from) * f64::from(i) / count).collect()
}

impl Lamp {
    /// Returns the intensity in a direction of unit length. For `Axes` it is that of the nearest axis.
    pub(crate) fn intensity(&self, d: DVec3) -> f64 {
        match *self {
            Self::Power { peak, exponent, .. } => peak * libm::pow((-d.z).max(0.0), f64::from(exponent)),
            Self::Cone { peak, half_angle_deg } => {
                let angle = libm::atan2(libm::hypot(d.x, d.y), -d.z).to_degrees();
                peak * (1.0 - angle / half_angle_deg).max(0.0)
            }
            Self::Axes { down, up, x, y } => {
                let along = |values: [f64; 2], positive: bool| values[usize::from(!positive)];
                let sizes = d.abs();
                if sizes.z >= sizes.x.max(sizes.y) {
                    along([up, down], d.z > 0.0)
                } else if sizes.x >= sizes.y {
                    along(x, d.x > 0.0)
                } else {
                    along(y, d.y > 0.0)
                }
            }
            Self::Product { peak, .. } => 2.0 * peak * d.x.max(0.0) * (-d.z).max(0.0) * (1.0 + 0.5 * d.y),
        }
    }

    /// Returns the angles of the table of a file. Types A and B cover a half of all directions.
    pub(crate) fn angles(&self, file: FileKind) -> Angles {
        let half = |step| Angles { horizontal: steps(-90.0, 90.0, step), vertical: steps(-90.0, 90.0, step) };
        let is_half = matches!(file, FileKind::IesA | FileKind::IesB);
        match *self {
            Self::Power { step_deg, .. } => {
                Angles { horizontal: vec![0.0], vertical: steps(0.0, 90.0, step_deg) }
            }
            Self::Cone { half_angle_deg, .. } => {
                Angles { horizontal: vec![0.0], vertical: vec![0.0, half_angle_deg, 90.0] }
            }
            Self::Axes { .. } if is_half => half(90.0),
            Self::Product { step_deg, .. } if is_half => half(step_deg),
            Self::Axes { .. } => {
                Angles { horizontal: steps(0.0, 360.0, 90.0), vertical: steps(0.0, 180.0, 90.0) }
            }
            Self::Product { step_deg, .. } => {
                Angles { horizontal: steps(0.0, 360.0, step_deg), vertical: steps(0.0, 90.0, step_deg) }
            }
        }
    }
}
