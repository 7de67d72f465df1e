//! The numbers that the paper reports.
//!
//! Martínez, R., Forés, A. and Martín, I. (2009): *Parallel implementation of a global line Monte Carlo radiosity*, section 5.

use serde::Serialize;

use crate::experiment::lines::Lines;
use crate::scaling::statistics::{Overhead, Part, Spread};
use crate::scaling::study::Row;
use crate::scaling::workers::Workers;

/// Citation of the paper, for the report.
pub(crate) const CITATION: &str = "Martínez, Forés and Martín (2009), \"Parallel implementation of a global line Monte Carlo radiosity\", section 5";

/// Machine on which the authors measured.
pub(crate) const MACHINE: &str = "four HP ProLiant DL145 servers, each with two AMD Opteron 244 at 1.8 GHz \
                                  and 2 GB of memory, on a network of 100 Mbit/s";

/// Number of processors of the parallel runs whose times are reported.
pub(crate) const P: usize = 8;

/// Reported efficiency for several numbers of processors.
pub(crate) const EFFICIENCY: f64 = 0.9;

/// Best share of local lines, according to the paper.
pub(crate) const BEST_SHARE: f64 = 0.5;

/// Share of global lines that miss the scene, according to the paper.
pub(crate) const EMPTY_SHARE: f64 = 0.3;

/// Volume of the bounding sphere over that of the bounding box, according to the paper.
pub(crate) const SPHERE_TO_BOX: f64 = 1.3;

/// Times of a stage \[s\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Times {
    /// Time of the sequential run.
    pub(crate) sequential: f64,
    /// Time on eight processors.
    pub(crate) parallel: f64,
}

/// Scene of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Published {
    /// Folder of the scene's pipeline.
    pub(crate) name: &'static str,
    /// Number of patches.
    pub(crate) patches: usize,
    /// Numbers of lines.
    pub(crate) lines: Lines,
    /// Times of the first shot.
    pub(crate) first_shot: Times,
    /// Times of multipath.
    pub(crate) multipath: Times,
    /// Times of the whole run.
    pub(crate) whole: Times,
}

const LINES: Lines = Lines { local: 100_000_000, global: 130_000_000 };

const SCENES: [Published; 2] = [
    Published {
        name: "museum-stairs",
        patches: 614_778,
        lines: LINES,
        first_shot: Times { sequential: 484.7, parallel: 70.2 },
        multipath: Times { sequential: 861.7, parallel: 119.3 },
        whole: Times { sequential: 1346.4, parallel: 189.5 },
    },
    Published {
        name: "airplane-cabin",
        patches: 438_518,
        lines: LINES,
        first_shot: Times { sequential: 337.7, parallel: 47.0 },
        multipath: Times { sequential: 613.6, parallel: 83.5 },
        whole: Times { sequential: 951.3, parallel: 130.5 },
    },
];

/// Largest relative difference of the numbers of patches. They may differ, because subdivision cannot give every
/// number.
const SAME_PATCHES: f64 = 1e-3;

/// Returns the scene of the paper with this name, if the numbers of patches and lines match.
#[must_use]
pub(crate) fn published(name: &str, patches: usize, lines: Lines) -> Option<Published> {
    let apart = |scene: &Published| (patches as f64 / scene.patches as f64 - 1.0).abs();
    SCENES
        .into_iter()
        .find(|scene| scene.name == name && scene.lines == lines && apart(scene) <= SAME_PATCHES)
}

impl Times {
    /// Computes speed-up and efficiency.
    #[must_use]
    pub(crate) fn part(self) -> Part {
        let [one, many] = [self.sequential, self.parallel].map(|t| Spread { median: t, min: t, max: t });
        Part::new(one, many, P)
    }
}

impl Published {
    /// Returns the scene's point in a diagram of speed-ups.
    #[must_use]
    pub(crate) fn row(&self) -> Row {
        let nothing = Overhead { seconds: Spread { median: 0.0, min: 0.0, max: 0.0 }, share: 0.0 };
        Row {
            p: P,
            workers: Workers::BASELINE,
            more_than_cores: false,
            first_shot: Some(self.first_shot.part()),
            multipath: Some(self.multipath.part()),
            whole: self.whole.part(),
            sequential: nothing,
            communication: nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_add_up_and_efficiencies_are_about_as_stated() {
        for scene in SCENES {
            for pick in [(|t| t.sequential) as fn(Times) -> f64, |t| t.parallel] {
                let [first, second, whole] = [scene.first_shot, scene.multipath, scene.whole].map(pick);
                assert!((first + second - whole).abs() < 0.06, "{}", scene.name);
            }
            assert!((scene.whole.part().efficiency - EFFICIENCY).abs() < 0.02, "{}", scene.name);
        }
        let stairs = SCENES[0].whole.part();
        assert!((stairs.speed_up - 7.105).abs() < 1e-3 && (stairs.efficiency - 0.888).abs() < 1e-3);
    }

    #[test]
    fn only_the_same_task_is_compared() {
        assert!(published("museum-stairs", 614_776, LINES).is_some());
        assert_eq!(published("museum-stairs", 600_000, LINES), None);
        assert_eq!(published("museum-stairs", 614_778, LINES.times(0.5)), None);
        assert_eq!(published("cornell-box", 614_778, LINES), None);
    }
}
