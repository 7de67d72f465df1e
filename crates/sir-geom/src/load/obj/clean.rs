//! Simplification of OBJ and MTL text to the subset of the formats that `tobj` reads correctly.
//!
//! `tobj` 4.0 reads a comment after a value as a value, makes triangles of the polylines `l 1 2 3`, requires blanks
//! instead of tabs after some keywords, and panics on colors with fewer than three numbers. So it gets only the
//! statements that a scene needs, in their simplest form, each on its original line.

use std::borrow::Cow;
use std::collections::BTreeSet;

use crate::load::files::shortened;
use crate::load::obj::corners::Corners;

/// A simplified OBJ file.
#[derive(Debug, Default)]
pub(super) struct Obj {
    /// Statements `v`, `f`, `o` and `usemtl`, with positions only.
    pub(super) text: String,
    /// Arguments of the `mtllib` statements.
    pub(super) libraries: Vec<String>,
    /// Arguments of the `usemtl` statements.
    pub(super) used_materials: BTreeSet<String>,
    /// Texture coordinates and colors.
    pub(super) corners: Corners,
    /// Number of statements `p` and `l`, and of faces with one or two corners.
    pub(super) points_and_lines: usize,
}

/// Extracts from OBJ text the statements that a scene needs.
pub(super) fn obj(text: &str) -> Obj {
    let mut plain = Obj::default();
    let mut lines = 0;
    for (line, statement) in statements(text) {
        let (keyword, rest) = split_word(&statement);
        pad_to(&mut plain.text, &mut lines, line);
        match keyword {
            "v" => {
                push_words(&mut plain.text, "v", rest.split_whitespace().take(3).map(coordinate));
                plain.corners.add_vertex(rest.split_whitespace());
            }
            "vt" => plain.corners.add_place(rest.split_whitespace()),
            "f" if rest.split_whitespace().nth(2).is_some() => {
                plain.corners.add_face(rest.split_whitespace());
                push_words(&mut plain.text, "f", rest.split_whitespace().map(position));
            }
            "f" | "l" | "p" => plain.points_and_lines += 1,
            "usemtl" => {
                push_words(&mut plain.text, "usemtl", [rest].into_iter());
                plain.used_materials.insert(rest.to_owned());
            }
            // The last object or group before a face counts.
            "o" | "g" => push_words(&mut plain.text, "o", [rest].into_iter()),
            "mtllib" => plain.libraries.push(rest.to_owned()),
            _ => {}
        }
    }
    plain.text.push('\n');
    plain
}

/// A simplified material library.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Mtl {
    /// Statements `newmtl`, `Kd`, `Ke`, `d`, `Tr`, and their `map_…`.
    pub(super) text: String,
    /// Keywords of other statements that affect the appearance, but do not apply to diffuse surfaces.
    pub(super) ignored: BTreeSet<String>,
}

/// Keywords about gloss, refraction and ambient light, which are ignored without a warning, since most libraries have
/// them.
const SILENTLY_IGNORED: [&str; 8] = ["illum", "ka", "ks", "ni", "ns", "tf", "map_ka", "sharpness"];

/// Extracts from MTL text the names and diffuse properties of materials.
///
/// # Errors
///
/// The line number, and what is wrong with the line.
pub(super) fn mtl(text: &str) -> Result<Mtl, (usize, String)> {
    let mut plain = Mtl::default();
    let mut lines = 0;
    for (line, statement) in statements(text) {
        let (keyword, rest) = split_word(&statement);
        pad_to(&mut plain.text, &mut lines, line);
        let known = ["newmtl", "Kd", "Ke", "d", "Tr", "map_Kd", "map_Ke", "map_d"];
        let Some(known) = known.into_iter().find(|known| keyword.eq_ignore_ascii_case(known)) else {
            if !keyword.is_empty() && !SILENTLY_IGNORED.contains(&&*keyword.to_ascii_lowercase()) {
                plain.ignored.insert(shortened(keyword, 40));
            }
            continue;
        };
        let text = &mut plain.text;
        match (known, rest.split_whitespace().count()) {
            // One number stands for three (the MTL specification allows this for all colors).
            ("Kd" | "Ke", 1) => push_words(text, known, [rest; 3].into_iter()),
            ("Kd" | "Ke", 0 | 2) => {
                let start = shortened(&statement, 80);
                return Err((line, format!("\"{start}\" must have one or three numbers")));
            }
            ("newmtl", 0) => return Err((line, "a material has no name".to_owned())),
            ("map_Kd" | "map_Ke" | "map_d" | "d" | "Tr", 0) => {}
            // There may be an option `-halo` before the number.
            ("d" | "Tr", _) => push_words(text, known, rest.split_whitespace().last().into_iter()),
            _ => push_words(text, known, [rest].into_iter()),
        }
    }
    plain.text.push('\n');
    Ok(plain)
}

/// Returns the first word and the rest, both trimmed.
pub(super) fn split_word(text: &str) -> (&str, &str) {
    let text = text.trim();
    text.split_once(char::is_whitespace).map_or((text, ""), |(word, rest)| (word, rest.trim_start()))
}

/// Returns the statements with their line numbers, from 1, and without comments. A backslash at the end of a line
/// continues the statement on the next line.
fn statements(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines().map(without_comment).enumerate();
    std::iter::from_fn(move || {
        let (i, first) = lines.next()?;
        let mut statement = Cow::Borrowed(first);
        while statement.ends_with('\\') {
            let statement = statement.to_mut();
            statement.pop();
            statement.push(' ');
            statement.push_str(lines.next().map_or("", |(_, next)| next));
        }
        Some((i + 1, statement))
    })
}

/// Returns a line without its comment, trimmed. A comment begins with a `#` at the start of the line or after a blank,
/// since names may contain a `#`.
fn without_comment(line: &str) -> &str {
    let comment = line
        .match_indices('#')
        .map(|(i, _)| i)
        .find(|&i| line[..i].chars().next_back().is_none_or(char::is_whitespace));
    line[..comment.unwrap_or(line.len())].trim()
}

/// Returns the number, from 1, and the start of the line that ends at byte `end`.
pub(super) fn line_at(text: &str, end: usize) -> (usize, String) {
    let (line, statement) = text[..end].lines().enumerate().last().unwrap_or_default();
    (line + 1, shortened(statement, 80))
}

/// Appends line breaks until the text is at the start of `line`; `lines` is the number of line breaks so far.
fn pad_to(text: &mut String, lines: &mut usize, line: usize) {
    for _ in *lines + 1..line {
        text.push('\n');
    }
    *lines = line - 1;
}

/// Returns a coordinate, with `1.#IND` and the like, which some C libraries write for NaN, replaced by `nan`.
fn coordinate(word: &str) -> &str {
    if word.contains('#') { "nan" } else { word }
}

/// Returns the position number of a corner `position/texture/normal`, or the whole corner if it has none, so that the
/// error message shows it.
fn position(corner: &str) -> &str {
    corner.split('/').next().filter(|position| !position.is_empty()).unwrap_or(corner)
}

fn push_words<'a>(text: &mut String, keyword: &str, words: impl Iterator<Item = &'a str>) {
    text.push_str(keyword);
    for word in words {
        text.push(' ');
        text.push_str(word);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_keep_their_lines() {
        let plain = obj(
            "# head\n\nv\t1 2  3 0.1 0.2 0.3 # red\r\nf 1/2/3 \\\n  2//4 -1\nl 1 2 3\nusemtl\ta b#1 # c\n g x\n",
        );
        assert_eq!(plain.text, "\n\nv 1 2 3\nf 1 2 -1\n\n\nusemtl a b#1\no x\n");
        assert_eq!((plain.points_and_lines, plain.used_materials), (1, ["a b#1".to_owned()].into()));
    }

    #[test]
    fn colors_have_three_numbers() {
        let plain = mtl("newmtl  a\n\tkd 0.5\nKe 1 2 3 # x\nD -halo 0.3\nillum 2\nbump x.png").unwrap();
        assert_eq!(plain.text, "newmtl a\nKd 0.5 0.5 0.5\nKe 1 2 3\nd 0.3\n\n\n");
        assert_eq!(plain.ignored, ["bump".to_owned()].into());
        assert_eq!(mtl("newmtl a\n\nKd 0.5 1").unwrap_err().0, 3);
    }
}
