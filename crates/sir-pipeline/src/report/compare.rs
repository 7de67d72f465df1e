//! Compares the results of two runs.

use std::path::{Path, PathBuf};

use sir_view::{Comparison, Table};

use crate::error::Error;
use crate::run::execute::read_report;

/// Compares two results, each a table or a run directory with a table. Of several tables of a run, the last one is
/// used.
///
/// # Errors
///
/// If there is no table, it cannot be read, or the tables have different patches.
pub fn compare(a: &Path, b: &Path) -> Result<Comparison, Error> {
    let read = |path: &Path| -> Result<Table, Error> { Ok(Table::read(&table_of(path)?)?) };
    Ok(sir_view::compare(&read(a)?, &read(b)?)?)
}

fn table_of(path: &Path) -> Result<PathBuf, Error> {
    if !path.is_dir() {
        return Ok(path.to_owned());
    }
    let report = read_report(path)?;
    let table = report.outputs.iter().rfind(|output| output.kind == "table");
    table.map(|t| path.join(&t.path)).ok_or_else(|| Error::NoTable { directory: path.to_owned() })
}
