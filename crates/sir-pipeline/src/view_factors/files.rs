//! The output files of view factors.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::view_factors::report::{Matrix, Report};

/// Name of the JSON file. It is written last, so its presence shows that a directory holds view factors.
pub(super) const JSON: &str = "viewfactors.json";

/// Writes the view factors as CSV and JSON, and returns the paths of the files.
pub(super) fn write(report: &Report, directory: &Path) -> Result<Vec<PathBuf>, Error> {
    let counted = &report.counted;
    let mut files = vec![
        ("factors.csv", matrix(report, &counted.factors, [&counted.blocked, &counted.escaped])),
        ("errors.csv", matrix(report, &counted.errors, [&counted.blocked_errors, &counted.escaped_errors])),
        ("pairs.csv", pairs(report)),
    ];
    if let Some(closed) = &report.closed {
        let Matrix { factors, errors, blocked, blocked_errors, escaped, escaped_errors, .. } = closed;
        files.push(("closed.csv", matrix(report, factors, [blocked, escaped])));
        files.push(("closed-errors.csv", matrix(report, errors, [blocked_errors, escaped_errors])));
    }
    files.push((JSON, Ok(report.to_json().into_bytes())));
    let mut paths = Vec::new();
    for (name, content) in files {
        let path = directory.join(name);
        sir_view::write_atomically(&path, |file| file.write_all(&content?))?;
        paths.push(path);
    }
    Ok(paths)
}

/// Returns a CSV table with a row for each group, and columns for each group, `blocked` and `escaped`.
fn matrix(report: &Report, rows: &[Vec<f64>], rest: [&[f64]; 2]) -> io::Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let names = report.groups.iter().map(|group| group.name.as_str());
    table.write_record(["group", "area", "lines"].into_iter().chain(names).chain(["blocked", "escaped"]))?;
    for (i, (group, row)) in report.groups.iter().zip(rows).enumerate() {
        let head = [group.name.clone(), group.area.to_string(), group.lines.to_string()];
        let numbers = row.iter().chain(rest.map(|column| &column[i])).map(f64::to_string);
        table.write_record(head.into_iter().chain(numbers))?;
    }
    finish(table)
}

/// Returns a CSV table with a row for each pair of groups with a count above 0.
fn pairs(report: &Report) -> io::Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(["from", "to", "lines", "count", "factor", "error", "closed", "closed_error"])?;
    for (i, from) in report.groups.iter().enumerate() {
        for (j, to) in report.groups.iter().enumerate().filter(|&(j, _)| report.counts[i][j] > 0) {
            let closed = report.closed.as_ref();
            let closed =
                |of: fn(&Matrix) -> &Vec<Vec<f64>>| closed.map_or(String::new(), |m| of(m)[i][j].to_string());
            table.write_record([
                from.name.clone(),
                to.name.clone(),
                from.lines.to_string(),
                report.counts[i][j].to_string(),
                report.counted.factors[i][j].to_string(),
                report.counted.errors[i][j].to_string(),
                closed(|m| &m.factors),
                closed(|m| &m.errors),
            ])?;
        }
    }
    finish(table)
}

/// Returns the bytes of a table.
fn finish(table: csv::Writer<Vec<u8>>) -> io::Result<Vec<u8>> {
    table.into_inner().map_err(|error| error.into_error())
}
