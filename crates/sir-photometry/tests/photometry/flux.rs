//! Fluxes against closed forms.

use std::f64::consts::PI;

use sir_photometry::{Coordinates, IntensityDistribution};

use crate::lamps::{Ies, Lamp, Ldt, angles, beam, cosine, lopsided, uniform};

/// Lamps, their fluxes \[lm\], and the largest relative error of tables with steps of 1°: h²/12 times the mean second
/// derivative over the mean intensity, and the kink of the lamps at the horizon, which is at a table point.
fn lamps() -> [(Lamp, f64, f64); 4] {
    [
        (cosine, 1000.0 * PI, 5e-5),
        (beam, 1000.0 * 2.0 * PI / 11.0, 5e-4),
        (uniform, 400.0 * PI, 1e-12),
        (lopsided, 400.0 * PI * (1.5 * 1.5 + 0.7 / 3.0), 5e-5),
    ]
}

fn assert_flux(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found / expected - 1.0).abs() < tolerance, "{what}: {found} lm, not {expected} lm");
}

#[test]
fn fluxes_are_those_of_closed_forms() {
    let full = angles(0.0, 180.0, 1.0);
    for (lamp, expected, tolerance) in lamps() {
        let ies = Ies::new(1, full.clone(), angles(0.0, 360.0, 1.0)).read(lamp);
        assert_flux(ies.distribution.flux(), expected, tolerance + 1e-9, "type C");
        let ldt = Ldt::new(0, 1.0, full.clone()).read(lamp);
        assert_flux(ldt.distribution.flux(), expected, tolerance + 1e-9, "EULUMDAT");
        assert_eq!(ldt.stated_flux, Some(1000.0));
        // The angle to the aim is none of the angles of types A and B.
        let all = angles(-180.0, 180.0, 1.0);
        let half = angles(-90.0, 90.0, 1.0);
        let b = Ies::new(2, all.clone(), half.clone()).read(lamp);
        assert_flux(b.distribution.flux(), expected, 1e-3, "type B");
        let a = Ies::new(3, half, all).read(lamp);
        assert_flux(a.distribution.flux(), expected, 1e-3, "type A");
    }
}

#[test]
fn the_integral_of_a_linear_table_is_exact() {
    // I = I₀ (1 − 2θ/π): 2π I₀ ∫ (1 − 2θ/π) sin θ dθ = 2π I₀ (1 − 2/π).
    for coordinates in [Coordinates::C, Coordinates::CAcross, Coordinates::A, Coordinates::B] {
        let cone = IntensityDistribution::new(coordinates, &[0.0], &[0.0, 90.0], &[10.0, 0.0]).unwrap();
        assert_flux(cone.flux(), 20.0 * PI * (1.0 - 2.0 / PI), 1e-14, "cone");
        // I = I₀ φ/π in the lower half, for φ up to π: I₀ π/2.
        let wedge = [0.0, 0.0, 10.0, 10.0];
        let wedge = IntensityDistribution::new(coordinates, &[-90.0, 90.0], &[0.0, 90.0], &wedge).unwrap();
        assert_flux(wedge.flux(), 10.0 * PI / 2.0, 1e-14, "wedge");
    }
}

#[test]
fn the_numeric_integral_approaches_the_flux() {
    let file = Ies::new(1, angles(0.0, 180.0, 10.0), angles(0.0, 360.0, 15.0)).read(lopsided);
    let distribution = &file.distribution;
    for (step, tolerance) in [(15.0, 2e-3), (2.5, 1e-4), (0.625, 1e-5)] {
        assert_flux(distribution.integrate(step, |_| 1.0), distribution.flux(), tolerance, "integral");
    }
    // The illuminance of a plane below the lamp weighs with the cosine: for a Lambertian lamp I₀ 2π/3.
    let file = Ies::new(1, angles(0.0, 180.0, 1.0), vec![0.0]).read(cosine);
    let weighed = file.distribution.integrate(0.25, |d| -d.z);
    assert_flux(weighed, 2000.0 * PI / 3.0, 1e-4, "weighed integral");
    assert_flux(
        file.distribution.clone().scaled(0.25).flux(),
        0.25 * file.distribution.flux(),
        1e-15,
        "scaled",
    );
}

#[test]
fn stated_fluxes_follow_from_lamps_and_ratio() {
    let gammas = angles(0.0, 180.0, 1.0);
    // A lamp of 3,000 lm in a luminaire that lets 1000 π lm out.
    let mut ldt = Ldt::new(1, 90.0, gammas);
    ldt.lamps = vec![[2.0, 4000.0, 36.0], [1.0, 1500.0, 20.0]];
    ldt.output_ratio = 25.0 * PI;
    let file = ldt.read(cosine);
    assert_eq!(
        (file.lamp_flux, file.watts, file.color_temperature),
        (Some(4000.0), Some(36.0), Some(3000.0))
    );
    assert_flux(file.stated_flux.unwrap(), 1000.0 * PI, 1e-12, "stated");
    assert_flux(file.distribution.flux(), file.stated_flux.unwrap(), 5e-5, "integral");
    // The conversion factor belongs to the intensities in the file, not to the ratio.
    ldt.conversion = 1.25;
    let converted = ldt.read(cosine);
    assert_flux(converted.distribution.flux(), file.distribution.flux(), 1e-9, "converted");
    assert_eq!(converted.stated_flux, file.stated_flux);
}
