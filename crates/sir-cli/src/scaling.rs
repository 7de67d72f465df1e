//! `sir scaling`: speed-up on several threads and ranks.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use sir_study::scaling::{MPIRUN, Measured, ScalingOptions, json, scaling, text};

use crate::error::CliError;
use crate::interrupt;
use crate::numbers::{command_words, repeats, workers};
use crate::progress::Stderr;

/// Arguments of `sir scaling`.
#[derive(Debug, clap::Args)]
pub struct ScalingArgs {
    /// The pipeline file.
    pub pipeline: PathBuf,
    /// Numbers of threads of each process, such as 1,2,4; default: powers of two up to the number of cores.
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = workers)]
    pub threads: Vec<NonZeroUsize>,
    /// Numbers of processes, such as 1,2,4. More than one process needs a program built with --features mpi.
    ///
    /// Every number of ranks is run with every number of threads.
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = workers, default_value = "1")]
    pub ranks: Vec<NonZeroUsize>,
    /// Runs of each combination; medians are reported.
    #[arg(long, value_name = "N", default_value = "3", value_parser = repeats)]
    pub repeats: NonZeroUsize,
    /// Output directory; default: a new directory results/NAME-scaling. See `sir run --help` for NAME.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Command that starts several processes. It is split at spaces, and `-n RANKS sir run …` is appended.
    ///
    /// The default is for one machine: it allows more processes than cores, and does not bind a process with several
    /// threads to one core. On a cluster, use for instance --mpirun "srun" or --mpirun "mpirun --hostfile hosts". All
    /// machines must then see the output directory under the same path.
    #[arg(long, value_name = "COMMAND", default_value = MPIRUN, value_parser = command_words)]
    pub mpirun: String,
    /// Print the content of scaling.json instead of a table.
    #[arg(long)]
    pub json: bool,
}

impl ScalingArgs {
    /// Returns the options of the measurement.
    fn options(&self) -> ScalingOptions {
        ScalingOptions {
            pipeline: self.pipeline.clone(),
            threads: self.threads.clone(),
            ranks: self.ranks.clone(),
            repeats: self.repeats,
            out: self.out.clone(),
            mpirun: self.mpirun.clone(),
        }
    }
}

/// Executes the command: measures, writes the files, and returns the text to print.
pub(crate) fn command(args: &ScalingArgs) -> Result<String, CliError> {
    let Measured { study, files } =
        scaling(&args.options(), &Stderr::Lines, interrupt::flag()).map_err(CliError::from)?;
    if args.json {
        return Ok(json(&study));
    }
    let files: String = files.iter().map(|file| format!("{}\n", file.display())).collect();
    Ok(format!("{}\n{files}", text(&study)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: ScalingArgs,
    }

    fn parse(text: &str) -> Result<ScalingArgs, clap::Error> {
        Line::try_parse_from(["sir"].into_iter().chain(text.split('|'))).map(|line| line.args)
    }

    #[test]
    fn lists_are_separated_by_commas() {
        let args = parse("x.ron|--threads|1, 2,4|--ranks=1,2").unwrap();
        let plan = args.options().plan(NonZeroUsize::MIN);
        assert_eq!((plan.workers.len(), plan.most_ranks(), plan.repeats.get()), (6, 2, 3));
        for bad in
            ["x.ron|--threads|0", "x.ron|--ranks|1,,2", "x.ron|--repeats|0", "x.ron|--mpirun| ", "--json"]
        {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
