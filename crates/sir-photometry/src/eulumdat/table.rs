//! Angles and intensities, and their symmetries.

use crate::error::PhotometryError;
use crate::planes::{Planes, ascending, near};
use crate::text::Reader;

/// Returns angles, or multiples of a step if they do not ascend.
pub(crate) fn regular_if_broken(
    angles: Vec<f64>,
    step: f64,
    name: &str,
    warnings: &mut Vec<String>,
) -> Vec<f64> {
    if step <= 0.0 || ascending("", &angles).is_ok() {
        return angles;
    }
    warnings.push(format!("The angles {name} do not ascend; multiples of {step}° are used."));
    (0..angles.len()).map(|i| i as f64 * step).collect()
}

/// Returns the number of planes whose intensities are in a file with `all` planes around the full circle.
pub(crate) fn measured_count(symmetry: u8, all: usize) -> usize {
    match symmetry {
        0 => all,
        1 => 1,
        2 | 3 => all / 2 + 1,
        _ => all / 4 + 1,
    }
}

/// Returns the angles of the planes whose intensities are in the file.
pub(crate) fn measured_planes(symmetry: u8, all: &[f64]) -> Result<Vec<f64>, PhotometryError> {
    let (count, planes) = (all.len(), measured_count(symmetry, all.len()));
    let start = match symmetry {
        1 => return Ok(vec![0.0]),
        // From C270 through C0 to C90.
        3 => 3 * count / 4,
        _ => 0,
    };
    let angles: Vec<f64> =
        (start..start + planes).map(|i| all[i % count] + 360.0 * (i / count) as f64).collect();
    ascending("angles C", &angles)?;
    Ok(angles)
}

/// Reads the intensities. A few missing ones at the end are zero, with a warning: some programs leave them out.
pub(crate) fn intensities(
    reader: &mut Reader<'_>,
    planes: usize,
    gammas: usize,
    warnings: &mut Vec<String>,
) -> Result<Vec<f64>, PhotometryError> {
    let mut values = Vec::new();
    for plane in 1..=planes {
        for gamma in 1..=gammas {
            if plane == planes && gamma > 1 && reader.is_at_end() {
                warnings.push(format!(
                    "The last {} intensities are missing, and read as zero.",
                    gammas + 1 - gamma
                ));
                values.resize(planes * gammas, 0.0);
                return Ok(values);
            }
            values.push(
                reader
                    .number(|| format!("the intensity {gamma} of {gammas} in plane {plane} of {planes}"))?,
            );
        }
    }
    let left = reader.words_left();
    if left > 0 {
        warnings.push(format!("{left} numbers after the intensities are ignored."));
    }
    Ok(values)
}

/// Extends planes to a full turn by their symmetry.
pub(crate) fn extend(symmetry: u8, planes: &mut Planes) -> Result<(), PhotometryError> {
    let [first, last] = planes.range();
    let (expected, from, to, folds) = match symmetry {
        0 => {
            match planes.angles.len() {
                1 => {}
                // The plane C360 is in the file.
                count if near(last - first, 360.0) => planes.angles[count - 1] = first + 360.0,
                _ => planes.close(),
            }
            return Ok(());
        }
        1 => return Ok(()),
        2 => ("0 to 180° for the symmetry indicator 2", 0.0, 180.0, 1),
        3 => ("270 to 450° for the symmetry indicator 3", 270.0, 450.0, 1),
        _ => ("0 to 90° for the symmetry indicator 4", 0.0, 90.0, 2),
    };
    if !near(first, from) || !near(last, to) {
        return Err(PhotometryError::Angles { what: "angles C", first, last, expected });
    }
    let count = planes.angles.len();
    (planes.angles[0], planes.angles[count - 1]) = (from, to);
    for _ in 0..folds {
        planes.mirror_at_last();
    }
    Ok(())
}
