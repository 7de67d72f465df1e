//! Tone mapping: from radiance to screen values.

use sir_geom::Rgb;

/// Value at which compression begins.
const SHOULDER: f64 = 0.5;

/// Rate at which compressed colors fade to white.
const DESATURATION: f64 = 0.1;

/// Maps linear colors, after exposure, to linear colors in `[0, 1]`.
///
/// The curve acts on the largest band `x` and scales the other bands with it, so colors keep their hue. It is `x` up to
/// `s = ½`, and above that `1 − (1 − s)²/(x + 1 − 2s)`, which continues smoothly and approaches 1 at infinity. Strongly
/// compressed colors fade to white. The form is that of the Khronos PBR neutral tone mapper (2024), with an earlier
/// shoulder, so that walls near lamps keep their shading, and without its offset for gloss.
#[must_use]
pub fn tone_map(color: Rgb) -> Rgb {
    let color = color.max(Rgb::ZERO);
    let peak = color.max_element();
    if peak <= SHOULDER {
        return color;
    }
    if !peak.is_finite() {
        return Rgb::ONE;
    }
    let compressed = 1.0 - (1.0 - SHOULDER) * (1.0 - SHOULDER) / (peak + 1.0 - 2.0 * SHOULDER);
    let kept = 1.0 / (1.0 + DESATURATION * (peak - compressed));
    Rgb::splat(compressed).lerp(color * (compressed / peak), kept)
}

/// Returns the sRGB code value in `[0, 1]` of a linear value (IEC 61966-2-1).
#[must_use]
pub fn srgb(linear: f64) -> f64 {
    let x = linear.clamp(0.0, 1.0);
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

pub(crate) fn rgb(bands: &[f32; 3]) -> Rgb {
    Rgb::from_array(bands.map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_rises_smoothly_and_keeps_hues() {
        let mut last = tone_map(Rgb::ZERO).x;
        for i in 1..4000 {
            let x = f64::from(i) * 0.005;
            let y = tone_map(Rgb::splat(x)).x;
            assert!(y > last && y - last <= 0.005 + 1e-12 && y < 1.0, "at {x}");
            last = y;
        }
        let orange = tone_map(Rgb::new(0.8, 0.4, 0.2));
        assert!(orange.x > orange.y && orange.y > orange.z && orange.max_element() < 0.8);
        assert_eq!(tone_map(Rgb::new(0.3, 0.2, 0.1)), Rgb::new(0.3, 0.2, 0.1));
        assert!(tone_map(Rgb::new(1e4, 1e3, 1e3)).min_element() > 0.98, "lamps are white");
        assert_eq!(tone_map(Rgb::splat(f64::INFINITY)), Rgb::ONE);
    }

    #[test]
    fn srgb_agrees_with_known_values() {
        for (linear, code) in [(0.0, 0.0), (0.214_041_14, 127.5), (1.0, 255.0), (0.002, 6.5892)] {
            assert!((srgb(linear) * 255.0 - code).abs() < 1e-3, "{linear}");
        }
    }
}
