//! Typed access to the nodes of a pipeline file; whatever is wrong is noted and reading goes on.

use std::fmt::Display;
use std::ops::Range;

use crate::format::{grouped, list};
use crate::text::diagnostic::{Diagnostic, Position};
use crate::text::literal::{float, whole_number};
use crate::text::ron_tree;
use crate::text::ron_tree::{Node, Value};
use crate::text::suggest::did_you_mean;

/// A largest number of lines or patches that is surely a slip of the pen.
pub(crate) const ABSURD: u64 = 1_000_000_000_000_000;

/// Collects the problems of a file while it is read.
pub(crate) struct Reader<'a> {
    pub(crate) source: &'a str,
    pub(crate) problems: Vec<Diagnostic>,
}

/// The named fields of a node, which are taken out one by one.
pub(crate) struct Fields<'a> {
    owner: &'static str,
    /// What a missing field is reported at.
    place: &'a str,
    fields: Vec<(&'a str, Node<'a>)>,
    /// Whether a problem has been noted that explains why fields are missing.
    excused: bool,
}

impl<'a> Fields<'a> {
    /// Whether a problem has been noted that explains why fields are missing.
    pub(crate) fn is_excused(&self) -> bool {
        self.excused
    }

    /// Takes out the value of an optional field.
    pub(crate) fn take(&mut self, name: &str) -> Option<Node<'a>> {
        let i = self.fields.iter().position(|(n, _)| *n == name)?;
        let node = self.fields.remove(i).1;
        (node.value != Value::Nothing).then_some(node)
    }
}

impl<'a> Reader<'a> {
    /// Notes a problem with `part`, a slice of the source.
    pub(crate) fn problem(&mut self, part: &str, message: impl Display, help: impl Display) {
        let span = self.span(part);
        self.problems.push(Diagnostic { span, message: message.to_string(), help: help.to_string() });
    }

    /// The bytes of a slice of the source.
    pub(crate) fn span(&self, part: &str) -> Range<usize> {
        ron_tree::span(self.source, part)
    }

    /// The line of a slice of the source.
    pub(crate) fn line(&self, part: &str) -> usize {
        Position::of(self.source, self.span(part).start).line
    }

    /// The named fields of `node`, of which there may be those in `allowed`.
    pub(crate) fn fields(&mut self, node: Node<'a>, owner: &'static str, allowed: &[&str]) -> Fields<'a> {
        let name = node.name();
        let place = if name.is_empty() { &node.text[..node.text.len().min(1)] } else { name };
        let mut fields: Vec<(&'a str, Node<'a>)> = Vec::new();
        let mut excused = false;
        match node.value {
            Value::Fields(given) => {
                for (key, value) in given {
                    if !allowed.contains(&key) {
                        let meant = new_name(key, allowed).or_else(|| did_you_mean(key, allowed));
                        excused |= meant.is_some();
                        let help = meant
                            .unwrap_or_else(|| format!("`{owner}` has the fields {}", list(allowed, "and")));
                        self.problem(key, format!("unknown field `{key}` in `{owner}`"), help);
                    } else if let Some((first, _)) = fields.iter().find(|(k, _)| *k == key) {
                        let help =
                            format!("remove one of the two; the first is in line {}", self.line(first));
                        self.problem(key, format!("the field `{key}` is given twice"), help);
                    } else {
                        fields.push((key, value));
                    }
                }
            }
            Value::Items(items) if items.is_empty() => {}
            _ => {
                let message = format!("`{owner}` takes named fields, but this is {}", node.kind());
                let help = format!("write `{owner}({}: …)`", allowed.first().unwrap_or(&""));
                self.problem(node.text, message, help);
                excused = true;
            }
        }
        Fields { owner, place, fields, excused }
    }

    /// Takes out the value of a field that must be there.
    pub(crate) fn required(
        &mut self,
        fields: &mut Fields<'a>,
        name: &str,
        example: &str,
    ) -> Option<Node<'a>> {
        let node = fields.take(name);
        if node.is_none() && !fields.excused {
            let owner = fields.owner;
            self.problem(
                fields.place,
                format!("`{owner}` lacks the field `{name}`"),
                format!("write `{owner}({name}: {example}, …)`"),
            );
        }
        node
    }

    /// A whole number from `range`.
    pub(crate) fn count(
        &mut self,
        node: &Node<'a>,
        name: &str,
        range: (u64, u64),
        example: &str,
    ) -> Option<u64> {
        let (least, most) = range;
        let parsed = (node.value == Value::Number).then(|| whole_number(node.text)).flatten();
        if let Some(n) = parsed.filter(|n| (least..=most).contains(n)) {
            return Some(n);
        }
        self.problem(
            node.text,
            format!(
                "`{name}` must be a whole number from {least} to {}, but it is {}",
                grouped(most),
                node.kind()
            ),
            format!("write for instance `{name}: {example}`"),
        );
        None
    }

    /// A finite number.
    pub(crate) fn number(&mut self, node: &Node<'a>, name: &str, example: &str) -> Option<f64> {
        let parsed = (node.value == Value::Number).then(|| float(node.text)).flatten();
        if parsed.is_none() {
            let message = format!("`{name}` must be a finite number, but it is {}", node.kind());
            self.problem(node.text, message, format!("write for instance `{name}: {example}`"));
        }
        parsed
    }

    /// A finite number above zero.
    pub(crate) fn positive(&mut self, node: &Node<'a>, name: &str, example: &str) -> Option<f64> {
        let number = self.number(node, name, example)?;
        if number > 0.0 {
            return Some(number);
        }
        let message = format!("`{name}` must be above zero, but it is {}", node.text);
        self.problem(node.text, message, format!("write for instance `{name}: {example}`"));
        None
    }

    /// A text that is not empty.
    pub(crate) fn text(&mut self, node: &Node<'a>, name: &str, example: &str) -> Option<String> {
        let what = match &node.value {
            Value::Text(text) if !text.is_empty() => return Some(text.clone()),
            Value::Text(_) => "empty".to_owned(),
            _ => node.kind(),
        };
        self.problem(
            node.text,
            format!("`{name}` must be a text in quotes, but it is {what}"),
            format!("write for instance `{name}: {example}`"),
        );
        None
    }

    /// Three finite numbers, `(x, y, z)`.
    pub(crate) fn vector(&mut self, node: &Node<'a>, name: &str, example: &str) -> Option<[f64; 3]> {
        if let Value::Items(items) | Value::List(items) = &node.value
            && let [x, y, z] = items.as_slice()
        {
            let [x, y, z] = [x, y, z].map(|n| self.number(n, name, example));
            return Some([x?, y?, z?]);
        }
        let message = format!("`{name}` must be three numbers, but it is {}", node.kind());
        self.problem(node.text, message, format!("write for instance `{name}: {example}`"));
        None
    }

    /// One of a few names.
    pub(crate) fn choice(
        &mut self,
        node: &Node<'a>,
        name: &str,
        choices: &[&'static str],
    ) -> Option<&'static str> {
        let given = match &node.value {
            Value::Items(items) if items.is_empty() => node.name(),
            _ => "",
        };
        let chosen = choices.iter().copied().find(|c| *c == given);
        if chosen.is_none() {
            let help =
                did_you_mean(given, choices).unwrap_or_else(|| format!("write {}", list(choices, "or")));
            self.problem(
                node.text,
                format!("`{name}` must be {}, but it is {}", list(choices, "or"), node.kind()),
                help,
            );
        }
        chosen
    }
}

/// Fields that had another name: the old one, and the new one.
const RENAMED: [(&str, &str); 1] = [("calm", "denoise")];

/// Says what a field is called today, if it once had the name `key`.
fn new_name(key: &str, allowed: &[&str]) -> Option<String> {
    let (_, new) = RENAMED.iter().find(|(old, new)| *old == key && allowed.contains(new))?;
    Some(format!("the field is called `{new}` now"))
}
