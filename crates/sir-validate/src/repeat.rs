//! Repetition of solver runs until their mean is precise enough.

use crate::check::Check;
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::estimate::Estimate;
use crate::runner::Runner;
use crate::trial::Trial;

/// Number of runs for the first estimate of the noise.
const FIRST_RUNS: usize = 16;

/// Largest number of runs. If the noise is still too large, the verdict says so.
const MAX_RUNS: usize = 256;

/// Returns the number of lines of the runs that are always made.
pub(crate) fn least_lines(trial: &Trial<'_>, effort: Effort) -> u64 {
    effort.lines(trial.lines) * FIRST_RUNS as u64
}

/// Makes independent runs, with seeds from `seed` on, until all standard errors are small enough.
pub(crate) fn repeat(
    trial: &Trial<'_>,
    effort: Effort,
    seed: u64,
    runner: &mut Runner<'_>,
) -> Result<Vec<Check>, ValidateError> {
    let (sample, lines) = ((trial.prepare)(effort)?, effort.lines(trial.lines));
    let mut samples: Vec<Vec<f64>> = vec![Vec::new(); trial.quantities.len()];
    let (mut made, mut planned) = (0, FIRST_RUNS);
    while made < planned {
        let values = runner.run(&sample, lines, seed.wrapping_add(made as u64))?;
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
