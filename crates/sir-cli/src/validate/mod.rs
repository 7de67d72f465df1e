//! `sir validate`: cases with known answers.

pub(crate) mod error;
pub(crate) mod options;
mod watch;

use std::fs;
use std::io::Write as _;
use std::path::Path;

pub use error::ValidationError;
pub use options::ValidateArgs;
use sir_validate::{Effort, FILES, Reference, Settings, validate};

use crate::error::CliError;
use crate::interrupt;
use crate::output;
use crate::progress::Stderr;
use watch::Watch;

/// Executes the command: runs the cases, writes the report, and returns the text to print.
///
/// # Errors
///
/// If an answer is wrong or too noisy to judge, after printing the report; if a case does not exist; or if files cannot
/// be read or written.
pub fn command(args: &ValidateArgs) -> Result<String, CliError> {
    let stop = interrupt::flag();
    let reference = match &args.reference {
        None => Reference::built_in(),
        Some(folder) => read(folder)?,
    }
    .map_err(ValidationError::Cases)?;
    // Before anything that takes time, so that errors show at once.
    if let Some(folder) = &args.out {
        fs::create_dir_all(folder).map_err(sir_pipeline::Error::directory(folder))?;
    }
    let settings = Settings {
        effort: if args.quick { Effort::Quick } else { Effort::Full },
        seed: args.seed,
        threads: args.threads.unwrap_or_else(sir_parallel::cores),
        cases: args.cases.clone(),
    };
    let progress = Stderr::unless(args.quiet);
    let mut watch = Watch::new(progress, stop);
    let report = validate(&reference, &settings, &mut watch);
    drop(watch);
    let report = report.map_err(ValidationError::Cases)?;
    let written = args.out.as_deref().map_or(Ok(()), |folder| {
        write_file(&folder.join("validation.md"), &report.markdown())?;
        write_file(&folder.join("validation.json"), &report.json())
    });
    let text = if args.json { report.json() } else { report.markdown() };
    let failed = || CliError::from(ValidationError::Failed { summary: report.summary() });
    match written.and_then(|()| if report.passed() { Ok(()) } else { Err(failed()) }) {
        Ok(()) => Ok(text),
        Err(error) => {
            // The report took minutes, and says more than the error. The exit code is that of the error, even if the
            // report cannot be printed.
            let _ = output::print_text(&text);
            Err(error)
        }
    }
}

fn read(folder: &Path) -> Result<Result<Reference, sir_validate::ValidateError>, CliError> {
    let mut texts = Vec::new();
    for name in FILES {
        let path = folder.join(name);
        let text = fs::read_to_string(&path);
        texts.push(text.map_err(|source| ValidationError::ReadReference { path, source })?);
    }
    let mut texts = texts.iter().map(String::as_str);
    Ok(Reference::parse(std::array::from_fn(|_| texts.next().unwrap_or_default())))
}

fn write_file(path: &Path, text: &str) -> Result<(), CliError> {
    sir_view::write_atomically(path, |file| file.write_all(text.as_bytes()))
        .map_err(sir_pipeline::Error::from)?;
    Ok(())
}
