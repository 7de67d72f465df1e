//! Starting this program again with other numbers of ranks and threads.

use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Output, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use crate::error::StudyError;
use crate::scaling::error::ScalingError;
use crate::scaling::workers::Workers;
use sir_pipeline::ErrorKind;
use sir_pipeline::report::Report;

/// Variables that allow Open MPI to run as root, which is usual in containers. It requires both; other MPI libraries
/// ignore them.
const ROOT: [(&str, &str); 2] = [("OMPI_ALLOW_RUN_AS_ROOT", "1"), ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")];

/// Options that turn off checkpoints. They cost time that is unrelated to the number of workers, so timed runs write
/// none.
pub(crate) const NO_CHECKPOINTS: [&str; 2] = ["--checkpoint-every", "1000000"];

/// Launcher of runs of pipelines.
pub(crate) struct Launcher {
    program: PathBuf,
    /// Command that starts several processes, with its arguments.
    mpirun: Vec<String>,
    /// True after Ctrl-C, which child processes also receive.
    stop: Arc<AtomicBool>,
}

impl Launcher {
    /// Checks that runs on up to `most_ranks` ranks can be started, so that this does not fail after hours of runs on
    /// one rank.
    pub(crate) fn new(mpirun: &str, most_ranks: usize, stop: Arc<AtomicBool>) -> Result<Self, ScalingError> {
        let mpirun: Vec<String> = mpirun.split_whitespace().map(str::to_owned).collect();
        if most_ranks > 1 {
            if !sir_parallel::HAS_MPI {
                return Err(ScalingError::NoMpi);
            }
            let command = mpirun.first().cloned().unwrap_or_default();
            // The answer does not matter, because not every launcher knows this option.
            let tried = Command::new(&command).arg("--version").stdin(Stdio::null()).output();
            tried.map_err(|source| ScalingError::Mpirun { command, source })?;
        }
        let program = std::env::current_exe().map_err(ScalingError::Program)?;
        Ok(Self { program, mpirun, stop })
    }

    /// Runs a pipeline, given by its absolute path, in a temporary directory inside `folder`, where there is space for
    /// the real results, too.
    pub(crate) fn run(&self, pipeline: &Path, workers: Workers, folder: &Path) -> Result<Report, StudyError> {
        self.check_stop()?;
        let directory = tempfile::Builder::new().prefix(".run-").tempdir_in(folder);
        let directory = directory.map_err(sir_pipeline::Error::directory(folder))?;
        let words = ["run".as_ref(), pipeline.as_os_str(), "--out".as_ref(), directory.path().as_ref()];
        self.execute(workers, &[&words, &NO_CHECKPOINTS.map(OsStr::new)[..]].concat())
    }

    /// Runs this program with the arguments `words`, of a command that prints a report, such as `sir run`.
    pub(crate) fn execute(&self, workers: Workers, words: &[&OsStr]) -> Result<Report, StudyError> {
        self.check_stop()?;
        let output = self.command(workers, words).output();
        let output = output.map_err(|source| self.not_started(workers, source))?;
        self.check_stop()?;
        Ok(read(workers, &output)?)
    }

    pub(crate) fn check_stop(&self) -> Result<(), ScalingError> {
        if self.stop.load(Relaxed) { Err(ScalingError::Interrupted) } else { Ok(()) }
    }

    fn not_started(&self, workers: Workers, source: io::Error) -> ScalingError {
        match self.mpirun.first() {
            Some(command) if workers.ranks.get() > 1 => {
                ScalingError::Mpirun { command: command.clone(), source }
            }
            _ => ScalingError::Program(source),
        }
    }

    /// Returns the command line of one run.
    fn command(&self, workers: Workers, words: &[&OsStr]) -> Command {
        let mut command = match self.mpirun.split_first() {
            Some((mpirun, options)) if workers.ranks.get() > 1 => {
                let mut command = Command::new(mpirun);
                command.args(options).args(["-n", &workers.ranks.to_string()]).arg(&self.program);
                command
            }
            _ => Command::new(&self.program),
        };
        command.args(words).args(["--threads", &workers.threads.to_string(), "--quiet", "--json"]);
        command.envs(ROOT).stdin(Stdio::null());
        command
    }
}

/// Returns the report of a run that has ended, or the reason why there is none.
fn read(workers: Workers, output: &Output) -> Result<Report, ScalingError> {
    if !output.status.success() {
        return Err(ScalingError::Run {
            workers,
            status: output.status.to_string(),
            kind: kind(output.status),
            stderr: String::from_utf8_lossy(&output.stderr).trim_end().to_owned(),
        });
    }
    serde_json::from_slice(&output.stdout)
        .map_err(|error| ScalingError::NoReport { workers, why: error.to_string() })
}

/// Returns the kind of failure for an exit code of `sir`; `sir --help` lists the codes.
fn kind(status: ExitStatus) -> ErrorKind {
    match status.code() {
        Some(2) => ErrorKind::Usage,
        Some(130) => ErrorKind::Interrupted,
        // Any other code, or killed.
        _ => ErrorKind::Failed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroUsize;

    fn launcher(program: &str) -> Launcher {
        Launcher {
            program: program.into(),
            mpirun: ["srun", "--exclusive"].map(str::to_owned).into(),
            stop: Arc::default(),
        }
    }

    fn workers(ranks: usize) -> Workers {
        Workers { ranks: NonZeroUsize::new(ranks).unwrap(), threads: NonZeroUsize::new(4).unwrap() }
    }

    #[test]
    fn several_ranks_are_started_by_another_program() {
        let line = |ranks| {
            let command = launcher("/bin/sir").command(workers(ranks), &["run", "room.ron"].map(OsStr::new));
            let words = std::iter::once(command.get_program()).chain(command.get_args());
            words.map(|word| word.to_str().unwrap().to_owned()).collect::<Vec<_>>().join(" ")
        };
        let run = "/bin/sir run room.ron --threads 4 --quiet --json";
        assert_eq!(line(1), run);
        assert_eq!(line(2), format!("srun --exclusive -n 2 {run}"));
    }

    #[test]
    fn ranks_need_mpi_and_what_starts_them() {
        let tried = Launcher::new("no-such-command --now", 2, Arc::default()).err();
        if sir_parallel::HAS_MPI {
            let named =
                matches!(&tried, Some(ScalingError::Mpirun { command, .. }) if command == "no-such-command");
            assert!(named, "{tried:?}");
        } else {
            assert!(matches!(tried, Some(ScalingError::NoMpi)), "{tried:?}");
        }
        assert!(Launcher::new("no-such-command", 1, Arc::default()).is_ok());
    }

    #[test]
    fn what_goes_wrong_in_a_run_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let error_of = |launcher: &Launcher| {
            launcher.run(Path::new("/a/room.ron"), workers(1), folder.path()).unwrap_err()
        };
        assert!(
            sir_pipeline::chain(&error_of(&launcher("/no/such/program")))
                .starts_with("cannot start this program again: ")
        );
        let stopped = launcher("true");
        stopped.stop.store(true, Relaxed);
        assert_eq!(error_of(&stopped).kind(), ErrorKind::Interrupted);
        // Every run leaves nothing behind.
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[cfg(unix)]
    #[test]
    fn a_run_that_fails_hands_on_its_kind_of_failure_and_what_it_said() {
        use std::os::unix::process::ExitStatusExt;

        let output = |status: i32, stdout: &str, stderr: &str| Output {
            status: ExitStatus::from_raw(status),
            stdout: stdout.into(),
            stderr: stderr.into(),
        };
        let error = read(workers(2), &output(2 << 8, "", "error: no lamp\n")).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Usage);
        assert_eq!(
            error.to_string(),
            "the run on 2 ranks × 4 threads failed (exit status: 2):\nerror: no lamp"
        );
        for (status, kind) in
            [(130 << 8, ErrorKind::Interrupted), (7 << 8, ErrorKind::Failed), (9, ErrorKind::Failed)]
        {
            assert_eq!(read(workers(1), &output(status, "", "")).unwrap_err().kind(), kind, "{status}");
        }
        let error = read(workers(1), &output(0, "hello", "")).unwrap_err();
        assert!(matches!(error, ScalingError::NoReport { .. }), "{error}");
    }
}
