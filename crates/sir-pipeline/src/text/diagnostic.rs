//! Problems of a pipeline file, each with its place and what to write instead.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The most characters of a line that are shown.
const WIDTH: usize = 160;

/// The most characters of a message, which may quote the file.
const MESSAGE: usize = 400;

/// The most problems that are shown.
const SHOWN: usize = 30;

/// A place in a text: line and column, both from 1, columns counted in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
}

impl Position {
    /// The place of a byte of `text`; bytes past its end are at its end.
    #[must_use]
    pub fn of(text: &str, byte: usize) -> Self {
        let before = &text.as_bytes()[..byte.min(text.len())];
        let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        Self {
            line: 1 + before.iter().filter(|&&b| b == b'\n').count(),
            column: 1 + String::from_utf8_lossy(&before[line_start..]).chars().count(),
        }
    }

    /// The byte of `text` at this place, or the end of `text` if it has no such place.
    #[must_use]
    pub fn byte_in(self, text: &str) -> usize {
        let line_start: usize = text.split_inclusive('\n').take(self.line - 1).map(str::len).sum();
        let line = text[line_start..].split('\n').next().unwrap_or_default();
        line_start + line.char_indices().nth(self.column - 1).map_or(line.len(), |(i, _)| i)
    }
}

/// One problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The bytes of the file that it is about.
    pub span: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: String,
}

/// All problems of one pipeline file, in the order of their places. Displayed as compilers do: file, line and
/// column, the line itself with the culprit underlined, and what to write instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    path: PathBuf,
    text: String,
    list: Vec<Diagnostic>,
}

impl std::error::Error for Diagnostics {}

impl Diagnostics {
    /// Problems of the file `path`, which says `text`.
    #[must_use]
    pub fn new(path: &Path, text: &str, mut list: Vec<Diagnostic>) -> Self {
        for Diagnostic { span, message, help } in &mut list {
            shorten(message);
            shorten(help);
            span.start = span.start.min(text.len());
            span.end = span.end.clamp(span.start, text.len());
        }
        list.sort_by_key(|d| (d.span.start, d.span.end));
        Self { path: path.to_owned(), text: text.to_owned(), list }
    }

    /// The problems, in the order of their places.
    #[must_use]
    pub fn list(&self) -> &[Diagnostic] {
        &self.list
    }

    /// Where a problem begins.
    #[must_use]
    pub fn position(&self, problem: &Diagnostic) -> Position {
        Position::of(&self.text, problem.span.start)
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.list.iter().enumerate().take(SHOWN) {
            if i > 0 {
                writeln!(f)?;
            }
            let at = self.position(problem);
            writeln!(f, "{}:{}:{}: error: {}", self.path.display(), at.line, at.column, problem.message)?;
            let line = self.text.lines().nth(at.line - 1).unwrap_or_default();
            let (line, indent) = excerpt(line, at.column - 1);
            let rest = line.chars().count().saturating_sub(indent);
            let marked = String::from_utf8_lossy(&self.text.as_bytes()[problem.span.clone()]);
            let marks = marked.lines().next().unwrap_or_default().chars().count().min(rest).max(1);
            let number = at.line.to_string();
            writeln!(f, "{number} | {line}")?;
            writeln!(f, "{:width$} | {:indent$}{}", "", "", "^".repeat(marks), width = number.len())?;
            writeln!(f, "{:width$} = help: {}", "", problem.help, width = number.len())?;
        }
        if self.list.len() > SHOWN {
            writeln!(f, "\n{} more problems are not shown", self.list.len() - SHOWN)?;
        }
        Ok(())
    }
}

/// Cuts off what is too long, and takes out what would play tricks on a terminal.
fn shorten(text: &mut String) {
    if text.chars().nth(MESSAGE).is_some() || text.contains(char::is_control) {
        let dots = if text.chars().nth(MESSAGE).is_some() { "…" } else { "" };
        let plain = text.chars().take(MESSAGE).map(|c| if c.is_control() { '\u{fffd}' } else { c });
        *text = plain.chain(dots.chars()).collect();
    }
}

/// The part of a line that is shown, around the character at `column`, and the place of that character in it.
fn excerpt(line: &str, column: usize) -> (String, usize) {
    // A tab is as wide as a terminal likes; a space keeps the marks in their place.
    let printable = |c: char| if c.is_control() { ' ' } else { c };
    let start = if line.chars().count() > WIDTH { column.saturating_sub(WIDTH / 2) } else { 0 };
    let shown: String = line.chars().skip(start).take(WIDTH).map(printable).collect();
    (shown, column - start)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_bytes_correspond() {
        let text = "aß\n\n  Łx";
        for (byte, line, column) in
            [(0, 1, 1), (1, 1, 2), (3, 1, 3), (4, 2, 1), (7, 3, 3), (9, 3, 4), (10, 3, 5)]
        {
            let position = Position { line, column };
            assert_eq!(Position::of(text, byte), position);
            assert_eq!(position.byte_in(text), byte);
        }
        assert_eq!(Position { line: 9, column: 9 }.byte_in(text), text.len());
        assert_eq!(Position::of(text, 99), Position { line: 3, column: 5 });
    }

    #[test]
    fn of_a_long_line_a_part_is_shown() {
        let line = "x".repeat(5000);
        for column in [0, 79, 80, 2500, 4999, 5000] {
            let (shown, place) = excerpt(&line, column);
            assert!(shown.chars().count() <= WIDTH && place <= shown.chars().count(), "{column}");
        }
        assert_eq!(excerpt("\tab", 2), (" ab".to_owned(), 2));
    }

    #[test]
    fn a_problem_is_shown_in_its_line() {
        let problem =
            |span, message: &str, help: &str| Diagnostic { span, message: message.into(), help: help.into() };
        let all = Diagnostics::new(
            Path::new("dir/x.ron"),
            "(\n\tlines: 0,\n)",
            vec![problem(13..14, "second", "none"), problem(3..8, "first", "do this")],
        );
        insta::assert_snapshot!(all, @r"
        dir/x.ron:2:2: error: first
        2 |  lines: 0,
          |  ^^^^^
          = help: do this

        dir/x.ron:3:1: error: second
        3 | )
          | ^
          = help: none
        ");
    }
}
