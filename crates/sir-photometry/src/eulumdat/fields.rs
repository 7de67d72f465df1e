//! Fields that have a line of their own.

use crate::error::PhotometryError;
use crate::text::{Reader, WITHIN_LIMITS, is_too_large, shortened};

/// Returns the next line.
pub(crate) fn line<'a>(reader: &mut Reader<'a>, what: &str) -> Result<&'a str, PhotometryError> {
    let place = reader.place();
    let next = reader.line().map(|(line, _)| line);
    next.ok_or_else(|| PhotometryError::End { line: place.line, what: what.to_owned() })
}

/// Returns the number of the next line; 0 if the line is blank.
pub(crate) fn optional(reader: &mut Reader<'_>, what: &str) -> Result<f64, PhotometryError> {
    field_or(reader, what, "a number", |_| true, Some(0.0))
}

/// Returns the number of the next line, which must fulfill a condition that `expected` describes.
pub(crate) fn field(
    reader: &mut Reader<'_>,
    what: &str,
    expected: &'static str,
    condition: impl Fn(f64) -> bool,
) -> Result<f64, PhotometryError> {
    field_or(reader, what, expected, condition, None)
}

/// Does the same; a blank line has the value `blank`.
pub(crate) fn field_or(
    reader: &mut Reader<'_>,
    what: &str,
    expected: &'static str,
    condition: impl Fn(f64) -> bool,
    blank: Option<f64>,
) -> Result<f64, PhotometryError> {
    let place = reader.place();
    let text = line(reader, what)?;
    let value = if text.is_empty() { blank } else { reader.value(text) };
    value.filter(|&value| condition(value)).ok_or_else(|| PhotometryError::Value {
        line: place.line,
        column: place.column,
        what: what.to_owned(),
        found: shortened(text),
        expected: if is_too_large(text) { WITHIN_LIMITS } else { expected },
    })
}
