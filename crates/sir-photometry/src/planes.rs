//! Planes of a measurement, and their repetition by symmetry.

use crate::error::PhotometryError;

/// Deviation of an angle \[°\] that is taken for rounding.
pub(crate) const ROUNDING: f64 = 0.05;

/// Half planes that share an axis, each with as many intensities as there are angles in it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Planes {
    /// Angles between the planes \[°\], ascending.
    pub(crate) angles: Vec<f64>,
    /// Intensities of all planes after each other.
    pub(crate) values: Vec<f64>,
}

impl Planes {
    /// Returns the number of values of a plane.
    fn width(&self) -> usize {
        self.values.len() / self.angles.len().max(1)
    }

    /// Returns the first and the last angle; zeros if there is no plane.
    pub(crate) fn range(&self) -> [f64; 2] {
        range(&self.angles)
    }

    /// Adds the mirror images of all planes behind the last one.
    pub(crate) fn mirror_at_last(&mut self) {
        let (width, [_, last]) = (self.width(), self.range());
        for plane in (0..self.angles.len().saturating_sub(1)).rev() {
            self.angles.push(2.0 * last - self.angles[plane]);
            self.values.extend_from_within(plane * width..(plane + 1) * width);
        }
    }

    /// Adds the mirror images of all planes before the first one.
    pub(crate) fn mirror_at_first(&mut self) {
        let (width, [first, _]) = (self.width(), self.range());
        let (mut angles, mut values) = (Vec::new(), Vec::new());
        for plane in (1..self.angles.len()).rev() {
            angles.push(2.0 * first - self.angles[plane]);
            values.extend_from_slice(&self.values[plane * width..(plane + 1) * width]);
        }
        angles.append(&mut self.angles);
        values.append(&mut self.values);
        *self = Self { angles, values };
    }

    /// Adds the first plane again at a full turn.
    pub(crate) fn close(&mut self) {
        let (width, [first, _]) = (self.width(), self.range());
        self.angles.push(first + 360.0);
        self.values.extend_from_within(..width);
    }

    /// Returns the values in the order of the other angles: the first values of all planes, then the second values.
    pub(crate) fn transposed(&self) -> Vec<f64> {
        let width = self.width();
        (0..width)
            .flat_map(|i| (0..self.angles.len()).map(move |plane| (plane, i)))
            .map(|(plane, i)| self.values[plane * width + i])
            .collect()
    }
}

/// Returns true if two angles \[°\] differ by rounding only.
pub(crate) fn near(angle: f64, other: f64) -> bool {
    (angle - other).abs() < ROUNDING
}

/// Returns a polar angle \[°\], moved to 0, 90 or 180° if it is nearly there.
pub(crate) fn snapped(angle: f64) -> f64 {
    [0.0, 90.0, 180.0].into_iter().find(|round| (angle - round).abs() < 1e-3).unwrap_or(angle)
}

/// Returns the first and the last angle; zeros if there is none.
pub(crate) fn range(angles: &[f64]) -> [f64; 2] {
    [angles.first(), angles.last()].map(|angle| angle.copied().unwrap_or(0.0))
}

/// Checks that angles ascend.
///
/// # Errors
///
/// If they do not.
pub(crate) fn ascending(what: &'static str, angles: &[f64]) -> Result<(), PhotometryError> {
    let Some(pair) = angles.windows(2).find(|pair| pair[0] >= pair[1]) else { return Ok(()) };
    Err(PhotometryError::Angles {
        what,
        first: pair[0],
        last: pair[1],
        expected: "each larger than the one before",
    })
}

/// Warns if polar angles \[°\] end within a hemisphere.
pub(crate) fn warn_of_range(polars: &[f64], warnings: &mut Vec<String>) {
    let [first, last] = range(polars);
    if !([0.0, 90.0].contains(&first) && [90.0, 180.0].contains(&last)) {
        warnings.push(format!("There is no light outside of the vertical angles from {first}° to {last}°."));
    }
}

/// Sets negative intensities to zero, with a warning: they are noise of the measurement.
pub(crate) fn without_negative(values: &mut [f64], warnings: &mut Vec<String>) {
    let (mut count, mut lowest) = (0, 0.0);
    for value in values {
        if *value < 0.0 {
            lowest = f64::min(lowest, *value);
            *value = 0.0;
            count += 1;
        }
    }
    if count > 0 {
        warnings.push(format!(
            "{count} negative intensities are set to zero; the lowest in the table is {lowest}."
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_repeated() {
        let planes = Planes { angles: vec![0.0, 30.0, 90.0], values: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0] };
        let mut mirrored = planes.clone();
        mirrored.mirror_at_last();
        assert_eq!(mirrored.angles, [0.0, 30.0, 90.0, 150.0, 180.0]);
        assert_eq!(mirrored.values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 3.0, 4.0, 1.0, 2.0]);
        let mut mirrored = planes.clone();
        mirrored.mirror_at_first();
        assert_eq!(mirrored.angles, [-90.0, -30.0, 0.0, 30.0, 90.0]);
        assert_eq!(mirrored.values, [5.0, 6.0, 3.0, 4.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let mut closed = planes.clone();
        closed.close();
        assert_eq!((closed.angles.last(), &closed.values[6..]), (Some(&360.0), &[1.0, 2.0][..]));
        assert_eq!(planes.transposed(), [1.0, 3.0, 5.0, 2.0, 4.0, 6.0]);
    }

    #[test]
    fn negative_values_become_zero() {
        let (mut values, mut warnings) = (vec![1.0, -0.5, -0.1], Vec::new());
        without_negative(&mut values, &mut warnings);
        assert_eq!(values, [1.0, 0.0, 0.0]);
        assert!(warnings[0].contains("2 negative") && warnings[0].contains("-0.5"), "{warnings:?}");
    }
}
