//! Samples against their density.

use glam::DVec3;
use sir_photometry::{Coordinates, IntensityDistribution};

use crate::lamps::Dice;

/// Number of samples of a test.
const SAMPLES: u32 = 200_000;

/// Quantile of the normal distribution: a correct sampler fails one test in 10⁹.
const QUANTILE: f64 = 6.0;

/// Number of parts of each cell of the table in each angle.
const PARTS: usize = 3;

/// Table whose intensity is given by its values.
struct Table {
    coordinates: Coordinates,
    azimuths: Vec<f64>,
    polars: Vec<f64>,
    values: Vec<f64>,
}

impl Table {
    fn distribution(&self) -> IntensityDistribution {
        let Self { coordinates, azimuths, polars, values } = self;
        IntensityDistribution::new(*coordinates, azimuths, polars, values).unwrap()
    }

    /// Returns the azimuth and the polar angle \[°\] of a direction, from the definitions of the types.
    fn angles(&self, d: DVec3) -> [f64; 2] {
        let (azimuth, polar) = match self.coordinates {
            Coordinates::C => (d.y.atan2(d.x), (-d.z).acos()),
            Coordinates::CAcross => (d.x.atan2(-d.y), (-d.z).acos()),
            Coordinates::B => (d.x.atan2(-d.z), d.y.acos()),
            Coordinates::A => ((-d.y).atan2(d.x), (-d.z).acos()),
        };
        let first = self.azimuths[0];
        [first + (azimuth.to_degrees() - first).rem_euclid(360.0), polar.to_degrees()]
    }

    /// Compares counts of samples in parts of cells with their fluxes (chi-square).
    fn check(&self, seed: u64) {
        let distribution = self.distribution();
        let [azimuths, polars] = [&self.azimuths, &self.polars].map(|angles| divided(angles));
        let parts = polars.len() - 1;
        let mut counts = vec![0u32; (azimuths.len() - 1) * parts];
        let mut dice = Dice(seed);
        for _ in 0..SAMPLES {
            let direction = distribution.sample([dice.next(), dice.next()]);
            assert!((direction.length() - 1.0).abs() < 1e-12, "{direction}");
            let [azimuth, polar] = self.angles(direction);
            let place = |angles: &[f64], angle: f64| {
                angles.partition_point(|&other| other <= angle).clamp(1, angles.len() - 1) - 1
            };
            counts[place(&azimuths, azimuth) * parts + place(&polars, polar)] += 1;
        }
        let (mut chi, mut cells) = (0.0, 0);
        let mut sum = 0.0;
        for (i, count) in counts.iter().enumerate() {
            let share = self.flux([i / parts, i % parts], &azimuths, &polars) / distribution.flux();
            let expected = share * f64::from(SAMPLES);
            sum += share;
            if share == 0.0 {
                assert_eq!(*count, 0, "{:?}: samples in the dark", self.coordinates);
            } else if expected > 10.0 {
                chi += (f64::from(*count) - expected).powi(2) / expected;
                cells += 1;
            }
        }
        assert!((sum - 1.0).abs() < 1e-7, "the parts have {sum} of the flux");
        // Wilson and Hilferty (1931).
        let freedom = f64::from(cells - 1);
        let spread = 2.0 / (9.0 * freedom);
        let limit = freedom * (1.0 - spread + QUANTILE * spread.sqrt()).powi(3);
        assert!(chi < limit, "{:?}: chi-square {chi} of {freedom} degrees, limit {limit}", self.coordinates);
    }

    /// Returns the flux of a part of a cell, by Gauss's rule with three points in each angle.
    fn flux(&self, [i, k]: [usize; 2], azimuths: &[f64], polars: &[f64]) -> f64 {
        let nodes = [(-0.6f64.sqrt(), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6f64.sqrt(), 5.0 / 18.0)];
        let at = |angles: &[f64], i: usize, node: f64| {
            0.5 * (angles[i] + angles[i + 1] + node * (angles[i + 1] - angles[i]))
        };
        let area = (azimuths[i + 1] - azimuths[i]).to_radians() * (polars[k + 1] - polars[k]).to_radians();
        let mut flux = 0.0;
        for (node, weight) in nodes {
            for (other, factor) in nodes {
                let (azimuth, polar) = (at(azimuths, i, node), at(polars, k, other));
                flux += weight
                    * factor
                    * self.value(i / PARTS, k / PARTS, azimuth, polar)
                    * polar.to_radians().sin();
            }
        }
        flux * area
    }

    /// Returns the interpolated value in a cell.
    fn value(&self, i: usize, k: usize, azimuth: f64, polar: f64) -> f64 {
        let share = |angles: &[f64], i: usize, angle: f64| (angle - angles[i]) / (angles[i + 1] - angles[i]);
        let (s, t) = (share(&self.azimuths, i, azimuth), share(&self.polars, k, polar));
        let n = self.polars.len();
        let along = |plane: usize| {
            let [low, high] = [0, 1].map(|next| self.values[plane * n + k + next]);
            low + t * (high - low)
        };
        along(i) + s * (along(i + 1) - along(i))
    }
}

/// Returns angles with [`PARTS`] steps in place of each.
fn divided(angles: &[f64]) -> Vec<f64> {
    let mut all = vec![angles[0]];
    for pair in angles.windows(2) {
        all.extend((1..=PARTS).map(|i| pair[0] + (pair[1] - pair[0]) * i as f64 / PARTS as f64));
    }
    all
}

const SYSTEMS: [Coordinates; 4] = [Coordinates::C, Coordinates::CAcross, Coordinates::B, Coordinates::A];

#[test]
fn samples_have_the_density_of_the_table() {
    for (seed, coordinates) in (1..).zip(SYSTEMS) {
        let values =
            [3.0, 5.0, 1.0, 0.5, 3.0, 0.0, 8.0, 0.5, 3.0, 2.0, 2.0, 0.5, 3.0, 5.0, 1.0, 0.5].to_vec();
        let (azimuths, polars) = (vec![0.0, 100.0, 220.0, 360.0], vec![0.0, 40.0, 100.0, 180.0]);
        Table { coordinates, azimuths, polars, values }.check(seed);
    }
}

#[test]
fn samples_stay_in_partial_tables_and_out_of_dark_parts() {
    for (seed, coordinates) in (11..).zip(SYSTEMS) {
        // Dark planes at both ends and in the middle; dark angles at both ends.
        let dark = [0.0; 5];
        let values =
            [dark, dark, [0.0, 0.0, 2.0, 0.0, 0.0], dark, dark, [0.0, 1.0, 4.0, 0.0, 0.0], dark, dark]
                .concat();
        let azimuths = vec![-120.0, -100.0, -60.0, -40.0, 0.0, 50.0, 90.0, 130.0];
        Table { coordinates, azimuths, polars: vec![10.0, 30.0, 60.0, 100.0, 150.0], values }.check(seed);
    }
}

#[test]
fn corners_of_the_square_are_valid_and_never_dark() {
    let dark = [0.0; 5];
    let values = [dark, [0.0, 0.0, 2.0, 0.0, 0.0], dark, dark].concat();
    let below = 1.0 - f64::EPSILON / 2.0;
    let tiny = f64::MIN_POSITIVE;
    for coordinates in SYSTEMS {
        let (azimuths, polars) = ([0.0, 90.0, 180.0, 300.0], [0.0, 45.0, 90.0, 135.0, 180.0]);
        let table = IntensityDistribution::new(coordinates, &azimuths, &polars, &values).unwrap();
        let table_of = Table {
            coordinates,
            azimuths: azimuths.to_vec(),
            polars: polars.to_vec(),
            values: values.clone(),
        };
        for u in [0.0, tiny, 1e-9, 0.5, 1.0 - 1e-9, below, 1.0] {
            for v in [0.0, tiny, 1e-9, 0.5, 1.0 - 1e-9, below, 1.0] {
                let direction = table.sample([u, v]);
                assert!((direction.length() - 1.0).abs() < 1e-12, "{coordinates:?} {u} {v}: {direction}");
                let [azimuth, polar] = table_of.angles(direction);
                let azimuth = if azimuth > 359.9 { azimuth - 360.0 } else { azimuth };
                let inside = (-1e-6..=180.0 + 1e-6).contains(&azimuth)
                    && (45.0 - 1e-6..=135.0 + 1e-6).contains(&polar);
                assert!(inside, "{coordinates:?} {u} {v}: {azimuth}° {polar}°");
            }
        }
    }
}

#[test]
fn samples_grow_with_their_coordinates() {
    let (azimuths, polars) = (vec![-90.0, -20.0, 90.0], vec![0.0, 50.0, 90.0]);
    let values = vec![1.0, 4.0, 0.0, 2.0, 2.0, 2.0, 9.0, 0.0, 1.0];
    let table = Table { coordinates: Coordinates::B, azimuths, polars, values };
    let distribution = table.distribution();
    let steps: Vec<f64> = (0..1000).map(|i| f64::from(i) / 1000.0).collect();
    for pair in steps.windows(2) {
        let azimuth = |u: f64| table.angles(distribution.sample([u, 0.5]))[0];
        let polar = |v: f64| table.angles(distribution.sample([0.3, v]))[1];
        assert!(azimuth(pair[0]) < azimuth(pair[1]) && polar(pair[0]) < polar(pair[1]), "{pair:?}");
    }
}
