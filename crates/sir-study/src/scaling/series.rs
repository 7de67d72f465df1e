//! The series of the diagrams: stages of the pipeline, and kinds of workers.

use plotters::style::RGBColor;

use crate::scaling::statistics::Part;
use crate::scaling::study::{Row, Study};
use crate::scaling::workers::{Workers, counted};

/// Part of the run, with the style of its lines. The colors are distinguishable for color-blind people, too (Okabe and
/// Ito).
#[derive(Clone, Copy)]
pub(crate) struct Stage {
    pub(crate) name: &'static str,
    pub(crate) color: RGBColor,
    /// Width of the lines in pixels. The line of the whole run often coincides with that of a stage, and is then below
    /// it.
    pub(crate) width: u32,
    pub(crate) part: fn(&Row) -> Option<Part>,
}

const STAGES: [Stage; 3] = [
    Stage { name: "first shot", color: RGBColor(0, 114, 178), width: 2, part: |row| row.first_shot },
    Stage { name: "multipath", color: RGBColor(213, 94, 0), width: 2, part: |row| row.multipath },
    Stage { name: "whole run", color: RGBColor(90, 90, 90), width: 4, part: |row| Some(row.whole) },
];

/// Returns the parts that the pipeline has.
pub(crate) fn stages(study: &Study) -> Vec<Stage> {
    STAGES.into_iter().filter(|stage| study.rows.iter().any(|row| (stage.part)(row).is_some())).collect()
}

/// Combinations that a line joins. From one to the next, only the number of threads changes, or only the number of
/// ranks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    pub(crate) label: String,
    /// Indices of rows, fewest workers first.
    pub(crate) rows: Vec<usize>,
    /// Indices of the rows that have a mark.
    pub(crate) marked: Vec<usize>,
    /// Corners of the mark at each point; a disc if there are none.
    pub(crate) mark: &'static [(i32, i32)],
    /// True for dashed lines, which ranks have.
    pub(crate) dashed: bool,
}

/// Cross: two strokes.
const CROSS: &[(i32, i32)] = &[(-6, -6), (6, 6), (0, 0), (6, -6), (-6, 6), (0, 0)];

impl Kind {
    /// Returns a series of published measurements, drawn as crosses.
    pub(crate) fn published(name: &str, rows: std::ops::Range<usize>) -> Self {
        let rows: Vec<usize> = rows.collect();
        Self { label: name.into(), rows: rows.clone(), marked: rows, mark: CROSS, dashed: true }
    }
}

/// Triangle, square, diamond, and inverted triangle.
const MARKS: [&[(i32, i32)]; 4] = [
    &[(0, -6), (6, 5), (-6, 5)],
    &[(-4, -4), (4, -4), (4, 4), (-4, 4)],
    &[(0, -6), (6, 0), (0, 6), (-6, 0)],
    &[(0, 6), (6, -5), (-6, -5)],
];

/// Returns a kind for the threads of one rank, and a kind for the ranks of each number of threads.
pub(crate) fn kinds(study: &Study) -> Vec<Kind> {
    let rows = |wanted: &dyn Fn(Workers) -> bool| -> Vec<usize> {
        let rows = study.rows.iter().enumerate();
        rows.filter(|(_, row)| wanted(row.workers)).map(|(i, _)| i).collect()
    };
    let one_rank = rows(&|workers| workers.ranks.get() == 1);
    let workers = study.rows.iter().map(|row| row.workers);
    let mut threads: Vec<usize> = workers.filter(|w| w.ranks.get() > 1).map(|w| w.threads.get()).collect();
    threads.sort_unstable();
    threads.dedup();
    // The baseline alone is no series of threads.
    let alone = (one_rank.len() > 1 || threads.is_empty()).then(|| Kind {
        label: "threads".into(),
        rows: one_rank.clone(),
        marked: one_rank,
        mark: &[],
        dashed: false,
    });
    let least_ranks = if alone.is_some() { 2 } else { 1 };
    let ranks = threads.iter().zip(MARKS.iter().cycle()).map(|(&t, mark)| Kind {
        label: if t == 1 { "ranks".into() } else { format!("ranks of {}", counted(t, "thread")) },
        rows: rows(&|workers| workers.threads.get() == t),
        // A line begins at one rank, where the mark of threads is drawn.
        marked: rows(&|workers| workers.threads.get() == t && workers.ranks.get() >= least_ranks),
        mark,
        dashed: true,
    });
    alone.into_iter().chain(ranks).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scaling::study::Timing;
    use crate::scaling::workers::Plan;
    use std::num::NonZeroUsize;

    fn study(ranks: &[usize], threads: &[usize]) -> Study {
        let numbers =
            |list: &[usize]| -> Vec<_> { list.iter().filter_map(|&n| NonZeroUsize::new(n)).collect() };
        let plan = Plan::new(&numbers(ranks), &numbers(threads), NonZeroUsize::MIN);
        let timing = Timing {
            first_shot: Some(1.0),
            multipath: None,
            whole: 1.0,
            sequential: 0.0,
            communication: 0.0,
        };
        Study::new("x", 1, &plan, &vec![vec![timing]; plan.workers.len()])
    }

    fn found(study: &Study) -> Vec<(String, Vec<(usize, usize)>)> {
        let workers = |&i: &usize| {
            let workers = study.rows[i].workers;
            (workers.ranks.get(), workers.threads.get())
        };
        kinds(study).into_iter().map(|k| (k.label, k.rows.iter().map(workers).collect())).collect()
    }

    #[test]
    fn a_line_changes_threads_or_ranks() {
        assert_eq!(
            found(&study(&[1, 2], &[1, 2])),
            [
                ("threads".into(), vec![(1, 1), (1, 2)]),
                ("ranks".into(), vec![(1, 1), (2, 1)]),
                ("ranks of 2 threads".into(), vec![(1, 2), (2, 2)]),
            ]
        );
        assert_eq!(found(&study(&[1, 4], &[1])), [("ranks".into(), vec![(1, 1), (4, 1)])]);
        assert_eq!(found(&study(&[1], &[1])), [("threads".into(), vec![(1, 1)])]);
        let marked: Vec<_> = kinds(&study(&[1, 2], &[1, 2])).into_iter().map(|kind| kind.marked).collect();
        assert_eq!(marked, [vec![0, 1], vec![2], vec![3]]);
        assert_eq!(found(&study(&[2], &[2])), [("ranks of 2 threads".into(), vec![(2, 2)])]);
    }

    #[test]
    fn only_what_the_pipeline_has_is_shown() {
        let names: Vec<_> = stages(&study(&[1], &[1])).iter().map(|stage| stage.name).collect();
        assert_eq!(names, ["first shot", "whole run"]);
    }
}
