//! The text of a drafted pipeline.

use serde::Serialize;

use crate::format::{grouped, length};
use crate::info::choices::Choices;
use crate::info::{Info, Setting};
use crate::prepare::up::name;
use crate::text::formats::write_number;

/// Largest width of a comment, in characters.
const WIDTH: usize = 100;

/// When a drafted pipeline is done. Without either limit it runs once.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Goal {
    /// Relative error of a patch's irradiance.
    pub relative_error: Option<f64>,
    /// Time for the light \[s\].
    pub seconds: Option<f64>,
}

/// A choice of a drafted pipeline that is doubtful.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Choice {
    /// Line in the file, from 1.
    pub line: usize,
    /// Text in the file; empty if nothing was written for it.
    pub set: String,
    /// What is doubtful about it, and what to write instead.
    pub doubt: String,
}

/// Text of a pipeline, line by line.
#[derive(Debug, Default)]
struct Page {
    lines: Vec<String>,
    choices: Vec<Choice>,
}

impl Page {
    fn line(&mut self, text: &str) {
        self.lines.push(text.to_owned());
    }

    /// Adds a comment, in lines of limited width.
    fn comment(&mut self, indent: &str, text: &str) {
        let mut line = format!("{indent}//");
        // Names in files may contain line breaks, and end the comment.
        for word in text.split_whitespace() {
            if line.chars().count() + 1 + word.chars().count() > WIDTH && !line.ends_with("//") {
                self.lines.push(std::mem::replace(&mut line, format!("{indent}//")));
            }
            line += &format!(" {word}");
        }
        self.lines.push(line);
    }

    /// Adds a choice with its reason as a comment.
    fn choice(&mut self, indent: &str, facts: &str, choice: Setting) {
        let Setting { set, why, doubt, .. } = choice;
        let about: Vec<&str> = [facts, &why].into_iter().filter(|text| !text.is_empty()).collect();
        if !about.is_empty() {
            self.comment(indent, &sentence(&about.join("; ")));
        }
        if let Some(doubt) = &doubt {
            self.comment(indent, &format!("Check: {doubt}."));
        }
        if !set.is_empty() {
            self.line(&format!("{indent}{set},"));
        }
        if let Some(doubt) = doubt {
            self.choices.push(Choice { line: self.lines.len(), set, doubt });
        }
    }
}

/// Returns the text of the pipeline, and its doubtful choices. `command` is the command that drafts it.
pub(super) fn text(info: &Info, choices: Choices, goal: Goal, command: &str) -> (String, Vec<Choice>) {
    let mut page = Page::default();
    let Choices { units, load, light, focus, subdivide, lines } = choices;
    let version = env!("CARGO_PKG_VERSION");
    page.comment(
        "",
        &format!("Drafted by `{command}` of SIR {version}. docs/pipeline.md describes all fields."),
    );
    page.line("Pipeline(");
    page.choice("    ", "", units);
    page.line("    stages: [");
    let stage = "        ";
    page.choice(stage, &size(info, load.set.contains("scale:")), load);
    page.choice(stage, "", light);
    if let Some(focus) = focus {
        page.choice(stage, "", focus);
    }
    page.choice(stage, "", subdivide);
    let (fields, meaning) = ending(goal);
    page.comment(stage, &meaning);
    let lines = grouped(lines);
    page.line(&format!("{stage}Repeat({fields}, stages: [Solve(lines: {lines})]),"));
    page.comment(
        stage,
        &format!("A page to look at, a picture from {}, and the lit scene for viewers. `Table(path: \"patches.csv\")` would write \
         numbers, and `Lightmap(path: \"lightmap.glb\")` the scene with its light in textures.", view(info)),
    );
    page.line(&format!("{stage}Save(["));
    for output in ["Report(path: \"report.html\")", "Image(path: \"view.png\")", "Gltf(path: \"lit.glb\")"] {
        page.line(&format!("{stage}    {output},"));
    }
    page.line(&format!("{stage}]),"));
    page.line("    ],");
    page.line(")");
    (page.lines.join("\n") + "\n", page.choices)
}

/// Returns the fields of `Repeat` for a goal, and what they mean.
fn ending(goal: Goal) -> (String, String) {
    let Goal { relative_error, seconds } = goal;
    let error = relative_error.map(|error| format!("the error of a patch is {} %", length(100.0 * error)));
    let until = relative_error.map(|error| format!("until: RelativeError({})", write_number(error)));
    match (until, error, seconds) {
        (Some(until), Some(error), Some(seconds)) => (
            format!("{until}, at_most_seconds: {}", write_number(seconds)),
            format!("Repeats until {error}, for {} at most.", time(seconds)),
        ),
        (Some(until), Some(error), None) => (until, format!("Repeats until {error}.")),
        (_, _, Some(seconds)) => {
            (format!("until: Seconds({})", write_number(seconds)), format!("Repeats for {}.", time(seconds)))
        }
        _ => ("times: 16".into(), "Sixteen repeats, from which the errors follow.".into()),
    }
}

/// Returns a time in minutes, as it was given.
fn time(seconds: f64) -> String {
    format!("{} min", length(seconds / 60.0))
}

/// Returns the point of view of the picture.
fn view(info: &Info) -> String {
    match info.cameras.first() {
        Some(camera) => format!("the file's camera {camera:?}"),
        None => "where much can be seen".into(),
    }
}

/// Returns the size and the up direction of the scene.
fn size(info: &Info, is_scaled: bool) -> String {
    let size = info.extent.size().to_array().map(length).join(" × ");
    let unit = if is_scaled { "units" } else { "m" };
    format!("{size} {unit}; up is {} ({})", name(info.up.into()), info.up_from)
}

/// Returns a text with a capital letter and a full stop.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default();
    let end = if text.ends_with(['.', '?', '!']) { "" } else { "." };
    format!("{first}{}{end}", letters.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_wrapped_and_cannot_be_left() {
        let mut page = Page::default();
        page.comment("    ", &format!("a\nb {} c", "x".repeat(WIDTH)));
        assert_eq!(
            page.lines,
            ["    // a b".to_owned(), format!("    // {}", "x".repeat(WIDTH)), "    // c".into()]
        );
    }

    #[test]
    fn a_goal_is_written_as_the_end_of_a_repeat() {
        let of = |relative_error, seconds| ending(Goal { relative_error, seconds });
        assert_eq!(of(Some(0.02), Some(120.0)).0, "until: RelativeError(0.02), at_most_seconds: 120");
        assert_eq!(of(Some(0.02), None).0, "until: RelativeError(0.02)");
        assert_eq!(of(None, Some(90.0)).0, "until: Seconds(90)");
        assert_eq!(
            of(Some(0.02), Some(120.0)).1,
            "Repeats until the error of a patch is 2 %, for 2 min at most."
        );
    }
}
