//! Repetition of solver runs until their mean is precise enough.

use sir_lines::seed_of_repeat;

use crate::check::Check;
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::estimate::Estimate;
use crate::runner::Runner;
use crate::trial::Trial;

/// Number of runs for the first estimate of the noise.
const FIRST_RUNS: usize = 16;

/// Largest number of runs, less than 2¹⁶. If the noise is still too large, the verdict says so.
const MAX_RUNS: usize = 4096;

/// Returns the number of lines of the runs that are always made.
pub(crate) fn least_lines(trial: &Trial<'_>, effort: Effort) -> u64 {
    effort.lines(trial.lines) * FIRST_RUNS as u64
}

/// Makes independent runs until all standard errors are small enough. Their seeds are hashes of `seed` and the numbers
/// from `first` on, so that no two runs share random numbers, not those of neighboring seeds either.
pub(crate) fn repeat(
    trial: &Trial<'_>,
    effort: Effort,
    (seed, first): (u64, u64),
    runner: &mut Runner<'_>,
) -> Result<Vec<Check>, ValidateError> {
    let (sample, lines) = ((trial.prepare)(effort)?, effort.lines(trial.lines));
    let mut samples: Vec<Vec<f64>> = vec![Vec::new(); trial.quantities.len()];
    let (mut made, mut planned) = (0, FIRST_RUNS);
    while made < planned {
        // Repeat 0 would have the seed itself.
        let seed = seed_of_repeat(seed, first + made as u64 + 1);
        let values = runner.run(&sample, lines, seed)?;
        samples.iter_mut().zip(values).for_each(|(all, value)| all.push(value));
        made += 1;
        if made == planned {
            planned = runs_needed(trial, &samples, effort).clamp(made, MAX_RUNS);
            runner.expect(lines * (planned - made) as u64);
        }
    }
    let checks = trial.quantities.iter().zip(&samples);
    Ok(checks.map(|(quantity, samples)| Check::new(quantity, Estimate::of(samples), effort)).collect())
}

/// Estimates the number of runs needed from the runs made so far.
fn runs_needed(trial: &Trial<'_>, samples: &[Vec<f64>], effort: Effort) -> usize {
    let worst = trial
        .quantities
        .iter()
        .zip(samples)
        .filter(|(quantity, _)| quantity.exact != 0.0)
        .map(|(quantity, samples)| Estimate::of(samples).sigma / quantity.exact.abs())
        .fold(0.0, f64::max);
    let made = samples.first().map_or(0, Vec::len);
    let ratio = worst / effort.precision();
    // A tenth more than estimated: the estimate is uncertain, and another extension would cost more runs than that.
    if ratio <= 1.0 { made } else { (made as f64 * ratio * ratio * 1.1).ceil() as usize }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::collections::BTreeSet;
    use std::num::NonZeroUsize;

    use super::*;
    use crate::runner::Watcher;
    use crate::trial::{Quantity, Sample};

    struct Blind;

    impl Watcher for Blind {
        fn begin(&mut self, _case: &str, _title: &str) {}
        fn progress(&mut self, _done: u64, _total: u64) {}
        fn should_stop(&self) -> bool {
            false
        }
    }

    /// Returns the seeds of the runs of a trial.
    fn seeds(seed: u64, first: u64) -> BTreeSet<u64> {
        let seen = RefCell::new(BTreeSet::new());
        let prepare = |_| -> Result<Sample<'_>, ValidateError> {
            Ok(Box::new(|_, seed, _| {
                seen.borrow_mut().insert(seed);
                Ok(vec![1.0])
            }))
        };
        let trial = Trial { quantities: vec![Quantity::new("", 1.0)], lines: 1, prepare: Box::new(prepare) };
        repeat(&trial, Effort::Quick, (seed, first), &mut Runner::new(&mut Blind, NonZeroUsize::MIN))
            .unwrap();
        drop(trial);
        seen.into_inner()
    }

    /// Another seed is a second opinion: no run of one is a run of the other, nor of another trial.
    #[test]
    fn no_two_runs_share_random_numbers() {
        let all: Vec<_> =
            [(1, 0), (2, 0), (3, 0), (17, 0), (1, 1 << 16), (2, 1 << 32)].map(|(s, f)| seeds(s, f)).into();
        let distinct: BTreeSet<u64> = all.iter().flatten().copied().collect();
        assert_eq!(distinct.len(), all.len() * FIRST_RUNS);
    }
}
