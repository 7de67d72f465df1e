//! Independent repeats of the same stages: their mean, and standard errors from their spread.
//!
//! A run of few lines is unbiased, so the mean of `k` runs with independent random numbers is, too. Its variance can be
//! estimated without any assumption about a single run: `Σ(x − mean)²/(k (k − 1))`. It includes what the errors of a
//! single run leave out, such as noise that a patch inherits from its neighbors.
//!
//! The spread of few runs is itself uncertain. For `k` runs, the deviation from the truth over the standard error
//! follows Student's t distribution with `k − 1` degrees of freedom. With fewer than [`MIN_REPEATS`], the variance is
//! therefore the mean of the variances that the runs state, over `k`.

use std::sync::Arc;

use sir_geom::Rgb;
use sir_lines::GlobalLines;
use sir_mesh::{SideId, SideSums};

use crate::counted::{Counted, CountedPower, common_scale, ratio};
use crate::focus_sides::FocusSides;
use crate::model::Model;
use crate::power::{PowerUnit, Quanta};
use crate::received::Received;
use crate::repeated_sums::RepeatedSums;
use crate::visitor::Visitor;
use crate::visitor::{from_word, to_word, visit_counts, visit_floats, visit_slice};
use crate::workers::{BLOCK, Workers, map_sides};

/// Smallest number of repeats for which errors are computed from their spread.
pub const MIN_REPEATS: u64 = 8;

/// Power received by the sides of patches in all repeats so far.
///
/// What lines have brought is estimated from the sums over all repeats, as if the lines of all were those of one: with few
/// crossings, a ratio of sums is far better than a mean of ratios. Its error is that of its linearization (the delta
/// method; Cochran 1977, section 6.4): per repeat the deviation of `power − β crossings`, with the mean power `β` of a
/// crossing.
#[derive(Clone, Debug)]
pub struct Repeats {
    count: u64,
    sides: Vec<Sums>,
    /// Sums of the variances that repeats state \[quanta²\], while they are too few for a spread; empty if not needed.
    stated: Vec<[f32; 3]>,
    /// Domain of the lines that are counted, and their number in all repeats.
    lines: Option<(GlobalLines, u64)>,
    /// Sums over sides whose errors are wanted.
    sums: Vec<RepeatedSums>,
}

/// Sums over repeats of one side, in 72 bytes.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Power, as lines have brought it \[quanta\].
    power: [f64; 3],
    /// Sum of the squared deviations from the mean power \[quanta²\].
    squares: [f32; 3],
    /// Sum of the products of the deviations of power and crossings \[quanta\].
    products: [f32; 3],
    /// Part of `power` that counted lines have brought \[quanta\].
    brought: [f32; 3],
    /// Number of these lines.
    crossings: f32,
    /// Sum of the squared deviations from their mean number.
    crossing_squares: f32,
}

impl Sums {
    /// Adds a repeat after `n` others.
    fn add(&mut self, n: f64, power: Quanta, brought: CountedPower) {
        let (power, crossings) = (power + brought.power, brought.crossings as f64);
        for (sum, brought) in self.brought.iter_mut().zip(brought.power.0) {
            *sum = (f64::from(*sum) + brought as f64) as f32;
        }
        if n > 0.0 {
            // Welford (1962): deviations from the previous means.
            let weight = n / (n + 1.0);
            let of_crossings = crossings - f64::from(self.crossings) / n;
            let square = of_crossings * of_crossings * weight;
            self.crossing_squares = (f64::from(self.crossing_squares) + square) as f32;
            for band in 0..3 {
                let deviation = power.0[band] as f64 - self.power[band] / n;
                let (square, product) = (&mut self.squares[band], &mut self.products[band]);
                *square = (f64::from(*square) + deviation * deviation * weight) as f32;
                *product = (f64::from(*product) + deviation * of_crossings * weight) as f32;
            }
        }
        self.power.iter_mut().zip(power.0).for_each(|(sum, power)| *sum += power as f64);
        self.crossings = (f64::from(self.crossings) + crossings) as f32;
    }

    /// Returns the mean power of a crossing.
    fn per_crossing(&self, band: usize) -> f64 {
        if self.crossings > 0.0 { f64::from(self.brought[band]) / f64::from(self.crossings) } else { 0.0 }
    }

    /// Returns the variance of the mean of `count` repeats. `is_counted` is true if the ratio estimator applies.
    fn variance(&self, count: u64, is_counted: bool) -> [f32; 3] {
        let (pairs, crossings) = ((count * (count - 1)) as f64, f64::from(self.crossings));
        // Two lines at least tell what a line brings, and how much that varies.
        let is_ratio = is_counted && crossings >= 2.0;
        let few = if is_ratio { crossings / (crossings - 1.0) } else { 1.0 };
        [0, 1, 2].map(|band| {
            let beta = if is_ratio { self.per_crossing(band) } else { 0.0 };
            let squares = f64::from(self.squares[band]) - 2.0 * beta * f64::from(self.products[band])
                + beta * beta * f64::from(self.crossing_squares);
            (few * squares.max(0.0) / pairs) as f32
        })
    }
}

impl Repeats {
    /// Memory per side \[bytes\].
    pub const BYTES_PER_SIDE: usize = size_of::<Sums>() + size_of::<[f32; 3]>();

    /// Memory per part of sums over sides \[bytes\].
    pub const BYTES_PER_PART: usize = RepeatedSums::BYTES_PER_PART;

    /// Returns the sums over no repeats, for runs with this number of sides.
    #[must_use]
    pub fn new(sides: usize) -> Self {
        Self {
            count: 0,
            sides: vec![Sums::default(); sides],
            stated: vec![[0.0; 3]; sides],
            lines: None,
            sums: Vec::new(),
        }
    }

    /// Returns the sums over no repeats, of which there will be [`MIN_REPEATS`] at least. The errors that single repeats
    /// state are not needed then. The errors of fewer are infinite.
    #[must_use]
    pub fn of_many(sides: usize) -> Self {
        Self { stated: Vec::new(), ..Self::new(sides) }
    }

    /// Adds sums over sides, whose errors [`errors_of_sums`](Self::errors_of_sums) returns. There must be no repeat yet.
    #[must_use]
    pub fn with_sums(mut self, sums: &[Arc<SideSums>]) -> Self {
        self.sums = sums.iter().cloned().map(RepeatedSums::new).collect();
        self
    }

    /// Returns the number of repeats so far.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// True if the errors are computed from the spread of the repeats, and not from the errors that each of them
    /// states.
    #[must_use]
    pub fn have_spread(&self) -> bool {
        self.count >= MIN_REPEATS
    }

    /// Adds a repeat: the power that sides have received, and what counted lines have brought besides. Repeats must be
    /// added in the order of their numbers, because sums are rounded.
    pub fn add(
        &mut self,
        model: &Model,
        received: &Received,
        counted: Option<&Counted>,
        workers: &dyn Workers,
    ) {
        for sums in &mut self.sums {
            let per_crossing = |side: SideId, band: usize| self.sides[side.index()].per_crossing(band);
            sums.add(model, received, counted, &per_crossing, self.count == 0);
        }
        let n = self.count as f64;
        map_sides(workers, &model.mesh, self.sides.chunks_mut(BLOCK), |sides, sums| {
            for ((_, side), sums) in sides.iter().zip(sums) {
                let brought = counted.map(|counted| counted.sides[side.index()]);
                sums.add(n, received.power[side.index()], brought.unwrap_or_default());
            }
        });
        if let Some(counted) = counted {
            let before = self.lines.take().map_or(0, |(_, lines)| lines);
            self.lines = Some((counted.domain.clone(), before + counted.lines));
        }
        self.count += 1;
        if self.have_spread() {
            self.stated = Vec::new();
        }
        if self.stated.is_empty() {
            return;
        }
        let mut add = |variance: &[[f32; 3]]| {
            for (sum, variance) in self.stated.iter_mut().zip(variance) {
                sum.iter_mut().zip(variance).for_each(|(sum, more)| *sum += more);
            }
        };
        match counted {
            Some(counted) => {
                let mut all = received.clone();
                counted.add_to(&mut all, model, workers);
                add(&all.variance);
            }
            None => add(&received.variance),
        }
    }

    /// Calls `visit` for every side, in blocks of sides, with its area, the mean power of all repeats \[quanta\], and the
    /// variance of the mean \[quanta²\]. Returns the results of all blocks in order.
    fn map_means<T: Default + Send>(
        &self,
        model: &Model,
        in_focus: &FocusSides,
        workers: &dyn Workers,
        visit: impl Fn(&mut T, SideId, f64, [f64; 3], [f32; 3]) + Sync,
    ) -> Vec<T> {
        let count = self.count.max(1) as f64;
        let forecast = self.lines.as_ref().map(|(domain, lines)| domain.forecast(*lines));
        let factor = |sums: &Sums, area: f64| {
            let expected = forecast.as_ref().map_or(0.0, |forecast| forecast.crossings(area));
            ratio(expected, f64::from(sums.crossings))
        };
        let brought = |sums: &Sums| sums.brought.map(f64::from);
        let scale = common_scale(model, workers, in_focus, |triangle, side| {
            let sums = &self.sides[side.index()];
            (brought(sums), factor(sums, model.area(triangle, side)))
        });
        map_sides(workers, &model.mesh, self.sides.chunks(BLOCK), |sides, sums| {
            let mut result = T::default();
            for ((triangle, side), sums) in sides.iter().zip(sums) {
                let area = model.area(triangle, side);
                let is_counted = in_focus.contains(side) && self.lines.is_some();
                let factor = if is_counted { factor(sums, area) } else { 1.0 };
                let mean = [0, 1, 2].map(|band| {
                    let factor = if is_counted { factor * scale[band] } else { 1.0 };
                    (sums.power[band] + (factor - 1.0) * brought(sums)[band]) / count
                });
                let variance = match self.have_spread() {
                    true => sums.variance(self.count, is_counted),
                    false => self.stated.get(side.index()).map_or([f32::INFINITY; 3], |stated| {
                        stated.map(|sum| (f64::from(sum) / (count * count)) as f32)
                    }),
                };
                visit(&mut result, side, area, mean, variance);
            }
            result
        })
    }

    /// Returns the mean of all repeats, to the nearest quantum, with the variance of the mean.
    #[must_use]
    pub fn mean(&self, model: &Model, in_focus: &FocusSides, workers: &dyn Workers) -> Received {
        type Block = (Vec<Quanta>, Vec<[f32; 3]>);
        let blocks = self.map_means(model, in_focus, workers, |block: &mut Block, _, _, mean, variance| {
            block.0.push(Quanta(mean.map(|mean| mean.round() as i64)));
            block.1.push(variance);
        });
        let (power, variance): (Vec<_>, Vec<_>) = blocks.into_iter().unzip();
        Received { power: power.concat(), variance: variance.concat() }
    }

    /// Returns the relative error of the mean irradiance, per band: root of the area-weighted mean square of the standard
    /// errors, over the area-weighted mean, over the sides in the focus. Zero in a band without light.
    #[must_use]
    pub fn relative_error(&self, model: &Model, in_focus: &FocusSides, workers: &dyn Workers) -> [f64; 3] {
        type Block = (f64, [f64; 3], [f64; 3]);
        let blocks =
            self.map_means(model, in_focus, workers, |block: &mut Block, side, area, mean, variance| {
                if in_focus.contains(side) && area > 0.0 {
                    block.0 += area;
                    for band in 0..3 {
                        block.1[band] += mean[band];
                        block.2[band] += f64::from(variance[band]) / area;
                    }
                }
            });
        let all: f64 = blocks.iter().map(|block| block.0).sum();
        std::array::from_fn(|band| {
            let power: f64 = blocks.iter().map(|block| block.1[band]).sum();
            let squares: f64 = blocks.iter().map(|block| block.2[band]).sum();
            if power > 0.0 { (squares * all).sqrt() / power } else { 0.0 }
        })
    }

    /// Returns the standard errors of the irradiance and of the radiosity of each part of the sums with this index
    /// \[W/m²\], means over the covered area; `None` if there are not enough repeats. `unit` is the unit of the power.
    #[must_use]
    pub fn errors_of_sums(
        &self,
        index: usize,
        model: &Model,
        in_focus: &FocusSides,
        unit: PowerUnit,
    ) -> Option<Vec<[Rgb; 2]>> {
        let sums = self.sums.get(index).filter(|_| self.have_spread())?;
        let brought = |side: SideId| {
            let is_counted = self.lines.is_some() && in_focus.contains(side);
            if is_counted { self.sides[side.index()].brought.map(f64::from) } else { [0.0; 3] }
        };
        Some(sums.errors(model, self.count, unit, &brought))
    }

    /// Visits the sums. `domain` is that of the lines that are counted.
    pub fn visit(&mut self, domain: impl FnOnce() -> Option<GlobalLines>, visitor: &mut dyn Visitor) {
        let mut lines = self.lines.as_ref().map_or(0, |(_, lines)| *lines);
        visit_counts([&mut self.count, &mut lines], visitor);
        if lines > 0 && self.lines.is_none() {
            self.lines = domain().map(|domain| (domain, lines));
        }
        if self.have_spread() {
            self.stated = Vec::new();
        }
        visit_floats(&mut self.stated, visitor);
        self.sums.iter_mut().for_each(|sums| sums.visit(visitor));
        visit_slice(
            &mut self.sides,
            visitor,
            |sums| {
                let Sums { power, squares, products, brought, crossings, crossing_squares } = *sums;
                let [a, b, c] = power.map(|power| power.to_bits() as i64);
                let ([d, e, f], [g, h, i], [j, k, l]) =
                    (squares.map(to_word), products.map(to_word), brought.map(to_word));
                [a, b, c, d, e, f, g, h, i, j, k, l, to_word(crossings), to_word(crossing_squares)]
            },
            |[a, b, c, d, e, f, g, h, i, j, k, l, m, n]| Sums {
                power: [a, b, c].map(|word| f64::from_bits(word as u64)),
                squares: [d, e, f].map(from_word),
                products: [g, h, i].map(from_word),
                brought: [j, k, l].map(from_word),
                crossings: from_word(m),
                crossing_squares: from_word(n),
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use std::sync::LazyLock;

    use glam::DVec3;
    use sir_geom::{Material, Rgb, SceneBuilder};
    use sir_lines::{Domain, Purpose, Streams};
    use sir_mesh::Subdivision;

    use super::*;
    use crate::workers::OneWorker;

    /// A single triangle, which is a single side.
    static MODEL: LazyLock<Model> = LazyLock::new(|| {
        let mut builder = SceneBuilder::new();
        let material = builder.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|corner| builder.add_vertex(corner));
        builder.add_polygon(&corners, material);
        Model::new(builder.build().unwrap().scene, Subdivision::PerTriangle).unwrap()
    });

    fn received(power: i64, variance: f32) -> Received {
        Received { power: vec![Quanta([power, -power, 0])], variance: vec![[variance; 3]] }
    }

    fn of(all: impl IntoIterator<Item = Received>) -> Repeats {
        let mut repeats = Repeats::new(1);
        all.into_iter().for_each(|one| repeats.add(&MODEL, &one, None, &OneWorker));
        repeats
    }

    fn mean(repeats: &Repeats) -> Received {
        repeats.mean(&MODEL, &FocusSides::all(), &OneWorker)
    }

    #[test]
    fn the_mean_of_one_is_that_one() {
        let one = received(1 << 52, 0.1);
        assert_eq!(mean(&of([one.clone()])), one);
    }

    #[test]
    fn few_repeats_have_the_errors_that_they_state() {
        let mean = mean(&of([7, 8, 10].map(|power| received(power, 3.0))));
        assert_eq!(mean.power[0], Quanta([8, -8, 0]));
        assert_eq!(mean.variance[0], [1.0; 3], "of three, the mean of what they state over three");
    }

    #[test]
    fn the_spread_is_that_of_the_textbook() {
        // Small deviations of large numbers, which must not cancel.
        let far = 1_i64 << 30;
        let deviations = [3, -1, 4, -1, 5, -9, 2, -6, 5, 3];
        let repeats = of(deviations.map(|d| received(far + d, 1e9)));
        let n = deviations.len() as f64;
        let center = deviations.iter().sum::<i64>() as f64 / n;
        let squares: f64 = deviations.iter().map(|&d| (d as f64 - center) * (d as f64 - center)).sum();
        let expected = squares / (n * (n - 1.0));
        let [r, g, b] = mean(&repeats).variance[0].map(f64::from);
        assert!((r / expected - 1.0).abs() < 1e-6 && (g / expected - 1.0).abs() < 1e-6, "{r} {g} {expected}");
        assert_eq!(b, 0.0);
    }

    /// Many runs of repeats with few crossings each: the mean is unbiased, and its error is right. Lines bring power that
    /// differs, or the same, in which case counting leaves no noise but that of the number of lines.
    #[test]
    fn pooled_ratios_are_unbiased_and_their_errors_honest() {
        let domain = GlobalLines::from(Domain::hull(MODEL.scene.vertices()));
        let (area, repeats) = (MODEL.scene.total_area(), 16u32);
        let nothing = Received::nothing(1);
        let per_line = domain.forecast(1).crossings(area);
        for (expected, spread) in [(0.5, 0.9), (2.0, 0.9), (10.0, 0.9), (10.0, 0.0)] {
            let lines = (expected / per_line).round() as u64;
            let (runs, streams) = (4000u32, Streams::new(1, Purpose::PROBE));
            let (mut sum, mut squares, mut stated, mut number) = (0.0, 0.0, 0.0, 0);
            for _ in 0..runs {
                let mut all = Repeats::new(1);
                for _ in 0..repeats {
                    let mut stream = streams.line(number);
                    number += 1;
                    // A Poisson number of lines (Knuth), which bring an uneven power each.
                    let (mut crossings, mut power, mut product) = (0, 0.0, stream.unit());
                    while product > libm::exp(-expected) {
                        crossings += 1;
                        power += 1e6 * (1.0 + spread * (2.0 * stream.unit() - 1.0));
                        product *= stream.unit();
                    }
                    let power = Quanta([power as i64; 3]);
                    let sides = vec![CountedPower { power, crossings, variance: [0.0; 3] }];
                    let focus_sides = FocusSides::all();
                    let counted = Counted { domain: domain.clone(), lines, focus_sides, sides };
                    all.add(&MODEL, &nothing, Some(&counted), &OneWorker);
                }
                // Without the common scale, which would undo the correction of a single side.
                let sums = &all.sides[0];
                let factor = ratio(expected * f64::from(repeats), f64::from(sums.crossings));
                let mean = factor * f64::from(sums.brought[0]) / f64::from(repeats);
                sum += mean;
                squares += mean * mean;
                stated += f64::from(sums.variance(u64::from(repeats), true)[0]);
            }
            let n = f64::from(runs);
            let (mean, exact) = (sum / n, 1e6 * expected);
            let variance = squares / n - mean * mean;
            let z = (mean - exact) / (variance / n).sqrt();
            let ratio = (variance / (stated / n)).sqrt();
            println!("{expected} crossings, spread {spread}: z {z:.2}, spread over stated {ratio:.3}");
            if spread > 0.0 {
                assert!(z.abs() < 4.0, "{mean} of {exact}: z = {z}");
                assert!((0.9..1.1).contains(&ratio), "{expected}: {ratio}");
            } else {
                assert!((mean / exact - 1.0).abs() < 1e-6 && variance < 1e-9 * exact * exact);
            }
        }
    }
}
