//! Part `error`: the error of the pipeline's result against the reference.

use serde::Serialize;
use sir_view::Table;

use crate::error::StudyError;
use crate::experiment::accuracy::{Accuracy, Bands, Reference};
use crate::experiment::lines::Lines;
use crate::experiment::markdown::{Grid, count, percent, signed_percent};
use sir_pipeline::format::duration;

/// Results of the part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Precision {
    /// Numbers of lines of the run.
    pub(crate) lines: Lines,
    /// Numbers of lines of the reference.
    pub(crate) reference_lines: Lines,
    /// Time of the reference \[s\].
    pub(crate) reference_seconds: f64,
    /// Error of the run against the reference.
    #[serde(flatten)]
    pub(crate) accuracy: Accuracy,
    /// Error that the run states itself, on the same scale: red, green, blue.
    pub(crate) stated: [f64; 3],
    /// Error that the reference states itself, on the same scale.
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
    /// Returns the section of the report.
    pub(crate) fn section(&self) -> String {
        let Accuracy { relative_rms: rms, relative_bias: bias } = self.accuracy;
        let mut grid = Grid::new(&[
            "",
            "relative RMS",
            "relative bias",
            "error stated by the run",
            "error stated by the reference",
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
             radiosity of the reference. The RMS includes the error of the reference.\n\n{}",
            count(self.lines.local),
            count(self.lines.global),
            count(self.reference_lines.local),
            count(self.reference_lines.global),
            duration(self.reference_seconds),
            grid.end()
        )
    }
}
