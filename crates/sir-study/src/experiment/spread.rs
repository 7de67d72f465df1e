//! Part `spread`: the spread of the cost of global lines.

use serde::Serialize;
use sir_radiosity::Model;

use crate::error::StudyError;
use crate::experiment::crossings::{count, scaled};
use crate::experiment::markdown;
use crate::experiment::markdown::{Grid, percent, signed_percent};
use crate::experiment::paper::P;
use crate::experiment::runs::Runs;
use crate::experiment::subject::Subject;
use crate::scaling::table::seconds;
use sir_pipeline::stopwatch::Stopwatch;

/// Number of lines before scaling, and the minimum after it.
const LINES: (u64, u64) = (4_000_000, 200_000);

/// Numbers of lines of a block.
const BLOCKS: [usize; 4] = [1, 100, 10_000, 1_000_000];

/// Spread of the mean number of crossings between blocks of lines.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct BlockSpread {
    /// Number of lines of a block.
    pub(crate) lines: usize,
    /// Number of blocks.
    pub(crate) blocks: usize,
    /// Standard deviation of a block's mean, relative to the mean of all lines.
    pub(crate) relative_deviation: f64,
}

/// Statistics of one of eight equal shares of the lines.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Share {
    /// Crossings per line, relative to the mean of all lines, minus 1.
    pub(crate) deviation: f64,
    /// Time to draw the lines and find their crossings \[s\].
    pub(crate) seconds: f64,
}

/// Results of the part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Unevenness {
    /// Number of lines traced.
    pub(crate) lines: u64,
    /// Mean number of crossings of a line.
    pub(crate) mean: f64,
    /// Standard deviation of the number of crossings of a line.
    pub(crate) deviation: f64,
    /// Spread between blocks of lines.
    pub(crate) blocks: Vec<BlockSpread>,
    /// Statistics of eight equal shares of the lines.
    pub(crate) shares: Vec<Share>,
    /// Expected standard deviation of one of eight equal shares of the pipeline's scaled number of global lines,
    /// relative to the mean.
    pub(crate) expected: f64,
}

/// Traces the lines, one share after the other.
pub(crate) fn find(
    runs: &Runs,
    subject: &Subject,
    model: &Model,
    scale: f64,
) -> Result<Unevenness, StudyError> {
    let share = scaled(LINES.0, scale, LINES.1) / P as u64;
    let domain = subject.domain.around(&model.scene);
    let mut counts = Vec::with_capacity(share as usize * P);
    let mut times = Vec::new();
    // Warms the caches for the first share.
    count(runs, model, &domain, 0..share.min(20_000), |_| {})?;
    for k in 0..P as u64 {
        let watch = Stopwatch::start();
        count(runs, model, &domain, k * share..(k + 1) * share, |crossings| counts.push(crossings))?;
        times.push(watch.seconds());
    }
    Ok(Unevenness::of(&counts, &times, subject.lines.global))
}

/// Returns the mean and the standard deviation.
fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    (mean, (square / (n - 1.0).max(1.0)).sqrt())
}

/// Returns the means of blocks of `lines` lines. An incomplete block at the end is ignored.
fn means(counts: &[u32], lines: usize) -> Vec<f64> {
    let mean = |block: &[u32]| block.iter().map(|&c| f64::from(c)).sum::<f64>() / lines as f64;
    counts.chunks_exact(lines).map(mean).collect()
}

impl Unevenness {
    fn of(counts: &[u32], times: &[f64], pipeline_lines: u64) -> Self {
        let (mean, deviation) = moments(&means(counts, 1));
        let scale = mean.max(1e-300);
        let block = |&lines: &usize| {
            let means = means(counts, lines);
            let relative_deviation = moments(&means).1 / scale;
            (means.len() > 1).then_some(BlockSpread { lines, blocks: means.len(), relative_deviation })
        };
        let shares = means(counts, (counts.len() / times.len().max(1)).max(1));
        let share = |(mean, &seconds): (&f64, &f64)| Share { deviation: mean / scale - 1.0, seconds };
        let of_share = (pipeline_lines as f64 / P as f64).max(1.0);
        Self {
            lines: counts.len() as u64,
            mean,
            deviation,
            blocks: BLOCKS.iter().filter_map(block).collect(),
            shares: shares.iter().zip(times).map(share).collect(),
            expected: deviation / scale / of_share.sqrt(),
        }
    }

    /// Returns the largest absolute deviation of a share from the mean.
    pub(crate) fn largest(&self) -> f64 {
        self.shares.iter().map(|share| share.deviation.abs()).fold(0.0, f64::max)
    }

    /// Returns the section of the report.
    pub(crate) fn section(&self) -> String {
        let mut blocks = Grid::new(&["lines of a block", "blocks", "standard deviation of a block's mean"]);
        for b in &self.blocks {
            blocks.row([
                markdown::count(b.lines as u64),
                markdown::count(b.blocks as u64),
                percent(b.relative_deviation),
            ]);
        }
        let mut shares = Grid::new(&["share", "crossings per line, against the mean", "time [s]"]);
        for (number, share) in (1..).zip(&self.shares) {
            shares.row([format!("{number}"), signed_percent(share.deviation), seconds(share.seconds)]);
        }
        format!(
            "### Cost of a line\n\n{} global lines cross {:.2} surfaces each on average; the standard deviation \
             between lines is {:.2}. It averages out in blocks of lines:\n\n{}{P} equal shares of the lines, \
             traced one after the other by one thread (times are for drawing lines and finding crossings, \
             and include the noise of the machine):\n\n{}The largest deviation is {}. For {P} equal shares \
             of the pipeline's global lines, the expected standard deviation is {}.\n\n",
            markdown::count(self.lines),
            self.mean,
            self.deviation,
            blocks.end(),
            shares.end(),
            percent(self.largest()),
            percent(self.expected)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_and_shares_are_means_of_their_lines() {
        let counts: Vec<u32> = (0..1000).map(|i| if i % 2 == 0 { 1 } else { 3 }).collect();
        let found = Unevenness::of(&counts, &[1.0; 8], 8);
        assert_eq!((found.lines, found.mean), (1000, 2.0));
        assert!((found.deviation - 1.0).abs() < 1e-3);
        assert!((found.expected - 0.5).abs() < 1e-3);
        let blocks: Vec<_> = found.blocks.iter().map(|b| (b.lines, b.blocks)).collect();
        assert_eq!(blocks, [(1, 1000), (100, 10)]);
        assert_eq!(found.blocks[1].relative_deviation, 0.0);
        // 125 lines in a share: one more of the one kind than of the other.
        assert_eq!(found.shares.len(), 8);
        assert!((found.largest() - 1.0 / 250.0).abs() < 1e-12);
    }
}
