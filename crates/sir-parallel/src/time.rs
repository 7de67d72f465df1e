//! Wall-clock time of a stage.

use std::time::Duration;

use sir_radiosity::Visitor;

/// Wall-clock time of a stage on this rank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageTime {
    /// Total time, including setup.
    pub total: Duration,
    /// Time for tracing lines, on all threads in parallel.
    pub tracing: Duration,
    /// Time for communication with other ranks, including waiting for them.
    pub communication: Duration,
}

impl StageTime {
    /// Returns the time that is neither tracing nor communication.
    #[must_use]
    pub fn sequential(&self) -> Duration {
        self.total.saturating_sub(self.tracing + self.communication)
    }

    /// Passes the times to a visitor, in whole microseconds.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        let times = [&mut self.total, &mut self.tracing, &mut self.communication];
        let mut words = [0; 3];
        words.iter_mut().zip(&times).for_each(|(word, time)| *word = time.as_micros() as i64);
        visitor.same(&mut words);
        times.into_iter().zip(words).for_each(|(time, word)| *time = Duration::from_micros(word as u64));
    }
}

impl std::ops::AddAssign for StageTime {
    fn add_assign(&mut self, other: Self) {
        self.total += other.total;
        self.tracing += other.tracing;
        self.communication += other.communication;
    }
}
