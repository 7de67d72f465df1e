//! Glare: the luminances of light sources in the field of view of an eye, weighted as for the unified glare rating (UGR) of
//! CIE 117 (1995).

use std::f64::consts::{LN_10, PI};

use glam::DVec3;
use sir_accel::{Ray, Tracer};
use sir_geom::{Line, Rgb, Side, TriangleId, luminance};

use crate::emitter::Emitter;
use crate::model::Model;
use crate::sources::sources;

/// Surfaces that emit, as sources of glare.
#[derive(Clone, Debug)]
pub struct GlareSources<'m> {
    model: &'m Model,
    surfaces: Vec<Surface>,
    up: DVec3,
}

/// A part of a surface that emits.
#[derive(Clone, Copy, Debug)]
struct Surface {
    triangle: TriangleId,
    side: Side,
    corners: [DVec3; 3],
    normal: DVec3,
    exitance: Rgb,
}

/// Largest extent of an element of a surface, in its distance from the eye.
const ELEMENT: f64 = 0.02;

/// Smallest and largest number of elements along an edge of a surface. A few show what covers a part of it.
const DIVISIONS: [u32; 2] = [4, 64];

/// Limits of the table of position indices of CIE 117: tangents of the angles to the side of the line of sight, and above it.
const LIMITS: [f64; 2] = [3.0, 1.9];

impl<'m> GlareSources<'m> {
    /// Returns the emitting surfaces of a scene whose up direction is `up`, of unit length.
    #[must_use]
    pub fn of(model: &'m Model, up: DVec3) -> Self {
        let surface = |emitter| match emitter {
            Emitter::Surface { triangle, patch, side, corners, normal } => {
                let exitance = match patch {
                    Some(patch) => model.exitance(triangle, patch, side),
                    None => model.scene.exitance(triangle, side),
                };
                Some(Surface { triangle, side, corners, normal, exitance })
            }
            _ => None,
        };
        let all = sources(&model.scene, &model.mesh).into_iter();
        Self { model, surfaces: all.filter_map(|source| surface(source.emitter)).collect(), up }
    }

    /// Returns the sum `Σ L² ω / p²` \[cd²/m⁴ sr\] over all that emits in view of an eye: luminance, solid angle and Guth's
    /// position index. `view` is the line of sight, of unit length and not vertical.
    ///
    /// Surfaces are divided into small elements, each of which counts if its center is visible. As in the table of CIE 117, what
    /// is below the line of sight does not count, nor what is seen more than 1.9 times as high above it as it is far along it, or
    /// three times as far to the side.
    #[must_use]
    pub fn sum(&self, eye: DVec3, view: DVec3, tracer: &mut Tracer<'_>) -> f64 {
        let Some(right) = view.cross(self.up).try_normalize() else { return 0.0 };
        let above = right.cross(view);
        let (mut rays, mut elements) = (Vec::new(), Vec::new());
        for surface in &self.surfaces {
            let [a, b, c] = surface.corners;
            if (eye - a).dot(surface.normal) <= 0.0 {
                continue;
            }
            let center = (a + b + c) / 3.0;
            let extent = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let nearest = (eye.distance(center) - extent).max(0.1 * extent);
            let [least, most] = DIVISIONS;
            let divisions = ((extent / (ELEMENT * nearest)).ceil() as u32).clamp(least, most);
            let area = 0.5 * (b - a).cross(c - a).length() / f64::from(divisions * divisions);
            for center in centers([a, b, c], divisions) {
                let to = center - eye;
                let [ahead, aside, height] = [view, right, above].map(|axis| to.dot(axis));
                let [most_aside, most_height] = LIMITS;
                if ahead <= 0.0
                    || height < 0.0
                    || aside.abs() > most_aside * ahead
                    || height > most_height * ahead
                {
                    continue;
                }
                let square = to.length_squared();
                let direction = to / square.sqrt();
                let solid_angle = area * -direction.dot(surface.normal) / square;
                let relative = self.model.scene.relative_radiance(surface.triangle, -direction);
                let luminance = luminance(surface.exitance) * relative / PI;
                let index = position_index(ahead, aside, height);
                rays.push(Ray::new(Line { origin: eye, direction }));
                elements.push((
                    surface.triangle,
                    surface.side,
                    luminance * luminance * solid_angle / (index * index),
                ));
            }
        }
        // Rays are traced in any order, but floats have to be added in a fixed order.
        let mut is_seen = vec![false; rays.len()];
        tracer.closest_each(&rays, |i, hit| {
            let (triangle, side, _) = elements[i];
            is_seen[i] = hit.is_some_and(|hit| (hit.triangle, hit.side) == (triangle, side));
        });
        elements.iter().zip(is_seen).filter(|(_, seen)| *seen).map(|((.., weight), _)| weight).sum()
    }
}

/// Returns the unified glare rating for a sum of [`GlareSources::sum`] and a background luminance \[cd/m²\]:
/// `8 log₁₀(0.25/L_b · Σ L² ω / p²)` (CIE 117). `None` if nothing glares, or the background is dark.
#[must_use]
pub fn unified_glare_rating(sum: f64, background: f64) -> Option<f64> {
    (sum > 0.0 && background > 0.0).then(|| 8.0 * libm::log10(0.25 / background * sum))
}

/// Returns the standard error of the unified glare rating for the relative standard error of the background luminance.
#[must_use]
pub fn error_of_rating(relative_error: f64) -> f64 {
    8.0 / LN_10 * relative_error
}

/// Returns the position index of Guth for a source at this place, in any unit: ahead along the line of sight, aside of it and
/// above it (Illuminating Engineering Society 1984, *Lighting Handbook*, reference volume). The table of CIE 117, which has two
/// decimals, differs by up to 6.4 % in the points that were compared: 0.4 of a rating.
fn position_index(ahead: f64, aside: f64, height: f64) -> f64 {
    // Angle from the line of sight, and from the vertical around it.
    let off = libm::atan2(libm::hypot(aside, height), ahead).to_degrees();
    let around = libm::atan2(aside.abs(), height).to_degrees();
    let linear = 35.2 - 0.318_89 * around - 1.22 * libm::exp(-2.0 * around / 9.0);
    let square = 21.0 + (0.266_67 - 0.002_963 * around) * around;
    libm::exp((linear * 1e-3 + square * 1e-5 * off) * off)
}

/// Returns the centers of the congruent parts of a triangle whose edges are divided into this many parts.
fn centers([a, b, c]: [DVec3; 3], divisions: u32) -> impl Iterator<Item = DVec3> {
    let (along, across) = ((b - a) / f64::from(divisions), (c - a) / f64::from(divisions));
    (0..divisions).flat_map(move |row| {
        (0..2 * (divisions - row) - 1).map(move |k| {
            // Every other part is turned around.
            let third = if k % 2 == 0 { 1.0 / 3.0 } else { 2.0 / 3.0 };
            a + (f64::from(k / 2) + third) * along + (f64::from(row) + third) * across
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_geom::shapes::{self, Facing};
    use sir_geom::{Material, SceneBuilder};
    use sir_mesh::Subdivision;

    /// Values of table 4.1 of CIE 117. The formula is an approximation of what the table was made from.
    #[test]
    fn position_indices_are_those_of_the_table() {
        let table = [
            (0.0, 0.0, 1.00),
            (0.1, 0.0, 1.26),
            (0.5, 0.0, 2.86),
            (0.0, 0.1, 1.05),
            (0.5, 0.5, 2.91),
            (0.6, 0.6, 3.60),
            (0.3, 1.3, 3.70),
            (1.0, 1.0, 7.00),
            (1.5, 2.0, 12.85),
        ];
        for (height, aside, index) in table {
            let found = position_index(1.0, aside, height);
            assert!((found / index - 1.0).abs() < 0.07, "{aside} {height}: {found}");
        }
    }

    /// A room of 6 by 6 m, 3 m high, with a square lamp of 0.2 m in its ceiling that faces down, and what covers it.
    fn room(cover: Option<f64>) -> Model {
        let mut b = SceneBuilder::new();
        let gray = b.add_material(Material::diffuse("", Rgb::splat(0.5)));
        let lamp = b.add_material(Material::diffuse("", Rgb::ZERO).emitting(Rgb::splat(10_000.0 * PI)));
        shapes::cuboid(&mut b, DVec3::ZERO, DVec3::new(6.0, 3.0, 6.0), [gray; 6], Facing::Inward);
        let square = |x: f64, y: f64, z: f64, size: f64| {
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
                .map(|(u, v)| DVec3::new(x + u * size, y, z + v * size))
        };
        shapes::quad(&mut b, square(2.9, 2.99, 1.9, 0.2), lamp);
        if let Some(x) = cover {
            shapes::quad(&mut b, square(x, 2.98, 1.5, 1.0), gray);
        }
        Model::new(b.build().unwrap().scene, Subdivision::PerTriangle).unwrap()
    }

    #[test]
    fn small_lamps_count_with_their_solid_angle_and_position() {
        let eye = DVec3::new(3.0, 1.2, 5.0);
        let sum = |model: &Model, view: DVec3| {
            GlareSources::of(model, DVec3::Y).sum(eye, view, &mut model.accel.tracer())
        };
        let model = room(None);
        let to = DVec3::new(3.0, 2.99, 2.0) - eye;
        let solid_angle = 0.04 * to.y / to.length().powi(3);
        let exact = 1e8 * solid_angle / position_index(-to.z, 0.0, to.y).powi(2);
        let found = sum(&model, -DVec3::Z);
        assert!((found / exact - 1.0).abs() < 2e-3, "{found} {exact}");
        // Behind the back, below the line of sight, and behind a cover of one half.
        assert_eq!(sum(&model, DVec3::Z), 0.0);
        assert_eq!(sum(&model, DVec3::new(0.0, 0.9, -0.3).normalize()), 0.0);
        assert_eq!(sum(&room(Some(2.5)), -DVec3::Z), 0.0);
        let half = sum(&room(Some(3.0)), -DVec3::Z);
        assert!((half / exact - 0.5).abs() < 0.02, "{half}");
    }

    #[test]
    fn ratings_are_logarithms() {
        assert_eq!(unified_glare_rating(400.0, 10.0), Some(8.0));
        assert_eq!(unified_glare_rating(0.0, 10.0), None);
        assert_eq!(unified_glare_rating(1.0, 0.0), None);
        assert!((error_of_rating(0.01) - 0.0347).abs() < 1e-4);
    }
}
