//! Messages about broken files: where, what was found, what was expected, and what to do.

use std::path::Path;

use sir_photometry::{Photometry, PhotometryError};

use crate::lamps::{Ies, Ldt, angles, cosine};

fn ies() -> String {
    Ies::new(1, angles(0.0, 90.0, 45.0), vec![0.0]).text(cosine)
}

fn ldt() -> String {
    Ldt::new(1, 90.0, angles(0.0, 90.0, 45.0)).text(cosine)
}

fn message(text: &str) -> String {
    Photometry::parse(text.as_bytes()).unwrap_err().to_string()
}

/// Returns a EULUMDAT file one of whose lines, from 1, is replaced.
fn replaced(number: usize, line: &str) -> String {
    let text = ldt();
    let mut lines: Vec<&str> = text.lines().collect();
    lines[number - 1] = line;
    lines.join("\n")
}

/// Returns the message about such a file.
fn with_line(number: usize, line: &str) -> String {
    message(&replaced(number, line))
}

#[test]
fn errors_are_small() {
    assert!(size_of::<PhotometryError>() < 128);
}

#[test]
fn values_of_ies_are_located() {
    assert_eq!(
        message(&ies().replace("\n0 45 90\n", "\n0 x5 90\n")),
        "line 7, column 3: the vertical angle 2 of 3 is \"x5\" (expected a number); correct it, or export the file again"
    );
    for (from, to, expected) in [
        (
            "1 -1 1 3",
            "1 -1 0 3",
            "line 5, column 6: the candela multiplier is \"0\" (expected a number above 0)",
        ),
        (
            "1 -1 1 3 1 1",
            "1 -1 1 3 1 4",
            "the photometric type is \"4\" (expected 1 for C, 2 for B or 3 for A)",
        ),
        (
            "1 -1 1 3 1 1 2",
            "1 -1 1 3 1 1 0",
            "the unit of lengths is \"0\" (expected 1 for feet or 2 for meters)",
        ),
        (
            "1 -1 1 3",
            "1 -1 1 2.5",
            "the number of vertical angles is \"2.5\" (expected a whole number from 1 to 1000000000)",
        ),
        ("1 -1 1 3", "1 -1 1 4", "the file ends in line 9 before the intensity at the horizontal angle 1000"),
        ("1 1 0\n", "0 1 0\n", "line 6, column 1: the ballast factor is \"0\""),
        (
            "0 45 90",
            "0 90 45",
            "line 7: the vertical angles go from 90° to 45° (expected each larger than the one before)",
        ),
        ("0 45 90", "0 45 200", "the vertical angles go from 0° to 200° (expected angles within 0 to 180°)"),
        (
            "TILT=NONE",
            "TILT=INCLUDE\n4",
            "line 5, column 1: the lamp-to-luminaire geometry is \"4\" (expected 1, 2 or 3)",
        ),
        (
            "TILT=NONE",
            "TILT=INCLUDE\n1 2 9 8 1 1",
            "the list of tilt angles is \"9 … 8\" (expected ascending angles)",
        ),
        ("TILT=NONE", "NONE", "the line \"TILT=\" of IES LM-63 is missing"),
    ] {
        let error = message(&ies().replacen(from, to, 1));
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn horizontal_angles_outside_the_standard_are_refused() {
    for (kind, vertical, horizontal, expected) in [
        (
            1,
            angles(0.0, 90.0, 45.0),
            angles(0.0, 60.0, 30.0),
            "the horizontal angles go from 0° to 60° (expected 0 only",
        ),
        (1, angles(0.0, 90.0, 45.0), angles(0.0, 400.0, 40.0), "from 0° to 400°"),
        (
            2,
            angles(-90.0, 90.0, 45.0),
            vec![0.0],
            "the horizontal angles go from 0° to 0° (expected 0 to 90°",
        ),
        (
            2,
            angles(-90.0, 90.0, 45.0),
            angles(-90.0, 180.0, 45.0),
            "from -90° to 180° (expected angles within -90 to 90°)",
        ),
        (
            3,
            angles(0.0, 180.0, 45.0),
            angles(-90.0, 90.0, 45.0),
            "the vertical angles go from 0° to 180° (expected angles",
        ),
    ] {
        let error = message(&Ies::new(kind, vertical, horizontal).text(|_| 1.0));
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn values_of_eulumdat_are_located() {
    for (line, text, expected) in [
        (
            4,
            "2.5",
            "line 4, column 1: the number of planes is \"2.5\" (expected a whole number from 1 to 1000000000)",
        ),
        (6, "", "line 6, column 1: the number of angles in a plane is \"\""),
        (16, "wide", "line 16, column 1: a dimension is \"wide\" (expected a number)"),
        (26, "-1", "line 26, column 1: the number of lamp sets is \"-1\""),
        (29, "1000 lm", "line 29, column 1: the flux of the lamps is \"1000 lm\""),
        (47, "x", "line 47, column 1: the angle γ 1 of 3 is \"x\""),
        (51, "1e99", "the intensity 2 of 3 in plane 1 of 1 is \"1e99\" (expected a number up to 1e12)"),
    ] {
        let error = with_line(line, text);
        assert!(error.contains(expected), "{error}");
    }
    let text = ldt();
    let short: Vec<&str> = text.lines().take(30).collect();
    assert!(
        message(&short.join("\n")).starts_with("the file ends in line 30 before the color rendering;"),
        "{}",
        message(&short.join("\n"))
    );
}

/// With another number of sets, angles and intensities would be read from wrong lines.
#[test]
fn a_wrong_number_of_lamp_sets_is_refused() {
    for (sets, wrong) in [(1, "0"), (1, "2"), (2, "1"), (2, "3")] {
        let mut file = Ldt::new(4, 15.0, angles(0.0, 90.0, 5.0));
        file.lamps = vec![[1.0, 1000.0, 0.0]; sets];
        let text = file.text(cosine);
        let mut lines: Vec<&str> = text.lines().collect();
        lines[25] = wrong;
        let error = message(&lines.join("\n"));
        let expected = format!("line 26, column 1: the number of lamp sets is \"{wrong}\" (expected that of");
        assert!(error.starts_with(&expected), "{error}");
    }
}

#[test]
fn a_file_with_the_name_of_eulumdat_is_read_as_that() {
    let folder = tempfile::tempdir().unwrap();
    for (line, found, expected) in [
        (3, "5", "line 3, column 1: the symmetry indicator is \"5\" (expected a whole number from 0 to 4)"),
        (3, "", "line 3, column 1: the symmetry indicator is \"\""),
        (4, "0", "line 4, column 1: the number of planes is \"0\" (expected a whole number from 1"),
    ] {
        let text = ldt();
        let mut lines: Vec<&str> = text.lines().collect();
        lines[line - 1] = found;
        for name in ["a.ldt", "A.LDT"] {
            let path = folder.path().join(name);
            std::fs::write(&path, lines.join("\n")).unwrap();
            let error = Photometry::read(&path).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
    let path = folder.path().join("folder.ldt");
    std::fs::create_dir(&path).unwrap();
    let error = std::error::Error::source(&Photometry::read(&path).unwrap_err()).unwrap().to_string();
    assert_eq!(error, "this is a folder, not a file");
}

#[test]
fn planes_of_eulumdat_fit_their_symmetry() {
    for (symmetry, expected) in [(2, "0 to 180°"), (3, "270 to 450°"), (4, "0 to 90°")] {
        let mut file = Ldt::new(symmetry, 30.0, angles(0.0, 90.0, 45.0));
        file.planes.truncate(10);
        let error = message(&file.text(cosine));
        let expected = format!("(expected {expected} for the symmetry indicator {symmetry}); correct");
        assert!(error.starts_with("line 43: the angles C go from ") && error.contains(&expected), "{error}");
    }
}

#[test]
fn other_formats_are_named() {
    for (text, expected) in [
        ("", "it is empty"),
        ("  \n", "it is empty"),
        ("<?xml version=\"1.0\"?><IESTM33-22/>", "XML or JSON"),
        ("IESNA:LM-63-2002\n[TEST] 1", "\"TILT=\" of IES LM-63 is missing"),
        ("a\nb\nc\nd", "lines 2 to 4 are not the indicators of EULUMDAT"),
    ] {
        let error = message(text);
        assert!(
            error.starts_with("this is neither an IES LM-63 nor a EULUMDAT file (")
                && error.contains(expected),
            "{error}"
        );
    }
}

#[test]
fn a_dark_file_is_refused() {
    let dark = Ies::new(1, angles(0.0, 90.0, 45.0), vec![0.0]).text(|_| 0.0);
    assert_eq!(message(&dark), "line 9: all intensities are zero; correct the file, or export it again");
}

#[test]
fn files_are_named() {
    let error = Photometry::read(Path::new("absent.ies")).unwrap_err();
    assert_eq!(error.to_string(), "cannot read the photometric file absent.ies");
    assert!(std::error::Error::source(&error).is_some());
    let error = Photometry::read(Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap_err();
    assert!(matches!(error, PhotometryError::Read { .. }), "{error}");
    let error =
        Photometry::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml")).unwrap_err().to_string();
    assert!(error.contains("Cargo.toml: this is neither"), "{error}");
}

#[test]
fn doubtful_files_are_read_with_a_warning() {
    for (text, expected) in [
        (
            ies().replace("LM-63-2002", "LM-63-2020"),
            "The version line \"IESNA:LM-63-2020\" is none of the standard",
        ),
        (ies().replace("TILT=NONE", "TILT="), "The line \"TILT=\" has no value"),
        (ies().replace("TILT=NONE", "TILT=absent.tlt"), "The tilt file \"absent.tlt\" cannot be read"),
        (ies() + "IESNA:LM-63-2002\nTILT=NONE", "The text after the first luminaire is ignored."),
        (
            ies().replace("\n1000.0", "\n-1 "),
            "1 negative intensities are set to zero; the lowest in the table is -1.",
        ),
        (
            ies().replace("0 45 90", "0 45 80"),
            "There is no light outside of the vertical angles from 0° to 80°.",
        ),
        (ies().replace("\n0\n", "\n90\n"), "The only horizontal angle is 90°"),
        (ies().replace("1 -1 1", "2 -500 1"), "The flux of 2 × -500 lm of the lamps is ignored;"),
        (ies().replace("1 -1 1", "1 0 1"), "The flux of 1 × 0 lm of the lamps is ignored;"),
        (ies().replace("1 1 0\n", "1 1 -15\n"), "The electric power -15 W is negative"),
        (ldt().replacen("\r\n100\r\n", "\r\n0\r\n", 1), "The light output ratio 0 % is ignored;"),
        (ldt().replace("LED\r\n1000", "LED\r\n-4000"), "The flux of the lamps -4000 lm is negative;"),
        (ldt().replace("1B\r\n0", "1B\r\n-40"), "The electric power -40 W is negative"),
        (replaced(16, "-5"), "The dimension -5 mm in line 16 is read without its sign."),
        (ldt() + "\r\n7\r\n8", "2 numbers after the intensities are ignored."),
        (
            ldt().lines().take(51).collect::<Vec<_>>().join("\n"),
            "The last 1 intensities are missing, and read as zero.",
        ),
    ] {
        let file = Photometry::parse(text.as_bytes()).unwrap_or_else(|error| panic!("{expected}: {error}"));
        assert!(
            file.warnings.iter().any(|warning| warning.starts_with(expected)),
            "{expected}: {:?}",
            file.warnings
        );
    }
    let mut file = Ldt::new(1, 90.0, angles(0.0, 90.0, 45.0));
    file.lamps[0][1] = 0.0;
    let text = ldt().replace("LED\r\n1000", "LED\r\n");
    let file = Photometry::parse(text.as_bytes()).unwrap();
    assert!(
        file.lamp_flux.is_none() && file.warnings[0].contains("1000 lm are assumed"),
        "{:?}",
        file.warnings
    );
}
