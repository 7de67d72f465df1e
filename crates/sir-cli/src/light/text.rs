//! What `sir light` prints after the summary of the run.

use sir_pipeline::RunResult;
use sir_pipeline::draft::{Choice, Draft, PIPELINE_FILE};
use sir_pipeline::run::absolute;

use crate::output::quoted;

/// Returns the path of the pipeline, what to check in it, and how to run it.
pub(super) fn drafted(drafted: &Draft, force: bool) -> String {
    let path = drafted.directory.join(PIPELINE_FILE);
    let (directory, force) = (quoted(&drafted.directory), if force { " --force" } else { "" });
    format!(
        "{}\n{}\nrun it: sir run {} --out {directory}{force}\n",
        absolute(&path).display(),
        doubts(drafted),
        quoted(&path),
    )
}

/// Returns what to check in the pipeline, and the path of the page.
pub(super) fn finished(drafted: &Draft, result: &RunResult) -> String {
    let path = drafted.directory.join(PIPELINE_FILE);
    let page = result.report.outputs.iter().find(|output| output.kind == "report");
    let page = page.map_or(String::new(), |page| {
        format!("page: {}\n", absolute(&result.directory.join(&page.path)).display())
    });
    let other = match drafted.choices.is_empty() {
        true => "other settings",
        false => "after a change",
    };
    format!("{}\n{other}: sir run {}\n{page}", doubts(drafted), quoted(&path))
}

/// Returns the doubtful choices with their places.
pub(super) fn doubts(drafted: &Draft) -> String {
    let path = drafted.directory.join(PIPELINE_FILE);
    let doubts = drafted.choices.iter().map(|Choice { line: number, set, doubt }| {
        let set = if set.is_empty() { String::new() } else { format!("    {set}\n") };
        format!("{}:{number}: {doubt}\n{set}", path.display())
    });
    let text: String = doubts.collect();
    if text.is_empty() { text } else { format!("\ncheck what was chosen:\n{}", clean(&text)) }
}

/// Returns a text without control characters: names in files may contain some, which would change the terminal's state.
fn clean(text: &str) -> String {
    text.replace(|c: char| c.is_control() && c != '\n', "\u{fffd}")
}
