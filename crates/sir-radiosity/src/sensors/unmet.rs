//! Light that no ray of a sensor has met.
//!
//! The spread of the rays tells nothing about a small and bright surface that all of them miss. If none of `n` rays has
//! met it, its share of the view is probably at most about `1/(n + 2)` (Laplace's rule of succession), as for view
//! factors to which no line arrived. So a sensor may be wrong by the light of the brightest surfaces with this share of the
//! area, as far as it exceeds the brightest light that rays have met: a ray has the variance `∫ (B − B_met)² dA/A`. A
//! sensor is finished only if this error, too, is as small as requested; it is the error of a sensor whose rays do not
//! differ.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use sir_geom::{Rgb, luminance};

use crate::model::Model;
use crate::solution::Solution;

/// The brightest light so far: the maximum per band, and of the luminance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Peak {
    bands: Rgb,
    luminance: f64,
}

impl Peak {
    /// Raises the peak to a light, if that is brighter.
    pub(crate) fn raise(&mut self, light: Rgb) {
        self.bands = self.bands.max(light);
        self.luminance = self.luminance.max(luminance(light));
    }

    /// Returns the squares of what exceeds another peak, per band and of the luminance.
    fn excess(self, met: Self) -> Squares {
        let bands = (self.bands - met.bands).max(Rgb::ZERO);
        let excess = (self.luminance - met.luminance).max(0.0);
        Squares { bands: bands * bands, luminance: excess * excess }
    }
}

/// Squared errors, per band and of the luminance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Squares {
    pub(crate) bands: Rgb,
    pub(crate) luminance: f64,
}

impl Squares {
    /// Adds squared errors, multiplied by a factor.
    pub(super) fn add(&mut self, other: Self, factor: f64) {
        self.bands += other.bands * factor;
        self.luminance += other.luminance * factor;
    }
}

/// Surfaces of about the same brightness.
#[derive(Clone, Copy, Debug, Default)]
struct Class {
    brightest: Peak,
    /// Share of the area of all surfaces.
    share: f64,
}

/// Brightest light that rays have met, and that rays aimed at emitters have not met.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Extremes {
    /// Reflected light at the surfaces that were hit.
    pub(crate) reflected: Peak,
    /// Light of the sky, as irradiance by a sky of this radiance everywhere.
    pub(crate) sky: Peak,
    /// Contribution of a ray that arrived at the emitter at which it was aimed.
    pub(crate) arrived: Peak,
    /// Contribution that a ray would have had that was blocked on the way.
    pub(crate) blocked: Peak,
}

/// Brightness of everything in a scene that lights a sensor, except lights without a surface.
#[derive(Clone, Debug)]
pub(crate) struct Brightness {
    /// Distribution of the reflected light over the surfaces, from bright to dark.
    reflected: Vec<Class>,
    /// Brightest direction of the sky, as irradiance by a sky of this radiance everywhere.
    sky: Peak,
}

impl Brightness {
    /// Returns the brightness of the sky, and of the light that a solution reflects.
    pub(crate) fn of(model: &Model, solution: &Solution) -> Self {
        let mut classes: BTreeMap<u64, Class> = BTreeMap::new();
        let mut total = 0.0;
        model.mesh.for_each_side(|triangle, _, _, side| {
            let light = model.reflectance(triangle, side) * solution.irradiance[side.index()];
            let area = model.area(triangle, side);
            total += area;
            let y = luminance(light);
            if y > 0.0 {
                // Eight classes per factor of two.
                let class = classes.entry(y.to_bits() >> 49).or_default();
                class.brightest.raise(light);
                class.share += area;
            }
        });
        let share = |class: Class| Class { share: class.share / total, ..class };
        let mut sky = Peak::default();
        sky.raise(model.scene.sky().map_or(Rgb::ZERO, |sky| PI * sky.largest_radiance()));
        Self { reflected: classes.into_values().rev().map(share).collect(), sky }
    }

    /// Returns the squared standard errors by light that none of `rays` rays has met.
    pub(crate) fn unmet(&self, extremes: &Extremes, rays: u64) -> Squares {
        let Extremes { reflected, sky, arrived, blocked } = *extremes;
        let rays = rays as f64;
        let largest = 1.0 / (rays + 2.0);
        let mut sum = Squares::default();
        sum.add(blocked.excess(arrived), largest);
        sum.add(self.sky.excess(sky), largest);
        let mut left = largest;
        for Class { brightest, share } in &self.reflected {
            if left <= 0.0 || brightest.luminance <= reflected.luminance {
                break;
            }
            sum.add(brightest.excess(reflected), share.min(left));
            left -= share;
        }
        let mut mean = Squares::default();
        mean.add(sum, 1.0 / rays);
        mean
    }
}
