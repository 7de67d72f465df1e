//! Versions of the standard.

use crate::text::shortened;

/// Version of IES LM-63.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Version {
    V1986,
    V1991,
    V1995,
    V2002,
    V2019,
}

/// First lines of the files, their versions, and how other programs abbreviate the year.
const VERSIONS: [(&str, Version, &str); 5] = [
    ("IESNA86", Version::V1986, "86"),
    ("IESNA91", Version::V1991, "91"),
    ("IESNA:LM-63-1995", Version::V1995, "95"),
    ("IESNA:LM-63-2002", Version::V2002, "02"),
    ("IES:LM-63-2019", Version::V2019, "19"),
];

impl Version {
    /// Returns the version that the first line of a file states, and a warning if it is not written as the standard demands.
    /// `None` if the line is no version line, as in files of 1986.
    pub(crate) fn of(line: &str) -> Option<(Self, Option<String>)> {
        let upper = line.to_ascii_uppercase();
        if !upper.starts_with("IES") || !(upper.contains("LM-63") || upper.starts_with("IESNA")) {
            return None;
        }
        if let Some(&(_, version, _)) = VERSIONS.iter().find(|(tag, ..)| *tag == upper) {
            return Some((version, None));
        }
        let digits = upper.len() - upper.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        let year = &upper[upper.len() - digits.min(2)..];
        let known = VERSIONS.iter().find(|(.., short)| *short == year && (digits == 2 || digits == 4));
        let version = known.map_or(Self::V2019, |&(_, version, _)| version);
        let warning = format!(
            "The version line \"{}\" is none of the standard; the file is read as {}.",
            shortened(line),
            version.name()
        );
        Some((version, Some(warning)))
    }

    /// Returns the name of the version.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::V1986 => "IES LM-63-1986",
            Self::V1991 => "IES LM-63-1991",
            Self::V1995 => "IES LM-63-1995",
            Self::V2002 => "IES LM-63-2002",
            Self::V2019 => "IES LM-63-2019",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_recognized() {
        for (line, version, exact) in [
            ("IESNA91", Version::V1991, true),
            ("IESNA:LM-63-1995", Version::V1995, true),
            ("IESNA:LM-63-2002", Version::V2002, true),
            ("IES:LM-63-2019", Version::V2019, true),
            ("iesna:lm-63-2002", Version::V2002, true),
            ("IESNA:LM-63-1991", Version::V1991, false),
            ("IESNA:LM-63-95", Version::V1995, false),
            ("IES:LM-63-2002", Version::V2002, false),
            ("IESNA:LM-63-2030", Version::V2019, false),
            ("IESNA", Version::V2019, false),
        ] {
            let (found, warning) = Version::of(line).unwrap();
            assert_eq!((found, warning.is_none()), (version, exact), "{line}");
        }
        for line in ["", "[TEST] 1", "TILT=NONE", "A downlight of IESNA91"] {
            assert_eq!(Version::of(line), None, "{line}");
        }
    }
}
