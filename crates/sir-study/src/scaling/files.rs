//! The output files of a measurement.

use std::io::{self, Write as _};
use std::path::Path;

use crate::error::StudyError;
use crate::scaling::statistics::{Overhead, Part, Spread};
use crate::scaling::study::{Row, Study};
use crate::scaling::{plot, table};

/// Name of the JSON file. It is written last, so its presence shows that a directory holds a measurement.
pub(crate) const JSON: &str = "scaling.json";

/// Writes the measurements as CSV, Markdown, SVG and JSON.
///
/// # Errors
///
/// If a file cannot be written.
pub fn write(study: &Study, directory: &Path) -> Result<(), StudyError> {
    let file = |name: &str, content: io::Result<String>| -> Result<(), StudyError> {
        sir_view::write_atomically(&directory.join(name), |file| file.write_all(content?.as_bytes()))?;
        Ok(())
    };
    file("scaling.csv", Ok(csv(study)))?;
    file("scaling.md", Ok(table::markdown(study)))?;
    file("scaling.svg", plot::svg(study))?;
    file(JSON, Ok(json(study)))
}

/// Returns all numbers as JSON.
#[must_use]
pub fn json(study: &Study) -> String {
    // Serializing cannot fail: the study is a tree of plain structs and finite numbers.
    serde_json::to_string_pretty(study).map(|json| json + "\n").unwrap_or_default()
}

/// Returns all numbers as CSV with a line per combination. Cells of stages that the pipeline does not have are empty.
#[must_use]
pub fn csv(study: &Study) -> String {
    let mut names: Vec<String> = ["p", "ranks", "threads", "more_than_cores"].map(str::to_owned).into();
    for part in ["first_shot", "multipath", "whole"] {
        let fields = ["seconds", "min", "max", "speed_up", "efficiency"];
        names.extend(fields.map(|field| format!("{part}_{field}")));
    }
    for overhead in ["sequential", "communication"] {
        names.extend(["seconds", "min", "max", "share"].map(|field| format!("{overhead}_{field}")));
    }
    let mut text = names.join(",") + "\n";
    for row in &study.rows {
        text += &(cells(row).join(",") + "\n");
    }
    text
}

fn cells(row: &Row) -> Vec<String> {
    let Row { p, workers, more_than_cores, first_shot, multipath, whole, sequential, communication } = row;
    let mut cells = vec![
        p.to_string(),
        workers.ranks.to_string(),
        workers.threads.to_string(),
        more_than_cores.to_string(),
    ];
    for part in [first_shot.as_ref(), multipath.as_ref(), Some(whole)] {
        let numbers = part.map(|&Part { seconds, speed_up, efficiency }| {
            let Spread { median, min, max } = seconds;
            [median, min, max, speed_up, efficiency]
        });
        cells.extend(numbers.map_or_else(|| [const { String::new() }; 5], |n| n.map(|x| x.to_string())));
    }
    for Overhead { seconds: Spread { median, min, max }, share } in [sequential, communication] {
        cells.extend([median, min, max, share].map(|x| x.to_string()));
    }
    cells
}
