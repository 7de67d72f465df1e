//! Focus: importance sampling of global lines in a part of the scene.
//!
//! Of the lines drawn through a whole scene, only one in hundreds meets a room that stands on a wide ground. Therefore
//! some lines are drawn through a box around the room, and the others through the whole domain. Uniform lines through a
//! body of surface `S` have the density `1/S` everywhere in it, so the mixture has only two densities. With a share `s`
//! of the lines through the box `F` and the others through the domain `K`, the density is `s/S_F + (1 − s)/S_K` for
//! lines that meet the box, and `(1 − s)/S_K` for all others. The contribution of a line is weighted with the inverse
//! of its density (balance heuristic, Veach and Guibas 1995), so that power is conserved and the estimate is unbiased
//! wherever the box is.

use sir_types::{BoundingBox, Line};

use crate::domain::Domain;
use crate::forecast::Forecast;

/// Largest ratio of the density of lines in a focus to that elsewhere. It is limited because power and crossings are
/// counted in whole numbers, whose range must be sufficient for both.
pub const MAX_FOCUS_DENSITY: u32 = 1 << 18;

/// Margin around a focus, in lengths of its diagonal, so that surfaces in its faces belong to it.
const MARGIN: f64 = 1e-6;

/// Box that is sampled with a larger share of the lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Focus {
    bounds: BoundingBox,
    share: f64,
}

impl Focus {
    /// Returns a focus on the part of a scene in the box `bounds`. `share` is the requested share of the lines through
    /// it, in `[0, 1)`; `scene` is the bounding box of the scene.
    ///
    /// Returns `None` if the boxes do not intersect, or intersect in a point or a line only.
    #[must_use]
    pub fn new(bounds: BoundingBox, share: f64, scene: BoundingBox) -> Option<Self> {
        let margin = MARGIN * bounds.size().length();
        let bounds = BoundingBox { min: bounds.min - margin, max: bounds.max + margin };
        let bounds = bounds.intersection(&scene)?;
        (bounds.face_areas().element_sum() > 0.0).then_some(Self { bounds, share })
    }

    /// Returns the box, clipped to the bounding box of the scene.
    #[must_use]
    pub fn bounds(&self) -> BoundingBox {
        self.bounds
    }

    /// Returns the requested share of the lines through the focus.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.share
    }

    /// Returns words that identify this focus: the bits of its box and of its share.
    #[must_use]
    pub fn identity(&self) -> [u64; 7] {
        let BoundingBox { min, max } = self.bounds;
        [min.x, min.y, min.z, max.x, max.y, max.z, self.share].map(f64::to_bits)
    }
}

/// Number of local lines and an optional focus for them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalLines {
    /// Total number of lines.
    pub count: u64,
    /// Focus of the lines; `None` if the whole scene matters equally.
    pub focus: Option<Focus>,
}

impl From<u64> for LocalLines {
    fn from(count: u64) -> Self {
        Self { count, focus: None }
    }
}

/// Global lines: uniform lines through a domain, optionally mixed with uniform lines through a focus.
#[derive(Clone, Debug, PartialEq)]
pub struct GlobalLines {
    domain: Domain,
    mixture: Option<Mixture>,
}

/// Lines through a focus, and their mixture with the lines through the domain.
#[derive(Clone, Debug, PartialEq)]
struct Mixture {
    focus: Focus,
    through: Domain,
    /// Share of the lines that are drawn through the focus.
    share: f64,
    /// The share in units of 2⁻⁶⁴.
    step: u64,
    /// Weight of lines that do not meet the focus; all others have weight 1.
    weight: u32,
    /// Inverse of the density of lines that meet the focus.
    surface: f64,
}

impl From<Domain> for GlobalLines {
    fn from(domain: Domain) -> Self {
        Self { domain, mixture: None }
    }
}

impl GlobalLines {
    /// Returns lines through a domain and a focus, with about the requested share through the focus. The share is
    /// rounded such that weights are whole numbers. If all weights would be 1, there is no focus and all lines are
    /// drawn through the domain.
    #[must_use]
    pub fn focused(domain: Domain, focus: Focus) -> Self {
        let through = Domain::Box(focus.bounds);
        let [inner, outer] = [through.surface(), domain.surface()];
        let wanted = 1.0 + focus.share / (1.0 - focus.share) * (outer / inner);
        let weight = wanted.round().min(f64::from(MAX_FOCUS_DENSITY)) as u32;
        if weight <= 1 {
            return domain.into();
        }
        let odds = f64::from(weight - 1) * (inner / outer);
        let share = odds / (1.0 + odds);
        let surface = 1.0 / (share / inner + (1.0 - share) / outer);
        let step = (share * (1u128 << 64) as f64) as u64;
        Self { domain, mixture: Some(Mixture { focus, through, share, step, weight, surface }) }
    }

    /// Maps a point of the unit cube to a line, as [`Domain::line`] does, and returns the line with its weight.
    ///
    /// The index decides whether the line is drawn through the focus (systematic sampling): in any run of consecutive
    /// indices, the number of lines through the focus is within one of its expectation. `offset` is a random number,
    /// the same for all lines.
    #[inline]
    #[must_use]
    pub fn line(&self, index: u64, offset: u64, point: [f64; 6]) -> (Line, u32) {
        let Some(mixture) = &self.mixture else { return (self.domain.line(point), 1) };
        if mixture.is_focused(index, offset) {
            return (mixture.through.line(point), 1);
        }
        let line = self.domain.line(point);
        let weight = if mixture.focus.bounds.meets(&line) { 1 } else { mixture.weight };
        (line, weight)
    }

    /// Returns the domain through which all lines that are not drawn through the focus are drawn.
    #[must_use]
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Returns the focus, if there is one.
    #[must_use]
    pub fn focus(&self) -> Option<&Focus> {
        self.mixture.as_ref().map(|mixture| &mixture.focus)
    }

    /// Returns the share of the lines that are drawn through the focus.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.mixture.as_ref().map_or(0.0, |mixture| mixture.share)
    }

    /// Returns the weight of lines that do not meet the focus: the ratio of the density of lines in the focus to that
    /// elsewhere, at least 1.
    #[must_use]
    pub fn weight(&self) -> u32 {
        self.mixture.as_ref().map_or(1, |mixture| mixture.weight)
    }

    /// Returns the forecast for this number of lines. It states the expected sum of the weights of the lines that cross
    /// a surface, which is the same inside and outside of the focus.
    #[must_use]
    pub fn forecast(&self, lines: u64) -> Forecast {
        let surface = self.mixture.as_ref().map_or(self.domain.surface(), |mixture| mixture.surface);
        Forecast { lines, surface }
    }

    /// Returns the largest number of consecutive lines whose weights add up to at most 2³¹.
    #[must_use]
    pub fn max_lines(&self) -> u64 {
        let Some(mixture) = &self.mixture else { return 1 << 31 };
        let weight = f64::from(mixture.weight);
        let mean = mixture.share + (1.0 - mixture.share) * weight;
        // Either kind may have one line more than expected.
        ((f64::from(1u32 << 31) - 2.0 * weight) / (mean + 1e-6)) as u64
    }
}

impl Mixture {
    /// Returns true if this line is drawn through the focus.
    #[inline]
    fn is_focused(&self, index: u64, offset: u64) -> bool {
        let place = index.wrapping_mul(self.step).wrapping_add(offset);
        place.checked_add(self.step).is_none()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use glam::DVec3;
    use sir_geom::shapes::{Facing, cuboid};
    use sir_geom::{Material, Rgb, SceneBuilder};

    use super::*;
    use crate::stream::{Purpose, Streams};

    /// A box of 20 × 2 × 20 m with a focus in one of its corners. The box of the focus extends beyond the scene.
    fn corner(share: f64) -> GlobalLines {
        let mut b = SceneBuilder::new();
        let gray = b.add_material(Material::diffuse("", Rgb::splat(0.5)));
        cuboid(&mut b, DVec3::ZERO, DVec3::new(20.0, 2.0, 20.0), [gray; 6], Facing::Inward);
        let scene = b.build().unwrap().scene;
        let bounds = BoundingBox { min: DVec3::new(-5.0, 0.0, -5.0), max: DVec3::new(2.0, 3.0, 1.0) };
        let focus = Focus::new(bounds, share, scene.bounding_box()).unwrap();
        let in_scene = focus.bounds();
        assert_eq!(in_scene.min, DVec3::ZERO);
        assert!((in_scene.max - DVec3::new(2.0, 2.0, 1.0)).abs().max_element() < 1e-4);
        GlobalLines::focused(Domain::hull(scene.vertices()), focus)
    }

    /// The weights of the lines that cross a disc add up to the forecast within four standard errors: for discs inside,
    /// outside and half inside the focus. In the focus, many more lines cross a disc than without a focus.
    #[test]
    fn weights_make_up_for_the_density() {
        const LINES: u64 = 400_000;
        let streams = Streams::new(4, Purpose::GLOBAL);
        for share in [0.5, 0.9] {
            let lines = corner(share);
            assert!(lines.weight() > 10 && (lines.share() - share).abs() < 0.05, "{}", lines.share());
            let all: Vec<_> = (0..LINES).map(|i| lines.line(i, 12_345, streams.line(i).point())).collect();
            let radius = 0.4;
            for (center, normal) in [
                (DVec3::new(1.0, 1.0, 0.5), DVec3::Y),
                (DVec3::new(15.0, 1.0, 12.0), DVec3::Y),
                (DVec3::new(2.0, 1.0, 0.5), DVec3::Z),
                (DVec3::new(2.5, 1.0, 0.5), DVec3::X),
            ] {
                let crosses = |line: &Line| {
                    let t = (center - line.origin).dot(normal) / line.direction.dot(normal);
                    line.at(t).distance_squared(center) < radius * radius
                };
                let weights =
                    all.iter().filter(|(line, _)| crosses(line)).map(|(_, weight)| f64::from(*weight));
                let (sum, squares) = weights.clone().fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
                let expected = lines.forecast(LINES).crossings(std::f64::consts::PI * radius * radius);
                assert!(
                    (sum - expected).abs() < 4.0 * f64::sqrt(squares),
                    "{share}, {center}: {sum} of {expected}"
                );
                if center.x < 2.0 {
                    let without =
                        lines.domain().forecast(LINES).crossings(std::f64::consts::PI * radius * radius);
                    assert!(weights.count() as f64 > 10.0 * without);
                }
            }
        }
    }

    /// In any run of consecutive lines, the number of lines through the focus is within one of its expectation, for any
    /// offset.
    #[test]
    fn the_share_is_kept_in_every_range() {
        let lines = corner(0.7);
        let mixture = lines.mixture.as_ref().unwrap();
        let share = lines.share();
        for offset in [0, 1 << 63, u64::MAX] {
            for start in [0, 17, 1 << 40] {
                let mut taken = 0;
                for n in 0..3_000_u32 {
                    assert!((f64::from(taken) - share * f64::from(n)).abs() <= 1.0 + 1e-6);
                    taken += u32::from(mixture.is_focused(start + u64::from(n), offset));
                }
            }
        }
        let sum = lines.max_lines() as f64 * (share + (1.0 - share) * f64::from(lines.weight()));
        assert!(sum < 2f64.powi(31) && sum > 2f64.powi(30), "{sum}");
    }

    #[test]
    fn a_focus_on_everything_changes_nothing() {
        let lines = corner(0.0);
        assert_eq!((lines.weight(), lines.share(), lines.focus()), (1, 0.0, None));
        assert_eq!(lines, lines.domain().clone().into());
    }
}
