//! `sir experiment`: repeats section 5 of Martínez, Forés and Martín (2009) on any pipelines.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

use clap::ValueEnum;
use sir_study::experiment::{ExperimentOptions, Part, experiment};
use sir_study::scaling::MPIRUN;

use crate::error::CliError;
use crate::interrupt;
use crate::numbers::{command_words, reference, scale, workers};
use crate::progress::Stderr;

/// Arguments of `sir experiment`.
#[derive(Debug, clap::Args)]
pub struct ExperimentArgs {
    /// Pipeline files; default: those of the museum stairs and of the airplane cabin, in `scenes` in the current
    /// folder.
    pub pipelines: Vec<PathBuf>,
    /// Output directory; default: a new directory results/experiment.
    ///
    /// The same command with the directory of an earlier experiment continues it: finished runs are not repeated.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Factor on all numbers of lines, above 0 and at most 1. The patches stay the same.
    #[arg(long, value_name = "S", default_value = "1", value_parser = scale)]
    pub scale: f64,
    /// Numbers of threads to measure speed-ups with, such as 1,2,4; default: 1 up to the number of cores.
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = workers)]
    pub threads: Vec<NonZeroUsize>,
    /// Numbers of processes of one thread each to measure speed-ups with; default: 1 up to the number of cores, if
    /// built with --features mpi.
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = workers)]
    pub ranks: Vec<NonZeroUsize>,
    /// Command that starts several processes, as for `sir scaling`.
    #[arg(long, value_name = "COMMAND", default_value = MPIRUN, value_parser = command_words)]
    pub mpirun: String,
    /// Lines of the reference run, with which results are compared, as a multiple of the pipeline's: from 1 to 10000.
    #[arg(long, value_name = "F", default_value = "20", value_parser = reference)]
    pub reference: f64,
    /// Parts to do, such as scaling,mix; default: all.
    #[arg(long, value_name = "PART,…", value_delimiter = ',', value_enum)]
    pub parts: Vec<PartOption>,
}

/// A part of the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PartOption {
    /// Times, speed-ups and efficiencies of threads and ranks.
    Scaling,
    /// Error against a run with many more lines.
    Error,
    /// Best share of local lines.
    Mix,
    /// Share of global lines that miss the scene.
    Domains,
    /// Spread of the cost of lines.
    Spread,
    /// Light that the mean of independent replicas loses.
    Farm,
    /// Images of the pipeline.
    Pictures,
}

impl From<PartOption> for Part {
    fn from(part: PartOption) -> Self {
        match part {
            PartOption::Scaling => Self::Scaling,
            PartOption::Error => Self::Error,
            PartOption::Mix => Self::Mix,
            PartOption::Domains => Self::Domains,
            PartOption::Spread => Self::Spread,
            PartOption::Farm => Self::Farm,
            PartOption::Pictures => Self::Pictures,
        }
    }
}

impl ExperimentArgs {
    /// Returns the options of the experiment.
    fn options(&self) -> ExperimentOptions {
        ExperimentOptions {
            pipelines: self.pipelines.clone(),
            out: self.out.clone(),
            scale: self.scale,
            threads: self.threads.clone(),
            ranks: self.ranks.clone(),
            mpirun: self.mpirun.clone(),
            reference: self.reference,
            parts: self.parts.iter().map(|&part| part.into()).collect(),
        }
    }
}

/// Executes the command: makes the runs, writes the report, and returns the text to print.
pub(crate) fn command(args: &ExperimentArgs) -> Result<String, CliError> {
    let files = experiment(&args.options(), Arc::new(Stderr::Lines), interrupt::flag())?;
    Ok(files.iter().map(|file| format!("{}\n", file.display())).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: ExperimentArgs,
    }

    fn parse(text: &str) -> Result<ExperimentArgs, clap::Error> {
        Line::try_parse_from(std::iter::once("sir").chain(text.split_whitespace())).map(|line| line.args)
    }

    #[test]
    fn numbers_and_parts_are_checked() {
        for bad in [
            "--scale 0",
            "--scale 1.5",
            "--scale nan",
            "--reference 0.5",
            "--reference inf",
            "--parts all",
            "--threads 0",
        ] {
            assert!(parse(bad).is_err(), "{bad}");
        }
        let args = parse("a.ron --scale 0.5 --parts mix,error,mix").unwrap();
        assert_eq!(args.options().parts(), [Part::Error, Part::Mix]);
        assert_eq!(parse("").unwrap().options().parts().len(), 7);
    }
}
