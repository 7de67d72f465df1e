//! Statements and words of OBJ and MTL text.
//!
//! Text is bytes: keywords and numbers are ASCII, but names may be in any encoding, which neither format states.

use std::borrow::Cow;

use crate::load::files::shortened;

/// Byte order mark in UTF-8. Joined files have it at the start of any line.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Returns the statements with their line numbers, from 1, and without comments. A backslash at the end of a line
/// continues the statement on the next line.
pub(super) fn statements(text: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, [u8]>)> {
    let mut lines = lines(text).map(without_comment).enumerate();
    std::iter::from_fn(move || {
        let (i, first) = lines.next()?;
        let mut statement = Cow::Borrowed(first);
        while continues(&statement) {
            let statement = statement.to_mut();
            statement.pop();
            statement.push(b' ');
            statement.extend(lines.next().map_or(&[][..], |(_, next)| next));
        }
        Some((i + 1, statement))
    })
}

/// Returns the lines, which end with LF, CR LF, or CR alone.
fn lines(mut rest: &[u8]) -> impl Iterator<Item = &[u8]> {
    std::iter::from_fn(move || {
        let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let (line, behind) = rest.split_at_checked(end.unwrap_or(rest.len()))?;
        let behind = behind.strip_prefix(b"\r\n").or_else(|| behind.get(1..));
        (end.is_some() || !line.is_empty()).then(|| {
            rest = behind.unwrap_or_default();
            line
        })
    })
}

/// Returns a line without byte order marks and without its comment, trimmed. A comment begins with a `#` at the start
/// of the line or after a blank, since names may contain a `#`.
fn without_comment(mut line: &[u8]) -> &[u8] {
    while let Some(rest) = line.strip_prefix(BYTE_ORDER_MARK) {
        line = rest;
    }
    let begins = |&i: &usize| line[i] == b'#' && (i == 0 || line[i - 1].is_ascii_whitespace());
    let comment = (0..line.len()).find(begins);
    line[..comment.unwrap_or(line.len())].trim_ascii()
}

/// Returns true if a statement ends with a backslash. After a byte that is not ASCII it does not count: it is the
/// second half of a character in some encodings of Chinese and Japanese.
fn continues(statement: &[u8]) -> bool {
    matches!(statement, [b'\\'] | [.., ..=0x7f, b'\\'])
}

/// Returns the first word and the rest, both trimmed.
pub(super) fn split_word(text: &[u8]) -> (&[u8], &[u8]) {
    let text = text.trim_ascii();
    let (word, rest) = text.split_at(text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len()));
    (word, rest.trim_ascii_start())
}

/// Returns the words of a text.
pub(super) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// Returns a keyword in lower case.
pub(super) fn lower_case(keyword: &[u8]) -> Cow<'_, [u8]> {
    if keyword.iter().any(u8::is_ascii_uppercase) {
        Cow::Owned(keyword.to_ascii_lowercase())
    } else {
        Cow::Borrowed(keyword)
    }
}

/// Parses a number. `1.#IND`, `nan(ind)` and the like, which some C libraries write, are not-a-number.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    let text = str::from_utf8(word).ok()?;
    let is_nan = || text.contains('#') || text.trim_start_matches('-').starts_with("nan(");
    text.parse().ok().or_else(|| is_nan().then_some(f64::NAN))
}

/// Returns a text in readable form. If it is not UTF-8, its encoding is unknown, and all bytes except those of ASCII are
/// escaped, as in `\xB0`: different names stay different.
pub(super) fn shown(text: &[u8]) -> String {
    match str::from_utf8(text) {
        Ok(text) => text.to_owned(),
        Err(_) => {
            let escape = |&byte: &u8| match byte {
                0..=0x7f => char::from(byte).to_string(),
                _ => format!("\\x{byte:02X}"),
            };
            text.iter().map(escape).collect()
        }
    }
}

/// Returns the start of a text in quotes, for an error message.
pub(super) fn start_of(text: &[u8]) -> String {
    // A character has at most four bytes, so that enough are left.
    format!("\"{}\"", shortened(&shown(&text[..text.len().min(400)]), 80))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &[u8]) -> Vec<(usize, String)> {
        let all = statements(text).map(|(line, statement)| (line, shown(&statement)));
        all.filter(|(_, statement)| !statement.is_empty()).collect()
    }

    #[test]
    fn statements_have_their_lines_whatever_ends_them() {
        let text = "# head\n\nv\t1  3 # red\nf 1/2 \\\n  2//4 -1\nusemtl\ta b#1 # c\n g x";
        let expected = [(3, "v\t1  3"), (4, "f 1/2  2//4 -1"), (6, "usemtl\ta b#1"), (7, "g x")];
        let expected = expected.map(|(line, statement)| (line, statement.to_owned()));
        for end in ["\n", "\r\n", "\r"] {
            assert_eq!(all(text.replace('\n', end).as_bytes()), expected);
            assert_eq!(all(format!("{text}\n\n").replace('\n', end).as_bytes()), expected);
        }
        assert_eq!(
            all(b"a\rb\nc\r\nd"),
            [(1, "a"), (2, "b"), (3, "c"), (4, "d")].map(|(i, s)| (i, s.to_owned()))
        );
        assert_eq!(all(b"\xef\xbb\xbf\xef\xbb\xbfv\n\xef\xbb\xbfv").len(), 2);
        assert!(all(b"").is_empty() && all(b"\n\r\n# x\\").is_empty());
    }

    /// The second byte of many characters in Shift JIS, GBK and Big5 is that of a backslash.
    #[test]
    fn half_a_character_continues_nothing() {
        assert_eq!(all(b"usemtl \x83\x5c\nf 1 2 3").len(), 2);
        assert_eq!(all(b"f 1 2\\\n3").len(), 1);
    }

    #[test]
    fn names_that_are_not_utf8_stay_different() {
        assert_eq!(shown("ca\u{fc}".as_bytes()), "ca\u{fc}");
        assert_eq!([shown(b"a\xb5\xd8"), shown(b"a\xb6\xa5")], ["a\\xB5\\xD8", "a\\xB6\\xA5"]);
        assert_eq!(start_of(&[b'x'; 500]).chars().count(), 83);
    }

    #[test]
    fn numbers_are_those_of_c_libraries_too() {
        assert_eq!(number(b"-1.5e-3"), Some(-0.0015));
        for nan in ["nan", "-nan", "-nan(ind)", "1.#QNAN", "-1.#IND"] {
            assert!(number(nan.as_bytes()).unwrap().is_nan(), "{nan}");
        }
        assert!([&b"0,5"[..], b"x", b"", b"\xff", b"banana"].iter().all(|word| number(word).is_none()));
    }
}
