//! Running the cases.

use std::num::NonZeroUsize;

use serde::Serialize;

use crate::bench::{Bench, Watcher};
use crate::catalogue::plan;
use crate::check::{Check, Verdict};
use crate::data::Case;
use crate::data::Reference;
use crate::error::ValidateError;

/// How precise answers have to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Effort {
    /// Standard errors of at most 0.5 % of the exact answer.
    Quick,
    /// Standard errors of at most 0.1 % of the exact answer.
    Full,
}

impl Effort {
    /// The largest standard error, relative to the exact answer.
    #[must_use]
    pub fn precision(self) -> f64 {
        match self {
            Self::Quick => 5e-3,
            Self::Full => 1e-3,
        }
    }

    /// Lines of a run that has this many in full.
    pub(crate) fn lines(self, full: u64) -> u64 {
        match self {
            Self::Quick => full / 20,
            Self::Full => full,
        }
    }

    /// Parts of a circle that has this many in full. Each facet needs some lines, so there are fewer where lines are few.
    pub(crate) fn segments(self, full: u32) -> u32 {
        match self {
            Self::Quick => full / 4,
            Self::Full => full,
        }
    }
}

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

/// What became of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Its name.
    pub case: String,
    /// What it is about.
    pub title: String,
    /// Why it was not run, if it was not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skipped: Option<String>,
    /// The answers.
    pub checks: Vec<Check>,
}

/// The outcome of all cases that were asked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// How precise answers had to be.
    pub effort: Effort,
    /// Seed of the random numbers.
    pub seed: u64,
    /// The cases in the order of the reference.
    pub cases: Vec<Outcome>,
}

impl Report {
    /// All answers.
    pub fn checks(&self) -> impl Iterator<Item = &Check> {
        self.cases.iter().flat_map(|case| &case.checks)
    }

    /// Number of answers with this verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.checks().filter(|check| check.verdict == verdict).count()
    }

    /// Whether all answers are right and precise enough.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.checks().all(|check| check.verdict == Verdict::Passed)
    }
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
    let mut bench = Bench::new(watcher, settings.threads);
    for trial in plans.iter().flat_map(|(_, _, plan)| plan.trials()) {
        bench.expect(trial.least_lines(effort));
    }
    let mut cases = Vec::new();
    for (number, case, plan) in &plans {
        if plan.skipped().is_none() {
            bench.watcher.begin(&case.id, &case.title);
        }
        let mut checks = Vec::new();
        for (part, trial) in (0..).zip(plan.trials()) {
            // No two runs have random numbers in common.
            let stream: u64 = (number << 32) | (part << 16);
            checks.extend(trial.check(effort, settings.seed.wrapping_add(stream), &mut bench)?);
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
