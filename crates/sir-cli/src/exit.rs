//! Exit codes and printed messages of failed commands, with hints that name command-line options.

use std::process::ExitCode;

use sir_pipeline::view_factors::ViewFactorsError;
use sir_pipeline::{Error, ErrorKind, chain};
use sir_study::StudyError;
use sir_study::experiment::ExperimentError;
use sir_study::scaling::ScalingError;

use crate::error::CliError;
use crate::output::quoted;

/// Exit code of an interrupted program.
pub(crate) const INTERRUPTED: u8 = 130;

/// Returns the exit code: 2 for invalid usage or an invalid pipeline, 130 after an interrupt, otherwise 1.
pub(crate) fn code(kind: ErrorKind) -> ExitCode {
    ExitCode::from(match kind {
        ErrorKind::Usage => 2,
        ErrorKind::Failed => 1,
        ErrorKind::Interrupted => INTERRUPTED,
    })
}

/// Returns the text to print for an error; it is empty if another rank prints it.
pub(crate) fn message(error: &CliError) -> String {
    match error {
        CliError::Pipeline(Error::Pipeline(problems)) => problems.to_string(),
        CliError::Pipeline(Error::Elsewhere { .. }) => String::new(),
        other => {
            let hint = hint(other).map(|hint| format!("  = help: {hint}\n"));
            format!("error: {}\n{}", chain(other), hint.unwrap_or_default())
        }
    }
}

/// Returns the options or commands that follow the advice of an error. The libraries know neither options nor commands.
fn hint(error: &CliError) -> Option<String> {
    match error {
        CliError::Pipeline(error) => pipeline_hint(error),
        CliError::Study(StudyError::Pipeline(error)) => pipeline_hint(error),
        CliError::Study(StudyError::Scaling(error)) => scaling_hint(error),
        CliError::Study(StudyError::Experiment(error)) => experiment_hint(error),
        CliError::Study(StudyError::View(_))
        | CliError::Validation(_)
        | CliError::Watch(_)
        | CliError::LightOnRanks => None,
    }
}

fn pipeline_hint(error: &Error) -> Option<String> {
    Some(match error {
        Error::NotText { .. } | Error::LongPipeline { .. } => "`sir --help` shows an example pipeline".into(),
        Error::OtherPipeline { path } => format!(
            "`sir run {}` runs it, `--out DIR` chooses another directory, `--force` replaces it",
            quoted(path)
        ),
        Error::OutputExists { .. } => {
            "`--out DIR` chooses another directory, `--force` replaces the existing files".into()
        }
        Error::IsPipeline { path } => format!("`sir run {}` runs it", quoted(path)),
        Error::Exists { .. } | Error::ViewFactors(ViewFactorsError::Exists { .. }) => {
            "`--out DIR` chooses another directory, `--force` replaces the existing result".into()
        }
        Error::ExistsInterrupted { directory } => format!(
            "`sir resume {}` continues the run, `--out DIR` chooses another directory, `--force` replaces the existing run",
            directory.display()
        ),
        Error::Directory { .. } | Error::NotWritable { .. } | Error::InUse { .. } => {
            "`--out DIR` chooses another directory".into()
        }
        Error::Interrupted { directory, .. }
        | Error::InterruptedSaving { directory }
        | Error::InterruptedMeasuring { directory }
        | Error::NotWritten { directory, .. } => {
            format!("`sir resume {}` continues the run", directory.display())
        }
        Error::NoLightGroups { .. } => "`sir run PIPELINE` runs a pipeline".into(),
        Error::MixOfItself { .. } => "`--out DIR` chooses another directory".into(),
        Error::MixOfMix { run, .. } => format!("`sir mix {run}` mixes it"),
        Error::CannotResume { .. } => "`sir run PIPELINE` starts a new run".into(),
        Error::ViewFactors(ViewFactorsError::NoGroups { .. }) => "use `--by material`".into(),
        Error::ViewFactors(ViewFactorsError::Closure(_)) => "leave out `--closure`".into(),
        _ => return None,
    })
}

fn scaling_hint(error: &ScalingError) -> Option<String> {
    Some(match error {
        ScalingError::NoMpi => "leave out `--ranks`".into(),
        ScalingError::Mpirun { .. } | ScalingError::NoReport { .. } => {
            "`--mpirun COMMAND` sets the command that starts the processes".into()
        }
        ScalingError::Exists { .. } => "`--out DIR` chooses another directory".into(),
        _ => return None,
    })
}

fn experiment_hint(error: &ExperimentError) -> Option<String> {
    Some(match error {
        ExperimentError::NoScenes { .. } => "`sir experiment room.ron` uses another pipeline".into(),
        ExperimentError::Interrupted { directory } => {
            format!("the same command with `--out {}` continues", directory.display())
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    #[test]
    fn errors_end_with_the_option_that_helps() {
        let directory = PathBuf::from("results/room");
        let shown = |error: Error| message(&error.into());
        insta::assert_snapshot!(shown(Error::Exists { directory: directory.clone() }), @r"
        error: results/room already holds a result; choose another run directory, or allow it to be replaced
          = help: `--out DIR` chooses another directory, `--force` replaces the existing result
        ");
        insta::assert_snapshot!(shown(Error::Interrupted { done: 3, total: 9, directory }), @r"
        error: interrupted after 3 of 9 lines; resume the run in results/room to continue
          = help: `sir resume results/room` continues the run
        ");
        let path = PathBuf::from("x.ron");
        insta::assert_snapshot!(shown(Error::ReadPipeline { path, source: std::io::ErrorKind::NotFound.into() }), @"error: cannot read the pipeline x.ron: entity not found");
        assert_eq!(shown(Error::Elsewhere { rank: 1, kind: ErrorKind::Failed }), "");
    }
}
