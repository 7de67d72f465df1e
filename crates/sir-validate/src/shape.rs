//! Triangulation of the shapes of the reference.
//!
//! Curved shapes are surfaces of revolution: a profile, rotated about an axis in steps. A polygon approximates a
//! circle; its corners lie a little outside, so that both have the same area. Arcs of a profile are cut as finely.
//!
//! The effect on an answer falls with the square of the size of the facets, and is measured with large facets
//! (`radiosity::tests`). A convex body sends all its light to a body around it, and gets light back in proportion to
//! the areas, for any facets, so concentric spheres may be coarse. Facets of one sphere see a little too much across
//! their edges and nothing of themselves, which matters where zones with different exitances meet.

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::{MaterialId, SceneBuilder};

use crate::data::{ActiveSide, Shape};

/// Default number of parts of a circle: 1.25° each.
pub(crate) const SEGMENTS: u32 = 288;

/// A point of a profile: position along the axis and distance from it \[m\].
type ProfilePoint = (f64, f64);

/// Adds a shape to a scene; its front is the active side. Circles are cut into `segments` parts.
pub(crate) fn add(builder: &mut SceneBuilder, shape: &Shape, material: MaterialId, segments: u32) {
    match *shape {
        Shape::Polygon { ref vertices } => {
            let corners: Vec<_> =
                vertices.iter().map(|&v| builder.add_vertex(DVec3::from_array(v))).collect();
            builder.add_polygon(&corners, material);
        }
        Shape::Disc { center, normal, radius } => {
            revolve(builder, center, normal, &[(0.0, radius), (0.0, 0.0)], material, segments);
        }
        Shape::Annulus { center, normal, inner_radius, outer_radius } => {
            let profile = [(0.0, outer_radius), (0.0, inner_radius)];
            revolve(builder, center, normal, &profile, material, segments);
        }
        Shape::Sphere { center, radius, active_side } => {
            let profile = facing(active_side, arc(radius, [0.0, 180.0], segments));
            revolve(builder, center, [0.0, 0.0, 1.0], &profile, material, segments);
        }
        Shape::SphericalZone { center, radius, axis, polar_angle_deg, active_side } => {
            let profile = facing(active_side, arc(radius, polar_angle_deg, segments));
            revolve(builder, center, axis, &profile, material, segments);
        }
        Shape::Cylinder { base_center, axis, radius, length, active_side } => {
            let profile = facing(active_side, vec![(0.0, radius), (length, radius)]);
            revolve(builder, base_center, axis, &profile, material, segments);
        }
    }
}

/// Returns points on an arc about the origin between two angles from the axis \[degrees\], in the direction of the
/// axis.
fn arc(radius: f64, [from, to]: [f64; 2], segments: u32) -> Vec<ProfilePoint> {
    let parts = ((to - from) / 360.0 * f64::from(segments)).ceil().max(1.0) as u32;
    let at = |i: u32| {
        let degrees = from + (to - from) * f64::from(i) / f64::from(parts);
        let (sin, cos) = libm::sincos(degrees.to_radians());
        // Exactly 0 at a pole, not the rounded sine of π, so that a pole is one point.
        let at_pole = degrees <= 0.0 || degrees >= 180.0;
        (radius * cos, if at_pole { 0.0 } else { radius * sin })
    };
    (0..=parts).rev().map(at).collect()
}

/// Orients a profile: one in the direction of the axis makes an outside, one against it an inside.
fn facing(side: ActiveSide, mut profile: Vec<ProfilePoint>) -> Vec<ProfilePoint> {
    if side == ActiveSide::Inside {
        profile.reverse();
    }
    profile
}

/// Rotates a profile about an axis. Fronts are to the right of the profile; the axis is to the left of a profile that
/// runs in its direction.
fn revolve(
    builder: &mut SceneBuilder,
    center: [f64; 3],
    axis: [f64; 3],
    profile: &[ProfilePoint],
    material: MaterialId,
    segments: u32,
) {
    let (center, axis) = (DVec3::from_array(center), DVec3::from_array(axis).normalize_or_zero());
    let (x, y) = axis.any_orthonormal_pair();
    let step = 2.0 * PI / f64::from(segments);
    // A regular polygon of circumradius ρ has the area ½ n ρ² sin(2π/n).
    let outside = (step / libm::sin(step)).sqrt();
    let at = |(height, radius): ProfilePoint, segment: u32| {
        let (sin, cos) = libm::sincos(step * f64::from(segment % segments));
        center + axis * height + (x * cos + y * sin) * (radius * outside)
    };
    for ends in profile.windows(2) {
        let (a, b) = (ends[0], ends[1]);
        for segment in 0..segments {
            let mut corners = vec![at(a, segment)];
            if a.1 > 0.0 {
                corners.push(at(a, segment + 1));
            }
            corners.push(at(b, segment + 1));
            if b.1 > 0.0 {
                corners.push(at(b, segment));
            }
            let corners: Vec<_> = corners.into_iter().map(|p| builder.add_vertex(p)).collect();
            builder.add_polygon(&corners, material);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_geom::{Material, Rgb, Scene};

    fn scene(shape: &Shape) -> Scene {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("", Rgb::ZERO));
        add(&mut b, shape, m, SEGMENTS);
        b.build().unwrap().scene
    }

    const CENTER: [f64; 3] = [1.0, 2.0, 3.0];

    #[test]
    fn areas_are_those_of_the_smooth_shapes() {
        let (normal, active_side) = ([0.6, 0.0, 0.8], ActiveSide::Outside);
        let zone = |polar_angle_deg| Shape::SphericalZone {
            center: CENTER,
            radius: 2.0,
            axis: normal,
            polar_angle_deg,
            active_side,
        };
        for (shape, exact) in [
            (Shape::Disc { center: CENTER, normal, radius: 2.0 }, 4.0 * PI),
            (Shape::Annulus { center: CENTER, normal, inner_radius: 1.0, outer_radius: 2.0 }, 3.0 * PI),
            (Shape::Sphere { center: CENTER, radius: 2.0, active_side }, 16.0 * PI),
            (zone([0.0, 60.0]), 4.0 * PI),
            (zone([60.0, 105.0]), 8.0 * PI * (0.5 - 105f64.to_radians().cos())),
            (
                Shape::Cylinder { base_center: CENTER, axis: normal, radius: 2.0, length: 3.0, active_side },
                12.0 * PI,
            ),
        ] {
            let off = scene(&shape).total_area() / exact - 1.0;
            assert!(off.abs() < 6e-5, "{shape:?}: {off:e}");
        }
    }

    #[test]
    fn fronts_are_the_active_sides() {
        for (active_side, sign) in [(ActiveSide::Inside, -1.0), (ActiveSide::Outside, 1.0)] {
            let axis = [0.0, 0.6, 0.8];
            for shape in [
                Shape::Sphere { center: CENTER, radius: 2.0, active_side },
                Shape::Cylinder { base_center: CENTER, axis, radius: 2.0, length: 3.0, active_side },
            ] {
                let scene = scene(&shape);
                for t in scene.triangle_ids() {
                    let middle = scene.corners(t).iter().sum::<DVec3>() / 3.0 - DVec3::from_array(CENTER);
                    let away = match shape {
                        Shape::Cylinder { .. } => middle.reject_from_normalized(DVec3::from_array(axis)),
                        _ => middle,
                    };
                    assert!(sign * scene.normal(t).dot(away) > 0.0);
                }
            }
        }
        let normal = [0.0, 0.6, 0.8];
        for shape in [
            Shape::Disc { center: CENTER, normal, radius: 1.0 },
            Shape::Annulus { center: CENTER, normal, inner_radius: 1.0, outer_radius: 2.0 },
        ] {
            let scene = scene(&shape);
            assert!(scene.triangle_ids().all(|t| scene.normal(t).dot(DVec3::from_array(normal)) > 0.999_999));
        }
    }
}
