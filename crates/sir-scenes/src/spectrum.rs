//! Conversion of spectra to linear Rec. 709 RGB.

use sir_geom::Rgb;

/// Returns the wavelengths of all integrals \[nm\]: those at which the Cornell box was measured.
pub(crate) fn wavelengths() -> impl Iterator<Item = f64> {
    (0..76).map(|i| f64::from(400 + 4 * i))
}

/// Returns `∫ spectrum · r̄, ḡ, b̄ dλ` divided by the wavelength step, for a spectrum given at [`wavelengths`].
pub(crate) fn integrate(spectrum: impl Iterator<Item = f64>) -> Rgb {
    wavelengths().zip(spectrum).map(|(nm, value)| value * color_matching(nm)).sum()
}

/// Returns `∫ spectrum · ȳ dλ`, in the same unit as [`integrate`].
pub(crate) fn luminance(spectrum: impl Iterator<Item = f64>) -> f64 {
    wavelengths().zip(spectrum).map(|(nm, value)| value * observer(nm)[1]).sum()
}

/// Returns the color-matching functions of the three bands at a wavelength \[nm\].
///
/// They have negative lobes where a spectral color lies outside the gamut of the three primaries.
fn color_matching(nm: f64) -> Rgb {
    let [x, y, z] = observer(nm);
    // XYZ to linear Rec. 709 with white point D65 (IEC 61966-2-1 primaries, four digits).
    Rgb::new(
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    )
}

/// Returns the CIE 1931 standard observer `x̄, ȳ, z̄` at a wavelength \[nm\].
///
/// It is approximated by sums of piecewise Gaussian lobes (Wyman, Sloan and Shirley, Journal of Computer Graphics
/// Techniques 2 (2), 2013, table 1).
fn observer(nm: f64) -> [f64; 3] {
    let lobe = |height: f64, center: f64, below: f64, above: f64| {
        let t = (nm - center) * if nm < center { below } else { above };
        height * (-0.5 * t * t).exp()
    };
    [
        lobe(0.362, 442.0, 0.0624, 0.0374)
            + lobe(1.056, 599.8, 0.0264, 0.0323)
            + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    ]
}

/// Rounds to a multiple of `1 / per_unit`, so that the result does not depend on the last bits of the machine's `exp`.
pub(crate) fn round_to(value: Rgb, per_unit: f64) -> Rgb {
    (value * per_unit).round() / per_unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn observer_is_normalized_and_peaks_where_the_eye_does() {
        let [x, y, z] = [0, 1, 2].map(|i| 4.0 * wavelengths().map(|nm| observer(nm)[i]).sum::<f64>());
        // In the tables of the standard, each of the three functions sums to 106.9.
        for sum in [x, y, z] {
            assert!((sum - 106.9).abs() < 1.5, "{sum}");
        }
        let peak = wavelengths().max_by(|a, b| observer(*a)[1].total_cmp(&observer(*b)[1]));
        assert!(peak.is_some_and(|nm| (nm - 555.0).abs() <= 5.0), "{peak:?}");
    }

    #[test]
    fn equal_energy_is_slightly_reddish_under_d65() {
        let white = integrate(wavelengths().map(|_| 1.0)) / luminance(wavelengths().map(|_| 1.0));
        // Linear Rec. 709 of the chromaticity (1/3, 1/3) at Y = 1.
        assert!(white.abs_diff_eq(Rgb::new(1.205, 0.948, 0.909), 0.02), "{white}");
    }
}
