//! Text of a photometric file: its encoding, lines, words and numbers.

use std::borrow::Cow;

use crate::error::PhotometryError;

/// Maximum number of characters of the file that a message repeats.
const MAX_SHOWN: usize = 60;

/// Largest absolute value of a number. No physical quantity of a luminaire comes near it, and products of a few such
/// numbers are finite.
const MAX_NUMBER: f64 = 1e12;

/// What is expected instead of a number above [`MAX_NUMBER`].
pub(crate) const WITHIN_LIMITS: &str = "a number up to 1e12";

/// Decodes a file: UTF-8 or UTF-16 with a byte order mark, otherwise UTF-8 if it is valid, otherwise Latin-1. All line
/// ends become `\n`, and the end-of-file character of DOS becomes a space.
pub(crate) fn decode(bytes: &[u8]) -> String {
    let units = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
        char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect::<String>()
    };
    let text: Cow<'_, str> = match bytes {
        [0xff, 0xfe, rest @ ..] => units(rest, u16::from_le_bytes).into(),
        [0xfe, 0xff, rest @ ..] => units(rest, u16::from_be_bytes).into(),
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => text.into(),
            Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect::<String>().into(),
        },
    };
    let mut plain = String::with_capacity(text.len());
    let mut returns = 0;
    for c in text.chars() {
        match c {
            '\r' => returns += 1,
            // Some programs write "\r\r\n" for one line end.
            '\n' => {
                returns = 0;
                plain.push('\n');
            }
            _ => {
                plain.extend(std::iter::repeat_n('\n', returns));
                returns = 0;
                plain.push(if c == '\u{1a}' { ' ' } else { c });
            }
        }
    }
    plain
}

/// Returns the start of a text from a file, as a message repeats it.
pub(crate) fn shortened(text: &str) -> String {
    shortened_to(text, MAX_SHOWN)
}

/// Returns the first characters of a text from a file. Control characters are replaced, because they could manipulate a
/// terminal.
pub(crate) fn shortened_to(text: &str, characters: usize) -> String {
    let shown = |c: char| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c };
    let mut start: String = text.chars().take(characters).map(shown).collect();
    if text.chars().nth(characters).is_some() {
        start.push('…');
    }
    start
}

/// Returns the color temperature \[K\] at the start of a text such as `3000 K`; `None` if it has another meaning.
pub(crate) fn color_temperature(text: &str) -> Option<f64> {
    let text = text.trim();
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let unit = text[end..].trim_start();
    let known = unit.is_empty() || unit.starts_with(['k', 'K', '°', '/', ',', ';', '(']);
    number(&text[..end]).filter(|kelvins| known && (1000.0..=40_000.0).contains(kelvins))
}

/// Returns the value of a number as C and Fortran write it: `.5`, `1.`, `1E3` or `1D3`. `None` if the text is no number,
/// or one above [`MAX_NUMBER`].
fn number(text: &str) -> Option<f64> {
    // The parser of the standard library also accepts words such as `inf`.
    let known = |c: u8| c.is_ascii_digit() || b"+-.eEdD".contains(&c);
    if text.len() > 100 || !text.bytes().all(known) {
        return None;
    }
    let number: f64 = text.replace(['d', 'D'], "e").parse().ok()?;
    (number.abs() <= MAX_NUMBER).then_some(number)
}

/// Returns true if a text is a number, but one above [`MAX_NUMBER`].
pub(crate) fn is_too_large(text: &str) -> bool {
    number(text).is_none() && text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) && {
        let value = text.replace(['d', 'D'], "e").replace(',', ".").parse::<f64>();
        value.is_ok_and(|value| value.abs() > MAX_NUMBER)
    }
}

/// Character that separates numbers besides blanks and line ends, or is a part of them.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Comma {
    /// A separator.
    Separator,
    /// The decimal point.
    Decimal,
}

/// Place of a word or line in the file.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// Line number, from 1.
    pub(crate) line: usize,
    /// Number of the character in the line, from 1.
    pub(crate) column: usize,
}

/// Reader of lines, then of numbers.
pub(crate) struct Reader<'a> {
    rest: &'a str,
    place: Place,
    comma: Comma,
}

impl<'a> Reader<'a> {
    /// Starts at the beginning of a decoded text.
    pub(crate) fn new(text: &'a str, comma: Comma) -> Self {
        Self { rest: text, place: Place { line: 1, column: 1 }, comma }
    }

    /// Returns the place of the next character.
    pub(crate) fn place(&self) -> Place {
        self.place
    }

    /// Returns the rest of the current line without blanks around it, and its number; `None` at the end of the file.
    pub(crate) fn line(&mut self) -> Option<(&'a str, usize)> {
        if self.rest.is_empty() {
            return None;
        }
        let number = self.place.line;
        let (line, rest) = match self.rest.split_once('\n') {
            Some(parts) => {
                self.place = Place { line: number + 1, column: 1 };
                parts
            }
            None => (self.rest, ""),
        };
        self.rest = rest;
        Some((line.trim(), number))
    }

    /// Returns the next word and its place; `None` at the end of the file.
    fn word(&mut self) -> Option<(&'a str, Place)> {
        let start = self.rest.find(|c| !self.separates(c))?;
        for c in self.rest[..start].chars() {
            if c == '\n' {
                self.place = Place { line: self.place.line + 1, column: 1 };
            } else {
                self.place.column += 1;
            }
        }
        let rest = &self.rest[start..];
        let (word, rest) = rest.split_at(rest.find(|c| self.separates(c)).unwrap_or(rest.len()));
        let place = self.place;
        self.rest = rest;
        self.place.column += word.chars().count();
        Some((word, place))
    }

    /// Returns the number of the line of the next word; at the end of the file, that of its last line.
    pub(crate) fn line_of_next(&self) -> usize {
        let start = self.rest.find(|c| !self.separates(c)).unwrap_or(self.rest.len());
        self.place.line + self.rest[..start].matches('\n').count()
    }

    /// Returns true if a character separates words.
    fn separates(&self, c: char) -> bool {
        c.is_whitespace() || c == ',' && self.comma == Comma::Separator
    }

    /// Returns true if no word is left.
    pub(crate) fn is_at_end(&self) -> bool {
        self.rest.chars().all(|c| self.separates(c))
    }

    /// Returns the number of words left.
    pub(crate) fn words_left(&self) -> usize {
        self.rest.split(|c| self.separates(c)).filter(|word| !word.is_empty()).count()
    }

    /// Returns the next number. `what` names it, as in `the vertical angle 3`.
    ///
    /// # Errors
    ///
    /// If the file ends, or the next word is no number.
    pub(crate) fn number(&mut self, what: impl Fn() -> String) -> Result<f64, PhotometryError> {
        self.number_in(what, "a number", |_| true)
    }

    /// Returns the next number, which must fulfill a condition that `expected` describes.
    ///
    /// # Errors
    ///
    /// If the file ends, or the next word is no such number.
    pub(crate) fn number_in(
        &mut self,
        what: impl Fn() -> String,
        expected: &'static str,
        condition: impl Fn(f64) -> bool,
    ) -> Result<f64, PhotometryError> {
        let Some((word, place)) = self.word() else {
            return Err(PhotometryError::End { line: self.place.line, what: what() });
        };
        match self.value(word) {
            Some(number) if condition(number) => Ok(number),
            _ => Err(PhotometryError::Value {
                line: place.line,
                column: place.column,
                what: what(),
                found: shortened(word),
                expected: if is_too_large(word) { WITHIN_LIMITS } else { expected },
            }),
        }
    }

    /// Returns the value of a word or of a whole line.
    pub(crate) fn value(&self, word: &str) -> Option<f64> {
        match self.comma {
            Comma::Separator => number(word),
            Comma::Decimal => number(&word.replace(',', ".")),
        }
    }

    /// Returns a count from 1, which may be written with a decimal point.
    ///
    /// # Errors
    ///
    /// If the file ends, or the next word is no such number.
    pub(crate) fn count(&mut self, what: &str) -> Result<usize, PhotometryError> {
        let whole = |number: f64| (1.0..=1e9).contains(&number) && number.fract() == 0.0;
        Ok(self.number_in(|| what.to_owned(), "a whole number from 1 to 1000000000", whole)? as usize)
    }

    /// Returns the next `count` numbers. Memory is taken only for numbers that are in the file, however large the count is.
    ///
    /// # Errors
    ///
    /// If the file ends, or a word is no number.
    pub(crate) fn numbers(&mut self, count: usize, what: &str) -> Result<Vec<f64>, PhotometryError> {
        let mut numbers = Vec::new();
        while numbers.len() < count {
            let next = numbers.len() + 1;
            numbers.push(self.number(|| format!("{what} {next} of {count}"))?);
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings_and_line_ends_are_recognized() {
        let text = "Größe\n1 2\n3";
        let wide = |unit: fn(u16) -> [u8; 2], mark: [u8; 2]| {
            mark.into_iter().chain(text.encode_utf16().flat_map(unit)).collect::<Vec<u8>>()
        };
        assert_eq!(decode(text.as_bytes()), text);
        assert_eq!(decode(&[b"\xef\xbb\xbf", text.as_bytes()].concat()), text);
        assert_eq!(decode(&wide(u16::to_le_bytes, [0xff, 0xfe])), text);
        assert_eq!(decode(&wide(u16::to_be_bytes, [0xfe, 0xff])), text);
        assert_eq!(decode(b"Gr\xf6\xdfe\r\n1 2\r3\x1a"), "Größe\n1 2\n3 ");
        assert_eq!(decode(b"a\r\r\nb\r\rc"), "a\nb\n\nc");
        assert_eq!(decode(b"\xff\xfea"), "");
    }

    #[test]
    fn numbers_are_read_as_fortran_writes_them() {
        let cases =
            [(".5", 0.5), ("1.", 1.0), ("1E3", 1000.0), ("-2.5D-1", -0.25), ("+7", 7.0), ("1e-400", 0.0)];
        for (text, value) in cases {
            assert_eq!(number(text), Some(value), "{text}");
        }
        for text in ["", ".", "e", "inf", "nan", "1e999", "1e13", "0x10", "1_000", "--1", "1,5"] {
            assert_eq!(number(text), None, "{text}");
            assert_eq!(is_too_large(text), ["1e999", "1e13"].contains(&text), "{text}");
        }
    }

    #[test]
    fn color_temperatures_are_recognized() {
        for text in ["3000", " 3000 K", "3000K", "3000.0", "3000/830"] {
            assert_eq!(color_temperature(text), Some(3000.0), "{text}");
        }
        for text in ["", "830", "warm", "ww 3000", "3000 lm", "1e9"] {
            assert_eq!(color_temperature(text), None, "{text}");
        }
    }

    #[test]
    fn words_have_places() {
        let mut reader = Reader::new("first line\n 1,2\n\n\tx", Comma::Separator);
        assert_eq!(reader.line(), Some(("first line", 1)));
        assert_eq!(reader.numbers(2, "value").unwrap(), [1.0, 2.0]);
        let error = reader.number(|| "the end".to_owned()).unwrap_err().to_string();
        assert!(error.starts_with("line 4, column 2: the end is \"x\" (expected a number)"), "{error}");
        let error = reader.number(|| "the end".to_owned()).unwrap_err().to_string();
        assert!(error.starts_with("the file ends in line 4 before the end"), "{error}");
        let mut reader = Reader::new("1,5 ,25", Comma::Decimal);
        assert_eq!(reader.numbers(2, "value").unwrap(), [1.5, 0.25]);
    }
}
