//! Execution of the selected cases.

use std::num::NonZeroUsize;

use crate::catalog::plan;
use crate::data::{Case, Reference};
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::repeat::{least_lines, repeat};
use crate::report::{Outcome, Report};
use crate::runner::{Runner, Watcher};

/// Settings of a validation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Required precision of the answers.
    pub effort: Effort,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of threads that trace lines; answers do not depend on it.
    pub threads: NonZeroUsize,
    /// IDs of cases, or prefixes of IDs, ignoring case; all cases if empty.
    pub cases: Vec<String>,
}

/// Runs all selected cases.
///
/// # Errors
///
/// If a selected case does not exist, the reference is invalid, or the watcher stops the run. Wrong answers are not
/// errors.
pub fn validate(
    reference: &Reference,
    settings: &Settings,
    watcher: &mut dyn Watcher,
) -> Result<Report, ValidateError> {
    let mut plans = Vec::new();
    for (number, case) in (0..).zip(&reference.cases) {
        if is_selected(case, settings) {
            plans.push((number, case, plan(case)?));
        }
    }
    check_selection(reference, settings)?;
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
            let first: u64 = (number << 32) | (part << 16);
            checks.extend(repeat(trial, effort, (settings.seed, first), &mut runner)?);
        }
        let skipped = plan.skipped().map(str::to_owned);
        cases.push(Outcome { case: case.id.clone(), title: case.title.clone(), skipped, checks });
    }
    Ok(Report { effort, seed: settings.seed, cases })
}

/// Returns true if a case is selected by its ID or a prefix of it.
fn is_selected(case: &Case, settings: &Settings) -> bool {
    settings.cases.is_empty() || settings.cases.iter().any(|asked| is_prefix(asked, &case.id))
}

fn is_prefix(asked: &str, id: &str) -> bool {
    id.to_ascii_lowercase().starts_with(&asked.to_ascii_lowercase())
}

fn check_selection(reference: &Reference, settings: &Settings) -> Result<(), ValidateError> {
    for asked in &settings.cases {
        if asked.is_empty() || !reference.ids().any(|id| is_prefix(asked, id)) {
            let known = reference.ids().collect::<Vec<_>>().join(", ");
            return Err(ValidateError::NoCase { asked: asked.clone(), known });
        }
    }
    Ok(())
}
