//! What the numbers of a pipeline are measured in.

use serde::{Deserialize, Serialize};

/// Whether light is counted as radiation or by what the eye sees of it. The numbers are the same: this only says what they are called.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Units {
    /// Power in watts per band. Default.
    #[default]
    Radiometric,
    /// Luminous flux in lumens per band: where a light is white, or all bands are alike, they are lumens, lux and candelas.
    Photometric,
}

impl Units {
    /// Of power: `W` or `lm`.
    #[must_use]
    pub fn power(self) -> &'static str {
        match self {
            Self::Radiometric => "W",
            Self::Photometric => "lm",
        }
    }

    /// Of irradiance and illuminance, and of radiosity: `W/m²` or `lx`.
    #[must_use]
    pub fn irradiance(self) -> &'static str {
        match self {
            Self::Radiometric => "W/m²",
            Self::Photometric => "lx",
        }
    }

    /// What falls on a surface: `irradiance` or `illuminance`.
    #[must_use]
    pub fn irradiance_name(self) -> &'static str {
        match self {
            Self::Radiometric => "irradiance",
            Self::Photometric => "illuminance",
        }
    }
}
