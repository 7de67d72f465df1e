//! Mistakes that readers of other programs have made.

use glam::DVec3;

use crate::lamps::{Ies, Ldt, angles, assert_same, beam, cosine, lopsided, symmetric_in_both, type_b};

#[test]
fn factors_are_applied_once() {
    for (header, factors, applied) in [
        ("", [2.0, 0.9, 0.8], 0.8),
        ("IESNA91\n", [2.0, 0.9, 0.8], 0.8),
        ("IESNA:LM-63-1995\n", [2.0, 0.9, 0.8], 1.0),
        ("IESNA:LM-63-2002\n", [0.5, 1.1, 1.0], 1.0),
        ("IES:LM-63-2019\n", [0.5, 1.1, 1.00001], 1.0),
    ] {
        let mut ies = Ies::new(1, angles(0.0, 90.0, 1.0), vec![0.0]);
        (ies.header, ies.factors) = (header, factors);
        let file = ies.read(cosine);
        let largest = file.distribution.largest();
        assert!((largest - 1000.0 * applied).abs() < 1e-6, "{header}: {largest}");
        let ignored = usize::from(header.contains("1995"));
        assert_eq!(file.warnings.len(), ignored, "{:?}", file.warnings);
    }
}

#[test]
fn intensities_are_not_squared() {
    let file = Ies::new(1, angles(0.0, 180.0, 1.0), vec![0.0]).read(beam);
    let at_30 = file.distribution.intensity(DVec3::new(0.5, 0.0, -0.75f64.sqrt()));
    assert!((at_30 / beam(DVec3::new(0.5, 0.0, -0.75f64.sqrt())) - 1.0).abs() < 1e-6, "{at_30}");
}

#[test]
fn horizontal_angles_are_not_dropped() {
    let file = Ies::new(1, angles(0.0, 180.0, 2.0), angles(0.0, 90.0, 2.0)).read(symmetric_in_both);
    let [x, y] = [DVec3::X, DVec3::Y].map(|d| file.distribution.intensity(d));
    assert!(
        (x - symmetric_in_both(DVec3::X)).abs() < 1e-6 && (y - symmetric_in_both(DVec3::Y)).abs() < 1e-6,
        "{x} {y}"
    );
    assert!((x - y).abs() > 50.0, "{x} {y}");
}

#[test]
fn the_azimuth_survives_a_rotation() {
    // A luminaire whose aim is turned to +x and whose length to +y.
    let file = Ies::new(1, angles(0.0, 180.0, 2.0), angles(0.0, 360.0, 2.0)).read(lopsided);
    let turn = glam::DMat3::from_cols(DVec3::Y, DVec3::NEG_Z, DVec3::NEG_X);
    assert!((turn.determinant() - 1.0).abs() < 1e-15 && turn * DVec3::NEG_Z == DVec3::X);
    for d in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.6, 0.0, 0.8)] {
        let found = file.distribution.intensity(turn.transpose() * d);
        let expected = lopsided(DVec3::new(d.y, -d.z, -d.x));
        assert!((found - expected).abs() < 0.2, "{d}: {found}, not {expected}");
    }
}

#[test]
fn the_aim_is_minus_z() {
    let [ies, ldt] = [
        Ies::new(1, angles(0.0, 90.0, 1.0), vec![0.0]).read(beam),
        Ldt::new(1, 90.0, angles(0.0, 90.0, 1.0)).read(beam),
    ];
    for file in [ies, ldt, Ies::new(2, angles(-90.0, 90.0, 1.0), angles(-90.0, 90.0, 1.0)).read(beam)] {
        let intensity = |d: DVec3| file.distribution.intensity(d);
        assert!((intensity(DVec3::NEG_Z) - 1000.0).abs() < 1e-6, "{}", file.format);
        assert_eq!([DVec3::Y, DVec3::NEG_Y, DVec3::Z].map(intensity), [0.0; 3], "{}", file.format);
    }
}

#[test]
fn a_single_horizontal_angle_is_all_of_them() {
    for angle in [0.0, 90.0] {
        let file = Ies::new(1, angles(0.0, 180.0, 1.0), vec![angle]).read(cosine);
        assert_same(&file, cosine, 1e-3, "one plane");
    }
}

#[test]
fn c0_is_not_turned() {
    // Bright along the luminaire: 0° of IES, C90 of EULUMDAT.
    fn along(d: DVec3) -> f64 {
        100.0 * d.x * d.x
    }
    let ies = Ies::new(1, angles(0.0, 180.0, 1.0), angles(0.0, 90.0, 1.0)).text(along);
    let plane = ies.lines().nth(8).unwrap();
    assert!(plane.split(' ').nth(90).unwrap().starts_with("100.0"), "{plane}");
    let ldt = Ldt::new(4, 1.0, angles(0.0, 180.0, 1.0)).read(along);
    assert!((ldt.distribution.intensity(DVec3::X) - 100.0).abs() < 1e-6);
    assert!(ldt.distribution.intensity(DVec3::Y) < 1e-6);
}

#[test]
fn type_b_is_read_by_its_own_angles() {
    // A wide flat beam: ±60° horizontally, ±10° vertically.
    fn fan(d: DVec3) -> f64 {
        let (vertical, horizontal) = (d.x.atan2(-d.z).to_degrees(), (-d.y).asin().to_degrees());
        1000.0 * (1.0 - vertical.abs() / 10.0).max(0.0) * (1.0 - horizontal.abs() / 60.0).max(0.0)
    }
    let file = Ies::new(2, angles(-90.0, 90.0, 1.0), angles(-90.0, 90.0, 1.0)).read(fan);
    let at = |vertical: f64, horizontal: f64| file.distribution.intensity(type_b(vertical, horizontal));
    assert!((at(0.0, 30.0) - 500.0).abs() < 1e-6 && (at(5.0, 0.0) - 500.0).abs() < 1e-6);
    assert_eq!([at(30.0, 0.0), at(0.0, 70.0)], [0.0; 2]);
    assert!(file.distribution.intensity(DVec3::new(0.0, 0.5, -0.75f64.sqrt())) > 400.0);
    assert_eq!(file.distribution.intensity(DVec3::new(0.5, 0.0, -0.75f64.sqrt())), 0.0);
}
