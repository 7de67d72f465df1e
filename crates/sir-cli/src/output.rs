//! Standard output and standard error. A reader that goes away, or a disk that is full, never ends a command early.

use std::fmt::Display;
use std::io;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

/// Prints a line to standard error: progress, a warning or an error. Nobody may be reading, for example after
/// `sir run room.ron 2>&1 | head`; a result that takes hours must not depend on that, so failures are ignored.
pub(crate) fn print_note(line: impl Display) {
    // One write, so that lines of several ranks do not mix.
    let _ = io::stderr().write_all(format!("{line}\n").as_bytes());
}

/// Returns a path as a shell reads it.
pub(crate) fn quoted(path: &Path) -> String {
    let text = path.to_string_lossy();
    shlex::try_quote(&text).map_or_else(|_| text.to_string(), |quoted| quoted.into_owned())
}

/// Prints the text of a command to standard output, and returns the exit code of a command that succeeded. If the text
/// cannot be printed, prints the reason to standard error.
pub(crate) fn print_text(text: &str) -> ExitCode {
    let mut out = io::stdout();
    exit_code(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}

/// Returns the exit code of a command that succeeded and has printed its text. If printing failed, prints the reason to
/// standard error. A closed pipe is no failure: its reader, such as `head`, has read enough.
pub(crate) fn exit_code(printed: io::Result<()>) -> ExitCode {
    match printed {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            print_note(format!(
                "error: cannot write to standard output: {error}\n  = help: free disk space, or send the output elsewhere; \
                 files that the command wrote are complete"
            ));
            ExitCode::FAILURE
        }
        _ => ExitCode::SUCCESS,
    }
}
