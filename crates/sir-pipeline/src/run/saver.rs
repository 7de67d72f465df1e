//! What the outputs of all stages `Save` have in common.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use crate::plan::Pipeline;
use crate::prepare::prepared::Prepared;
use crate::progress::Progress;

/// What the outputs of all stages `Save` have in common.
#[derive(Clone, Copy)]
pub(crate) struct Saver<'a> {
    pub(crate) pipeline: &'a Pipeline,
    pub(crate) prepared: &'a Prepared,
    pub(crate) directory: &'a Path,
    pub(crate) threads: usize,
    pub(crate) progress: &'a dyn Progress,
    /// Becomes true when the run is asked to stop.
    pub(crate) stop: &'a AtomicBool,
}
