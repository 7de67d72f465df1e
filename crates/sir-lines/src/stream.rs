//! Random streams, one per line.

use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// What a family of lines is for. Lines of different stages are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Stage(pub u64);

impl Stage {
    /// Local lines of the first shot.
    pub const FIRST_SHOT: Self = Self(1);
    /// Decisions of the first shot that are made once, before its lines.
    pub const ALLOCATION: Self = Self(2);
    /// Global lines.
    pub const GLOBAL: Self = Self(3);
    /// Sub-pixel positions of pictures.
    pub const PICTURE: Self = Self(4);
    /// Local lines of the second shot.
    pub const SECOND_SHOT: Self = Self(6);
    /// Rays of sensors.
    pub const SENSORS: Self = Self(9);
    /// Lines that are traced to learn about a scene, not to solve it.
    pub const PROBE: Self = Self(5);
    /// Local lines that count view factors.
    pub const VIEW_FACTORS: Self = Self(12);
}

/// The random streams of all lines of one stage.
#[derive(Clone, Copy, Debug)]
pub struct Streams {
    key: u64,
}

/// Increment of the SplitMix64 sequence: 2⁶⁴ divided by the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Numbers of a stage that belong to a line.
const PER_LINE: u64 = 1 << 14;

/// Output function of SplitMix64 (Steele, Lea, Flood 2014), a bijection of 64-bit words.
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Streams {
    /// The streams of a stage of a run with this seed.
    #[must_use]
    pub fn new(seed: u64, stage: Stage) -> Self {
        Self { key: mix(mix(seed.wrapping_add(GOLDEN)) ^ mix(stage.0.wrapping_mul(GOLDEN))) }
    }

    /// The stream of line `index`: of all numbers of the stage, those from `16,384 index`. As long as a line takes fewer, and an
    /// index has at most 50 bits, no two lines of a stage have one in common.
    #[inline]
    #[must_use]
    pub fn line(&self, index: u64) -> Stream {
        let first = index.wrapping_mul(GOLDEN.wrapping_mul(PER_LINE));
        Stream(SplitMix64::seed_from_u64(self.key.wrapping_add(first)))
    }
}

/// A sequence of random numbers.
#[derive(Clone, Debug)]
pub struct Stream(SplitMix64);

impl Stream {
    /// A uniform number in `[0, 1)`: a multiple of 2⁻⁵³.
    #[inline]
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// These numbers are part of the contract: if they change, no old result can be reproduced.
    #[test]
    fn streams_never_change() {
        let mut s = Streams::new(1, Stage::GLOBAL).line(0);
        let first: Vec<String> = (0..3).map(|_| format!("{:.15}", s.unit())).collect();
        assert_eq!(first, ["0.155747808824734", "0.782331486519907", "0.072572689650649"]);
    }

    #[test]
    fn neighbouring_lines_seeds_and_stages_are_uncorrelated() {
        let n = 20_000;
        let centred = |seed, stage, i| Streams::new(seed, stage).line(i).unit() - 0.5;
        let (global, local) = (Stage::GLOBAL, Stage::FIRST_SHOT);
        let lines = |i| centred(1, global, i) * centred(1, global, i + 1);
        let seeds = |i| centred(i, global, 0) * centred(i + 1, global, 0);
        let stages = |i| centred(1, global, i) * centred(1, local, i);
        for product in [&lines as &dyn Fn(u64) -> f64, &seeds, &stages] {
            let sum: f64 = (0..n).map(product).sum();
            // A product of two centred uniform numbers has the standard deviation 1/12.
            let z = sum * 12.0 / f64::from(n as u32).sqrt();
            assert!(z.abs() < 4.0, "correlated: z = {z}");
        }
    }
}
