//! Compares the results of two runs.

use std::path::Path;

use sir_view::{Comparison, Table};

use crate::error::Error;
use crate::run::execute::read_report;

/// Compares two results, each a table or a run directory with a table. Of several tables of a run, the last one of patches is
/// used, or else the last one.
///
/// # Errors
///
/// If there is no table, it cannot be read, or the tables have different patches.
pub fn compare(a: &Path, b: &Path) -> Result<Comparison, Error> {
    Ok(sir_view::compare(&table_of(a)?, &table_of(b)?)?)
}

fn table_of(path: &Path) -> Result<Table, Error> {
    if !path.is_dir() {
        return Ok(Table::read(path)?);
    }
    let report = read_report(path)?;
    let mut last = None;
    for output in report.outputs.iter().rev().filter(|output| output.kind == "table") {
        let table = Table::read(&path.join(&output.path))?;
        if table.per.is_none() {
            return Ok(table);
        }
        last = last.or(Some(table));
    }
    last.ok_or_else(|| Error::NoTable { directory: path.to_owned() })
}
