//! Color of the light of a luminaire, of which the file states the luminous flux.

use sir_geom::{Rgb, luminance};

/// Returns a color of luminance 1 in linear Rec. 709 RGB; `None` if it has no luminance.
pub(crate) fn of_unit_luminance(color: Rgb) -> Option<Rgb> {
    let y = luminance(color);
    (y > 0.0 && y.is_finite()).then(|| color / y)
}

/// Range of color temperatures \[K\].
pub(crate) const TEMPERATURES: std::ops::RangeInclusive<f64> = 1700.0..=25_000.0;

/// Returns the color of a black body at a temperature \[K\] in [`TEMPERATURES`], of luminance 1, relative to the white of
/// Rec. 709 (D65), which has about 6500 K.
///
/// The chromaticity is the cubic approximation of Kim et al. (2002; US patent 7024034). Colors outside of the gamut, below about
/// 1,900 K, lose what is negative.
pub(crate) fn of_black_body(temperature: f64) -> Rgb {
    let t = 1000.0 / temperature;
    let cubic = |[a, b, c, d]: [f64; 4], s: f64| ((a * s + b) * s + c) * s + d;
    let x = match temperature {
        ..=4000.0 => cubic([-0.266_123_9, -0.234_358_9, 0.877_695_6, 0.179_910], t),
        _ => cubic([-3.025_846_9, 2.107_037_9, 0.222_634_7, 0.240_390], t),
    };
    let y = match temperature {
        ..=2222.0 => cubic([-1.106_381_4, -1.348_110_2, 2.185_558_32, -0.202_196_83], x),
        ..=4000.0 => cubic([-0.954_947_6, -1.374_185_93, 2.091_370_15, -0.167_488_67], x),
        _ => cubic([3.081_758_0, -5.873_386_7, 3.751_129_97, -0.370_014_83], x),
    };
    let (xx, zz) = (x / y, (1.0 - x - y) / y);
    let rgb = Rgb::new(
        3.240_454_2 * xx - 1.537_138_5 - 0.498_531_4 * zz,
        -0.969_266_0 * xx + 1.876_010_8 + 0.041_556_0 * zz,
        0.055_643_4 * xx - 0.204_025_9 + 1.057_225_2 * zz,
    );
    let inside = rgb.max(Rgb::ZERO);
    inside / luminance(inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of the table of Charity (2001, *What color is a blackbody?*), which has eight bits per band.
    #[test]
    fn black_bodies_are_red_when_cool_and_blue_when_hot() {
        for (temperature, [r, b]) in
            [(1700.0, [2.9, 0.0]), (2700.0, [2.02, 0.19]), (6500.0, [1.03, 1.02]), (20_000.0, [0.72, 1.78])]
        {
            let color = of_black_body(temperature);
            assert!((luminance(color) - 1.0).abs() < 1e-12 && color.min_element() >= 0.0);
            assert!((color.x - r).abs() < 0.1 && (color.z - b).abs() < 0.1, "{temperature}: {color}");
        }
    }

    #[test]
    fn a_color_keeps_its_flux() {
        let color = of_unit_luminance(Rgb::new(3.0, 2.0, 1.0)).unwrap();
        assert!((luminance(color) - 1.0).abs() < 1e-12);
        assert_eq!(of_unit_luminance(Rgb::ZERO), None);
    }
}
