//! Intensities at the points of a table, between them, at its poles and across its seam.

use glam::DVec3;
use sir_photometry::{Coordinates, IntensityDistribution, TableError};

use crate::lamps::{c_gamma, type_a, type_b, type_c};

/// Coordinate system, and its directions of an azimuth and a polar angle.
type System = (Coordinates, fn(f64, f64) -> DVec3);

const SYSTEMS: [System; 4] = [
    (Coordinates::C, |azimuth, polar| type_c(polar, azimuth)),
    (Coordinates::CAcross, |azimuth, polar| c_gamma(polar, azimuth)),
    (Coordinates::A, |azimuth, polar| type_a(polar - 90.0, azimuth)),
    (Coordinates::B, |azimuth, polar| type_b(azimuth, polar - 90.0)),
];

fn assert_near(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() < 1e-9, "{what}: {found}, not {expected}");
}

#[test]
fn values_are_found_at_and_between_points() {
    let (azimuths, polars) = ([-90.0, -30.0, 45.0, 90.0], [0.0, 20.0, 70.0, 180.0]);
    let values: Vec<f64> = (0..16).map(|i| f64::from((i * 7) % 11)).collect();
    for (coordinates, direction) in SYSTEMS {
        let table = IntensityDistribution::new(coordinates, &azimuths, &polars, &values).unwrap();
        for (i, azimuth) in azimuths.into_iter().enumerate() {
            for (k, polar) in polars.into_iter().enumerate().skip(1).take(2) {
                let what = format!("{coordinates:?} {azimuth} {polar}");
                assert_near(table.intensity(direction(azimuth, polar)), values[4 * i + k], &what);
                let Some(next) = azimuths.get(i + 1) else { continue };
                let middle = [4 * i + k, 4 * i + k + 1, 4 * i + k + 4, 4 * i + k + 5].map(|i| values[i]);
                let center = direction(0.5 * (azimuth + next), 0.5 * (polar + polars[k + 1]));
                assert_near(table.intensity(center), middle.iter().sum::<f64>() / 4.0, &what);
            }
        }
        for outside in [-170.0, -91.0, 91.0, 180.0] {
            assert_eq!(table.intensity(direction(outside, 50.0)), 0.0, "{coordinates:?} {outside}");
        }
    }
}

#[test]
fn poles_and_the_seam_belong_to_the_table() {
    let azimuths = [0.0, 90.0, 180.0, 270.0, 360.0];
    let values = [5.0, 1.0, 7.0, 5.0, 2.0, 7.0, 5.0, 3.0, 7.0, 5.0, 4.0, 7.0, 5.0, 1.0, 7.0];
    for (coordinates, direction) in SYSTEMS {
        let table = IntensityDistribution::new(coordinates, &azimuths, &[0.0, 90.0, 180.0], &values).unwrap();
        assert_near(table.intensity(direction(0.0, 0.0)), 5.0, "first pole");
        assert_near(table.intensity(direction(0.0, 180.0)), 7.0, "last pole");
        for (azimuth, value) in
            [(0.0, 1.0), (360.0, 1.0), (-1e-14, 1.0), (359.0, 1.0 + 3.0 / 90.0), (1.0, 1.0 + 1.0 / 90.0)]
        {
            assert_near(
                table.intensity(direction(azimuth, 90.0)),
                value,
                &format!("{coordinates:?} {azimuth}"),
            );
        }
        // Each axis, to the last bit.
        for axis in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z] {
            assert!(table.intensity(axis) > 0.0, "{coordinates:?} {axis}");
        }
    }
}

#[test]
fn edges_of_partial_tables_belong_to_them() {
    for (coordinates, direction) in SYSTEMS {
        for first in -180..180 {
            let azimuths = [0.0, 60.0, 120.0, 180.0].map(|turn| f64::from(first) + turn);
            let polars = [30.0, 60.0, 120.0];
            let table = IntensityDistribution::new(coordinates, &azimuths, &polars, &[3.0; 12]).unwrap();
            for azimuth in azimuths {
                for polar in polars {
                    let what = format!("{coordinates:?} {azimuth} {polar}");
                    assert_near(table.intensity(direction(azimuth, polar)), 3.0, &what);
                }
            }
        }
    }
}

#[test]
fn a_single_plane_is_rotated() {
    for (coordinates, direction) in SYSTEMS {
        let table = IntensityDistribution::new(coordinates, &[0.0], &[0.0, 90.0], &[8.0, 4.0]).unwrap();
        for azimuth in [0.0, 33.0, 180.0, 271.0] {
            assert_near(table.intensity(direction(azimuth, 45.0)), 6.0, &format!("{coordinates:?}"));
        }
    }
}

#[test]
fn invalid_tables_are_refused() {
    let table = |azimuths: &[f64], polars: &[f64], values: &[f64]| {
        IntensityDistribution::new(Coordinates::C, azimuths, polars, values).unwrap_err()
    };
    let size = |azimuths, polars, values| TableError::Size { azimuths, polars, values };
    assert_eq!(table(&[], &[0.0, 90.0], &[]), size(0, 2, 0));
    assert_eq!(table(&[0.0], &[0.0], &[1.0]), size(1, 1, 1));
    assert_eq!(table(&[0.0], &[0.0, 90.0], &[1.0]), size(1, 2, 1));
    assert_eq!(table(&[0.0], &[0.0, f64::NAN], &[1.0, 1.0]), TableError::NotFinite);
    assert_eq!(table(&[0.0], &[0.0, 90.0], &[1e308, 1e308]), TableError::NotFinite);
    assert_eq!(table(&[0.0], &[90.0, 0.0], &[1.0, 1.0]), TableError::Order);
    assert_eq!(table(&[0.0, 0.0], &[0.0, 90.0], &[1.0; 4]), TableError::Order);
    assert_eq!(table(&[0.0, 361.0], &[0.0, 90.0], &[1.0; 4]), TableError::Range);
    assert_eq!(table(&[0.0], &[-1.0, 90.0], &[1.0, 1.0]), TableError::Range);
    assert_eq!(table(&[0.0], &[0.0, 181.0], &[1.0, 1.0]), TableError::Range);
    assert_eq!(table(&[0.0], &[0.0, 90.0], &[1.0, -2.0]), TableError::Negative { value: -2.0 });
    assert_eq!(table(&[0.0], &[0.0, 90.0], &[0.0, 0.0]), TableError::Dark);
    assert!(IntensityDistribution::new(Coordinates::C, &[0.0], &[0.0, 180.000_000_1], &[1.0, 1.0]).is_ok());
}
