//! Files of points: six numbers per line, the input format of Radiance's `rtrace`.

use std::fs::File;
use std::io;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use glam::DVec3;
use sir_radiosity::Sensor;

use crate::text::back_slashes::{path_help, printable};
use crate::text::formats::quoted;
use crate::text::reader::Reader;
use crate::text::record::Body;
use crate::text::ron_tree::{Node, Value};

/// File of points. It is read together with the pipeline, so that its errors are reported as problems of the pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct PointsFile {
    /// Path of the file: the path in the pipeline, joined to the folder of the pipeline file.
    pub path: PathBuf,
    /// Points in the file, at least one.
    pub sensors: Vec<Sensor>,
}

impl Body for PointsFile {
    fn read<'a>(reader: &mut Reader<'a>, node: &Node<'a>) -> Option<Self> {
        let example = "write for instance `File(\"points.txt\")`; paths are relative to the folder of the pipeline file";
        let path = match &node.value {
            Value::Items(items) => match items.as_slice() {
                [Node { value: Value::Text(name), .. }] if !name.is_empty() => reader.folder.join(name),
                _ => PathBuf::new(),
            },
            _ => PathBuf::new(),
        };
        let example = path_help(node.text, example);
        if path.as_os_str().is_empty() {
            reader.problem(node.text, "`File` must have the path of a file in quotes", example);
            return None;
        }
        match read_bounded(&path).map(|text| parse(&text)) {
            Ok(Ok(sensors)) => Some(Self { path, sensors }),
            Ok(Err((line, why))) => {
                let message = format!("{}:{line} is not a point: {why}", path.display());
                let help = "write one point `x y z dx dy dz` per line; `#` begins a comment";
                reader.problem(node.text, message, help);
                None
            }
            Err(error) => {
                let message = format!("cannot read the points of {}: {error}", printable(&path));
                reader.problem(node.text, message, example);
                None
            }
        }
    }

    fn write(&self, name: &str) -> String {
        format!("{name}({})", quoted(&self.path.to_string_lossy()))
    }
}

/// Largest size of a points file, in bytes: some four million points.
const MAX_BYTES: u64 = 1 << 28;

/// Reads a text file of limited size.
fn read_bounded(path: &Path) -> io::Result<String> {
    // Opening a pipe would wait for its other end.
    if !path.metadata()?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(io::Error::new(io::ErrorKind::InvalidData, "it has more than 256 MiB"));
    }
    String::from_utf8(sir_geom::utf8_text(bytes))
        .map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is not a text file in UTF-8 or UTF-16"))
}

/// Parses points, one `x y z dx dy dz` per line. `#` begins a comment.
///
/// The error has the number of the invalid line, and the reason.
fn parse(text: &str) -> Result<Vec<Sensor>, (usize, String)> {
    let mut sensors = Vec::new();
    let end = if text.contains('\n') { '\n' } else { '\r' };
    for (number, line) in (1..).zip(text.trim_start_matches('\u{feff}').split(end)) {
        let words: Vec<&str> = line.split('#').next().unwrap_or("").split_whitespace().collect();
        if words.is_empty() {
            continue;
        }
        let wrong = |why: String| (number, why);
        let mut numbers = Vec::with_capacity(6);
        for word in &words {
            let parsed = word.parse::<f64>().ok().filter(|x| x.is_finite());
            numbers.push(parsed.ok_or_else(|| wrong(format!("\"{word}\" is not a finite number")))?);
        }
        let [x, y, z, dx, dy, dz] = numbers[..] else {
            return Err(wrong(format!("it has {} numbers, but a point has six", numbers.len())));
        };
        let sensor = Sensor::new(DVec3::new(x, y, z), DVec3::new(dx, dy, dz));
        sensors.push(sensor.ok_or_else(|| wrong("the length of its direction is zero".into()))?);
    }
    if sensors.is_empty() {
        return Err((1, "the file has no points".into()));
    }
    Ok(sensors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_read() {
        let text = "\u{feff}# a desk\n\n 1 2.5 -3e-1\t0 0 2\r\n4 5 6 0 1 0 # the wall\n";
        for text in [text, &text.replace("\r\n", "\n"), &text.replace("\r\n", "\n").replace('\n', "\r")] {
            let sensors = parse(text).unwrap();
            assert_eq!(sensors.len(), 2);
            assert_eq!(sensors[0].position(), DVec3::new(1.0, 2.5, -0.3));
            assert_eq!((sensors[0].direction(), sensors[1].direction()), (DVec3::Z, DVec3::Y));
        }
    }

    #[test]
    fn wrong_lines_are_named() {
        for (text, line, why) in [
            ("1 2 3 0 0 1\n\n1 2 3 0 0\n", 3, "5 numbers"),
            ("# nothing\n", 1, "no points"),
            ("1 2 3 0 0 0", 1, "is zero"),
            ("1 2 3 0 0 one", 1, "\"one\""),
            ("1 2 3 0 0 inf", 1, "\"inf\""),
        ] {
            let (number, message) = parse(text).unwrap_err();
            assert!(number == line && message.contains(why), "{text:?}: {number} {message}");
        }
    }
}
