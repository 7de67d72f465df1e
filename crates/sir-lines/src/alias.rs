//! Sampling of indices in proportion to weights.

/// Alias table: samples an index in proportion to its weight, in constant time (Walker 1977; Vose 1991).
///
/// Each of `n` columns has the weight `1/n` and is divided between at most two indices.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AliasTable {
    columns: Vec<Column>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Column {
    /// Share of the column's own index.
    own: f64,
    /// Index that has the rest.
    other: u32,
}

impl AliasTable {
    /// Builds the table. Weights must be finite and positive; there must be at least one and fewer than 2³².
    pub(crate) fn new(weights: &[f64]) -> Self {
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        let columns = weights.iter().zip(0..).map(|(w, other)| Column { own: w / mean, other });
        let mut columns: Vec<Column> = columns.collect();
        let (mut small, mut large): (Vec<u32>, Vec<u32>) =
            (0..columns.len() as u32).partition(|&i| columns[i as usize].own < 1.0);
        // A large column fills up a small one and keeps the rest. When either list is empty, all remaining columns are
        // full up to rounding.
        while let (Some(&under), Some(&over)) = (small.last(), large.last()) {
            small.pop();
            columns[under as usize].other = over;
            let left = columns[over as usize].own - (1.0 - columns[under as usize].own);
            columns[over as usize].own = left;
            if left < 1.0 {
                large.pop();
                small.push(over);
            }
        }
        Self { columns }
    }

    /// Returns an index: the first coordinate chooses a column, the second one of its two indices.
    #[inline]
    pub(crate) fn sample(&self, [u, v]: [f64; 2]) -> usize {
        let column = (u * self.columns.len() as f64) as usize;
        let Column { own, other } = self.columns[column];
        if v < own { column } else { other as usize }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::{Purpose, Streams};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn shares_are_the_weights(
            weights in prop::collection::vec(prop_oneof![1e-9..1e-6f64, 0.1..10.0f64, Just(1.0)], 1..100),
        ) {
            let table = AliasTable::new(&weights);
            let mut shares = vec![0.0; weights.len()];
            for (i, column) in table.columns.iter().enumerate() {
                let own = column.own.min(1.0);
                shares[i] += own;
                shares[column.other as usize] += 1.0 - own;
            }
            let sum: f64 = weights.iter().sum();
            for (share, w) in shares.iter().zip(&weights) {
                prop_assert!((share / weights.len() as f64 - w / sum).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn choices_are_in_proportion_to_weights() {
        let weights = [3.0, 0.5, 1.0, 1e-12, 5.5];
        let table = AliasTable::new(&weights);
        let streams = Streams::new(2, Purpose::GLOBAL);
        let n = 100_000;
        let mut counted = [0.0; 5];
        for i in 0..n {
            counted[table.sample(streams.line(i).point())] += 1.0;
        }
        for (count, w) in counted.iter().zip(weights) {
            let share = w / 10.0;
            let sigma = (n as f64 * share * (1.0 - share)).sqrt();
            assert!((count - n as f64 * share).abs() <= 4.0 * sigma, "{count} of {w}");
        }
    }
}
