//! Watcher of the light of a run: the interface through which a caller sees it before the run has ended.

use std::fmt::Debug;

use serde_json::Value;
use sir_report::View;

/// Watcher of the light of a run. It sees the mean of the repeats so far.
pub trait Watcher: Debug + Send + Sync {
    /// True if it wants to see the light now. Coding the light takes time.
    fn wants_light(&self) -> bool;

    /// Receives light that is not final. `facts` are the facts of a page (see `web/README.md` of `sir-report`), and `status`
    /// says how far the run is.
    fn show(&self, title: &str, view: View, facts: Value, status: &str);

    /// Receives the facts of a run that has ended, and its light if the pipeline has a page.
    fn end(&self, title: &str, view: Option<View>, facts: Value);

    /// True if it wants no further repeats. The run then ends as if these were all.
    fn wants_end(&self) -> bool;
}
