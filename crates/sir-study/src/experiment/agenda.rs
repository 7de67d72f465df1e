//! How much is done, and how long the rest will take.

use std::collections::BTreeMap;

use sir_pipeline::format::duration;

/// Runs to be made, and those that have been.
#[derive(Debug, Default)]
pub(crate) struct Agenda {
    /// Cost of each run by its name: lines per worker.
    ahead: BTreeMap<String, f64>,
    total: usize,
    /// Cost of the runs that were made, and seconds that they took.
    spent: (f64, f64),
}

impl Agenda {
    /// Adds a run to those ahead.
    pub(crate) fn add(&mut self, name: String, cost: f64) {
        if self.ahead.insert(name, cost).is_none() {
            self.total += 1;
        }
    }

    /// Which run of how many is the next one.
    pub(crate) fn place(&self) -> String {
        format!("run {} of {}", self.total - self.ahead.len() + 1, self.total)
    }

    /// A run is done: it took some seconds, or none if it was there already.
    pub(crate) fn done(&mut self, name: &str, seconds: Option<f64>) {
        let cost = self.ahead.remove(name).unwrap_or(0.0);
        if let Some(seconds) = seconds {
            self.spent = (self.spent.0 + cost, self.spent.1 + seconds);
        }
    }

    /// What is left, as a text for people; empty if nothing is, or nothing is known.
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
