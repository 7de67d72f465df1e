//! Means of independent runs, and their deviations from exact answers.

/// Relative precision of the exact answers, given by their last digits. Smaller differences are not significant.
const EXACT_PRECISION: f64 = 1e-9;

/// Mean of independent runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) mean: f64,
    /// Standard error of the mean, from the spread of the runs.
    pub(crate) sigma: f64,
    /// Number of runs.
    pub(crate) runs: usize,
}

impl Estimate {
    /// Returns the estimate of at least two runs.
    pub(crate) fn of(samples: &[f64]) -> Self {
        let n = samples.len() as f64;
        let mean = samples.iter().sum::<f64>() / n;
        let variance = samples.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
        Self { mean, sigma: (variance / n).sqrt(), runs: samples.len() }
    }

    /// Returns the deviation of the mean from the exact value as a standard normal deviate: the number of standard
    /// deviations that a normal variable exceeds with the same probability. An exact zero must be met exactly.
    ///
    /// The standard error of a few runs is itself uncertain, so the difference in standard errors is Student's t.
    /// Wallace (1959), *Bounds on normal approximations to Student's and the chi-square distributions*, gives the
    /// normal deviate to 0.2 % from 16 runs on.
    pub(crate) fn z(self, exact: f64) -> f64 {
        let off = self.mean - exact;
        if off == 0.0 {
            return 0.0;
        }
        let t = off / self.sigma.max(0.25 * EXACT_PRECISION * exact.abs());
        let freedom = self.runs as f64 - 1.0;
        let z = (freedom * libm::log1p(t * t / freedom)).sqrt();
        z.copysign(t) * (8.0 * freedom + 1.0) / (8.0 * freedom + 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_standard_errors() {
        let estimate = Estimate::of(&[1.0, 2.0, 3.0, 6.0]);
        assert_eq!((estimate.mean, estimate.runs), (3.0, 4));
        assert!((estimate.sigma - (14.0f64 / 3.0 / 4.0).sqrt()).abs() < 1e-15);
    }

    /// Normal deviates of Student's t by numerical integration.
    #[test]
    fn few_runs_count_less() {
        for (runs, t, z) in [(16, 1.0, 0.96775), (16, 4.0, 3.2487), (16, 5.5, 4.0087), (64, -4.0, -3.76127)] {
            let found = Estimate { mean: 10.0 + 2.0 * t, sigma: 2.0, runs }.z(10.0);
            assert!((found / z - 1.0).abs() < 2e-3, "{runs} runs, t = {t}: {found}");
        }
    }

    #[test]
    fn without_noise_only_the_last_digits_may_differ() {
        let exactly = |mean| Estimate { mean, sigma: 0.0, runs: 16 };
        assert_eq!(exactly(0.0).z(0.0), 0.0);
        assert_eq!(exactly(1e-30).z(0.0), f64::INFINITY);
        assert!(exactly(1.0 + 1e-12).z(1.0).abs() < 0.1);
        assert!(exactly(1.0 - 1e-8).z(1.0) < -4.0);
    }
}
