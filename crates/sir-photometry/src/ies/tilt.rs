//! Tables of tilt factors, in the file itself or in another one.

use std::io;

use crate::error::PhotometryError;
use crate::text::{Comma, Reader, decode, shortened};
use crate::tilt::{LampGeometry, Tilt};

/// Reads the tilt factors that the line `TILT=` asks for. A tilt file that cannot be read is a warning, because it changes
/// nothing for a luminaire that is not tilted.
///
/// # Errors
///
/// If the table is invalid.
pub(crate) fn read(
    value: &str,
    reader: &mut Reader<'_>,
    tilt_file: &mut dyn FnMut(&str) -> io::Result<Vec<u8>>,
    warnings: &mut Vec<String>,
) -> Result<Option<Tilt>, PhotometryError> {
    let name = value.trim_matches(|c: char| c.is_whitespace() || "\"'<>".contains(c));
    if name.eq_ignore_ascii_case("NONE") {
        return Ok(None);
    }
    if name.eq_ignore_ascii_case("INCLUDE") {
        return table(reader).map(Some);
    }
    if name.is_empty() {
        warnings.push("The line \"TILT=\" has no value; it is read as NONE.".to_owned());
        return Ok(None);
    }
    match tilt_file(name) {
        Ok(bytes) => match table(&mut Reader::new(&decode(&bytes), Comma::Separator)) {
            Ok(tilt) => Ok(Some(tilt)),
            Err(problem) => {
                Err(PhotometryError::TiltFile { name: shortened(name), problem: Box::new(problem) })
            }
        },
        Err(error) => {
            let name = shortened(name);
            warnings.push(format!(
                "The tilt file \"{name}\" cannot be read ({error}); no tilt factor is applied."
            ));
            Ok(None)
        }
    }
}

fn table(reader: &mut Reader<'_>) -> Result<Tilt, PhotometryError> {
    let is_geometry = |number: f64| [1.0, 2.0, 3.0].contains(&number);
    let geometry =
        reader.number_in(|| "the lamp-to-luminaire geometry".to_owned(), "1, 2 or 3", is_geometry)?;
    let geometry = match geometry as u8 {
        1 => LampGeometry::Vertical,
        2 => LampGeometry::HorizontalFixed,
        _ => LampGeometry::HorizontalTilting,
    };
    let count = reader.count("the number of tilt angles")?;
    let place = reader.place();
    let angles = reader.numbers(count, "the tilt angle")?;
    let mut factors = Vec::new();
    for i in 0..count {
        let what = || format!("the tilt factor {} of {count}", i + 1);
        factors.push(reader.number_in(what, "a number that is not negative", |factor| factor >= 0.0)?);
    }
    let range = [angles.first(), angles.last()].map(|angle| angle.copied().unwrap_or(0.0));
    let pairs = angles.into_iter().zip(factors).map(|(angle, factor)| [angle, factor]).collect();
    Tilt::new(geometry, pairs).ok_or_else(|| PhotometryError::Value {
        line: place.line,
        column: place.column,
        what: "the list of tilt angles".to_owned(),
        found: format!("{} … {}", range[0], range[1]),
        expected: "ascending angles",
    })
}
