//! Diagnostics of a pipeline file: each problem with its position and a suggested fix.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

/// Maximum number of underlined characters.
const MAX_UNDERLINED: usize = 60;

/// Maximum number of characters of a message, which may quote the file.
const MAX_MESSAGE: usize = 400;

/// Maximum number of problems that are shown.
const MAX_SHOWN: usize = 30;

/// Position in a text: line and column, both from 1. Columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
}

impl Position {
    /// Returns the position of a byte of `text`. Bytes past the end have the position of the end.
    #[must_use]
    pub fn of(text: &str, byte: usize) -> Self {
        let before = &text.as_bytes()[..byte.min(text.len())];
        let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        Self {
            line: 1 + before.iter().filter(|&&b| b == b'\n').count(),
            column: 1 + String::from_utf8_lossy(&before[line_start..]).chars().count(),
        }
    }

    /// Returns the byte of `text` at this position, or the end of `text` if the position does not exist.
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
    /// Affected bytes of the file.
    pub span: Range<usize>,
    /// Description of the problem.
    pub message: String,
    /// Suggested fix.
    pub help: String,
}

/// All problems of one pipeline file, sorted by position. Displayed as by compilers: file, line and column, the line
/// itself with the affected part underlined, and the suggested fix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    path: PathBuf,
    text: String,
    list: Vec<Diagnostic>,
}

impl std::error::Error for Diagnostics {}

impl Diagnostics {
    /// Sorts and shortens the problems of the file `path`, whose content is `text`.
    #[must_use]
    pub fn new(path: &Path, text: &str, mut list: Vec<Diagnostic>) -> Self {
        let end = text.trim_end().len();
        for Diagnostic { span, message, help } in &mut list {
            shorten(message);
            shorten(help);
            *span = span.start.min(end)..span.end.min(end);
            // The renderer does not accept a span that splits a character.
            if text.get(span.clone()).is_none() {
                *span = end..end;
            }
        }
        list.sort_by_key(|d| (d.span.start, d.span.end));
        Self { path: path.to_owned(), text: text.to_owned(), list }
    }

    /// Returns the problems, sorted by position.
    #[must_use]
    pub fn list(&self) -> &[Diagnostic] {
        &self.list
    }

    /// Returns the start of a problem.
    #[must_use]
    pub fn position(&self, problem: &Diagnostic) -> Position {
        Position::of(&self.text, problem.span.start)
    }

    /// Returns the part of a span that is underlined: the beginning of its first line.
    fn mark(&self, span: &Range<usize>) -> Range<usize> {
        let line = self.text[span.clone()].lines().next().unwrap_or_default();
        span.start..span.start + line.chars().take(MAX_UNDERLINED).map(char::len_utf8).sum::<usize>()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut path = self.path.display().to_string();
        shorten(&mut path);
        // The renderer replaces all other control characters. The substitute has the same number of bytes.
        let text = self.text.replace(|c| ('\u{80}'..='\u{9f}').contains(&c), "·");
        for (i, problem) in self.list.iter().enumerate().take(MAX_SHOWN) {
            if i > 0 {
                writeln!(f)?;
            }
            let mark = AnnotationKind::Primary.span(self.mark(&problem.span));
            let error = Level::ERROR
                .primary_title(&problem.message)
                .element(Snippet::source(&text).path(&path).annotation(mark))
                .element(Level::HELP.message(&problem.help));
            writeln!(f, "{}", Renderer::plain().render(&[error]))?;
        }
        if self.list.len() > MAX_SHOWN {
            writeln!(f, "\n{} more problems are not shown", self.list.len() - MAX_SHOWN)?;
        }
        Ok(())
    }
}

/// Truncates a text that is too long, and replaces control characters, which could be terminal escape sequences.
fn shorten(text: &mut String) {
    if text.chars().nth(MAX_MESSAGE).is_some() || text.contains(char::is_control) {
        let dots = if text.chars().nth(MAX_MESSAGE).is_some() { "…" } else { "" };
        let plain = text.chars().take(MAX_MESSAGE).map(|c| if c.is_control() { '\u{fffd}' } else { c });
        *text = plain.chain(dots.chars()).collect();
    }
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

    /// Returns the display of a problem of a file.
    fn shown(text: &str, span: Range<usize>) -> String {
        let problem = Diagnostic { span, message: "wrong\u{1b}[31m".into(), help: "write\n1".into() };
        Diagnostics::new(Path::new("x\u{1b}[31m.ron"), text, vec![problem]).to_string()
    }

    #[test]
    fn of_a_long_line_a_part_is_shown() {
        for c in ["x", "ß", "漢"] {
            let line = format!("{}\n", c.repeat(5000));
            for at in [0, 79, 80, 2500, 4999, 5000] {
                for marked in [0, 1, 59, 61, 5000] {
                    let shown = shown(&line, at * c.len()..(at + marked) * c.len());
                    let widest = shown.lines().map(|line| line.chars().count()).max().unwrap();
                    assert!(widest <= 160 && shown.contains('^'), "{widest}: {shown}");
                }
            }
        }
    }

    #[test]
    fn nothing_plays_tricks_on_a_terminal() {
        insta::assert_snapshot!(shown("(\u{0}\t\u{1b}[31m\u{85}\u{9b}\u{202e}漢 x\r\n)", 19..20), @r"
        error: wrong�[31m
         --> x�[31m.ron:1:14
          |
        1 | (␀    ␛[31m··�漢 x
          |                  ^
          |
          = help: write�1
        ");
    }

    #[test]
    fn spans_anywhere_are_shown() {
        insta::assert_snapshot!(shown("", 0..0), @r"
        error: wrong�[31m
         --> x�[31m.ron:1:1
          |
        1 |
          | ^
          |
          = help: write�1
        ");
        insta::assert_snapshot!(shown("(\n", 2..2), @r"
        error: wrong�[31m
         --> x�[31m.ron:1:2
          |
        1 | (
          |  ^
          |
          = help: write�1
        ");
        insta::assert_snapshot!(shown("(ß\n  a", 2..99), @r"
        error: wrong�[31m
         --> x�[31m.ron:2:4
          |
        2 |   a
          |    ^
          |
          = help: write�1
        ");
        insta::assert_snapshot!(shown("[\n 1,\n]", 0..8), @r"
        error: wrong�[31m
         --> x�[31m.ron:1:1
          |
        1 | [
          | ^
          |
          = help: write�1
        ");
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
        error: first
         --> dir/x.ron:2:2
          |
        2 |     lines: 0,
          |     ^^^^^
          |
          = help: do this

        error: second
         --> dir/x.ron:3:1
          |
        3 | )
          | ^
          |
          = help: none
        ");
    }
}
