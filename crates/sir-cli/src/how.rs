//! Options of the execution of a run.

use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sir_parallel::Communicator;
use sir_pipeline::{RunOptions, Watcher};

use crate::error::CliError;
use crate::numbers::{seconds, threads};
use crate::output::print_note;
use crate::progress::Stderr;
use crate::watch::Page;

/// Options of the execution of a run. None of them changes the result.
#[derive(Debug, clap::Args)]
pub struct HowArgs {
    /// Threads of each process, 1 to 4096; default: one per processor core. The result does not depend on it.
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<NonZeroUsize>,
    /// Seconds between checkpoints, from which `sir resume` can continue.
    #[arg(long, value_name = "SECONDS", default_value = "300", value_parser = seconds)]
    pub checkpoint_every: Duration,
    /// Serve a page on this computer that shows the light after each repeat, and print its address. It has a button that ends
    /// the run after the current repeat.
    #[arg(long)]
    pub watch: bool,
    /// Show no progress; warnings and errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print the content of result.json instead of a summary.
    #[arg(long)]
    pub json: bool,
}

impl HowArgs {
    /// Returns the options of a run that `stop` can interrupt. Starts the server of `--watch`.
    pub(crate) fn options(
        &self,
        stop: Arc<AtomicBool>,
        comm: &dyn Communicator,
    ) -> Result<RunOptions, CliError> {
        let mut watcher: Option<Arc<dyn Watcher>> = None;
        if self.watch && comm.is_first() {
            let (page, url) = Page::start().map_err(CliError::Watch)?;
            print_note(format!("watch: {url}"));
            watcher = Some(Arc::new(page));
        }
        Ok(RunOptions {
            threads: self.threads,
            checkpoint_every: self.checkpoint_every,
            stop,
            progress: Arc::new(Stderr::unless(self.quiet)),
            watcher,
            ..RunOptions::default()
        })
    }
}
