//! Lines 1 to 26: names, numbers of angles, dimensions and factors.

use crate::error::PhotometryError;
use crate::eulumdat::fields::{field, field_or, line, optional};
use crate::opening::{Opening, Outline};
use crate::text::{Reader, shortened_to};

/// Maximum number of characters of the name of a luminaire.
const MAX_NAME: usize = 200;

/// Contents of the header, as far as they matter.
pub(crate) struct Header {
    pub(crate) name: String,
    /// Symmetry indicator `Isym`.
    pub(crate) symmetry: u8,
    /// Number of planes around the full circle, `Mc`, and the step between them \[°\].
    pub(crate) planes: usize,
    pub(crate) plane_step: f64,
    /// Number of angles in a plane, `Ng`, and the step between them \[°\].
    pub(crate) gammas: usize,
    pub(crate) gamma_step: f64,
    /// Length and width of the luminaire \[mm\].
    pub(crate) luminaire: [f64; 2],
    /// Length and width of the luminous area, and its heights in the planes C0, C90, C180 and C270 \[mm\].
    pub(crate) area: [f64; 2],
    pub(crate) heights: [f64; 4],
    /// Light output ratio \[%\].
    pub(crate) output_ratio: f64,
    pub(crate) conversion: f64,
    /// Tilt during the measurement \[°\].
    pub(crate) tilt: f64,
    /// Number of sets of lamps.
    pub(crate) sets: usize,
}

impl Header {
    pub(crate) fn read(reader: &mut Reader<'_>, warnings: &mut Vec<String>) -> Result<Self, PhotometryError> {
        let company = line(reader, "the company")?;
        line(reader, "the type indicator")?;
        let indicator = |x: f64| (0.0..=4.0).contains(&x) && x.fract() == 0.0;
        let symmetry =
            field(reader, "the symmetry indicator", "a whole number from 0 to 4", indicator)? as u8;
        let count = |x: f64| (1.0..=1e9).contains(&x) && x.fract() == 0.0;
        let planes =
            field(reader, "the number of planes", "a whole number from 1 to 1000000000", count)? as usize;
        let plane_step = optional(reader, "the step between planes")?;
        let gammas =
            field(reader, "the number of angles in a plane", "a whole number from 1 to 1000000000", count)?
                as usize;
        let gamma_step = optional(reader, "the step between angles in a plane")?;
        line(reader, "the number of the report")?;
        let luminaire = line(reader, "the name of the luminaire")?;
        let number = line(reader, "the number of the luminaire")?;
        let luminaire = if luminaire.is_empty() { number } else { luminaire };
        let name =
            company.split_whitespace().chain(luminaire.split_whitespace()).collect::<Vec<_>>().join(" ");
        line(reader, "the file name")?;
        line(reader, "the date")?;
        let mut sizes = [0.0; 9];
        for size in &mut sizes {
            let line = reader.place().line;
            *size = optional(reader, "a dimension")?;
            if *size < 0.0 {
                warnings.push(format!("The dimension {size} mm in line {line} is read without its sign."));
                *size = size.abs();
            }
        }
        let [length, width, _, area_length, area_width, heights @ ..] = sizes;
        optional(reader, "the downward flux fraction")?;
        let output_ratio = optional(reader, "the light output ratio")?;
        let conversion = optional(reader, "the conversion factor")?;
        let tilt = optional(reader, "the tilt of the measurement")?;
        let whole = |x: f64| (0.0..=1e9).contains(&x) && x.fract() == 0.0;
        let sets = field_or(reader, "the number of lamp sets", "a whole number", whole, Some(0.0))? as usize;
        Ok(Self {
            name: shortened_to(&name, MAX_NAME),
            symmetry,
            planes,
            plane_step,
            gammas,
            gamma_step,
            luminaire: [length, width],
            area: [area_length, area_width],
            heights,
            output_ratio,
            conversion,
            tilt,
            sets,
        })
    }

    /// Returns the factor of intensities.
    pub(crate) fn conversion(&self, warnings: &mut Vec<String>) -> f64 {
        if self.conversion > 0.0 {
            return self.conversion;
        }
        warnings.push(format!("The conversion factor {} is read as 1.", self.conversion));
        1.0
    }

    pub(crate) fn opening(&self, warnings: &mut Vec<String>) -> Opening {
        let meters = |millimeters: f64| millimeters / 1000.0;
        let [length, width] = self.area.map(meters);
        let height = meters(self.heights.iter().sum::<f64>() / 4.0);
        if self.heights.iter().any(|&other| other != self.heights[0]) {
            warnings.push(format!(
                "The luminous heights {:?} mm differ; their mean {} mm is used.",
                self.heights,
                1000.0 * height
            ));
        }
        // A circle has a diameter, and no width.
        let (outline, length, width) = match (length > 0.0, width > 0.0) {
            (false, false) if height == 0.0 => {
                if self.luminaire.iter().any(|&size| size > 0.0) {
                    warnings.push(
                        "The file states no luminous area; the luminaire is read as a point.".to_owned(),
                    );
                }
                return Opening::Point;
            }
            (true, false) => (Outline::Ellipse, length, length),
            (false, true) => (Outline::Ellipse, width, width),
            _ => (Outline::Rectangle, length, width),
        };
        if height > 0.0 {
            Opening::Solid { outline, length, width, height }
        } else {
            Opening::Flat { outline, length, width }
        }
    }
}
