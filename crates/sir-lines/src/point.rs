//! Uniform points of the unit cube.

use rand::Rng;

/// Converts 64 random bits to a number in `[0, 1)`, a multiple of 2⁻⁵³. The crate `rand` currently converts bits to
/// `f64` in the same way, but does not guarantee it for later versions, and these bits are part of our contract.
#[inline]
pub(crate) fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// Draws a uniform point of the unit cube `[0, 1)^K` from any generator, coordinate by coordinate, with 64 bits for
/// each.
#[inline]
pub fn random_point<const K: usize>(generator: &mut (impl Rng + ?Sized)) -> [f64; K] {
    std::array::from_fn(|_| unit(generator.next_u64()))
}

/// Uniform numbers of one line, which decide where it begins and where it goes.
pub trait Numbers {
    /// Draws a uniform number in `[0, 1)`: a multiple of 2⁻⁵³.
    fn unit(&mut self) -> f64;

    /// Draws a uniform point of the unit cube `[0, 1)^K`, coordinate by coordinate, as [`unit`](Self::unit) does.
    #[inline]
    fn point<const K: usize>(&mut self) -> [f64; K] {
        std::array::from_fn(|_| self.unit())
    }
}

#[cfg(test)]
mod tests {
    use rand::rngs::SmallRng;
    use rand::{RngExt, SeedableRng};

    use super::*;

    #[test]
    fn numbers_are_those_of_rand() {
        let generator = || SmallRng::seed_from_u64(3);
        let (mut ours, mut theirs) = (generator(), generator());
        let point: [f64; 1000] = random_point(&mut ours);
        assert_eq!(point, std::array::from_fn(|_| theirs.random::<f64>()));
        assert!(point.iter().all(|x| (0.0..1.0).contains(x)));
        assert_eq!([unit(0), unit(u64::MAX)], [0.0, 1.0 - 0.5 * f64::EPSILON]);
    }
}
