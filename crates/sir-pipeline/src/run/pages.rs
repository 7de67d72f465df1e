//! Pages: written when a run has ended, because they have its figures.

use std::path::{Path, PathBuf};

use serde_json::Value;
use sir_report::{View, write_page};

use crate::error::Error;
use crate::prepare::prepared::Prepared;
use crate::report::page::{Shown, facts, title};
use crate::report::result::Report;
use crate::watcher::Watcher;

/// Contents of pages, as far as they are known before the run ends. Only on the first rank.
#[derive(Default)]
pub(crate) struct Pages {
    pub(crate) pages: Vec<Page>,
    /// What a watcher was shown last.
    pub(crate) watched: Option<Shown>,
    /// Measurements of sensors, as JSON.
    pub(crate) sensors: Vec<Value>,
}

/// A page whose light is known, but not all figures.
pub(crate) struct Page {
    /// Path inside the run directory.
    pub(crate) path: PathBuf,
    pub(crate) view: View,
    pub(crate) shown: Shown,
}

impl Pages {
    /// Writes the pages into a run directory.
    pub(crate) fn write(&self, prepared: &Prepared, directory: &Path, report: &Report) -> Result<(), Error> {
        for Page { path, view, shown } in &self.pages {
            let facts = facts(report, &prepared.model.scene, shown, &self.sensors);
            write_page(&directory.join(path), title(report), view, &facts)?;
        }
        Ok(())
    }

    /// Shows a watcher the last page, or the facts of what it was shown last.
    pub(crate) fn show_last(&mut self, watcher: &dyn Watcher, prepared: &Prepared, report: &Report) {
        let (view, shown) = match (self.pages.pop(), self.watched.take()) {
            (Some(page), _) => (Some(page.view), page.shown),
            (None, Some(shown)) => (None, shown),
            (None, None) => return,
        };
        watcher.end(title(report), view, facts(report, &prepared.model.scene, &shown, &self.sensors));
    }
}
