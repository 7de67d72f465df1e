//! Numbers of lines: scaled, divided between the stages, or chosen for equal time.

use serde::Serialize;

use sir_pipeline::plan::{Replicas, Transport};

/// Numbers of lines of the two stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Lines {
    /// Number of local lines, for the first shot.
    pub(crate) local: u64,
    /// Number of global lines, for multipath.
    pub(crate) global: u64,
}

/// Lines per second of each stage on one thread.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Rates {
    /// Rate of local lines \[1/s\].
    pub(crate) local: f64,
    /// Rate of global lines \[1/s\].
    pub(crate) global: f64,
}

fn whole(lines: f64) -> u64 {
    (lines.round() as u64).max(1)
}

impl Lines {
    /// Returns the total number of lines.
    #[must_use]
    pub(crate) fn total(self) -> u64 {
        self.local.saturating_add(self.global)
    }

    /// Returns both numbers multiplied by `factor`, and at least 1.
    #[must_use]
    pub(crate) fn times(self, factor: f64) -> Self {
        Self { local: whole(self.local as f64 * factor), global: whole(self.global as f64 * factor) }
    }

    /// Returns the same total number of lines, with this share of local lines.
    #[must_use]
    pub(crate) fn with_share(self, share: f64) -> Self {
        let total = self.total().max(2);
        let local = whole(total as f64 * share).min(total - 1);
        Self { local, global: total - local }
    }

    /// Returns the time at these rates \[s\].
    #[must_use]
    pub(crate) fn seconds(self, rates: Rates) -> f64 {
        self.local as f64 / rates.local + self.global as f64 / rates.global
    }

    /// Returns numbers of lines with this share of local lines that take the same time at these rates.
    #[must_use]
    pub(crate) fn in_equal_time(self, share: f64, rates: Rates) -> Self {
        let per_line = share / rates.local + (1.0 - share) / rates.global;
        let total = self.seconds(rates) / per_line;
        Self { local: whole(total * share), global: whole(total * (1.0 - share)) }
    }
}

/// Adapts a transport to another number of global lines. The tail keeps its share of the lines.
#[must_use]
pub(crate) fn fitted(transport: &Transport, lines: u64, new_lines: u64) -> Transport {
    let scaled = |tail: u64| {
        let tail = tail as f64 * (new_lines as f64 / lines.max(1) as f64);
        (tail as u64).min(new_lines.saturating_sub(1))
    };
    match transport {
        Transport::Batches => Transport::Batches,
        Transport::Replicas(Replicas { count, tail }) => {
            Transport::Replicas(Replicas { count: (*count).min(new_lines), tail: tail.map(scaled) })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: Lines = Lines { local: 100_000_000, global: 130_000_000 };

    #[test]
    fn lines_are_scaled_but_never_vanish() {
        assert_eq!(PAPER.times(0.25), Lines { local: 25_000_000, global: 32_500_000 });
        assert_eq!(PAPER.times(1e-12), Lines { local: 1, global: 1 });
    }

    #[test]
    fn a_share_keeps_the_number_of_lines() {
        for percent in [5, 50, 90] {
            let lines = PAPER.with_share(f64::from(percent) / 100.0);
            assert_eq!((lines.total(), lines.local), (230_000_000, 2_300_000 * percent as u64));
        }
        assert_eq!(Lines { local: 1, global: 1 }.with_share(0.999), Lines { local: 1, global: 1 });
    }

    #[test]
    fn equal_time_is_equal_and_has_the_share() {
        let rates = Rates { local: 4e6, global: 1e6 };
        for share in [0.05, 0.3, 0.9] {
            let lines = PAPER.in_equal_time(share, rates);
            assert!((lines.seconds(rates) / PAPER.seconds(rates) - 1.0).abs() < 1e-6);
            assert!((lines.local as f64 / lines.total() as f64 - share).abs() < 1e-6);
        }
        // Local lines are cheaper, so there are more lines if most are local.
        assert!(PAPER.in_equal_time(0.9, rates).total() > 2 * PAPER.in_equal_time(0.05, rates).total());
    }

    #[test]
    fn a_tail_stays_a_tenth() {
        let replicas = |count, tail| Transport::Replicas(Replicas { count, tail });
        let transport = replicas(8, Some(100));
        assert_eq!(fitted(&transport, 1000, 50), replicas(8, Some(5)));
        assert_eq!(fitted(&transport, 1000, 1), replicas(1, Some(0)));
        assert_eq!(fitted(&replicas(8, None), 1000, 50), replicas(8, None));
        assert_eq!(fitted(&Transport::Batches, 1000, 1), Transport::Batches);
    }
}
