//! Exposure: the factor from radiance to screen values.

use sir_geom::{Rgb, luminance};

use crate::display::DisplayMesh;
use crate::picture::Picture;
use crate::tone::rgb;

/// Exposure of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Exposure {
    /// Maps the typical luminance of what is seen, without lamps, to middle gray.
    #[default]
    Auto,
    /// Multiplies radiance \[W/(m² sr)\] by this factor to obtain the linear screen value. Values above one half are
    /// compressed, see [`tone_map`](crate::tone_map).
    Factor(f64),
}

/// Linear screen value of the typical radiance. It is a little above the photographer's gray card (0.18), because walls
/// are brighter than that.
const MIDDLE_GRAY: f64 = 0.26;

/// Weight of a pixel that shows only sky, relative to one that shows a surface.
const SKY_WEIGHT: f64 = 1e-4;

impl Exposure {
    /// Returns the factor for a picture.
    ///
    /// `Auto` takes the logarithmic mean of the luminance (as in Reinhard et al. 2002, section 3.1) over the pixels
    /// that are neither black nor more than ten times as bright as the median, which excludes lamps. Sky has almost no
    /// weight, unless there is nothing else.
    #[must_use]
    pub fn factor_for_picture(self, picture: &Picture) -> f64 {
        let weighed = picture.radiance.iter().zip(&picture.surface);
        self.factor(|| {
            weighed.map(|(p, &surface)| (luminance(rgb(p)), f64::from(surface).max(SKY_WEIGHT))).collect()
        })
    }

    /// Returns the factor for a mesh.
    ///
    /// `Auto` takes the same mean over the radiance of all triangles, each weighted by the light that falls on it. The
    /// outer sides of a room and surfaces hidden in its furniture therefore do not count, and lamps count little.
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
            Self::Auto => typical(samples()).map_or(1.0, |typical| MIDDLE_GRAY / typical),
        }
    }
}

/// Returns the logarithmic mean of pairs (value, weight), without zeros and values above ten times the median.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lamps_and_black_do_not_change_the_automatic_exposure() {
        let picture = |lamp: usize, black: usize| {
            let rest = 100 - lamp - black;
            let radiance = [vec![[500.0; 3]; lamp], vec![[0.0; 3]; black], vec![[2.0; 3]; rest]].concat();
            Picture { width: 100, height: 1, shown: radiance.clone(), radiance, surface: vec![1.0; 100] }
        };
        let plain = Exposure::Auto.factor_for_picture(&picture(0, 0));
        assert!((plain * 2.0 / MIDDLE_GRAY - 1.0).abs() < 1e-12);
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
}
