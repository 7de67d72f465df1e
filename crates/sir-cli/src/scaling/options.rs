//! The command line of `sir scaling`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use crate::scaling::workers::Plan;

/// What to measure.
#[derive(Debug, clap::Args)]
pub struct ScalingArgs {
    /// The pipeline file.
    pub pipeline: PathBuf,
    /// Numbers of threads of each process, such as 1,2,4; default: powers of two up to the number of cores.
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = workers)]
    pub threads: Vec<NonZeroUsize>,
    /// Numbers of processes, such as 1,2,4. More than one need a program built with --features mpi.
    ///
    /// Every number of ranks is run with every number of threads.
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = workers, default_value = "1")]
    pub ranks: Vec<NonZeroUsize>,
    /// Runs of each combination; medians are reported.
    #[arg(long, value_name = "N", default_value = "3", value_parser = repeats)]
    pub repeats: NonZeroUsize,
    /// Where to write; default: a new directory results/NAME-scaling. See `sir run --help` for NAME.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What starts several processes; it is split at spaces, and `-n RANKS sir run …` is added.
    ///
    /// The default is for one machine: it allows more processes than cores, and does not tie a process with
    /// several threads to one core. On a cluster one gives for instance --mpirun "srun", or --mpirun "mpirun
    /// --hostfile hosts"; all machines must then see the output directory under the same name.
    #[arg(long, value_name = "COMMAND", default_value = MPIRUN, value_parser = command)]
    pub mpirun: String,
    /// Print the content of scaling.json instead of a table.
    #[arg(long)]
    pub json: bool,
}

/// What starts several processes on one machine. Without the options, Open MPI refuses more ranks than cores,
/// and binds each rank, with all of its threads, to one core.
pub(crate) const MPIRUN: &str = "mpirun --oversubscribe --bind-to none";

impl ScalingArgs {
    /// What they ask for, on a machine with so many cores.
    #[must_use]
    pub fn plan(&self, cores: NonZeroUsize) -> Plan {
        if self.threads.is_empty() {
            Plan::new(&self.ranks, &powers_of_two(cores), self.repeats)
        } else {
            Plan::new(&self.ranks, &self.threads, self.repeats)
        }
    }
}

/// 1, 2, 4, … and `last`.
fn powers_of_two(last: NonZeroUsize) -> Vec<NonZeroUsize> {
    let powers = std::iter::successors(Some(NonZeroUsize::MIN), |n| {
        n.checked_mul(NonZeroUsize::MIN.saturating_add(1))
    });
    powers.take_while(|n| *n < last).chain([last]).collect()
}

fn number(text: &str, most: usize) -> Option<NonZeroUsize> {
    text.trim().parse().ok().filter(|&n| n <= most).and_then(NonZeroUsize::new)
}

pub(crate) fn workers(text: &str) -> Result<NonZeroUsize, String> {
    number(text, 4096).ok_or_else(|| "write whole numbers from 1 to 4096, with commas between them".into())
}

fn repeats(text: &str) -> Result<NonZeroUsize, String> {
    number(text, 1000).ok_or_else(|| "write a whole number from 1 to 1000".into())
}

pub(crate) fn command(text: &str) -> Result<String, String> {
    if text.trim().is_empty() {
        return Err("write a command, such as `mpirun` or `srun`".into());
    }
    Ok(text.into())
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
        let plan = args.plan(NonZeroUsize::MIN);
        assert_eq!((plan.workers.len(), plan.most_ranks(), plan.repeats.get()), (6, 2, 3));
        for bad in
            ["x.ron|--threads|0", "x.ron|--ranks|1,,2", "x.ron|--repeats|0", "x.ron|--mpirun| ", "--json"]
        {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn by_default_all_cores_are_tried_with_one_rank() {
        let args = parse("x.ron").unwrap();
        let counts = |cores| -> Vec<usize> {
            args.plan(NonZeroUsize::new(cores).unwrap()).workers.iter().map(|w| w.count()).collect()
        };
        assert_eq!(counts(1), [1]);
        assert_eq!(counts(4), [1, 2, 4]);
        assert_eq!(counts(6), [1, 2, 4, 6]);
    }
}
