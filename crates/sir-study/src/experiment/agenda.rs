//! Progress of the experiment, and an estimate of the remaining time.

use std::collections::BTreeMap;

use sir_pipeline::format::duration;

/// Pending runs, and the cost of those made.
#[derive(Debug, Default)]
pub(crate) struct Agenda {
    /// Cost of each pending run by its name: lines per worker.
    ahead: BTreeMap<String, f64>,
    total: usize,
    /// Total cost of the runs made so far, and their total time \[s\].
    spent: (f64, f64),
}

impl Agenda {
    /// Adds a run to the pending ones.
    pub(crate) fn add(&mut self, name: String, cost: f64) {
        if self.ahead.insert(name, cost).is_none() {
            self.total += 1;
        }
    }

    /// Returns the number of the next run and the total, as text.
    pub(crate) fn place(&self) -> String {
        format!("run {} of {}", self.total - self.ahead.len() + 1, self.total)
    }

    /// Marks a run as done. `seconds` is `None` if its result existed already.
    pub(crate) fn done(&mut self, name: &str, seconds: Option<f64>) {
        let cost = self.ahead.remove(name).unwrap_or(0.0);
        if let Some(seconds) = seconds {
            self.spent = (self.spent.0 + cost, self.spent.1 + seconds);
        }
    }

    /// Returns the remaining time as text; it is empty if no run is pending or the time is unknown.
    pub(crate) fn left(&self) -> String {
        let (cost, seconds) = self.spent;
        let ahead: f64 = self.ahead.values().sum();
        if cost > 0.0 && ahead > 0.0 {
            format!(", about {} left", duration(ahead * seconds / cost))
        } else {
            String::new()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_there_already_says_nothing_of_time() {
        let mut agenda = Agenda::default();
        for (name, cost) in [("a", 1.0), ("b", 2.0), ("c", 4.0), ("c", 4.0)] {
            agenda.add(name.into(), cost);
        }
        assert_eq!(agenda.place(), "run 1 of 3");
        agenda.done("a", None);
        assert_eq!((agenda.place().as_str(), agenda.left().as_str()), ("run 2 of 3", ""));
        agenda.done("b", Some(10.0));
        assert_eq!(agenda.left(), ", about 20.0 s left");
        agenda.done("c", Some(20.0));
        assert_eq!(agenda.left(), "");
    }
}
