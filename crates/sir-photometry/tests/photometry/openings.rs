//! Luminous openings of whole files.

use sir_photometry::{Along, Opening, Outline};

use crate::lamps::{Ies, Ldt, angles, cosine};

#[test]
fn openings_of_ies_are_in_meters() {
    let mut ies = Ies::new(1, angles(0.0, 90.0, 10.0), vec![0.0]);
    for (header, opening, expected) in [
        ("IESNA91\n", "1 -2 0 0", Opening::Flat { outline: Outline::Ellipse, length: 0.6096, width: 0.6096 }),
        (
            "IESNA91\n",
            "2 -2 0 1",
            Opening::Solid { outline: Outline::Ellipse, length: 2.0, width: 2.0, height: 1.0 },
        ),
        (
            "IESNA:LM-63-2002\n",
            "2 1 2 0",
            Opening::Flat { outline: Outline::Rectangle, length: 2.0, width: 1.0 },
        ),
        (
            "IESNA:LM-63-2002\n",
            "2 -.1 2 -.1",
            Opening::Tube { along: Along::Length, length: 2.0, width: 0.1, height: 0.1 },
        ),
        ("IESNA:LM-63-1995\n", "2 -.1 2 -.1", Opening::Ellipsoid { length: 2.0, width: 0.1, height: 0.1 }),
    ] {
        (ies.header, ies.opening) = (header, opening);
        assert_eq!(ies.read(cosine).opening, expected, "{header} {opening}");
    }
}

#[test]
fn openings_of_eulumdat_are_round_without_a_width() {
    let mut ldt = Ldt::new(1, 90.0, angles(0.0, 90.0, 10.0));
    let flat = |outline, length, width| Opening::Flat { outline, length, width };
    for (area, expected) in [
        ([300.0, 0.0, 0.0, 0.0, 0.0, 0.0], flat(Outline::Ellipse, 0.3, 0.3)),
        ([0.0, 300.0, 0.0, 0.0, 0.0, 0.0], flat(Outline::Ellipse, 0.3, 0.3)),
        ([1200.0, 300.0, 0.0, 0.0, 0.0, 0.0], flat(Outline::Rectangle, 1.2, 0.3)),
        (
            [300.0, 0.0, 50.0, 50.0, 50.0, 50.0],
            Opening::Solid { outline: Outline::Ellipse, length: 0.3, width: 0.3, height: 0.05 },
        ),
        ([0.0; 6], Opening::Point),
    ] {
        ldt.area = area;
        let file = ldt.read(cosine);
        assert_eq!((file.opening, file.warnings.len()), (expected, 0), "{area:?}");
    }
    ldt.area = [300.0, 200.0, 10.0, 20.0, 30.0, 40.0];
    let file = ldt.read(cosine);
    let solid = Opening::Solid { outline: Outline::Rectangle, length: 0.3, width: 0.2, height: 0.025 };
    assert_eq!((file.opening, file.warnings.len()), (solid, 1));
}
