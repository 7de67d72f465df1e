//! State while a pipeline file is read: its text, its folder, and the problems so far.

use std::fmt::Display;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use crate::format::list;
use crate::run_files::RESERVED;
use crate::text::back_slashes::path_help;
use crate::text::diagnostic::{Diagnostic, Position};
use crate::text::ron_tree;
use crate::text::ron_tree::{Node, Value};
use crate::text::suggest::{did_you_mean, resembling};

/// Reader of a pipeline file. It collects problems and continues.
pub(crate) struct Reader<'a> {
    /// Text of the file.
    pub(crate) source: &'a str,
    /// Folder to which input paths are relative.
    pub(crate) folder: &'a Path,
    /// All problems so far.
    pub(crate) problems: Vec<Diagnostic>,
    /// Output paths so far, in lower case for file systems that ignore case, and the text that gives them.
    outputs: Vec<(PathBuf, &'a str)>,
}

/// Named fields of a node.
pub(crate) struct Fields<'a> {
    /// Name of the record.
    pub(crate) owner: &'static str,
    /// Text at which a missing field is reported.
    pub(crate) place: &'a str,
    /// Fields that another problem explains the lack of; `None` if it explains the lack of all.
    excused: Option<Vec<String>>,
    fields: Vec<(&'a str, Node<'a>)>,
    /// True if it has fields that the record does not know.
    has_unknown: bool,
}

impl<'a> Fields<'a> {
    /// Returns the value of a field, or `None` if it is missing or the file says `None`.
    pub(crate) fn get(&self, name: &str) -> Option<&Node<'a>> {
        let (_, node) = self.fields.iter().find(|(n, _)| *n == name)?;
        (node.value != Value::Nothing).then_some(node)
    }

    /// Returns true if another problem explains why a field is missing.
    pub(crate) fn is_excused(&self, name: &str) -> bool {
        self.excused.as_ref().is_none_or(|names| names.iter().any(|n| n == name))
    }

    /// Returns true if a problem with a field of an unknown name was reported.
    pub(crate) fn has_unknown(&self) -> bool {
        self.has_unknown
    }

    /// Returns the text of a field, or that of its record if the field is missing.
    pub(crate) fn place_of(&self, name: &str) -> &'a str {
        self.get(name).map_or(self.place, |node| node.text)
    }
}

impl<'a> Reader<'a> {
    /// Creates a reader of a text whose input paths are relative to `folder`.
    pub(crate) fn new(source: &'a str, folder: &'a Path) -> Self {
        Self { source, folder, problems: Vec::new(), outputs: Vec::new() }
    }

    /// Reports a problem with `part`, a slice of the source.
    pub(crate) fn problem(&mut self, part: &str, message: impl Display, help: impl Display) {
        let span = self.span(part);
        self.problems.push(Diagnostic { span, message: message.to_string(), help: help.to_string() });
    }

    /// Reports that the value of a field is not `what`, a description of valid values.
    pub(crate) fn wrong_value(&mut self, node: &Node<'a>, name: &str, what: &str, example: impl Display) {
        let message = format!("`{name}` must be {what}, but it is {}", node.kind());
        self.invalid_value(node, name, message, example);
    }

    /// Reports a problem with the value of a field, with an example of a valid value.
    pub(crate) fn invalid_value(
        &mut self,
        node: &Node<'a>,
        name: &str,
        message: impl Display,
        example: impl Display,
    ) {
        self.problem(node.text, message, format!("write for instance `{name}: {example}`"));
    }

    /// Returns the byte range of a slice of the source.
    pub(crate) fn span(&self, part: &str) -> Range<usize> {
        ron_tree::span(self.source, part)
    }

    /// Returns the line number of a slice of the source.
    pub(crate) fn line(&self, part: &str) -> usize {
        Position::of(self.source, self.span(part).start).line
    }

    /// Reads the named fields of `node`. Reports those that are not in `allowed`.
    pub(crate) fn fields(&mut self, node: &Node<'a>, owner: &'static str, allowed: &[&str]) -> Fields<'a> {
        let name = node.name();
        let place = if name.is_empty() { &node.text[..node.text.len().min(1)] } else { name };
        let mut fields: Vec<(&'a str, Node<'a>)> = Vec::new();
        let (mut excused, mut has_unknown) = (Some(Vec::new()), false);
        match &node.value {
            Value::Fields(given) => {
                for (key, value) in given {
                    if !allowed.contains(key) {
                        let help = match (new_form(key, owner), resembling(key, allowed)) {
                            (Some(form), _) => form,
                            (None, Some(meant)) => {
                                excused.iter_mut().for_each(|fields| fields.push((*meant).to_owned()));
                                format!("did you mean `{meant}`?")
                            }
                            (None, None) => has_fields(owner, allowed),
                        };
                        self.problem(key, format!("unknown field `{key}` in `{owner}`"), help);
                        has_unknown = true;
                    } else if let Some((first, _)) = fields.iter().find(|(k, _)| k == key) {
                        let help =
                            format!("remove one of the two; the first is in line {}", self.line(first));
                        self.problem(key, format!("the field `{key}` is given twice"), help);
                    } else {
                        fields.push((key, value.clone()));
                    }
                }
            }
            Value::Items(items) if items.is_empty() => {}
            _ => {
                let message = format!("`{owner}` takes named fields, but this is {}", node.kind());
                let help = match allowed.first() {
                    Some(first) => format!("write `{owner}({first}: …)`"),
                    None => format!("write `{owner}`"),
                };
                self.problem(node.text, message, help);
                excused = None;
            }
        }
        Fields { owner, place, excused, fields, has_unknown }
    }

    /// Returns the name of a node `Name(…)` if it is in `known`. Otherwise reports a problem; `what` is a noun for what
    /// the names stand for.
    pub(crate) fn name_of(
        &mut self,
        node: &Node<'a>,
        what: &str,
        known: &[&'static str],
    ) -> Option<&'static str> {
        let name = node.name();
        let found = known.iter().copied().find(|k| *k == name);
        if found.is_none() {
            let help =
                did_you_mean(name, known).unwrap_or_else(|| format!("{what}s are {}", list(known, "and")));
            if name.is_empty() {
                let message = format!("expected one of the {what}s, but this is {}", node.kind());
                self.problem(node.text, message, help);
            } else {
                self.problem(name, format!("unknown {what} `{name}`"), help);
            }
        }
        found
    }

    /// Reserves an output path inside the run directory for `node`. Reports a problem if the path is taken or leads
    /// outside.
    pub(crate) fn claim_output(&mut self, node: &Node<'a>, text: &str) -> Option<PathBuf> {
        let given = Path::new(text);
        let stays_inside = given.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
        if !stays_inside || text.contains('\\') {
            let message = format!("the output path \"{text}\" may lead out of the run directory");
            let help = "write a relative path without `..`; outputs are written into the run directory";
            self.problem(node.text, message, path_help(node.text, help));
            return None;
        }
        let path = inside(given);
        let key = PathBuf::from(path.to_string_lossy().to_lowercase());
        if let Some((what, help)) = unusable(&key) {
            self.problem(node.text, format!("the output path {text:?} {what}"), path_help(node.text, help));
            return None;
        }
        let clash =
            self.outputs.iter().find(|(p, _)| p.starts_with(&key) || key.starts_with(p)).map(|(_, t)| *t);
        if let Some(other) = clash {
            let message = format!("the output path \"{text}\" is used twice");
            let help = format!("choose another name; {other} is in line {}", self.line(other));
            self.problem(node.text, message, help);
            return None;
        }
        self.outputs.push((key, node.text));
        Some(path)
    }
}

/// Returns an output path without components such as `.`.
pub(crate) fn inside(path: &Path) -> PathBuf {
    path.components().filter(|c| matches!(c, Component::Normal(_))).collect()
}

/// Largest length of a file name in bytes, of most file systems.
const MAX_NAME: usize = 255;

/// Returns what makes an output path unusable, and what to do.
fn unusable(path: &Path) -> Option<(&'static str, &'static str)> {
    let names: Vec<_> = path.components().map(|c| c.as_os_str().to_string_lossy()).collect();
    if names.first().is_some_and(|name| RESERVED.contains(&name.as_ref())) {
        return Some(("is reserved for the run itself", "choose another name"));
    }
    if names.iter().any(|name| name.contains(char::is_control)) {
        return Some(("contains a control character", "use printable characters"));
    }
    // Files are written under a temporary name that is a little longer.
    if names.iter().any(|name| name.len() > MAX_NAME - 32) {
        return Some(("has too long a name", "use at most 223 bytes for the name of a file or folder"));
    }
    None
}

fn has_fields(owner: &str, allowed: &[&str]) -> String {
    match allowed {
        [] => format!("`{owner}` has no fields"),
        [one] => format!("`{owner}` has the field `{one}`"),
        _ => format!("`{owner}` has the fields {}", list(allowed, "and")),
    }
}

/// Renamed fields: record, old name, and the new syntax.
const CHANGED: [(&str, &str, &str); 3] = [
    ("Image", "calm", "the field is now called `denoise`"),
    ("Multipath", "replicas", "write `transport: Replicas(count: …, tail: …)` instead"),
    ("Multipath", "tail", "write `transport: Replicas(count: …, tail: …)` instead"),
];

/// Returns the new syntax of a renamed field, if `key` is its old name.
fn new_form(key: &str, owner: &str) -> Option<String> {
    let (.., now) = CHANGED.iter().find(|(of, old, _)| (*of, *old) == (owner, key))?;
    Some((*now).to_owned())
}
