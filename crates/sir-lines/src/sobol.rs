//! Points of a scrambled Sobol' sequence, one per line, which fill the unit cube more evenly than independent points.
//!
//! The sequence is that of Sobol' (1967) with the direction numbers of Joe and Kuo (2008, *Constructing Sobol' sequences with
//! better two-dimensional projections*). Each coordinate has a scramble of its own, as Owen (1995) describes them: the first
//! digits of a number decide whether its next digit is flipped. So every point is uniform, as if it were drawn at random, and
//! an estimate from the points has no bias. The scramble is a hash (Burley 2020, *Practical hash-based Owen scrambling*), so
//! that any point can be computed alone.

use crate::point::{Numbers, unit};
use crate::stream::{Purpose, Stream, Streams};

/// Number of coordinates of a point. Further numbers of a line are independent.
const DIMENSIONS: usize = 4;

/// Number of binary digits of an index, and of a coordinate.
const BITS: usize = 32;

/// Degree and coefficients of the primitive polynomials of the coordinates after the first, and the first direction numbers
/// (Joe and Kuo 2008, table `new-joe-kuo-6.21201`).
const POLYNOMIALS: [(usize, u32, [u32; 3]); DIMENSIONS - 1] =
    [(1, 0, [1, 0, 0]), (2, 1, [1, 3, 0]), (3, 1, [1, 3, 1])];

/// Coordinates of all indices with a single nonzero byte, with their binary digits in reverse: by byte, value and
/// coordinate. The coordinates of other indices are exclusive sums of these.
static OF_BYTES: [[[u32; DIMENSIONS]; 256]; 4] = of_bytes();

/// Returns the coordinates of the indices that are powers of two: the direction numbers.
const fn directions() -> [[u32; DIMENSIONS]; BITS] {
    let mut all = [[0; DIMENSIONS]; BITS];
    let mut k = 0;
    while k < BITS {
        all[k][0] = 1 << (BITS - 1 - k);
        k += 1;
    }
    let mut dimension = 1;
    while dimension < DIMENSIONS {
        let (degree, coefficients, first) = POLYNOMIALS[dimension - 1];
        let mut k = 0;
        while k < BITS {
            all[k][dimension] = if k < degree {
                first[k] << (BITS - 1 - k)
            } else {
                let before = all[k - degree][dimension];
                let mut v = before ^ (before >> degree);
                let mut i = 1;
                while i < degree {
                    if (coefficients >> (degree - 1 - i)) & 1 == 1 {
                        v ^= all[k - i][dimension];
                    }
                    i += 1;
                }
                v
            };
            k += 1;
        }
        dimension += 1;
    }
    all
}

const fn of_bytes() -> [[[u32; DIMENSIONS]; 256]; 4] {
    let directions = directions();
    let mut all = [[[0; DIMENSIONS]; 256]; 4];
    let mut byte = 0;
    while byte < 4 {
        let mut value = 0;
        while value < 256 {
            let mut bit = 0;
            while bit < 8 {
                if (value >> bit) & 1 == 1 {
                    let mut d = 0;
                    while d < DIMENSIONS {
                        all[byte][value][d] ^= directions[8 * byte + bit][d].reverse_bits();
                        d += 1;
                    }
                }
                bit += 1;
            }
            value += 1;
        }
        byte += 1;
    }
    all
}

/// Scrambled Sobol' points of all lines of one stage.
#[derive(Clone, Debug)]
pub struct SobolPoints {
    /// Independent numbers of each line, after those of its point.
    rest: Streams,
    /// Seeds of the scrambles.
    scrambles: Streams,
    /// Scramble of the first 2³² lines.
    first: [u32; DIMENSIONS],
}

impl SobolPoints {
    /// Returns the points of a stage of a run with this seed.
    #[must_use]
    pub fn new(seed: u64, stage: Purpose) -> Self {
        let scrambles = Streams::new(seed, Purpose(stage.0 | Purpose::SCRAMBLE.0));
        Self { rest: Streams::new(seed, stage), scrambles, first: scramble(scrambles, 0) }
    }

    /// Returns the numbers of line `index`. Lines from number 2³² on have another scramble.
    #[inline]
    #[must_use]
    pub fn line(&self, index: u64) -> SobolPoint {
        let block = index >> BITS;
        let scramble = if block == 0 { self.first } else { scramble(self.scrambles, block) };
        let bytes = (index as u32).to_le_bytes();
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| &OF_BYTES[k][usize::from(bytes[k])]);
        let coordinates =
            std::array::from_fn(|k| owen(a[k] ^ b[k] ^ c[k] ^ d[k], scramble[k]).reverse_bits());
        SobolPoint { coordinates, used: 0, rest: self.rest.line(index) }
    }
}

/// Returns the scramble of a block of 2³² lines.
fn scramble(scrambles: Streams, block: u64) -> [u32; DIMENSIONS] {
    let mut stream = scrambles.line(block);
    std::array::from_fn(|_| (stream.word() >> 32) as u32)
}

/// Scrambles the digits of a number, which are in reverse: each is flipped or not, depending on those below it. The addition
/// makes the result uniform, and the products with even numbers carry digits upwards only (Laine and Karras 2011; multipliers
/// by Burley 2020).
#[inline]
fn owen(reversed: u32, seed: u32) -> u32 {
    let mut x = reversed.wrapping_add(seed);
    x ^= x.wrapping_mul(0x6c50_b47c);
    x ^= x.wrapping_mul(0xb82f_1e52);
    x ^= x.wrapping_mul(0xc7af_e638);
    x ^ x.wrapping_mul(0x8d22_f6e6)
}

/// Numbers of one line: the coordinates of its point, and then independent ones.
#[derive(Clone, Debug)]
pub struct SobolPoint {
    coordinates: [u32; DIMENSIONS],
    used: usize,
    rest: Stream,
}

impl Numbers for SobolPoint {
    #[inline]
    fn unit(&mut self) -> f64 {
        let word = self.rest.word();
        match self.coordinates.get(self.used) {
            Some(&coordinate) => {
                self.used += 1;
                // The digits after those of the point are random.
                unit(u64::from(coordinate) << 32 | word >> 32)
            }
            None => unit(word),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(seed: u64, indices: std::ops::Range<u64>) -> Vec<[f64; DIMENSIONS]> {
        let points = SobolPoints::new(seed, Purpose::FIRST_SHOT);
        indices.map(|i| points.line(i).point()).collect()
    }

    #[test]
    fn the_sequence_is_that_of_sobol() {
        // By hand, from the recurrence for the direction numbers.
        let directions = directions();
        let at = |index: usize| {
            let mut x = [0; DIMENSIONS];
            for bit in (0..BITS).filter(|bit| index >> bit & 1 == 1) {
                x.iter_mut().zip(directions[bit]).for_each(|(x, direction)| *x ^= direction);
            }
            x.map(|x| f64::from(x) / 2f64.powi(32))
        };
        assert_eq!(at(1), [0.5; 4]);
        assert_eq!(at(2), [0.25, 0.75, 0.75, 0.75]);
        assert_eq!(at(3), [0.75, 0.25, 0.25, 0.25]);
        assert_eq!(at(4), [0.125, 0.625, 0.375, 0.125]);
        assert_eq!(at(8), [1.0, 15.0, 9.0, 5.0].map(|x| x / 16.0));
    }

    /// Of any aligned 2ᵏ points, each of the 2ᵏ equal intervals of a coordinate has one, and each of the 2ᵏ equal rectangles
    /// of the first two coordinates has one, whatever their shape.
    #[test]
    fn aligned_blocks_of_points_are_nets() {
        for start in [0, 1 << 8, 77 << 8, 1 << 32, (1 << 40) + (5 << 8)] {
            let block = points(3, start..start + 256);
            for dimension in 0..DIMENSIONS {
                let mut cells: Vec<_> = block.iter().map(|p| (256.0 * p[dimension]) as u32).collect();
                cells.sort_unstable();
                assert!(cells.into_iter().eq(0..256), "{start}, coordinate {dimension}");
            }
            for bits in 0..=8 {
                let [width, height] = [1 << bits, 256 >> bits].map(f64::from);
                let cell =
                    |p: &[f64; DIMENSIONS]| (width * p[0]) as u32 * (256 >> bits) + (height * p[1]) as u32;
                let mut cells: Vec<_> = block.iter().map(cell).collect();
                cells.sort_unstable();
                assert!(cells.into_iter().eq(0..256), "{start}, {width} by {height}");
            }
        }
    }

    /// Over many seeds, a point and pairs of coordinates and of points are uniform: each sixteenth of a coordinate, and each
    /// of 64 squares of a pair, has its share within 5 standard errors.
    #[test]
    fn every_point_is_uniform_over_the_seeds() {
        let seeds = 40_000_u32;
        let mut of_pairs = vec![[0u32; 64]; DIMENSIONS];
        let mut of_points = [[0u32; 16]; DIMENSIONS];
        for seed in 0..seeds {
            let p = points(u64::from(seed), 12_345..12_346)[0];
            for (k, counts) in of_pairs.iter_mut().enumerate() {
                let (x, y) = (p[k], p[(k + 1) % DIMENSIONS]);
                counts[(8.0 * x) as usize * 8 + (8.0 * y) as usize] += 1;
                of_points[k][(16.0 * x) as usize] += 1;
            }
        }
        let n = f64::from(seeds);
        let check = |counts: &[u32]| {
            let share = 1.0 / counts.len() as f64;
            let sigma = (n * share * (1.0 - share)).sqrt();
            assert!(counts.iter().all(|&c| (f64::from(c) - n * share).abs() < 5.0 * sigma), "{counts:?}");
        };
        of_pairs.iter().for_each(|counts| check(counts));
        of_points.iter().for_each(|counts| check(counts));
    }

    #[test]
    fn integrals_converge_faster_than_with_independent_points() {
        // The mean of a product of all coordinates is 1/16.
        let n = 1 << 14;
        let error = |seed| {
            let sum: f64 = points(seed, 0..n).iter().map(|p| p.iter().product::<f64>()).sum();
            sum / n as f64 - 1.0 / 16.0
        };
        let square = (0..32).map(|seed| error(seed) * error(seed)).sum::<f64>() / 32.0;
        let independent = ((1.0 / 3f64.powi(4) - 1.0 / 256.0) / n as f64).sqrt();
        assert!(square.sqrt() < independent / 10.0, "{} {independent}", square.sqrt());
    }

    /// These numbers are part of the contract: if they change, earlier results cannot be reproduced.
    #[test]
    fn points_never_change() {
        let mut line = SobolPoints::new(1, Purpose::FIRST_SHOT).line(7);
        let numbers: Vec<String> = (0..6).map(|_| format!("{:.12}", line.unit())).collect();
        let expected = [
            "0.755170233273",
            "0.236149831048",
            "0.197395491591",
            "0.315593948001",
            "0.631617375408",
            "0.075351846008",
        ];
        assert_eq!(numbers, expected);
    }
}
