//! The command-line arguments of the program.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::LazyLock;

use clap::{Parser, Subcommand};
use clap_complete::Shell;
use sir_geom::Rgb;
use sir_parallel::HAS_MPI;
use sir_pipeline::fingerprint::PROGRAM_VERSION;

use crate::experiment::ExperimentArgs;
use crate::how::HowArgs;
use crate::info::InfoArgs;
use crate::light::LightArgs;
use crate::numbers::{factor, threads};
use crate::scaling::ScalingArgs;
use crate::validate::options::ValidateArgs;
use crate::viewfactors::options::ViewFactorsArgs;

const EXAMPLES: &str = "\
Examples:
  sir light room.glb                             light a scene; choose everything, and say what was chosen
  sir info room.gltf                             show the contents of a scene, and suggest settings
  sir check scenes/cornell-box/pipeline.ron      check a pipeline, and estimate its time and memory
  sir run scenes/cornell-box/pipeline.ron        light the scene; write files to results/cornell-box
  sir compare results/cornell-box results/cornell-box-2
  sir resume results/cornell-box                 continue a run stopped by Ctrl-C or a power cut
  mpirun -n 4 sir run room.ron                   run on several machines, if built with --features mpi
  sir run room.ron --watch                       show the light in the browser while it is computed
  sir mix results/office --set desk=0.5          dim a light group of a finished run
  sir scaling room.ron --threads 1,2,4           measure the speed-up by more threads
  sir viewfactors room.obj --by group            compute the view factors between named parts
  sir experiment --scale 0.01                    check the claims of the paper of 2009, with 1 % of the lines
  sir validate --quick                           compare results with known answers

A pipeline is a text file like this one (reference: docs/pipeline.md):
  Pipeline(
      stages: [
          Load(path: \"room.gltf\"),
          Subdivide(patches: 20_000),
          Solve(lines: 2_000_000),
          Save([Report(path: \"report.html\"), Image(path: \"view.png\"), Table(path: \"patches.csv\")]),
      ],
  )

Results go to files and standard output, progress and warnings to standard error.

Exit codes: 0 success; 1 failure; 2 invalid usage or pipeline; 130 interrupted.";

/// Lights scenes by global-line Monte Carlo radiosity.
///
/// Computes the light on every part of every surface of a scene, with all diffuse reflections between the surfaces, and
/// states the accuracy of the result.
#[derive(Debug, Parser)]
#[command(name = "sir", version = PROGRAM_VERSION, long_version = LONG_VERSION.as_str(), after_long_help = EXAMPLES, after_help = "`sir --help` shows examples and exit codes.")]
pub struct Args {
    /// Command to execute.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Light a scene file: choose a pipeline, run it, and end with a page to look at.
    ///
    /// Reads a glTF, GLB or OBJ file; chooses units, lights, patches and lines by rules (docs/guide.md); writes the pipeline
    /// that it chose as pipeline.ron beside the results, with a comment on each choice; and runs it. What is doubtful it says,
    /// with the line to change. The same file gives the same pipeline.
    Light(LightArgs),
    /// Run a pipeline: light its scene and write its output files.
    ///
    /// Prints the paths of the files, images first, and a summary of each stage. Also writes all of this to result.json
    /// in the run directory, for other programs. The same pipeline always gives the same files, except for the times in
    /// result.json.
    Run(RunArgs),
    /// Continue an interrupted run.
    ///
    /// A run writes a checkpoint every few minutes, and when Ctrl-C, SIGTERM or a closed terminal stops it. The result has the same bytes
    /// as that of an uninterrupted run, on any number of threads and ranks.
    Resume {
        /// The run directory.
        directory: PathBuf,
        /// Options of the execution.
        #[command(flatten)]
        how: HowArgs,
    },
    /// Check a pipeline without running it.
    ///
    /// Reports all problems of the file at once. If there are none, reads the scene, traces some lines, and prints
    /// counts, light sources, memory and an estimate of the time. Writes nothing.
    Check {
        /// The pipeline file.
        pipeline: PathBuf,
    },
    /// Show the contents of a scene, and suggest pipeline settings.
    ///
    /// Reads a glTF, GLB or OBJ file and prints counts, sizes, materials, light sources, how closed the scene is and
    /// which sides of its surfaces face each other; then likely mistakes and suggested pipeline settings. Writes
    /// nothing.
    Info(InfoArgs),
    /// Compare two results: relative RMS, bias and the worst rows.
    ///
    /// Both must have the same rows: the same patches, or triangles, faces, materials or groups of the same scene. Of a run
    /// with several tables, the last one of patches is used. Differences are relative to the mean radiosity of the first; z
    /// is the difference of a row in standard errors.
    Compare {
        /// A run directory, or a table (.csv or .npy).
        a: PathBuf,
        /// Another run directory or table.
        b: PathBuf,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Write the files of a run again with its light groups dimmed or colored.
    ///
    /// The pipeline must name light groups (docs/pipeline.md). Each group has kept its light, so no lines are traced for
    /// it: tables, images, sensors and all other outputs are sums over the groups, each times its factor. A new directory
    /// holds them.
    Mix(MixArgs),
    /// Measure the speed-up of a pipeline on more threads and ranks.
    ///
    /// Runs it several times with every number of ranks and every number of threads, and prints times, speed-ups S(p) =
    /// T(1)/T(p) and efficiencies E(p) = S(p)/p of the first shot, of multipath and of the whole run. Checks that all
    /// results are the same. Writes scaling.csv, scaling.json, scaling.md and scaling.svg to the output directory.
    Scaling(ScalingArgs),
    /// Repeat the experiment of Martínez, Forés and Martín (2009), section 5.
    ///
    /// Measures speed-up and efficiency, the error, the best share of local lines, the share of global lines that miss
    /// the scene, the spread of the cost of lines, and the light that the mean of independent replicas loses. Writes
    /// report.md with diagrams and images, report.json, and all runs with their pipelines to the output directory.
    /// Takes hours; with a small --scale, minutes.
    Experiment(ExperimentArgs),
    /// Compute the view factors between the materials or named parts of a scene.
    ///
    /// F_ij is the share of the diffuse flux leaving group i that arrives directly at group j. The share that the backs
    /// of one-sided surfaces absorb is `blocked`, the share that leaves the scene is `escaped`, and the sum of each row
    /// is 1. Every factor has a standard error. The scene needs no light. docs/viewfactors.md lists the columns of the
    /// files.
    #[command(name = "viewfactors")]
    ViewFactors(ViewFactorsArgs),
    /// Check the program against cases with known answers.
    ///
    /// The cases are view factors, the analytical cases of CIE 171:2006, and exact radiosity solutions. Prints exact
    /// and computed answers, standard errors and differences. Exits with code 1 if an answer is off by more than four
    /// standard errors. Takes minutes; with --quick, half a minute.
    Validate(ValidateArgs),
    /// Print the fields of pipeline files as JSON, for editors.
    ///
    /// `records` has each record, such as Load, with its fields: their values, units, defaults and meanings, as in
    /// docs/pipeline.md. `choices` has the names among which a place of the file chooses: stages, lights, outputs and others.
    Schema,
    /// Print a script that completes commands and options in a shell.
    ///
    /// For example, in bash: `source <(sir completions bash)`.
    Completions {
        /// The shell.
        shell: Shell,
    },
}

/// Version of the program and how it was built.
static LONG_VERSION: LazyLock<String> = LazyLock::new(|| {
    let kind = if cfg!(debug_assertions) { "debug" } else { "release" };
    let mpi = if HAS_MPI { "mpi" } else { "none" };
    format!(
        "{PROGRAM_VERSION}\nbuild: {kind}, {} {}\nfeatures: {mpi}",
        std::env::consts::ARCH,
        std::env::consts::OS
    )
});

/// Arguments of `sir run`.
#[derive(Debug, clap::Args)]
pub struct RunArgs {
    /// The pipeline file.
    pub pipeline: PathBuf,
    /// Output directory; default: a new directory results/NAME, where NAME is the name of the pipeline.
    ///
    /// NAME is the pipeline's file name without extension, or its folder's name if the file is pipeline.ron. If that
    /// directory exists, results/NAME-2 is created, and so on. A directory given here is refused if it holds a result,
    /// unless --force is given.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Seed of the random numbers, instead of the pipeline's.
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Replace the result in the directory given with --out.
    #[arg(long)]
    pub force: bool,
    /// Options of the execution.
    #[command(flatten)]
    pub how: HowArgs,
}

/// Arguments of `sir mix`.
#[derive(Debug, clap::Args)]
pub struct MixArgs {
    /// The run directory.
    pub directory: PathBuf,
    /// Factor of a light group: a number, or three for red, green and blue. Groups without one keep their light.
    ///
    /// For example `--set desk=0.5 --set sky=1,0.9,0.8`.
    #[arg(long, value_name = "GROUP=FACTOR", value_parser = factor)]
    pub set: Vec<(String, Rgb)>,
    /// Directory for the files; default: a new directory beside that of the run, with `-mix` after its name.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the result in the directory given with --out.
    #[arg(long)]
    pub force: bool,
    /// Threads, 1 to 4096; default: one per processor core. The result does not depend on it.
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<NonZeroUsize>,
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
