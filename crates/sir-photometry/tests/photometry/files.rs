//! Small files of all versions, types and symmetries, as makers write them.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use sir_photometry::{LampGeometry, Opening, Outline, Photometry, PhotometryOptions};

use crate::lamps::{
    Lamp, assert_same, cosine, lopsided, symmetric_in_both, symmetric_in_x, symmetric_in_y, uniform,
};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name)
}

fn read(name: &str) -> Photometry {
    Photometry::read(&path(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// Lambertian, with 2 × 0.5 × 0.25 × 4 = 1 times the intensity of [`cosine`].
const FILES: [(&str, &str, &str, Lamp); 11] = [
    ("cosine-1986.ies", "IES LM-63-1986 type C", "Cosine lamp of 1986", cosine),
    ("quadrant-tilt-1991.ies", "IES LM-63-1991 type C", "Our Own Quadrant", symmetric_in_both),
    ("globe-1995.ies", "IES LM-63-1995 type C", "Our Own Globe", uniform),
    ("half-across-1995.ies", "IES LM-63-1995 type C", "Wall washer", symmetric_in_x),
    ("half-2002.ies", "IES LM-63-2002 type C", "Our Own Roadway lamp", symmetric_in_y),
    ("full-2019.ies", "IES LM-63-2019 type C", "Our Own Lopsided", lopsided),
    ("full.ldt", "EULUMDAT", "Our Own Lamp", lopsided),
    ("rotational.ldt", "EULUMDAT", "Our Own Lamp", cosine),
    ("c0-c180.ldt", "EULUMDAT", "Our Own Absolute", symmetric_in_x),
    ("c90-c270-commas.ldt", "EULUMDAT", "Leuchten Größe Überall", symmetric_in_y),
    ("quadrant.ldt", "EULUMDAT", "Our Own Lamp", symmetric_in_both),
];

#[test]
fn files_have_their_format_name_and_intensities() {
    for (name, format, luminaire, lamp) in FILES {
        let file = read(name);
        assert_eq!((file.format.as_str(), file.name.as_str()), (format, luminaire));
        // Steps of 10° and 15°.
        assert_same(&file, lamp, 0.035, name);
    }
}

#[test]
fn files_of_types_a_and_b_are_half() {
    let b = read("floodlight-b-2002.ies");
    assert_same(&b, |d| lopsided(d) * (-d.z).max(0.0), 0.035, "type B");
    let a = read("headlight-a-2019.ies");
    assert_same(&a, |d| symmetric_in_y(d) * d.x.max(0.0), 0.035, "type A");
    assert_eq!((a.color_temperature, a.watts, a.lamp_flux), (Some(5700.0), Some(55.0), None));
    assert_eq!(b.opening, Opening::Flat { outline: Outline::Ellipse, length: 0.2, width: 0.2 });
}

#[test]
fn numbers_besides_the_intensities_are_read() {
    let file = read("cosine-1986.ies");
    assert_eq!((file.lamp_flux, file.watts, file.color_temperature), (Some(2000.0), Some(100.0), None));
    let foot = Opening::Flat { outline: Outline::Ellipse, length: 0.3048, width: 0.3048 };
    assert_eq!((file.opening, file.warnings.len()), (foot, 0));

    let file = read("half-2002.ies");
    assert_eq!((file.lamp_flux, file.watts, file.color_temperature), (None, Some(120.5), Some(4000.0)));
    let opening = Opening::Flat { outline: Outline::Rectangle, length: 0.5, width: 0.2 };
    assert_eq!((file.opening, file.stated_flux), (opening, None));

    let file = read("full.ldt");
    let opening = Opening::Solid { outline: Outline::Rectangle, length: 0.5, width: 0.1, height: 0.02 };
    assert_eq!((file.opening, file.warnings.len()), (opening, 0));
    let stated = file.stated_flux.unwrap();
    assert!((stated - 0.8 * file.lamp_flux.unwrap()).abs() < 1e-9);
    assert!((stated / (400.0 * PI * (2.25 + 0.7 / 3.0)) - 1.0).abs() < 1e-5, "{stated}");
    assert!((file.distribution.flux() / stated - 1.0).abs() < 5e-3, "{}", file.distribution.flux());

    let file = read("c0-c180.ldt");
    assert_eq!((file.lamp_flux, file.stated_flux), (None, Some(3120.5)));
    assert_eq!((file.watts, file.color_temperature), (Some(25.5), Some(4000.0)));

    let file = read("c90-c270-commas.ldt");
    let opening = Opening::Solid { outline: Outline::Rectangle, length: 0.6, width: 0.6, height: 0.015 };
    assert_eq!((file.opening, file.stated_flux), (opening, Some(2850.0)));
    assert!(file.warnings.len() == 1 && file.warnings[0].contains("luminous heights"), "{:?}", file.warnings);

    let file = read("quadrant.ldt");
    assert_eq!((file.opening, file.color_temperature), (Opening::Point, None));
    assert!(file.warnings[0].contains("no luminous area"), "{:?}", file.warnings);
}

#[test]
fn tilt_factors_are_read_from_the_file_and_from_its_folder() {
    let tilt = read("quadrant-tilt-1991.ies").tilt.unwrap();
    assert_eq!((tilt.geometry, tilt.factor(0.0), tilt.factor(60.0)), (LampGeometry::Vertical, 1.0, 0.9));
    let file = read("globe-1995.ies");
    let tilt = file.tilt.unwrap();
    assert_eq!((tilt.geometry, tilt.factor(45.0)), (LampGeometry::HorizontalFixed, 0.97));
    assert_eq!(file.opening, Opening::Ellipsoid { length: 0.3, width: 0.3, height: 0.3 });

    // Without its folder, the same file has a warning.
    let bytes = std::fs::read(path("globe-1995.ies")).unwrap();
    let file = Photometry::parse(&bytes).unwrap();
    assert!(file.tilt.is_none() && file.warnings[0].contains("tilts\\lamp.tlt"), "{:?}", file.warnings);
    let table = |name: &str| {
        assert_eq!(name, "tilts\\lamp.tlt");
        Ok(b"3 2 0 90 1 .5".to_vec())
    };
    let file = Photometry::parse_with(&bytes, PhotometryOptions::default(), table).unwrap();
    assert_eq!(file.tilt.unwrap().factor(45.0), 0.75);
}

#[test]
fn a_set_of_lamps_can_be_chosen() {
    let file = read("rotational.ldt");
    assert_eq!((file.lamp_flux, file.watts), (Some(4000.0), Some(36.0)));
    assert_eq!(file.opening, Opening::Flat { outline: Outline::Ellipse, length: 0.2, width: 0.2 });
    assert_eq!(file.warnings, ["The set of lamps 1 of 2 is used; others are: 2 × TC-D 26 W, 3600 lm."]);

    let second = Photometry::read_with(&path("rotational.ldt"), PhotometryOptions { lamp_set: 1 }).unwrap();
    assert_eq!((second.lamp_flux, second.watts), (Some(3600.0), Some(60.0)));
    assert!((second.distribution.flux() / file.distribution.flux() - 0.9).abs() < 1e-12);

    let third = PhotometryOptions { lamp_set: 2 };
    let error = Photometry::read_with(&path("rotational.ldt"), third).unwrap_err().to_string();
    assert!(
        error.contains("rotational.ldt: the file has 2 sets of lamps, but set 3 was asked for"),
        "{error}"
    );
}

#[test]
fn encodings_do_not_matter() {
    for name in ["half-2002.ies", "full.ldt"] {
        let text = std::fs::read_to_string(path(name)).unwrap();
        let expected = read(name);
        let wide: Vec<u8> =
            [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
        let marked = [b"\xef\xbb\xbf", text.as_bytes()].concat();
        let plain = text.replace("\r\n", "\n");
        let others =
            [plain.replace('\n', "\r"), plain.replace('\n', "\r\n"), format!("{plain}\u{1a}"), plain];
        for bytes in others.map(String::into_bytes).into_iter().chain([wide, marked]) {
            assert_eq!(Photometry::parse(&bytes).unwrap(), expected, "{name}");
        }
    }
}
