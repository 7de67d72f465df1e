//! Runs of the solver, repeated until their mean is precise enough.

use sir_parallel::{Crew, RunError};

use crate::bench::Bench;
use crate::check::Check;
use crate::error::ValidateError;
use crate::estimate::Estimate;
use crate::validate::Effort;

/// Runs of which a first estimate of the noise is made.
const FIRST_RUNS: usize = 16;

/// Most runs: if the noise is still too large, the verdict says so.
const MOST_RUNS: usize = 256;

/// A number whose exact value is known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Quantity {
    pub(crate) name: String,
    /// Quantities that are alike, such as all faces of a cube, are shown in one row of a table.
    pub(crate) group: Option<String>,
    pub(crate) exact: f64,
    /// What others have published.
    pub(crate) published: Option<f64>,
}

impl Quantity {
    /// A number that stands alone.
    pub(crate) fn new(name: impl Into<String>, exact: f64) -> Self {
        Self { name: name.into(), group: None, exact, published: None }
    }
}

/// Gives one estimate of each quantity, from about this many lines with this seed.
pub(crate) type Sample<'a> = Box<dyn Fn(u64, u64, &mut Crew<'_>) -> Result<Vec<f64>, RunError> + 'a>;

/// Some numbers that the same runs give.
pub(crate) struct Trial<'a> {
    pub(crate) quantities: Vec<Quantity>,
    /// Lines of a run, if there is time enough.
    pub(crate) lines: u64,
    /// Makes the scene and says how to light it.
    pub(crate) prepare: Box<dyn Fn(Effort) -> Result<Sample<'a>, ValidateError> + 'a>,
}

impl Trial<'_> {
    /// Lines of the runs that are made in any case.
    pub(crate) fn least_lines(&self, effort: Effort) -> u64 {
        effort.lines(self.lines) * FIRST_RUNS as u64
    }

    /// Makes independent runs, with seeds from `seed` on, until all standard errors are small enough.
    pub(crate) fn check(
        &self,
        effort: Effort,
        seed: u64,
        bench: &mut Bench<'_>,
    ) -> Result<Vec<Check>, ValidateError> {
        let (sample, lines) = ((self.prepare)(effort)?, effort.lines(self.lines));
        let mut samples: Vec<Vec<f64>> = vec![Vec::new(); self.quantities.len()];
        let (mut made, mut planned) = (0, FIRST_RUNS);
        while made < planned {
            let values = bench.run(&sample, lines, seed.wrapping_add(made as u64))?;
            samples.iter_mut().zip(values).for_each(|(all, value)| all.push(value));
            made += 1;
            if made == planned {
                planned = self.runs_needed(&samples, effort).clamp(made, MOST_RUNS);
                bench.expect(lines * (planned - made) as u64);
            }
        }
        let checks = self.quantities.iter().zip(&samples);
        Ok(checks.map(|(quantity, samples)| Check::new(quantity, Estimate::of(samples), effort)).collect())
    }

    /// How many runs it takes, as far as can be told from those that were made.
    fn runs_needed(&self, samples: &[Vec<f64>], effort: Effort) -> usize {
        let worst = self
            .quantities
            .iter()
            .zip(samples)
            .filter(|(quantity, _)| quantity.exact != 0.0)
            .map(|(quantity, samples)| Estimate::of(samples).sigma / quantity.exact.abs())
            .fold(0.0, f64::max);
        let made = samples.first().map_or(0, Vec::len);
        let ratio = worst / effort.precision();
        // A tenth more than needed: the estimate is uncertain, and a second look costs more runs than that.
        if ratio <= 1.0 { made } else { (made as f64 * ratio * ratio * 1.1).ceil() as usize }
    }
}
