//! A whole file: header, tilt factors, and the table of intensities with its factors.

use std::io;

use crate::error::PhotometryError;
use crate::ies::angles::{Lines, Type, distribution};
use crate::ies::shape::opening;
use crate::ies::version::Version;
use crate::ies::{header, tilt};
use crate::photometry::Photometry;
use crate::planes::{Planes, without_negative};
use crate::text::{Comma, Reader};

/// Meters per foot.
const FOOT: f64 = 0.3048;

/// Reads a decoded file. `tilt_file` returns the contents of the file that the line `TILT=` names.
///
/// # Errors
///
/// If the file is incomplete, or a value is invalid.
pub(crate) fn read(
    text: &str,
    tilt_file: &mut dyn FnMut(&str) -> io::Result<Vec<u8>>,
) -> Result<Photometry, PhotometryError> {
    let mut warnings = Vec::new();
    let mut reader = Reader::new(text, Comma::Separator);
    let header = header::read(&mut reader, &mut warnings)?;
    let tilt = tilt::read(header.tilt, &mut reader, tilt_file, &mut warnings)?;
    let numbers = Numbers::read(&mut reader)?;
    let Numbers { verticals, horizontals, kind, .. } = numbers;

    let line_of_verticals = reader.line_of_next();
    let vertical = reader.numbers(verticals, "the vertical angle")?;
    let line_of_horizontals = reader.line_of_next();
    let angles = reader.numbers(horizontals, "the horizontal angle")?;
    let line_of_values = reader.line_of_next();
    let mut values = Vec::new();
    for angle in &angles {
        let what = format!("the intensity at the horizontal angle {angle}°, number");
        values.append(&mut reader.numbers(verticals, &what)?);
    }
    if reader.words_left() > 0 {
        warnings.push("The text after the first luminaire is ignored.".to_owned());
    }
    numbers.warn(&mut warnings);
    let factor = numbers.factor(header.version, &mut warnings);
    without_negative(&mut values, &mut warnings);
    values.iter_mut().for_each(|value| *value *= factor);
    let opening = opening(header.version, numbers.extents, &mut warnings);
    let lines =
        Lines { verticals: line_of_verticals, horizontals: line_of_horizontals, values: line_of_values };
    let distribution = distribution(kind, vertical, Planes { angles, values }, lines, &mut warnings)?;
    Ok(Photometry {
        format: format!("{} type {kind:?}", header.version.name()),
        name: header.name,
        distribution,
        lamp_flux: Some(numbers.lamps * numbers.lumens).filter(|&flux| numbers.lumens > 0.0 && flux > 0.0),
        stated_flux: None,
        watts: (numbers.watts > 0.0).then_some(numbers.watts),
        color_temperature: header.color_temperature,
        opening,
        tilt,
        warnings,
    })
}

/// The thirteen numbers before the angles.
struct Numbers {
    lamps: f64,
    /// Per lamp; −1 for absolute photometry.
    lumens: f64,
    multiplier: f64,
    verticals: usize,
    horizontals: usize,
    kind: Type,
    /// Width, length and height of the opening \[m\], with their signs.
    extents: [f64; 3],
    ballast: f64,
    /// Ballast-lamp photometric factor until 1991, `future use` in 1995 and 2002, a code for the origin of the data in 2019.
    ballast_lamp: f64,
    watts: f64,
}

impl Numbers {
    fn read(reader: &mut Reader<'_>) -> Result<Self, PhotometryError> {
        let positive = "a number above 0";
        let lamps = reader.number(|| "the number of lamps".to_owned())?;
        let lumens = reader.number(|| "the flux per lamp".to_owned())?;
        let multiplier = reader.number_in(|| "the candela multiplier".to_owned(), positive, |x| x > 0.0)?;
        let verticals = reader.count("the number of vertical angles")?;
        let horizontals = reader.count("the number of horizontal angles")?;
        let one_of = |reader: &mut Reader<'_>, what: &str, expected, last| {
            reader.number_in(
                || what.to_owned(),
                expected,
                move |x| (1.0..=last).contains(&x) && x.fract() == 0.0,
            )
        };
        let kind = match one_of(reader, "the photometric type", "1 for C, 2 for B or 3 for A", 3.0)? as u8 {
            1 => Type::C,
            2 => Type::B,
            _ => Type::A,
        };
        let unit = one_of(reader, "the unit of lengths", "1 for feet or 2 for meters", 2.0)?;
        let mut extents = [0.0; 3];
        for (extent, name) in extents.iter_mut().zip(["width", "length", "height"]) {
            let number = reader.number(|| format!("the {name} of the luminous opening"))?;
            *extent = if unit == 1.0 { number * FOOT } else { number };
        }
        let ballast = reader.number_in(|| "the ballast factor".to_owned(), positive, |x| x > 0.0)?;
        let ballast_lamp = reader.number(|| "the ballast-lamp factor".to_owned())?;
        let watts = reader.number(|| "the electric power".to_owned())?;
        Ok(Self {
            lamps,
            lumens,
            multiplier,
            verticals,
            horizontals,
            kind,
            extents,
            ballast,
            ballast_lamp,
            watts,
        })
    }

    /// Warns about numbers that are ignored.
    fn warn(&self, warnings: &mut Vec<String>) {
        let Self { lamps, lumens, watts, .. } = *self;
        if lumens != -1.0 && (lumens <= 0.0 || lamps <= 0.0) {
            warnings.push(format!(
                "The flux of {lamps} × {lumens} lm of the lamps is ignored; it should be above 0, or -1 lm per lamp for \
                 absolute photometry."
            ));
        }
        if watts < 0.0 {
            warnings.push(format!("The electric power {watts} W is negative, and ignored."));
        }
    }

    /// Returns the factor of all intensities. The ballast-lamp factor exists until 1991 only: later versions use its place for
    /// other purposes.
    fn factor(&self, version: Version, warnings: &mut Vec<String>) -> f64 {
        let factor = self.multiplier * self.ballast;
        match version {
            Version::V1986 | Version::V1991 if self.ballast_lamp > 0.0 => factor * self.ballast_lamp,
            Version::V2019 => factor,
            _ => {
                if self.ballast_lamp != 1.0 {
                    let found = self.ballast_lamp;
                    warnings.push(format!(
                        "The number {found} after the ballast factor is ignored; it should be 1."
                    ));
                }
                factor
            }
        }
    }
}
