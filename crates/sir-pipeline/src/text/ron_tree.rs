//! RON text as a tree whose nodes know their positions.
//!
//! serde stops at the first error and does not keep positions, so a file decoded by it shows one problem at a time.
//! Here the `ron` crate still does all the parsing: a node is read as [`RawValue`], which is a slice of the source and
//! therefore has a position. Its children are read from that slice in the same way. The text of a node is thus parsed
//! once per level of nesting, which does not matter for files of this size (and `ron` limits the nesting).

use std::fmt;
use std::ops::Range;

use ron::value::RawValue;
use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};

use crate::text::back_slashes::SLASHES;
use crate::text::diagnostic::{Diagnostic, Position};
use crate::text::literal::float;

/// A node of the tree.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node<'a> {
    /// Text of the node, a slice of the source.
    pub(crate) text: &'a str,
    /// Value of the node.
    pub(crate) value: Value<'a>,
}

/// Value of a node.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value<'a> {
    /// A number. `text` has its digits.
    Number,
    /// `true` or `false`.
    Bool(bool),
    /// A string, with its escapes resolved.
    Text(String),
    /// `Name(field: value, …)` or `(field: value, …)`.
    Fields(Vec<(&'a str, Node<'a>)>),
    /// `Name(value, …)` or `(value, …)`, or only `Name`.
    Items(Vec<Node<'a>>),
    /// `[value, …]`.
    List(Vec<Node<'a>>),
    /// `None`.
    Nothing,
    /// Any value that pipelines do not have: maps, characters, bytes, ranges.
    Other,
}

/// Parses RON.
///
/// # Errors
///
/// Returns the first syntax error.
pub(crate) fn parse(source: &str) -> Result<Node<'_>, Diagnostic> {
    let check = || -> Result<(), ron::error::SpannedError> {
        let mut deserializer = ron::Deserializer::from_str(source)?;
        IgnoredAny::deserialize(&mut deserializer).map_err(|e| deserializer.span_error(e))?;
        deserializer.end().map_err(|e| deserializer.span_error(e))
    };
    check().map_err(|e| syntax_error(source, &e))?;
    ron::from_str(source).map_err(|_| Diagnostic {
        span: 0..1,
        message: "the file is not plain RON".into(),
        help: "see docs/pipeline.md for the syntax of a pipeline".into(),
    })
}

fn syntax_error(source: &str, error: &ron::error::SpannedError) -> Diagnostic {
    use ron::Error as E;
    let place =
        |p: ron::error::Position| Position { line: p.line.max(1), column: p.col.max(1) }.byte_in(source);
    let (start, end) = (place(error.span.start), place(error.span.end));
    let help = match error.code {
        E::Eof => "the file ends within a value; close every `(`, `[` and `\"`",
        E::ExpectedComma | E::ExpectedStructLikeEnd | E::ExpectedArrayEnd => {
            "put a comma between two values, and close every `(` with `)` and every `[` with `]`"
        }
        E::ExpectedStringEnd => "end the string with `\"`",
        E::InvalidEscape(_) => SLASHES,
        E::ExpectedMapColon => "a field is written `name: value`",
        E::TrailingCharacters => "a pipeline is one value, `Pipeline(…)`; only comments may follow it",
        E::ExceededRecursionLimit => "a pipeline needs about ten levels of brackets; remove some",
        _ => "see docs/pipeline.md for the syntax of a pipeline",
    };
    // Messages of `ron` start with a capital letter.
    let message = match error.code {
        E::ExceededRecursionLimit => "brackets are nested too deeply".into(),
        _ => error.code.to_string(),
    };
    let mut letters = message.chars();
    let message = letters.next().map_or(String::new(), |c| c.to_lowercase().chain(letters).collect());
    let start = start.min(end);
    let blank = source[start..].len() - source[start..].trim_start().len();
    Diagnostic {
        span: start + blank..end.max(start + blank),
        message: format!("not valid RON: {message}"),
        help: help.into(),
    }
}

impl<'a> Node<'a> {
    /// Returns the name, with or without parentheses after it; empty if there is none.
    pub(crate) fn name(&self) -> &'a str {
        match self.value {
            Value::Fields(_) | Value::Items(_) => {
                let end =
                    self.text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(self.text.len());
                &self.text[..end]
            }
            _ => "",
        }
    }

    /// Returns the elements of `(…)` or `[…]`, or `None` for all else.
    pub(crate) fn elements(&self) -> Option<&[Self]> {
        match &self.value {
            Value::Items(items) | Value::List(items) if self.name().is_empty() => Some(items),
            _ => None,
        }
    }

    /// Describes the node in words.
    pub(crate) fn kind(&self) -> String {
        match &self.value {
            Value::Number => format!("the number {}", self.text),
            Value::Bool(_) => format!("`{}`", self.text),
            Value::Text(_) => "a string".into(),
            Value::List(_) => "a list".into(),
            Value::Nothing => "`None`".into(),
            Value::Items(items) if items.is_empty() && !self.name().is_empty() => {
                format!("`{}`", self.name())
            }
            Value::Fields(_) | Value::Items(_) => {
                if self.name().is_empty() {
                    "`(…)`".into()
                } else {
                    format!("`{}(…)`", self.name())
                }
            }
            Value::Other => "something else".into(),
        }
    }
}

/// Returns the byte range of `part`, a slice of `source`.
pub(crate) fn span(source: &str, part: &str) -> Range<usize> {
    let start = (part.as_ptr() as usize).saturating_sub(source.as_ptr() as usize).min(source.len());
    start..(start + part.len()).min(source.len())
}

impl<'de: 'a, 'a> Deserialize<'de> for Node<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = <&RawValue>::deserialize(deserializer)?.trim().get_ron();
        let other = Node { text, value: Value::Other };
        if text.starts_with('.') && float(text).is_some() {
            return Ok(Node { text, value: Value::Number });
        }
        if text.starts_with(['{', '\'', '.']) {
            return Ok(other);
        }
        let mut inner = ron::Deserializer::from_str(text).map_err(D::Error::custom)?;
        Ok(inner.deserialize_any(NodeVisitor { text }).unwrap_or(other))
    }
}

struct NodeVisitor<'a> {
    text: &'a str,
}

impl<'a> NodeVisitor<'a> {
    fn node(&self, value: Value<'a>) -> Node<'a> {
        Node { text: self.text, value }
    }
}

impl<'de: 'a, 'a> Visitor<'de> for NodeVisitor<'a> {
    type Value = Node<'a>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Node<'a>, E> {
        Ok(self.node(Value::Bool(value)))
    }

    fn visit_i64<E>(self, _: i64) -> Result<Node<'a>, E> {
        Ok(self.node(Value::Number))
    }

    fn visit_u64<E>(self, _: u64) -> Result<Node<'a>, E> {
        Ok(self.node(Value::Number))
    }

    fn visit_f64<E>(self, _: f64) -> Result<Node<'a>, E> {
        Ok(self.node(Value::Number))
    }

    fn visit_str<E>(self, value: &str) -> Result<Node<'a>, E> {
        Ok(self.node(Value::Text(value.to_owned())))
    }

    fn visit_none<E>(self) -> Result<Node<'a>, E> {
        Ok(self.node(Value::Nothing))
    }

    /// Reads `Some(x)` as `x`.
    fn visit_some<D: Deserializer<'de>>(self, inner: D) -> Result<Node<'a>, D::Error> {
        Node::deserialize(inner)
    }

    fn visit_unit<E>(self) -> Result<Node<'a>, E> {
        Ok(self.node(Value::Items(Vec::new())))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Node<'a>, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = access.next_element()? {
            items.push(item);
        }
        Ok(self.node(if self.text.starts_with('[') { Value::List(items) } else { Value::Items(items) }))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Node<'a>, A::Error> {
        let mut fields = Vec::new();
        while let Some(field) = access.next_entry()? {
            fields.push(field);
        }
        Ok(self.node(Value::Fields(fields)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the tree as an S-expression, with the position of every node.
    fn show(source: &str, node: &Node<'_>) -> String {
        let Range { start, end } = span(source, node.text);
        assert_eq!(&source[start..end], node.text);
        let all =
            |nodes: &[Node<'_>]| nodes.iter().map(|n| format!(" {}", show(source, n))).collect::<String>();
        match &node.value {
            Value::Fields(fields) => {
                let fields: String =
                    fields.iter().map(|(k, n)| format!(" {k}={}", show(source, n))).collect();
                format!("({}{{{fields} }}@{start})", node.name())
            }
            Value::Items(items) => format!("({}<{} >@{start})", node.name(), all(items)),
            Value::List(items) => format!("([{} ]@{start})", all(items)),
            Value::Text(text) => format!("{text:?}@{start}"),
            other => format!("{other:?}:{}@{start}", node.text),
        }
    }

    fn tree(source: &str) -> String {
        show(source, &parse(source).unwrap())
    }

    #[test]
    fn every_form_of_value_has_its_place() {
        for (source, expected) in [
            ("Pipeline(seed: 1, stages: [])", "(Pipeline{ seed=Number:1@15 stages=([ ]@26) }@0)"),
            ("( a : 1_000 , b : -2.5e3 , )", "({ a=Number:1_000@6 b=Number:-2.5e3@18 }@0)"),
            (
                "[Load(path: \"a\"), Sphere, Save([X(),]),]",
                "([ (Load{ path=\"a\"@12 }@1) (Sphere< >@18) (Save< ([ (X< >@32) ]@31) >@26) ]@0)",
            ),
            ("(1, 0x1F, true)", "(< Number:1@1 Number:0x1F@4 Bool(true):true@10 >@0)"),
            ("(a: r#\"q\"\\)\"#, b: \"x\\n) ]\")", "({ a=\"q\\\"\\\\)\"@4 b=\"x\\n) ]\"@18 }@0)"),
            (
                "/* ( */ (a: /* [ */ 1 /* ] */, // )\n b: 2 // end\n)\n// end\n",
                "({ a=Number:1@20 b=Number:2@40 }@8)",
            ),
            (
                "(a: Some(1), b: None, c: Some([2]))",
                "({ a=Number:1@9 b=Nothing:None@16 c=([ Number:2@31 ]@30) }@0)",
            ),
            (
                "(a: {1: 2}, b: 'c', c: 1..2, d: ())",
                "({ a=Other:{1: 2}@4 b=Other:'c'@15 c=Other:1..2@23 d=(< >@32) }@0)",
            ),
            (
                "(a: inf, b: NaN, c: +1, d: 1e6)",
                "({ a=Number:inf@4 b=Number:NaN@12 c=Number:+1@20 d=Number:1e6@27 }@0)",
            ),
            ("(a: 1, a: 2)", "({ a=Number:1@4 a=Number:2@10 }@0)"),
            ("#![enable(implicit_some)]\n(a: 1)", "({ a=Number:1@30 }@26)"),
            ("Load /* c */ (path: 1)", "(Load{ path=Number:1@20 }@0)"),
        ] {
            assert_eq!(tree(source), expected, "{source}");
        }
    }

    #[test]
    fn errors_of_syntax_have_their_place() {
        let errors: Vec<String> = [
            "(a: 1",
            "(a: 1 b: 2)",
            "(a: 1) x",
            "(a: \"x)",
            "(a 1)",
            "(a: [1)",
            "",
            "(a: 1, #)",
            "(\n  a: \"\\q\",\n)",
        ]
        .map(|source| {
            let error = parse(source).unwrap_err();
            format!("{source:?} {:?} {}", error.span, error.message)
        })
        .to_vec();
        insta::assert_snapshot!(errors.join("\n"), @r#"
            "(a: 1" 4..5 not valid RON: expected comma
            "(a: 1 b: 2)" 6..6 not valid RON: expected comma
            "(a: 1) x" 7..7 not valid RON: non-whitespace trailing characters
            "(a: \"x)" 4..5 not valid RON: expected end of string
            "(a 1)" 3..3 not valid RON: expected comma
            "(a: [1)" 6..6 not valid RON: expected comma
            "" 0..0 not valid RON: unexpected end of RON
            "(a: 1, #)" 7..7 not valid RON: expected identifier
            "(\n  a: \"\\q\",\n)" 8..10 not valid RON: unknown escape character
            "#);
        let deep = format!("{}{}", "[".repeat(5000), "]".repeat(5000));
        assert_eq!(parse(&deep).unwrap_err().message, "not valid RON: brackets are nested too deeply");
    }
}
