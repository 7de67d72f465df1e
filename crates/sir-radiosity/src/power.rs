//! Power in integers.

use std::ops::{Add, AddAssign, RangeInclusive, Sub};

use sir_geom::Rgb;

use crate::visitor::{Visitor, visit_float, visit_slice};

/// Power per band in whole quanta of a [`PowerUnit`].
///
/// Sums saturate instead of wrapping; the energy balance then does not close, which is reported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Quanta(pub [i64; 3]);

impl Quanta {
    /// No power.
    pub const ZERO: Self = Self([0; 3]);

    /// Returns this power times a fraction per band, rounded to the nearest quantum, halves away from zero.
    #[inline]
    #[must_use]
    pub fn scaled(self, fraction: Rgb) -> Self {
        let f = fraction.to_array();
        Self(std::array::from_fn(|k| {
            let exact = self.0[k] as f64 * f[k];
            (exact + 0.5_f64.copysign(exact)) as i64
        }))
    }

    /// Returns `count` times this power; saturates.
    #[inline]
    #[must_use]
    pub fn times(self, count: i64) -> Self {
        Self(self.0.map(|q| q.saturating_mul(count)))
    }

    /// Returns the sum over the bands.
    #[must_use]
    pub fn total(self) -> f64 {
        self.0.iter().map(|&q| q as f64).sum()
    }

    /// Returns the sum of the absolute values over the bands.
    #[must_use]
    pub fn amount(self) -> f64 {
        self.0.iter().map(|&q| (q as f64).abs()).sum()
    }

    #[inline]
    fn zip(self, other: Self, op: impl Fn(i64, i64) -> i64) -> Self {
        Self(std::array::from_fn(|k| op(self.0[k], other.0[k])))
    }
}

impl Add for Quanta {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        self.zip(other, i64::saturating_add)
    }
}

impl AddAssign for Quanta {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Quanta {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self.zip(other, i64::saturating_sub)
    }
}

/// Visits power that every worker holds identically.
pub(crate) fn visit_quanta(quanta: &mut [Quanta], visitor: &mut dyn Visitor) {
    visit_slice(quanta, visitor, |quanta| quanta.0, Quanta);
}

/// Range of the total power of the strongest band \[W\]. Its ends leave room for squares of irradiances, and for images
/// in single precision.
pub const POWERS: RangeInclusive<f64> = 1e-30..=1e30;

/// Size of a quantum in watts: a power of two, so that a conversion costs at most one rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerUnit {
    quantum: f64,
}

impl PowerUnit {
    /// Returns a unit that is fine enough to lose nothing and coarse enough not to overflow.
    ///
    /// All the power that is ever received, counted again at each reflection, is at most `total / (1 − ρ)` for the
    /// largest reflectance `ρ`. The unit lets four times that number, as a margin for chance, fill 62 bits. For
    /// `ρ ≤ 0.999` the quantum is at most 2⁻⁵⁰ of the total. `total` \[W\] is that of the strongest band.
    #[must_use]
    pub fn for_total(total: f64, largest_reflectance: f64) -> Self {
        let ceiling = 4.0 * total / (1.0 - largest_reflectance);
        // The next power of two from the exponent bits, which is exact, unlike `log2`.
        let exponent = ((ceiling.max(f64::MIN_POSITIVE).to_bits() >> 52) as i32) - 1023 + 1;
        Self { quantum: libm::scalbn(1.0, (exponent - 62).max(-1000)) }
    }

    /// Restores the unit that [`visit`](Self::visit) passed to the visitor that saved it.
    pub(crate) fn restore(visitor: &mut dyn Visitor) -> Self {
        let mut unit = Self { quantum: 1.0 };
        unit.visit(visitor);
        unit
    }

    /// Visits the unit.
    pub(crate) fn visit(&mut self, visitor: &mut dyn Visitor) {
        visit_float(&mut self.quantum, visitor);
    }

    /// Returns the nearest whole number of quanta; saturates.
    #[must_use]
    pub fn quanta(self, power: Rgb) -> Quanta {
        Quanta(power.to_array().map(|p| (p / self.quantum + 0.5) as i64))
    }

    /// Returns the power in watts.
    #[must_use]
    pub fn watts(self, quanta: Quanta) -> Rgb {
        Rgb::from_array(quanta.0.map(|q| q as f64 * self.quantum))
    }

    /// Returns the number of watts per quantum.
    #[must_use]
    pub fn quantum(self) -> f64 {
        self.quantum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_leaves_room_and_precision() {
        for total in [1e-30, 3.0, 1e6, 1e30] {
            let unit = PowerUnit::for_total(total, 0.999);
            let q = unit.quanta(Rgb::splat(total));
            assert!(q.0[0] > 1 << 49, "{total}: {q:?}");
            assert!(q.0[0] < (1 << 62) / 4000, "{total}: {q:?}");
            assert!((unit.watts(q).x / total - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn scaling_rounds_to_the_nearest_and_sums_saturate() {
        let q = Quanta([10, 7, 0]);
        assert_eq!(q.scaled(Rgb::new(0.25, 0.5, 0.9)), Quanta([3, 4, 0]));
        assert_eq!(Quanta([-10, -7, 0]).scaled(Rgb::new(0.25, 0.5, 0.9)), Quanta([-3, -4, 0]));
        assert_eq!(Quanta([i64::MAX; 3]) + q, Quanta([i64::MAX; 3]));
    }
}
