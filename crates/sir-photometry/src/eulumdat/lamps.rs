//! Sets of lamps with which the luminaire can be equipped.

use crate::error::PhotometryError;
use crate::eulumdat::fields::{line, optional};
use crate::text::{Reader, color_temperature, shortened};

/// Maximum number of other sets of lamps that a warning names.
const MAX_NAMED: usize = 5;

/// A set of lamps.
#[derive(Default)]
pub(crate) struct Lamps {
    /// Number of lamps; negative for absolute photometry.
    pub(crate) count: f64,
    pub(crate) kind: String,
    /// Flux of all lamps together \[lm\].
    pub(crate) flux: f64,
    pub(crate) color_temperature: Option<f64>,
    pub(crate) watts: f64,
}

impl Lamps {
    /// Reads all sets, and returns one of them.
    pub(crate) fn read(
        reader: &mut Reader<'_>,
        count: usize,
        wanted: usize,
        warnings: &mut Vec<String>,
    ) -> Result<Self, PhotometryError> {
        let (mut chosen, mut others) = (None, Vec::new());
        for index in 0..count {
            let mut lamps = Self { count: optional(reader, "the number of lamps")?, ..Self::default() };
            lamps.kind = shortened(line(reader, "the type of lamps")?);
            lamps.flux = optional(reader, "the flux of the lamps")?;
            lamps.color_temperature = color_temperature(line(reader, "the color temperature")?);
            line(reader, "the color rendering")?;
            lamps.watts = optional(reader, "the electric power")?;
            if index == wanted {
                chosen = Some(lamps);
            } else if others.len() < MAX_NAMED {
                others.push(format!("{} × {}, {} lm", lamps.count.abs(), lamps.kind, lamps.flux));
            }
        }
        if count > 1 {
            let rest = if count - 1 > others.len() { "; …" } else { "" };
            warnings.push(format!(
                "The set of lamps {} of {count} is used; others are: {}{rest}.",
                wanted + 1,
                others.join("; ")
            ));
        }
        match chosen {
            Some(lamps) => Ok(lamps),
            None if count == 0 && wanted == 0 => Ok(Self::default()),
            None => Err(PhotometryError::LampSet { count, wanted: wanted + 1 }),
        }
    }
}
