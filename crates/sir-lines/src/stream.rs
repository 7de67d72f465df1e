//! Counter-based random streams, one per line.

use std::convert::Infallible;

use rand::{Rng, SeedableRng, TryRng};
use rand_xoshiro::SplitMix64;

use crate::point::{Numbers, random_point, unit};

/// Purpose of a set of lines. Lines of different purposes have independent streams.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Purpose(pub u64);

impl Purpose {
    /// Local lines of the first shot.
    pub const FIRST_SHOT: Self = Self(1);
    /// Random offsets of the first shot that are drawn once, before its lines.
    pub const ALLOCATION: Self = Self(2);
    /// Global lines.
    pub const GLOBAL: Self = Self(3);
    /// Subpixel positions of images.
    pub const PICTURE: Self = Self(4);
    /// Local lines of the second shot.
    pub const SECOND_SHOT: Self = Self(6);
    /// Rays of sensors.
    pub const SENSORS: Self = Self(9);
    /// Lines that are traced to inspect a scene, not to solve it.
    pub const PROBE: Self = Self(5);
    /// Local lines of view factors.
    pub const VIEW_FACTORS: Self = Self(12);
    /// Random walks that send on what global lines have left unshot.
    pub const WALKS: Self = Self(17);
    /// Shadow rays from patches.
    pub const SHADOW_RAYS: Self = Self(18);
    /// Scrambles of the points of a stage, combined with its purpose.
    pub(crate) const SCRAMBLE: Self = Self(1 << 32);
    /// Seeds of repeats.
    const REPEAT: Self = Self(16);
}

/// Random streams of all lines of one stage.
#[derive(Clone, Copy, Debug)]
pub struct Streams {
    key: u64,
}

/// Increment of the SplitMix64 sequence: 2⁶⁴ divided by the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Length of the section of the sequence that belongs to one line.
const PER_LINE: u64 = 1 << 14;

/// Applies the output function of SplitMix64 (Steele, Lea, Flood 2014), a bijection of 64-bit words.
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Streams {
    /// Returns the streams of a stage of a run with this seed.
    #[must_use]
    pub fn new(seed: u64, stage: Purpose) -> Self {
        Self { key: mix(mix(seed.wrapping_add(GOLDEN)) ^ mix(stage.0.wrapping_mul(GOLDEN))) }
    }

    /// Returns the stream of line `index`: the section of the sequence of the stage that begins at number `16,384
    /// index`. If a line uses at most 16,384 numbers and an index has at most 50 bits, the streams of a stage do not
    /// overlap.
    #[inline]
    #[must_use]
    pub fn line(&self, index: u64) -> Stream {
        let first = index.wrapping_mul(GOLDEN.wrapping_mul(PER_LINE));
        Stream(SplitMix64::seed_from_u64(self.key.wrapping_add(first)))
    }
}

/// Returns the seed of a repeat of a run with the seed `seed`. Repeat 0 has that seed itself; the others have distinct
/// random seeds.
#[must_use]
pub fn seed_of_repeat(seed: u64, repeat: u64) -> u64 {
    if repeat == 0 { seed } else { Streams::new(seed, Purpose::REPEAT).line(repeat).0.next_u64() }
}

/// Random numbers of one line, as a generator of the crate [`rand`].
#[derive(Clone, Debug)]
pub struct Stream(SplitMix64);

impl Stream {
    /// Draws 64 random bits.
    #[inline]
    pub(crate) fn word(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Draws a uniform number in `[0, 1)`: a multiple of 2⁻⁵³.
    #[inline]
    pub fn unit(&mut self) -> f64 {
        unit(self.word())
    }

    /// Draws a uniform point of the unit cube `[0, 1)^K`, coordinate by coordinate, as [`unit`](Self::unit) does.
    #[inline]
    pub fn point<const K: usize>(&mut self) -> [f64; K] {
        random_point(&mut self.0)
    }
}

impl Numbers for Stream {
    #[inline]
    fn unit(&mut self) -> f64 {
        Self::unit(self)
    }
}

impl TryRng for Stream {
    type Error = Infallible;

    #[inline]
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        self.0.try_next_u32()
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        self.0.try_next_u64()
    }

    #[inline]
    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        self.0.try_fill_bytes(bytes)
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;

    /// These numbers are part of the contract: if they change, earlier results cannot be reproduced.
    #[test]
    fn streams_never_change() {
        let mut s = Streams::new(1, Purpose::GLOBAL).line(0);
        let first: Vec<String> = (0..3).map(|_| format!("{:.15}", s.unit())).collect();
        assert_eq!(first, ["0.155747808824734", "0.782331486519907", "0.072572689650649"]);
    }

    /// As a generator of `rand`, a stream gives the same numbers as by its own methods.
    #[test]
    fn streams_are_generators() {
        let line = || Streams::new(1, Purpose::GLOBAL).line(7);
        let (mut ours, mut theirs) = (line(), line());
        let numbers: [f64; 20] = ours.point();
        assert_eq!(numbers, std::array::from_fn(|_| theirs.random::<f64>()));
        let (mut ours, mut theirs) = (line(), line());
        assert_eq!(numbers, std::array::from_fn(|_| ours.unit()));
        assert_eq!(numbers, random_point(&mut theirs));
    }

    #[test]
    fn repeats_have_seeds_of_their_own() {
        assert_eq!([0, 1, 7].map(|seed| seed_of_repeat(seed, 0)), [0, 1, 7]);
        let mut seeds: Vec<u64> = (0..3).flat_map(|s| (0..1000).map(move |r| seed_of_repeat(s, r))).collect();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), 3000);
        // Part of the contract, like the numbers above.
        assert_eq!(seed_of_repeat(1, 1), 8_567_385_128_412_321_973);
    }

    #[test]
    fn neighboring_lines_seeds_and_stages_are_uncorrelated() {
        let n = 20_000;
        let centered = |seed, stage, i| Streams::new(seed, stage).line(i).unit() - 0.5;
        let (global, local) = (Purpose::GLOBAL, Purpose::FIRST_SHOT);
        let lines = |i| centered(1, global, i) * centered(1, global, i + 1);
        let seeds = |i| centered(i, global, 0) * centered(i + 1, global, 0);
        let stages = |i| centered(1, global, i) * centered(1, local, i);
        for product in [&lines as &dyn Fn(u64) -> f64, &seeds, &stages] {
            let sum: f64 = (0..n).map(product).sum();
            // The product of two centered uniform numbers has the standard deviation 1/12.
            let z = sum * 12.0 / f64::from(n as u32).sqrt();
            assert!(z.abs() < 4.0, "correlated: z = {z}");
        }
    }
}
