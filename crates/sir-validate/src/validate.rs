//! Running the cases.

use std::num::NonZeroUsize;

use crate::catalog::plan;
use crate::data::{Case, Reference};
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::repeat::{least_lines, repeat};
use crate::report::{Outcome, Report};
use crate::runner::{Runner, Watcher};

/// What to run, and how.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// How precisely.
    pub effort: Effort,
    /// Seed of the random numbers.
    pub seed: u64,
    /// How many threads trace lines; the answers do not depend on it.
    pub threads: NonZeroUsize,
    /// Names of cases, or their beginnings, in any case of letters; all if there are none.
    pub cases: Vec<String>,
}

/// Runs all cases that are asked for.
///
/// # Errors
///
/// If there is no such case, the reference is broken, or the watcher wants to stop. Wrong answers are no error.
pub fn validate(
    reference: &Reference,
    settings: &Settings,
    watcher: &mut dyn Watcher,
) -> Result<Report, ValidateError> {
    let mut plans = Vec::new();
    for (number, case) in (0..).zip(&reference.cases) {
        if asked_for(case, settings) {
            plans.push((number, case, plan(case)?));
        }
    }
    all_found(reference, settings)?;
    let effort = settings.effort;
    let mut runner = Runner::new(watcher, settings.threads);
    for trial in plans.iter().flat_map(|(_, _, plan)| plan.trials()) {
        runner.expect(least_lines(trial, effort));
    }
    let mut cases = Vec::new();
    for (number, case, plan) in &plans {
        if plan.skipped().is_none() {
            runner.watcher.begin(&case.id, &case.title);
        }
        let mut checks = Vec::new();
        for (part, trial) in (0..).zip(plan.trials()) {
            // No two runs have random numbers in common.
            let stream: u64 = (number << 32) | (part << 16);
            checks.extend(repeat(trial, effort, settings.seed.wrapping_add(stream), &mut runner)?);
        }
        let skipped = plan.skipped().map(str::to_owned);
        cases.push(Outcome { case: case.id.clone(), title: case.title.clone(), skipped, checks });
    }
    Ok(Report { effort, seed: settings.seed, cases })
}

/// Whether someone asked for a case: by its name or the beginning of it.
fn asked_for(case: &Case, settings: &Settings) -> bool {
    settings.cases.is_empty() || settings.cases.iter().any(|asked| names(asked, &case.id))
}

fn names(asked: &str, id: &str) -> bool {
    id.to_ascii_lowercase().starts_with(&asked.to_ascii_lowercase())
}

fn all_found(reference: &Reference, settings: &Settings) -> Result<(), ValidateError> {
    for asked in &settings.cases {
        if asked.is_empty() || !reference.ids().any(|id| names(asked, id)) {
            let known = reference.ids().collect::<Vec<_>>().join(", ");
            return Err(ValidateError::NoCase { asked: asked.clone(), known });
        }
    }
    Ok(())
}
