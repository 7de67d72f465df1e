//! From radiance to what a screen can show.

use sir_geom::{Rgb, luminance};

use crate::display::DisplayMesh;
use crate::picture::Picture;

/// How bright a picture is made.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Exposure {
    /// So that the typical brightness of what is seen, lamps apart, becomes a middle grey.
    #[default]
    Auto,
    /// Radiance \[W/(m² sr)\] times this factor is the linear value on the screen, as long as that is below one
    /// half; brighter values are compressed, see [`tone_map`].
    Factor(f64),
}

/// The linear value that the typical radiance gets: a little more than the photographer's grey card (0.18),
/// because walls are brighter than that.
const MIDDLE: f64 = 0.26;

/// How much a pixel that shows only sky counts beside one that shows a surface.
const SKY_WEIGHT: f64 = 1e-4;

impl Exposure {
    /// The factor for a picture.
    ///
    /// Automatically, it comes from the logarithmic mean of the luminance (as in Reinhard et al. 2002, section 3.1) of
    /// the pixels that are neither black nor more than ten times as bright as the median, which leaves out lamps. Sky hardly
    /// counts, unless there is nothing else.
    #[must_use]
    pub fn factor_for_picture(self, picture: &Picture) -> f64 {
        let weighed = picture.radiance.iter().zip(&picture.surface);
        self.factor(|| {
            weighed.map(|(p, &surface)| (luminance(rgb(p)), f64::from(surface).max(SKY_WEIGHT))).collect()
        })
    }

    /// The factor for a mesh: likewise, of the radiance of all triangles, each weighed by the light that falls on it. So the outer sides
    /// of a room and what is hidden in its furniture do not count, and lamps not much.
    #[must_use]
    pub fn factor_for_mesh(self, display: &DisplayMesh<'_>) -> f64 {
        self.factor(|| {
            let mut samples = Vec::with_capacity(display.triangles().len());
            for piece in display.pieces() {
                for t in piece.triangles {
                    let v = t.map(|i| display.vertices()[i as usize]);
                    let [a, b, c] = v.map(|v| display.positions()[v.position as usize]);
                    let e = v.iter().map(|v| rgb(&v.irradiance)).sum::<Rgb>() / 3.0;
                    let radiance = display.radiosity_of(&piece, e) / std::f64::consts::PI;
                    samples.push((luminance(radiance), luminance(e) * (b - a).cross(c - a).length()));
                }
            }
            samples
        })
    }

    fn factor(self, samples: impl FnOnce() -> Vec<(f64, f64)>) -> f64 {
        match self {
            Self::Factor(factor) => factor,
            Self::Auto => typical(samples()).map_or(1.0, |typical| MIDDLE / typical),
        }
    }
}

/// The logarithmic mean of weighted values, zeros and those above ten times the median left out.
fn typical(mut samples: Vec<(f64, f64)>) -> Option<f64> {
    samples.retain(|&(value, weight)| value.is_finite() && value > 0.0 && weight > 0.0);
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = samples.iter().map(|s| s.1).sum();
    let mut below = 0.0;
    let median = samples.iter().find(|s| {
        below += s.1;
        below >= 0.5 * total
    })?;
    let limit = 10.0 * median.0;
    let (sum, weight) = samples
        .iter()
        .take_while(|s| s.0 <= limit)
        .fold((0.0, 0.0), |(sum, weight), s| (sum + s.1 * s.0.ln(), weight + s.1));
    Some((sum / weight).exp())
}

/// Where compression begins.
const SHOULDER: f64 = 0.5;

/// How fast compressed colours fade to white.
const FADING: f64 = 0.1;

/// Maps linear colours, exposure applied, to linear colours in `[0, 1]`.
///
/// The curve acts on the largest band `x` and scales the others with it, so colours keep their hue: it is `x` up
/// to `s = ½`, and above that `1 − (1 − s)²/(x + 1 − 2s)`, which goes on smoothly and reaches 1 at infinity. Colours
/// that are compressed much fade to white. The form is that of the Khronos PBR neutral tone mapper (2024), with an
/// earlier shoulder, so that walls near lamps keep their shading, and without its offset for gloss.
#[must_use]
pub fn tone_map(colour: Rgb) -> Rgb {
    let colour = colour.max(Rgb::ZERO);
    let peak = colour.max_element();
    if peak <= SHOULDER {
        return colour;
    }
    if !peak.is_finite() {
        return Rgb::ONE;
    }
    let compressed = 1.0 - (1.0 - SHOULDER) * (1.0 - SHOULDER) / (peak + 1.0 - 2.0 * SHOULDER);
    let kept = 1.0 / (1.0 + FADING * (peak - compressed));
    Rgb::splat(compressed).lerp(colour * (compressed / peak), kept)
}

/// The sRGB code value in `[0, 1]` of a linear value (IEC 61966-2-1).
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
    fn lamps_and_black_do_not_change_the_automatic_exposure() {
        let picture = |lamp: usize, black: usize| {
            let rest = 100 - lamp - black;
            let radiance = [vec![[500.0; 3]; lamp], vec![[0.0; 3]; black], vec![[2.0; 3]; rest]].concat();
            Picture { width: 100, height: 1, shown: radiance.clone(), radiance, surface: vec![1.0; 100] }
        };
        let plain = Exposure::Auto.factor_for_picture(&picture(0, 0));
        assert!((plain * 2.0 / MIDDLE - 1.0).abs() < 1e-12);
        let with = Exposure::Auto.factor_for_picture(&picture(20, 30));
        assert!((with / plain - 1.0).abs() < 1e-12);
        assert_eq!(Exposure::Auto.factor_for_picture(&picture(0, 100)), 1.0);
        let mut sky = picture(60, 0);
        sky.surface[..60].fill(0.0);
        let with = Exposure::Auto.factor_for_picture(&sky);
        assert!((with / plain - 1.0).abs() < 1e-2, "{with}");
        sky.surface.fill(0.0);
        assert!(Exposure::Auto.factor_for_picture(&sky) < 0.1 * plain, "nothing but sky");
    }

    #[test]
    fn srgb_agrees_with_known_values() {
        for (linear, code) in [(0.0, 0.0), (0.214_041_14, 127.5), (1.0, 255.0), (0.002, 6.5892)] {
            assert!((srgb(linear) * 255.0 - code).abs() < 1e-3, "{linear}");
        }
    }
}
