//! Lines before the numbers: version, labels and keywords, and the line `TILT=`.

use crate::error::PhotometryError;
use crate::ies::version::Version;
use crate::text::{Reader, color_temperature, shortened_to};

/// Maximum number of characters of the name of a luminaire.
const MAX_NAME: usize = 200;

/// Contents of the header, as far as they matter.
pub(crate) struct Header<'a> {
    pub(crate) version: Version,
    /// Name of the luminaire and of its manufacturer.
    pub(crate) name: String,
    /// Correlated color temperature \[K\].
    pub(crate) color_temperature: Option<f64>,
    /// Text after `TILT=`.
    pub(crate) tilt: &'a str,
}

/// Returns the text after `TILT=`; `None` if the line has another meaning.
pub(crate) fn tilt_value(line: &str) -> Option<&str> {
    let (word, rest) = line.trim().split_at_checked(4)?;
    let value = rest.trim_start().strip_prefix('=')?;
    word.eq_ignore_ascii_case("TILT").then(|| value.trim())
}

/// Values of the keywords that are read.
#[derive(Default)]
struct Labels {
    manufacturer: String,
    luminaire: String,
    catalog: String,
    color_temperature: String,
    /// First line without a keyword, which is all that files of 1986 have.
    plain: String,
}

impl Labels {
    /// Returns the place of the value of a keyword; `None` if it is ignored. Keywords of users start with an underscore.
    fn of(&mut self, keyword: &str) -> Option<&mut String> {
        match keyword.trim().to_ascii_uppercase().trim_start_matches('_') {
            "MANUFAC" => Some(&mut self.manufacturer),
            "LUMINAIRE" => Some(&mut self.luminaire),
            "LUMCAT" => Some(&mut self.catalog),
            "CCT" | "COLORTEMP" | "COLORTEMPERATURE" => Some(&mut self.color_temperature),
            _ => None,
        }
    }

    fn name(&self) -> String {
        let luminaire =
            [&self.luminaire, &self.catalog, &self.plain].into_iter().find(|text| !text.is_empty());
        let words = [Some(&self.manufacturer), luminaire]
            .into_iter()
            .flatten()
            .flat_map(|text| text.split_whitespace());
        shortened_to(&words.collect::<Vec<_>>().join(" "), MAX_NAME)
    }
}

/// Reads all lines up to the line `TILT=`.
///
/// # Errors
///
/// If the file ends before that line.
pub(crate) fn read<'a>(
    reader: &mut Reader<'a>,
    warnings: &mut Vec<String>,
) -> Result<Header<'a>, PhotometryError> {
    let mut version = None;
    let mut labels = Labels::default();
    let mut keyword = "";
    let tilt = loop {
        let Some((line, _)) = reader.line() else {
            let what = "the line \"TILT=\"".to_owned();
            return Err(PhotometryError::End { line: reader.place().line, what });
        };
        if let Some(tilt) = tilt_value(line) {
            break tilt;
        }
        if line.is_empty() {
            continue;
        }
        if version.is_none() {
            let stated = Version::of(line);
            version = Some(stated.as_ref().map_or(Version::V1986, |(version, _)| *version));
            if let Some((_, warning)) = stated {
                warnings.extend(warning);
                continue;
            }
        }
        match line.strip_prefix('[').and_then(|line| line.split_once(']')) {
            Some((word, value)) if word.trim().eq_ignore_ascii_case("MORE") => {
                append(labels.of(keyword), value)
            }
            Some((word, value)) => {
                keyword = word;
                // Of several lamps or luminaires, the first is named.
                append(labels.of(keyword).filter(|text| text.is_empty()), value);
            }
            None => append(Some(&mut labels.plain).filter(|text| text.is_empty()), line),
        }
    };
    Ok(Header {
        version: version.unwrap_or(Version::V1986),
        name: labels.name(),
        color_temperature: color_temperature(&labels.color_temperature),
        tilt,
    })
}

fn append(text: Option<&mut String>, value: &str) {
    if let Some(text) = text {
        text.push(' ');
        text.push_str(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Comma;

    fn header(text: &str) -> Header<'_> {
        read(&mut Reader::new(text, Comma::Separator), &mut Vec::new()).unwrap()
    }

    #[test]
    fn keywords_and_their_continuations_are_read() {
        let text = "IESNA:LM-63-2002\n[TEST] 7\n[MANUFAC]  Lamp  Makers\n[MORE] of the World \n\n[LUMCAT] 12\n[LUMINAIRE] Down\n\
                    [MORE]light\n[OTHER] x\n[MORE] y\n[_CCT] 3000 K\nTILT = include\n1";
        let header = header(text);
        assert_eq!(header.name, "Lamp Makers of the World Down light");
        assert_eq!(
            (header.version, header.color_temperature, header.tilt),
            (Version::V2002, Some(3000.0), "include")
        );
    }

    #[test]
    fn labels_of_1986_are_names() {
        let header = header("A downlight\nof 1986\nTILT=NONE");
        assert_eq!((header.name.as_str(), header.version), ("A downlight", Version::V1986));
    }

    #[test]
    fn names_are_short_and_printable() {
        let text = format!("IESNA91\n[LUMINAIRE] \u{1b}[2J{}\nTILT=NONE", "x".repeat(1000));
        let name = header(&text).name;
        assert_eq!(name.chars().count(), MAX_NAME + 1);
        assert!(!name.contains(char::is_control));
    }
}
