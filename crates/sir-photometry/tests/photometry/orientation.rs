//! The same lamp has the same intensity in all directions, whatever the format, the type and the symmetry of its file.

use glam::DVec3;
use sir_photometry::Photometry;

use crate::lamps::{
    Ies, Lamp, Ldt, angles, assert_same, cosine, lopsided, symmetric_in_both, symmetric_in_x, symmetric_in_y,
    uniform,
};

/// Share of the largest intensity by which tables with steps of 2° may differ: h²/8 times the second derivative, below 4 times
/// the largest intensity, is 6e-4.
const TOLERANCE: f64 = 6e-4;

fn full() -> Vec<f64> {
    angles(0.0, 180.0, 2.0)
}

fn half() -> Vec<f64> {
    angles(-90.0, 90.0, 2.0)
}

/// Forward, as type A reaches it with angles from −90 to 90°.
fn forward(d: DVec3) -> f64 {
    lopsided(d) * d.x.max(0.0)
}

/// The same, and symmetric in y.
fn forward_symmetric(d: DVec3) -> f64 {
    symmetric_in_y(d) * d.x.max(0.0)
}

/// Down, as type B reaches it with angles from −90 to 90°.
fn down(d: DVec3) -> f64 {
    lopsided(d) * (-d.z).max(0.0)
}

/// The same, and symmetric in y.
fn down_symmetric(d: DVec3) -> f64 {
    symmetric_in_y(d) * (-d.z).max(0.0)
}

#[test]
fn ies_and_eulumdat_agree_without_symmetry() {
    let ies = Ies::new(1, full(), angles(0.0, 360.0, 2.0)).read(lopsided);
    let ldt = Ldt::new(0, 2.0, full()).read(lopsided);
    assert_same(&ies, lopsided, TOLERANCE, "IES");
    assert_same(&ldt, lopsided, TOLERANCE, "EULUMDAT");
    assert!(ies.warnings.is_empty() && ldt.warnings.is_empty(), "{:?} {:?}", ies.warnings, ldt.warnings);
    // The tables have the same directions: IES 0° is C90.
    let mut dice = crate::lamps::Dice(2);
    for _ in 0..1000 {
        let direction = dice.direction();
        let [a, b] = [&ies, &ldt].map(|file| file.distribution.intensity(direction));
        assert!((a - b).abs() < 1e-6, "{a} and {b} at {direction}");
    }
}

#[test]
fn symmetries_of_type_c_repeat_the_planes() {
    let cases: [(Lamp, f64, f64); 7] = [
        (cosine, 0.0, 0.0),
        (uniform, 0.0, 0.0),
        (symmetric_in_both, 0.0, 90.0),
        (symmetric_in_y, 0.0, 180.0),
        (symmetric_in_x, 90.0, 270.0),
        (symmetric_in_x, -90.0, 90.0),
        (lopsided, -180.0, 180.0),
    ];
    for (lamp, from, to) in cases {
        let file = Ies::new(1, full(), angles(from, to, 2.0)).read(lamp);
        assert_same(&file, lamp, TOLERANCE, &format!("{from} to {to}"));
        assert_eq!(file.format, "IES LM-63-2002 type C");
    }
}

#[test]
fn symmetries_of_eulumdat_repeat_the_planes() {
    // C0 is along −y, and C90 along +x.
    let cases: [(u8, Lamp); 7] = [
        (0, lopsided),
        (1, cosine),
        (1, uniform),
        (2, symmetric_in_x),
        (3, symmetric_in_y),
        (4, symmetric_in_both),
        (0, symmetric_in_both),
    ];
    for (symmetry, lamp) in cases {
        let file = Ldt::new(symmetry, 2.0, full()).read(lamp);
        assert_same(&file, lamp, TOLERANCE, &format!("Isym {symmetry}"));
        assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    }
}

#[test]
fn types_a_and_b_agree_with_type_c() {
    let cases: [(u8, &str, Lamp, Lamp); 2] = [
        (2, "IES LM-63-2002 type B", down, down_symmetric),
        (3, "IES LM-63-2002 type A", forward, forward_symmetric),
    ];
    for (kind, name, lamp, symmetric) in cases {
        let c = Ies::new(1, full(), angles(0.0, 360.0, 2.0)).read(lamp);
        assert_same(&c, lamp, 2e-3, "type C");
        let file = Ies::new(kind, half(), half()).read(lamp);
        assert_same(&file, lamp, 2e-3, name);
        assert_eq!(file.format, name);
        assert!(file.warnings.is_empty(), "{:?}", file.warnings);
        let file = Ies::new(kind, half(), angles(0.0, 90.0, 2.0)).read(symmetric);
        assert_same(&file, symmetric, 2e-3, name);
    }
    // The photometric zero of type B is straight down, as that of type C; the beam of type A is horizontal.
    let file = Ies::new(2, half(), half()).read(down);
    assert!(file.distribution.intensity(-DVec3::Z) > 0.0 && file.distribution.intensity(DVec3::Z) == 0.0);
    let file = Ies::new(3, half(), half()).read(forward);
    assert!(file.distribution.intensity(DVec3::X) > 0.0 && file.distribution.intensity(-DVec3::X) == 0.0);
    // All directions.
    let file = Ies::new(2, angles(-180.0, 180.0, 2.0), half()).read(lopsided);
    assert_same(&file, lopsided, TOLERANCE, "all of type B");
    let file = Ies::new(3, half(), angles(-180.0, 180.0, 2.0)).read(lopsided);
    assert_same(&file, lopsided, TOLERANCE, "all of type A");
}

#[test]
fn planes_at_irregular_angles_are_interpolated() {
    let planes = vec![0.0, 10.0, 15.0, 40.0, 60.0, 90.0];
    let around = |step: f64| angles(0.0, 360.0 - step, step);
    let mut ldt = Ldt::new(0, 5.0, angles(0.0, 180.0, 5.0));
    ldt.planes = planes.iter().copied().chain(angles(100.0, 350.0, 10.0)).collect();
    ldt.measured = ldt.planes.clone();
    assert_same(&ldt.read(lopsided), lopsided, 0.03, "irregular planes");
    ldt.planes = around(5.0);
    ldt.measured = around(5.0);
    ldt.gammas = [0.0, 3.0, 7.0].into_iter().chain(angles(10.0, 180.0, 5.0)).collect();
    assert_same(&ldt.read(lopsided), lopsided, 6e-3, "irregular angles γ");
    let mut ies = Ies::new(1, ldt.gammas, planes);
    assert_same(&ies.read(symmetric_in_both), symmetric_in_both, 0.03, "irregular angles of IES");
    ies.horizontal = angles(0.0, 90.0, 90.0);
    assert!(ies.read(symmetric_in_both).distribution.flux() > 0.0);
}

#[test]
fn tables_that_stop_short_of_the_circle_are_closed() {
    let mut ies = Ies::new(1, full(), angles(0.0, 345.0, 15.0));
    let closed = ies.read(lopsided);
    ies.horizontal = angles(0.0, 360.0, 15.0);
    let full_turn = ies.read(lopsided);
    assert_eq!(closed.distribution, full_turn.distribution);
    assert!(closed.warnings[0].contains("end at 345°"), "{:?}", closed.warnings);
    // Half a turn and more, but far from a full turn: the rest is dark.
    ies.horizontal = angles(0.0, 270.0, 15.0);
    let partial = ies.read(lopsided);
    assert!(partial.warnings[0].contains("no light between"), "{:?}", partial.warnings);
    assert_eq!(partial.distribution.intensity(DVec3::new(0.6, -0.6, -0.5).normalize()), 0.0);
    assert!(partial.distribution.flux() < 0.8 * full_turn.distribution.flux());
}

#[test]
fn a_last_plane_at_a_full_turn_is_not_repeated() {
    let mut ldt = Ldt::new(0, 15.0, full());
    let expected = ldt.read(lopsided).distribution;
    for last in [360.0, 359.99] {
        ldt.planes.push(last);
        ldt.measured = angles(0.0, 360.0, 15.0);
        let file = ldt.read(lopsided);
        assert!((file.distribution.flux() / expected.flux() - 1.0).abs() < 1e-9, "{last}");
        assert!(file.distribution.intensity(crate::lamps::c_gamma(90.0, 359.995)) > 0.0);
        ldt.planes.pop();
    }
    let mut ies = Ies::new(1, full(), angles(0.0, 360.0, 15.0));
    ies.horizontal[24] = 359.99;
    assert!(ies.read(lopsided).distribution.intensity(crate::lamps::type_c(90.0, 359.995)) > 0.0);
    // Horizontal angles of type A around the axis.
    let file = Ies::new(3, half(), angles(0.0, 360.0, 2.0)).read(lopsided);
    assert_same(&file, lopsided, TOLERANCE, "type A");
}

#[test]
fn steps_replace_angles_that_do_not_ascend() {
    let text = Ldt::new(4, 30.0, angles(0.0, 180.0, 10.0)).text(symmetric_in_both);
    let mut lines: Vec<&str> = text.lines().collect();
    (lines[4], lines[6]) = ("30", "10");
    // Twelve planes and 19 angles begin in line 43.
    lines[42..42 + 12 + 19].fill("0");
    let file = Photometry::parse(lines.join("\n").as_bytes()).unwrap();
    assert_same(&file, symmetric_in_both, 0.05, "steps");
    assert_eq!(file.warnings.len(), 2, "{:?}", file.warnings);
}

#[test]
fn a_partial_table_is_dark_elsewhere() {
    let file = Ies::new(2, angles(-30.0, 30.0, 2.0), angles(0.0, 40.0, 2.0)).read(down_symmetric);
    assert_eq!(file.warnings.len(), 2, "{:?}", file.warnings);
    let at = |v: f64, h: f64| file.distribution.intensity(crate::lamps::type_b(v, h));
    assert!(at(30.0, 40.0) > 0.0 && at(30.0, -40.0) > 0.0);
    assert!(at(30.1, 0.0) == 0.0 && at(-30.1, 0.0) == 0.0 && at(10.0, 40.1) == 0.0 && at(10.0, -40.1) == 0.0);
}

#[test]
fn the_length_is_along_x_in_both_formats() {
    // A tube along x is brightest across it.
    fn tube(d: DVec3) -> f64 {
        100.0 * (1.0 - d.x * d.x).sqrt()
    }
    let mut ies = Ies::new(1, full(), angles(0.0, 90.0, 2.0));
    ies.opening = "2 0 1.2 -0.03";
    let mut ldt = Ldt::new(4, 2.0, full());
    ldt.area = [1200.0, 30.0, 0.0, 0.0, 0.0, 0.0];
    for file in [ies.read(tube), ldt.read(tube)] {
        let intensity = |d: DVec3| file.distribution.intensity(d);
        assert!(intensity(DVec3::X) < 1e-6 && (intensity(DVec3::Y) - 100.0).abs() < 1e-6, "{}", file.format);
        let length = match file.opening {
            sir_photometry::Opening::Tube { length, .. } | sir_photometry::Opening::Flat { length, .. } => {
                length
            }
            other => panic!("{other:?}"),
        };
        assert_eq!(length, 1.2);
    }
}

#[test]
fn the_format_follows_from_the_contents() {
    let folder = tempfile::tempdir().unwrap();
    let (ies, ldt) = (folder.path().join("a.ldt"), folder.path().join("a.ies"));
    std::fs::write(&ies, Ies::new(1, full(), vec![0.0]).text(cosine)).unwrap();
    std::fs::write(&ldt, Ldt::new(1, 90.0, full()).text(cosine)).unwrap();
    assert_eq!(Photometry::read(&ies).unwrap().format, "IES LM-63-2002 type C");
    assert_eq!(Photometry::read(&ldt).unwrap().format, "EULUMDAT");
}
