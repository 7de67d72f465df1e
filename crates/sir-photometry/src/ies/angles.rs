//! Types of photometry and symmetries: from the angles of a file to a table over the whole range.

use crate::distribution::{Coordinates, IntensityDistribution};
use crate::error::PhotometryError;
use crate::planes::{Planes, ROUNDING, ascending, near, range, snapped, warn_of_range};

/// Type of photometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Type {
    C,
    B,
    A,
}

/// Lines in which the parts of a table begin.
#[derive(Clone, Copy)]
pub(crate) struct Lines {
    pub(crate) verticals: usize,
    pub(crate) horizontals: usize,
    pub(crate) values: usize,
}

/// Makes the distribution from the vertical angles \[°\] and the planes of constant horizontal angle.
///
/// # Errors
///
/// If the angles do not cover a range that the standard allows, or the table is invalid.
pub(crate) fn distribution(
    kind: Type,
    vertical: Vec<f64>,
    planes: Planes,
    lines: Lines,
    warnings: &mut Vec<String>,
) -> Result<IntensityDistribution, PhotometryError> {
    let [of_verticals, of_horizontals, of_values] =
        [lines.verticals, lines.horizontals, lines.values].map(PhotometryError::from_line);
    ascending("vertical angles", &vertical).map_err(&of_verticals)?;
    ascending("horizontal angles", &planes.angles).map_err(&of_horizontals)?;
    let from_nadir = |angles: &[f64]| angles.iter().map(|angle| snapped(angle + 90.0)).collect::<Vec<f64>>();
    let table = match kind {
        Type::C => {
            let polars: Vec<f64> = vertical.iter().map(|&angle| snapped(angle)).collect();
            let planes = around(planes, warnings).map_err(of_horizontals)?;
            within("vertical angles", &polars, 0.0, "angles within 0 to 180°").map_err(of_verticals)?;
            warn_of_range(&polars, warnings);
            IntensityDistribution::new(Coordinates::C, &planes.angles, &polars, &planes.values)
        }
        Type::A => {
            let planes = across(planes, warnings).map_err(&of_horizontals)?;
            let polars = from_nadir(&vertical);
            within("vertical angles", &polars, 90.0, "angles within -90 to 90°").map_err(of_verticals)?;
            warn_of_half(&vertical, warnings);
            IntensityDistribution::new(Coordinates::A, &planes.angles, &polars, &planes.values)
        }
        Type::B => {
            let planes = across(planes, warnings).map_err(&of_horizontals)?;
            let polars = from_nadir(&planes.angles);
            within("horizontal angles", &polars, 90.0, "angles within -90 to 90°")
                .map_err(&of_horizontals)?;
            warn_of_half(&vertical, warnings);
            // Planes of constant vertical angle share the horizontal axis.
            IntensityDistribution::new(Coordinates::B, &vertical, &polars, &planes.transposed())
        }
    };
    table.map_err(|problem| of_values(PhotometryError::Table { problem }))
}

/// Checks that polar angles are within 0 to 180°. `offset` is what was added to the angles of the file.
fn within(
    what: &'static str,
    polars: &[f64],
    offset: f64,
    expected: &'static str,
) -> Result<(), PhotometryError> {
    let [first, last] = range(polars);
    if first < 0.0 || last > 180.0 {
        return Err(PhotometryError::Angles { what, first: first - offset, last: last - offset, expected });
    }
    Ok(())
}

/// Extends planes of type C to a full turn, as their first and last angles demand.
fn around(mut planes: Planes, warnings: &mut Vec<String>) -> Result<Planes, PhotometryError> {
    let [first, last] = planes.range();
    let count = planes.angles.len();
    let span = last - first;
    // The last angle of a full turn or of a symmetry may be rounded.
    for (turn, fold) in [(90.0, 2), (180.0, 1), (360.0, 0)] {
        if near(span, turn)
            && (fold < 2 || near(first.rem_euclid(90.0), 0.0) || near(first.rem_euclid(90.0), 90.0))
        {
            planes.angles[count - 1] = first + turn;
            for _ in 0..fold {
                planes.mirror_at_last();
            }
            return Ok(planes);
        }
    }
    if count <= 1 {
        if !near(first, 0.0) {
            warnings.push(format!(
                "The only horizontal angle is {first}°, not 0; its intensities are those all around."
            ));
        }
        return Ok(planes);
    }
    if !(180.0..=360.0).contains(&span) {
        let expected = "0 only, 0 to 90°, 0 to 180°, 90 to 270° or 0 to 360°";
        return Err(PhotometryError::Angles { what: "horizontal angles", first, last, expected });
    }
    let largest = planes.angles.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    if 360.0 - span <= 2.0 * largest + ROUNDING {
        planes.close();
        warnings.push(format!(
            "The horizontal angles end at {last}°; the first plane is repeated at {}° to close the circle.",
            first + 360.0
        ));
    } else {
        warnings.push(format!(
            "The horizontal angles end at {last}°; there is no light between there and {first}°."
        ));
    }
    Ok(planes)
}

/// Extends planes of type A or B to both sides if they start at the plane of symmetry.
fn across(mut planes: Planes, warnings: &mut Vec<String>) -> Result<Planes, PhotometryError> {
    let [first, last] = planes.range();
    if planes.angles.len() < 2 {
        let expected = "0 to 90° or -90 to 90°";
        return Err(PhotometryError::Angles { what: "horizontal angles", first, last, expected });
    }
    if near(first, 0.0) && last < 180.0 + ROUNDING {
        planes.angles[0] = 0.0;
        planes.mirror_at_first();
    }
    let [first, last] = planes.range();
    if first > -90.0 + ROUNDING || last < 90.0 - ROUNDING {
        warnings
            .push(format!("There is no light outside of the horizontal angles from {first}° to {last}°."));
    }
    Ok(planes)
}

/// Warns if the vertical angles of types A and B cover one side only: the standard knows no vertical symmetry.
fn warn_of_half(vertical: &[f64], warnings: &mut Vec<String>) {
    let [first, last] = range(vertical);
    if first > -90.0 + ROUNDING || last < 90.0 - ROUNDING {
        warnings.push(format!("There is no light outside of the vertical angles from {first}° to {last}°."));
    }
}
