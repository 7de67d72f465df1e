//! Dependence of the light of a lamp on its tilt.

/// Dependence of the light of a luminaire on its tilt: some discharge lamps are dimmer if they are tilted. The intensities
/// of a luminaire that is turned away from the position of its measurement must be multiplied by [`factor`](Self::factor).
///
/// A luminaire that is aimed straight down, as it was measured, has the factor at 0°, which is 1 in most files.
#[derive(Clone, Debug, PartialEq)]
pub struct Tilt {
    /// Position of the lamp in the luminaire.
    pub geometry: LampGeometry,
    /// Angles \[°\], ascending, and their factors; at least one.
    table: Vec<[f64; 2]>,
}

/// Position of the lamp in a luminaire that is aimed straight down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LampGeometry {
    /// Vertical, with the base up or down.
    Vertical,
    /// Horizontal, and it stays so when the luminaire is tilted.
    HorizontalFixed,
    /// Horizontal, and it is tilted with the luminaire.
    HorizontalTilting,
}

impl Tilt {
    /// Makes the dependence from pairs of an angle \[°\] and its factor. `None` if there is no pair, if the angles do not
    /// ascend, or if a number is not finite or a factor is negative.
    #[must_use]
    pub fn new(geometry: LampGeometry, table: Vec<[f64; 2]>) -> Option<Self> {
        let valid =
            table.iter().all(|&[angle, factor]| angle.is_finite() && factor.is_finite() && factor >= 0.0);
        let ascends = table.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        (valid && ascends && !table.is_empty()).then_some(Self { geometry, table })
    }

    /// Returns the factor at a tilt of the lamp \[°\], which is interpolated linearly. Beyond the table it is that of the
    /// nearest angle.
    #[must_use]
    pub fn factor(&self, degrees: f64) -> f64 {
        let after = self.table.partition_point(|pair| pair[0] <= degrees);
        let [low, high] = [after.saturating_sub(1), after.min(self.table.len() - 1)].map(|i| self.table[i]);
        if low[0] == high[0] {
            return low[1];
        }
        low[1] + (degrees - low[0]) / (high[0] - low[0]) * (high[1] - low[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_interpolated() {
        let tilt = Tilt::new(LampGeometry::Vertical, vec![[0.0, 1.0], [10.0, 0.9], [90.0, 0.5]]).unwrap();
        for (angle, factor) in
            [(-5.0, 1.0), (0.0, 1.0), (5.0, 0.95), (10.0, 0.9), (50.0, 0.7), (90.0, 0.5), (120.0, 0.5)]
        {
            assert!((tilt.factor(angle) - factor).abs() < 1e-15, "{angle}");
        }
        assert_eq!(Tilt::new(LampGeometry::Vertical, vec![]), None);
        assert_eq!(Tilt::new(LampGeometry::Vertical, vec![[1.0, 1.0], [0.0, 1.0]]), None);
        assert_eq!(Tilt::new(LampGeometry::Vertical, vec![[0.0, -1.0]]), None);
    }
}
