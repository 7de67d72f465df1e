//! Sums over sides in independent repeats: the standard errors of their means.
//!
//! The light of patches is not independent: they share noise of the patches that they see, so the error of a sum is not
//! the root of the sum of squares. It follows from the spread of the sums.
//!
//! What counted lines have brought is corrected for their number, side by side (see [`Repeats`](crate::Repeats)). The
//! deviation of a sum is therefore that of `power − β (crossings − expected crossings)`, with the mean power `β` of a
//! crossing in the repeats before. The common scale, which leaves the total as the lines brought it, returns to each sum
//! its share of all these corrections.

use std::sync::Arc;

use sir_geom::Rgb;
use sir_mesh::{SideId, SideSums};

use crate::counted::Counted;
use crate::model::Model;
use crate::power::PowerUnit;
use crate::received::Received;
use crate::visitor::{Visitor, visit_counts, visit_slice};

/// Deviations of the sums over sides in all repeats so far.
#[derive(Clone, Debug)]
pub(crate) struct RepeatedSums {
    pub(crate) sums: Arc<SideSums>,
    /// Number of repeats that are in the deviations.
    count: u64,
    /// Received and reflected power of each part.
    parts: Vec<[Deviations; 2]>,
    /// The corrections of all sides together: they deviate from their own product.
    corrections: Deviations,
}

/// Deviations of a sum from its mean, per band.
#[derive(Clone, Copy, Debug, Default)]
struct Deviations {
    mean: [f64; 3],
    /// Sum of the squares.
    squares: [f64; 3],
    /// Sum of the products with the corrections of all sides.
    products: [f64; 3],
}

impl Deviations {
    /// Adds a repeat after `n` others, with the deviation of all corrections from their mean before.
    fn add(&mut self, n: f64, value: [f64; 3], correction: [f64; 3]) {
        for band in 0..3 {
            let deviation = value[band] - self.mean[band];
            let weight = n / (n + 1.0);
            self.squares[band] += weight * deviation * deviation;
            self.products[band] += weight * deviation * correction[band];
            self.mean[band] += deviation / (n + 1.0);
        }
    }
}

/// Mean power that a crossing of a side has brought in the repeats before, per band \[quanta\].
pub(crate) type PerCrossing<'a> = &'a dyn Fn(SideId, usize) -> f64;

impl RepeatedSums {
    /// Memory per part \[bytes\].
    pub(crate) const BYTES_PER_PART: usize = size_of::<[Deviations; 2]>();

    pub(crate) fn new(sums: Arc<SideSums>) -> Self {
        let parts = vec![Default::default(); sums.parts().len()];
        Self { sums, count: 0, parts, corrections: Deviations::default() }
    }

    /// Adds a repeat: the power that sides have received, and what counted lines have brought besides. `is_first` is true
    /// before any repeat.
    pub(crate) fn add(
        &mut self,
        model: &Model,
        received: &Received,
        counted: Option<&Counted>,
        per_crossing: PerCrossing<'_>,
        is_first: bool,
    ) {
        // The corrections of the first repeat are not known.
        if counted.is_some() && is_first {
            return;
        }
        let forecast = counted.map(|counted| counted.domain.forecast(counted.lines));
        let mut values = vec![[[0.0; 3]; 2]; self.parts.len()];
        let mut corrections = [0.0; 3];
        model.mesh.for_each_side(|triangle, _, _, side| {
            let mut power = received.power[side.index()].0.map(|power| power as f64);
            if let (Some(counted), Some(forecast)) = (counted, &forecast) {
                let brought = counted.sides[side.index()];
                let excess = match counted.focus_sides.contains(side) {
                    true => brought.crossings as f64 - forecast.crossings(model.area(triangle, side)),
                    false => 0.0,
                };
                for band in 0..3 {
                    let correction = excess * per_crossing(side, band);
                    power[band] += brought.power.0[band] as f64 - correction;
                    corrections[band] += correction;
                }
            }
            let reflectance = model.reflectance(triangle, side).to_array();
            for (part, share) in self.sums.shares(side) {
                for band in 0..3 {
                    values[part][0][band] += share * power[band];
                    values[part][1][band] += share * reflectance[band] * power[band];
                }
            }
        });
        let n = self.count as f64;
        let deviation = [0, 1, 2].map(|band| corrections[band] - self.corrections.mean[band]);
        for (part, values) in self.parts.iter_mut().zip(values) {
            part.iter_mut().zip(values).for_each(|(part, value)| part.add(n, value, deviation));
        }
        self.corrections.add(n, corrections, deviation);
        self.count += 1;
    }

    /// Returns the standard errors of the irradiance and of the radiosity of each part, means over its covered area
    /// \[W/m²\]. `count` is the number of repeats; `brought` returns what counted lines have brought to a side, if it was
    /// corrected.
    pub(crate) fn errors(
        &self,
        model: &Model,
        count: u64,
        unit: PowerUnit,
        brought: &dyn Fn(SideId) -> [f64; 3],
    ) -> Vec<[Rgb; 2]> {
        let mut areas = vec![0.0; self.parts.len()];
        let mut of_parts = vec![[[0.0; 3]; 2]; self.parts.len()];
        let mut of_all = [0.0; 3];
        model.mesh.for_each_side(|triangle, _, _, side| {
            let (area, brought) = (model.area(triangle, side), brought(side));
            let reflectance = model.reflectance(triangle, side).to_array();
            for (part, share) in self.sums.shares(side) {
                areas[part] += share * area;
                for band in 0..3 {
                    of_parts[part][0][band] += share * brought[band];
                    of_parts[part][1][band] += share * reflectance[band] * brought[band];
                }
            }
            of_all.iter_mut().zip(brought).for_each(|(all, brought)| *all += brought);
        });
        let pairs = (count * self.count.saturating_sub(1)) as f64;
        let error = |of: &Deviations, brought: [f64; 3], area: f64| {
            let per_band = [0, 1, 2].map(|band| {
                let share = if of_all[band] > 0.0 { brought[band] / of_all[band] } else { 0.0 };
                let all = share * share * self.corrections.squares[band];
                let squares = of.squares[band] + 2.0 * share * of.products[band] + all;
                (squares.max(0.0) / pairs).sqrt() * unit.quantum()
            });
            if area > 0.0 { Rgb::from_array(per_band) / area } else { Rgb::ZERO }
        };
        let parts = self.parts.iter().zip(of_parts).zip(areas);
        parts
            .map(|((of, brought), area)| [error(&of[0], brought[0], area), error(&of[1], brought[1], area)])
            .collect()
    }

    /// Visits the deviations.
    pub(crate) fn visit(&mut self, visitor: &mut dyn Visitor) {
        visit_counts([&mut self.count], visitor);
        visit_deviations(self.parts.as_flattened_mut(), visitor);
        visit_deviations(std::slice::from_mut(&mut self.corrections), visitor);
    }
}

fn visit_deviations(all: &mut [Deviations], visitor: &mut dyn Visitor) {
    visit_slice(
        all,
        visitor,
        |Deviations { mean, squares, products }| {
            let [[a, b, c], [d, e, f], [g, h, i]] =
                [mean, squares, products].map(|numbers| numbers.map(|number| number.to_bits() as i64));
            [a, b, c, d, e, f, g, h, i]
        },
        |[a, b, c, d, e, f, g, h, i]| {
            let [mean, squares, products] =
                [[a, b, c], [d, e, f], [g, h, i]].map(|words| words.map(|word| f64::from_bits(word as u64)));
            Deviations { mean, squares, products }
        },
    );
}
