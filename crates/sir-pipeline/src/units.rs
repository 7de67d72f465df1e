//! Units of the numbers of a pipeline.

use serde::{Deserialize, Serialize};

/// Radiometric or photometric units. The numbers are the same: the choice only affects how they are labeled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Units {
    /// Power in watts per band. Default.
    #[default]
    Radiometric,
    /// Luminous flux in lumens per band. If a light is white, or all bands are equal, the numbers are lumens, lux and
    /// candelas.
    Photometric,
}

impl Units {
    /// Returns the unit of power: `W` or `lm`.
    #[must_use]
    pub fn power(self) -> &'static str {
        match self {
            Self::Radiometric => "W",
            Self::Photometric => "lm",
        }
    }

    /// Returns the unit of irradiance, illuminance and radiosity: `W/m²` or `lx`.
    #[must_use]
    pub fn irradiance(self) -> &'static str {
        match self {
            Self::Radiometric => "W/m²",
            Self::Photometric => "lx",
        }
    }

    /// Returns the name of the received power per area: `irradiance` or `illuminance`.
    #[must_use]
    pub fn irradiance_name(self) -> &'static str {
        match self {
            Self::Radiometric => "irradiance",
            Self::Photometric => "illuminance",
        }
    }

    /// Returns the unit of radiance and luminance: `W/(m² sr)` or `cd/m²`.
    #[must_use]
    pub fn radiance(self) -> &'static str {
        match self {
            Self::Radiometric => "W/(m² sr)",
            Self::Photometric => "cd/m²",
        }
    }

    /// Returns the name of the light in a direction per area across it and solid angle: `radiance` or `luminance`.
    #[must_use]
    pub fn radiance_name(self) -> &'static str {
        match self {
            Self::Radiometric => "radiance",
            Self::Photometric => "luminance",
        }
    }
}
