//! Pages: written when a run has ended, because they have its figures.

use std::path::{Path, PathBuf};

use serde_json::Value;
use sir_report::{View, write_page};

use crate::error::Error;
use crate::prepare::prepared::Prepared;
use crate::report::page::{Shown, facts, title};
use crate::report::result::Report;

/// A page whose light is known, but not all figures.
pub(crate) struct Page {
    /// Path inside the run directory.
    pub(crate) path: PathBuf,
    pub(crate) view: View,
    pub(crate) shown: Shown,
}

/// Writes pages into a run directory. `sensors` has the measurements.
pub(crate) fn write_pages(
    pages: &[Page],
    sensors: &[Value],
    prepared: &Prepared,
    directory: &Path,
    report: &Report,
) -> Result<(), Error> {
    for Page { path, view, shown } in pages {
        let facts = facts(report, &prepared.model.scene, shown, sensors);
        write_page(&directory.join(path), title(report), view, &facts)?;
    }
    Ok(())
}
