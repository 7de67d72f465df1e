//! The files of view factors.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::view_factors::report::{Matrix, Report};

/// The file that tells that a directory has view factors: it is written last.
pub(super) const JSON: &str = "viewfactors.json";

/// Writes the view factors as CSV and JSON; returns the paths of the files.
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
    files.push((JSON, report.to_json()));
    let mut paths = Vec::new();
    for (name, content) in files {
        let path = directory.join(name);
        sir_view::write_atomically(&path, |file| file.write_all(content.as_bytes()))?;
        paths.push(path);
    }
    Ok(paths)
}

/// A row for each group, with a column for each group and those of what is blocked and escapes.
fn matrix(report: &Report, rows: &[Vec<f64>], rest: [&[f64]; 2]) -> String {
    let names = report.groups.iter().map(|group| cell(&group.name));
    let header: Vec<String> = ["group".into(), "area".into(), "lines".into()]
        .into_iter()
        .chain(names)
        .chain(["blocked".into(), "escaped".into()])
        .collect();
    let mut text = header.join(",") + "\n";
    for (i, (group, row)) in report.groups.iter().zip(rows).enumerate() {
        text += &format!("{},{},{}", cell(&group.name), group.area, group.lines);
        row.iter().chain(rest.map(|column| &column[i])).for_each(|x| text += &format!(",{x}"));
        text.push('\n');
    }
    text
}

/// A row for each pair of which something was counted.
fn pairs(report: &Report) -> String {
    let mut text = String::from("from,to,lines,count,factor,error,closed,closed_error\n");
    for (i, from) in report.groups.iter().enumerate() {
        for (j, to) in report.groups.iter().enumerate().filter(|&(j, _)| report.counts[i][j] > 0) {
            let (factor, error) = (report.counted.factors[i][j], report.counted.errors[i][j]);
            let closed = report.closed.as_ref().map(|m| format!("{},{}", m.factors[i][j], m.errors[i][j]));
            text += &format!(
                "{},{},{},{},{factor},{error},{}\n",
                cell(&from.name),
                cell(&to.name),
                from.lines,
                report.counts[i][j],
                closed.unwrap_or_else(|| ",".into())
            );
        }
    }
    text
}

/// A text as a cell of a CSV file (RFC 4180).
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        return format!("\"{}\"", text.replace('"', "\"\""));
    }
    text.to_owned()
}
