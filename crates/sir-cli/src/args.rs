//! The command line.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Parser, Subcommand};

use crate::experiment::ExperimentArgs;
use crate::info::InfoArgs;
use crate::numbers::{seconds, threads};
use crate::scaling::ScalingArgs;
use crate::validate::options::ValidateArgs;
use crate::viewfactors::options::ViewFactorsArgs;

const EXAMPLES: &str = "\
Examples:
  sir info room.gltf                             what is in this scene, and what should a pipeline set?
  sir check scenes/cornell-box/pipeline.ron      what will it do, and how long will it take?
  sir run scenes/cornell-box/pipeline.ron        light the scene; the files go to results/cornell-box
  sir compare results/cornell-box results/cornell-box-2
  sir resume results/cornell-box                 go on where it was stopped, by Ctrl-C or a power cut
  mpirun -n 4 sir run room.ron                   on several machines, if built with --features mpi
  sir scaling room.ron --threads 1,2,4           how much faster are more threads?
  sir viewfactors room.obj --by group            which share of the flux of a part arrives where?
  sir experiment --scale 0.01                    what does the paper of 2009 claim, and does it hold?
  sir validate --quick                           are answers right where they are known?

A pipeline is a text file like this one (docs/pipeline.md tells all):
  Pipeline(
      stages: [
          Load(path: \"room.gltf\"),
          Subdivide(patches: 20_000),
          FirstShot(lines: 1_000_000),
          Multipath(lines: 1_000_000),
          Save([Image(path: \"view.png\"), Gltf(path: \"result.glb\"), Table(path: \"patches.csv\")]),
      ],
  )

Results go to files and to the standard output, progress and warnings to the standard error stream.

Exit codes: 0 done; 1 failed; 2 wrong usage or pipeline; 130 interrupted.";

/// Lights scenes: global-line Monte Carlo radiosity.
///
/// Computes how much light every part of every surface of a scene gets, by diffuse reflection between all of them,
/// and states how accurate the result is.
#[derive(Debug, Parser)]
#[command(name = "sir", version, after_long_help = EXAMPLES, after_help = "`sir --help` shows examples and exit codes.")]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a pipeline: light its scene and write the files that it asks for.
    ///
    /// Prints the files that it wrote, pictures first, and what each stage did. The run directory also gets a
    /// result.json with all of this for programs. The same pipeline gives the same files every time; only the times
    /// in result.json differ.
    Run(RunArgs),
    /// Go on with a run that was interrupted.
    ///
    /// A run saves its state every few minutes, and when it is stopped by Ctrl-C or SIGTERM. The result has the same
    /// bytes as that of a run which was never stopped, on any number of threads and ranks.
    Resume {
        /// The run directory.
        directory: PathBuf,
        /// How to go about it.
        #[command(flatten)]
        how: HowArgs,
    },
    /// Check a pipeline without running it.
    ///
    /// Reports all problems of the file at once. If there are none, reads the scene, tries some lines, and
    /// prints counts, light sources, memory and an estimate of the time. Writes nothing.
    Check {
        /// The pipeline file.
        pipeline: PathBuf,
    },
    /// Say what is in a scene, and what to set to light it.
    ///
    /// Reads a glTF, GLB or OBJ file and prints counts, sizes, materials, light sources, how closed it is and which sides of
    /// its surfaces face each other; then what is strange, and what a pipeline should set. Writes nothing.
    Info(InfoArgs),
    /// Compare two results: relative RMS, bias and the worst patches.
    ///
    /// Both must be of the same scene, cut into the same patches. Differences are relative to the mean radiosity
    /// of the first; z is the difference of a row in standard errors.
    Compare {
        /// A run directory, or a table (.csv or .npy).
        a: PathBuf,
        /// Another one.
        b: PathBuf,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Measure how much faster a pipeline runs on more threads and ranks.
    ///
    /// Runs it with every number of ranks and every number of threads, several times, and prints times,
    /// speed-ups S(p) = T(1)/T(p) and efficiencies E(p) = S(p)/p of the first shot, of multipath and of the
    /// whole run. Checks that all results are the same. The output directory gets scaling.csv, scaling.json,
    /// scaling.md and scaling.svg.
    Scaling(ScalingArgs),
    /// Repeat the experiment of Martínez, Forés and Martín (2009), section 5.
    ///
    /// Measures speed-up and efficiency, error, the best share of local lines, how many global lines miss the scene, how evenly
    /// their work is shared, and what the mean of independent replicas loses. The output directory gets report.md with diagrams
    /// and pictures, report.json, and all runs with their pipelines. Takes hours; a small --scale, minutes.
    Experiment(ExperimentArgs),
    /// Compute the view factors between the materials or named parts of a scene.
    ///
    /// F_ij is the share of the diffuse flux leaving group i that arrives directly at group j; what the backs of one-sided surfaces absorb
    /// is `blocked`, what leaves the scene `escaped`, and each row adds up to 1. Every factor has a standard error. The scene
    /// needs no light. docs/viewfactors.md has the columns of the files.
    #[command(name = "viewfactors")]
    ViewFactors(ViewFactorsArgs),
    /// Check the program against cases whose answers are known.
    ///
    /// View factors, the analytical cases of CIE 171:2006, and exact solutions of radiosity. Prints exact answers, ours, their standard
    /// errors and the differences, and ends with 1 if one is off by more than four standard errors. Takes minutes; --quick, half a minute.
    Validate(ValidateArgs),
}

/// How to run a pipeline.
#[derive(Debug, clap::Args)]
pub struct RunArgs {
    /// The pipeline file.
    pub pipeline: PathBuf,
    /// Where to write; default: a new directory results/NAME, where NAME is that of the pipeline.
    ///
    /// NAME is the pipeline's file name without extension, or its folder's name if the file is pipeline.ron. If
    /// there is such a directory, results/NAME-2 is made, and so on. A directory given here is refused if it
    /// holds a result, unless there is --force.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Seed of the random numbers, instead of the pipeline's.
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Replace the result in the directory given with --out.
    #[arg(long)]
    pub force: bool,
    /// How to go about it.
    #[command(flatten)]
    pub how: HowArgs,
}

/// How to go about a run. None of this changes the result.
#[derive(Debug, clap::Args)]
pub struct HowArgs {
    /// Threads of each process, 1 to 4096; default: one per processor core. The result does not depend on it.
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<NonZeroUsize>,
    /// Seconds from one checkpoint to the next, from which `sir resume` can go on.
    #[arg(long, value_name = "SECONDS", default_value = "300", value_parser = seconds)]
    pub checkpoint_every: Duration,
    /// Show no progress; warnings and errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print the content of result.json instead of a summary.
    #[arg(long)]
    pub json: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn threads_are_checked() {
        for bad in ["0", "-1", "4097", "two"] {
            assert!(Args::try_parse_from(["sir", "run", "x.ron", "--threads", bad]).is_err(), "{bad}");
        }
        let args = Args::try_parse_from(["sir", "run", "x.ron", "--threads", "8"]).unwrap();
        assert!(
            matches!(args.command, Command::Run(RunArgs { how, .. }) if how.threads == NonZeroUsize::new(8))
        );
        for bad in ["-1", "soon", "1e300"] {
            assert!(
                Args::try_parse_from(["sir", "resume", "x", "--checkpoint-every", bad]).is_err(),
                "{bad}"
            );
        }
    }
}
