//! The command line of `sir experiment`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::ValueEnum;
use serde::Serialize;

use crate::scaling::options::{MPIRUN, command, workers};
use crate::scaling::workers::Plan;

/// What to redo, and how.
#[derive(Debug, clap::Args)]
pub struct ExperimentArgs {
    /// Pipeline files; default: those of the museum stairs and of the airplane cabin, in `scenes` of the current folder.
    pub pipelines: Vec<PathBuf>,
    /// Where to write; default: a new directory results/experiment.
    ///
    /// The same command with the directory of an earlier one goes on there: finished runs are not repeated.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What all numbers of lines are multiplied by, above 0 and at most 1. Patches stay.
    #[arg(long, value_name = "S", default_value = "1", value_parser = scale)]
    pub scale: f64,
    /// Numbers of threads to measure speed-ups with, such as 1,2,4; default: 1 up to the number of cores.
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = workers)]
    pub threads: Vec<NonZeroUsize>,
    /// Numbers of processes of one thread each to measure speed-ups with; default: 1 up to the number of cores, if
    /// built with --features mpi.
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = workers)]
    pub ranks: Vec<NonZeroUsize>,
    /// What starts several processes, as for `sir scaling`.
    #[arg(long, value_name = "COMMAND", default_value = MPIRUN, value_parser = command)]
    pub mpirun: String,
    /// Lines of the reference, to which results are compared, as a multiple of those of the pipeline: from 1 to 10000.
    #[arg(long, value_name = "F", default_value = "20", value_parser = reference)]
    pub reference: f64,
    /// What to do, such as scaling,mix; default: everything.
    #[arg(long, value_name = "PART,…", value_delimiter = ',', value_enum)]
    pub parts: Vec<Part>,
}

/// A part of the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Part {
    /// Times, speed-ups and efficiencies of threads and ranks.
    Scaling,
    /// How far the result is from a run with many more lines.
    Error,
    /// Which share of local lines is best.
    Mix,
    /// How many global lines miss the scene.
    Domains,
    /// How evenly the work of lines is shared.
    Spread,
    /// What averaging independent replicas loses.
    Farm,
    /// The picture.
    Pictures,
}

impl ExperimentArgs {
    /// The parts to do, in their order, each once.
    #[must_use]
    pub fn parts(&self) -> Vec<Part> {
        let all = Part::value_variants().iter().copied();
        all.filter(|part| self.parts.is_empty() || self.parts.contains(part)).collect()
    }

    /// On which workers the speed-up is measured, on a machine with so many cores.
    #[must_use]
    pub fn plan(&self, cores: NonZeroUsize, mpi: bool) -> Plan {
        let all: Vec<NonZeroUsize> = (1..=cores.get()).filter_map(NonZeroUsize::new).collect();
        let or = |given: &[NonZeroUsize], default: &[NonZeroUsize]| -> Vec<NonZeroUsize> {
            if given.is_empty() { default } else { given }.to_vec()
        };
        let ranks = or(&self.ranks, if mpi { &all } else { &[NonZeroUsize::MIN] });
        Plan::each(&ranks, &or(&self.threads, &all), NonZeroUsize::MIN)
    }
}

fn scale(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|&s| s > 0.0 && s <= 1.0);
    number.ok_or_else(|| "write a number above 0 and at most 1, such as 0.01".into())
}

fn reference(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|f| (1.0..=10_000.0).contains(f));
    number.ok_or_else(|| "write a number from 1 to 10000, such as 20".into())
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
        assert_eq!(args.parts(), [Part::Error, Part::Mix]);
        assert_eq!(parse("").unwrap().parts().len(), 7);
    }

    #[test]
    fn by_default_every_number_of_cores_is_tried() {
        let count = |text, mpi| {
            parse(text)
                .unwrap()
                .plan(NonZeroUsize::new(3).unwrap(), mpi)
                .workers
                .iter()
                .map(|w| w.count())
                .collect::<Vec<_>>()
        };
        assert_eq!(count("", false), [1, 2, 3]);
        assert_eq!(count("", true), [1, 2, 2, 3, 3]);
        assert_eq!(count("--threads 2 --ranks 4", true), [1, 2, 4]);
    }
}
