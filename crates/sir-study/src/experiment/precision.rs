//! Part `error`: how far the pipeline's result is from the reference.

use serde::Serialize;
use sir_view::Table;

use crate::error::StudyError;
use crate::experiment::accuracy::{Accuracy, Bands, Reference};
use crate::experiment::lines::Lines;
use crate::experiment::markdown::{Grid, count, percent, signed_percent};
use sir_pipeline::format::duration;

/// What the part finds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Precision {
    /// Lines of the run.
    pub(crate) lines: Lines,
    /// Lines of the reference.
    pub(crate) reference_lines: Lines,
    /// Seconds of the reference.
    pub(crate) reference_seconds: f64,
    /// How far apart they are.
    #[serde(flatten)]
    pub(crate) accuracy: Accuracy,
    /// What the run says of its own error, on the same scale: red, green, blue.
    pub(crate) stated: [f64; 3],
    /// What the reference says of its own.
    pub(crate) reference_stated: [f64; 3],
}

/// Compares a run with the reference.
pub(crate) fn find(
    table: &Table,
    reference: &Reference,
    (lines, reference_lines): (Lines, Lines),
) -> Result<Precision, StudyError> {
    Ok(Precision {
        lines,
        reference_lines,
        reference_seconds: reference.seconds,
        accuracy: reference.accuracy(table)?,
        stated: reference.stated(table),
        reference_stated: reference.stated(&reference.table),
    })
}

impl Precision {
    /// The section of the report.
    pub(crate) fn section(&self) -> String {
        let Accuracy { relative_rms: rms, relative_bias: bias } = self.accuracy;
        let mut grid = Grid::new(&[
            "",
            "relative RMS",
            "relative bias",
            "error that the run states",
            "that the reference states",
        ]);
        let stated = |list: &[f64; 3], k: Option<usize>| k.map_or("-".into(), |k| percent(list[k]));
        for (name, of, k) in [
            ("luminance", (|b| b.luminance) as fn(Bands) -> f64, None),
            ("red", |b| b.red, Some(0)),
            ("green", |b| b.green, Some(1)),
            ("blue", |b| b.blue, Some(2)),
        ] {
            grid.row([
                name.into(),
                percent(of(rms)),
                signed_percent(of(bias)),
                stated(&self.stated, k),
                stated(&self.reference_stated, k),
            ]);
        }
        format!(
            "### Error\n\nRadiosity of the run with {} local and {} global lines against the reference with \
             {} and {}, with another seed ({}). Everything is weighted by area and relative to the mean \
             radiosity of the reference, whose own error is in the RMS, too.\n\n{}",
            count(self.lines.local),
            count(self.lines.global),
            count(self.reference_lines.local),
            count(self.reference_lines.global),
            duration(self.reference_seconds),
            grid.end()
        )
    }
}
