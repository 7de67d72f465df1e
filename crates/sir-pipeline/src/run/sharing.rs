//! The number of repeats among which the lines of a pipeline are shared.

use sir_radiosity::{MIN_REPEATS, crossings_per_patch};

use crate::format::{grouped, rounded_up};
use crate::plan::{Action, Multipath, Transport};
use crate::prepare::prepared::Prepared;

/// Number of repeats among which the lines of a pipeline are shared, if they suffice.
pub(crate) const SHARED: u64 = 16;

/// Smallest number of lines that should cross a typical patch in a repeat.
pub(crate) const CROSSINGS: f64 = 30.0;

/// Repeats among which the lines of a pipeline are shared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sharing {
    /// Number of repeats.
    pub(crate) repeats: u64,
    /// If they are too few for the spread of repeats: the number of global lines, and how many of them cross a typical
    /// patch.
    too_few: Option<(u64, f64)>,
}

impl Sharing {
    /// Returns the sharing of stages with lines, in the order in which they are run. There is none without global lines, as
    /// the errors of a shot are known without repeats, or with the published transport.
    pub(crate) fn of<'a>(actions: impl Iterator<Item = &'a Action> + Clone, prepared: &Prepared) -> Self {
        let Prepared { model, focus, .. } = prepared;
        let fewest = actions.clone().map(Action::lines).filter(|lines| *lines > 0).min().unwrap_or(1);
        let multipath = actions.filter_map(|action| match action {
            Action::Multipath(multipath) => Some(multipath),
            _ => None,
        });
        let Some(Multipath { lines, domain, transport: Transport::Batches }) = multipath.last() else {
            return Self { repeats: 1, too_few: None };
        };
        let domain = domain.lines_around(&model.scene, *focus);
        let crossings = crossings_per_patch(model, &domain, *lines);
        match repeats_of(crossings / CROSSINGS).min(fewest) {
            repeats @ MIN_REPEATS.. => Self { repeats, too_few: None },
            _ => Self { repeats: 1, too_few: Some((*lines, crossings)) },
        }
    }

    /// Returns a warning if lines are too few for repeats. `solve` is the number of lines of a `Solve`, if there is one.
    pub(crate) fn warning(self, solve: Option<u64>) -> Option<String> {
        let (lines, crossings) = self.too_few?;
        let factor = MIN_REPEATS as f64 * CROSSINGS / crossings;
        let (stage, lines) = solve.map_or(("Multipath", lines), |lines| ("Solve", lines));
        Some(format!(
            "a typical patch is crossed by {crossings:.0} lines, too few to tell its error from the spread of repeats; errors \
             are those of single lines, which are too small where patches inherit noise from each other; give `{stage}` {} \
             lines or more, or make fewer patches",
            grouped(rounded_up(lines as f64 * factor))
        ))
    }
}

/// Returns the number of repeats if the lines are enough for `possible` of them: 1 if these are too few for a spread.
pub(crate) fn repeats_of(possible: f64) -> u64 {
    match (possible as u64).min(SHARED) {
        repeats @ MIN_REPEATS.. => repeats,
        _ => 1,
    }
}
