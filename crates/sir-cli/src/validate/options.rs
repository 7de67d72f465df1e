//! The arguments of `sir validate`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use crate::numbers::threads;

/// Arguments of `sir validate`.
#[derive(Debug, clap::Args)]
pub struct ValidateArgs {
    /// Accept standard errors of 0.5 % instead of 0.1 %: half a minute instead of minutes.
    #[arg(long)]
    pub quick: bool,
    /// Run only these cases, such as VF-13,CIE-5.8. Prefixes of names are accepted: RE, CIE-5.4.
    #[arg(long = "case", value_name = "ID,…", value_delimiter = ',')]
    pub cases: Vec<String>,
    /// Seed of the random numbers.
    #[arg(long, value_name = "S", default_value = "1")]
    pub seed: u64,
    /// Threads, 1 to 4096; default: one per processor core. The answers do not depend on it.
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<NonZeroUsize>,
    /// Also write validation.md and validation.json to this directory.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the content of validation.json instead of tables.
    #[arg(long)]
    pub json: bool,
    /// Show no progress.
    #[arg(long, short)]
    pub quiet: bool,
    /// A folder with exact answers that replace the built-in ones, in the same layout.
    #[arg(long, value_name = "DIR")]
    pub reference: Option<PathBuf>,
}
