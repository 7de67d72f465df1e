//! Splitting of triangles at the faces of a box, so that its contents can be treated differently.

use glam::DVec3;

use sir_types::{Barycentric, BoundingBox};

/// Relative tolerance: a corner lies in a face of the box if its distance is at most this fraction of the box's size.
const TOLERANCE: f64 = 1e-9;

/// A corner of a part of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    pub(crate) place: DVec3,
    /// Barycentric coordinates of the corner in the triangle.
    pub(crate) point: Barycentric,
    /// Index of the corner of the triangle, if it is one.
    pub(crate) own: Option<usize>,
}

/// Splits a triangle into convex parts, of which the last lies in the box. Returns `None` if the whole triangle lies in
/// the box or outside it, or if its coordinates are not finite.
///
/// Neighbors that are split along a common edge get bit-identical corners there.
pub(crate) fn split(triangle: [DVec3; 3], bounds: &BoundingBox) -> Option<Vec<Vec<Corner>>> {
    if !triangle.iter().all(|place| place.is_finite()) {
        return None;
    }
    let tolerance = TOLERANCE * bounds.size().max_element();
    let weight = |is: bool| f64::from(u8::from(is));
    let corner = |(i, &place)| {
        let point = Barycentric { v: weight(i == 1), w: weight(i == 2) };
        Corner { place, point, own: Some(i) }
    };
    let mut within: Vec<Corner> = triangle.iter().enumerate().map(corner).collect();
    let mut parts = Vec::new();
    for axis in 0..3 {
        for (face, outwards) in [(bounds.min[axis], -1.0), (bounds.max[axis], 1.0)] {
            let height = |corner: &Corner| {
                let height = outwards * (corner.place[axis] - face);
                if height.abs() <= tolerance { 0.0 } else { height }
            };
            let reaches = |side: f64| within.iter().any(|corner| side * height(corner) > 0.0);
            if !reaches(1.0) {
                continue;
            }
            if !reaches(-1.0) {
                return None;
            }
            let [mut inner, mut outer] = [Vec::new(), Vec::new()];
            for (i, from) in within.iter().enumerate() {
                let to = &within[(i + 1) % within.len()];
                let [h, next] = [from, to].map(height);
                if h <= 0.0 {
                    inner.push(*from);
                }
                if h >= 0.0 {
                    outer.push(*from);
                }
                if h * next < 0.0 {
                    let corner = crossing(from, to, axis, face);
                    inner.push(corner);
                    outer.push(corner);
                }
            }
            parts.push(outer);
            within = inner;
        }
    }
    parts.push(within);
    (parts.len() > 1).then_some(parts)
}

/// Returns the intersection of an edge with a plane across an axis.
fn crossing(from: &Corner, to: &Corner, axis: usize, plane: f64) -> Corner {
    // The direction of an edge does not depend on the triangle, so that both neighbors get the same point.
    let ends = if from.place.to_array() <= to.place.to_array() { [from, to] } else { [to, from] };
    let [a, b] = ends.map(|corner| corner.place[axis]);
    let part = (plane - a) / (b - a);
    let mix = |a: f64, b: f64| a + part * (b - a);
    let [start, end] = ends;
    let mut place = start.place + part * (end.place - start.place);
    place[axis] = plane;
    let point = Barycentric { v: mix(start.point.v, end.point.v), w: mix(start.point.w, end.point.w) };
    Corner { place, point, own: None }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use glam::{Vec2, Vec4};

    use super::*;
    use crate::builder::SceneBuilder;
    use crate::color::Rgb;
    use crate::material::Material;
    use crate::shapes;
    use crate::shapes::Facing;
    use sir_types::TriangleId;

    fn bounds(min: [f64; 3], max: [f64; 3]) -> BoundingBox {
        BoundingBox { min: min.into(), max: max.into() }
    }

    fn middle([a, b, c]: [DVec3; 3]) -> DVec3 {
        (a + b + c) / 3.0
    }

    /// A ground of 200 × 200 m in two triangles, and a sphere that is partly in the box: all areas are known, and every
    /// triangle ends up on one side of each face.
    #[test]
    fn what_is_in_a_box_is_cut_off() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        let far = |x: f64, y: f64| DVec3::new(100.0 * x, 100.0 * y, 0.0);
        shapes::quad(&mut b, [far(-1.0, -1.0), far(1.0, -1.0), far(1.0, 1.0), far(-1.0, 1.0)], m);
        shapes::sphere(&mut b, DVec3::new(3.0, 1.0, 0.7), 0.6, 3, Facing::Outward, |_| m);
        let whole = b.clone().build().unwrap().scene;
        let bounds = bounds([-1.0, 0.0, 0.0], [3.2, 2.0, 1.0]);
        b.split_at(&bounds);
        let built = b.build().unwrap();
        assert_eq!(built.warnings, []);
        let scene = built.scene;
        assert!((scene.total_area() / whole.total_area() - 1.0).abs() < 1e-12);
        let slack = BoundingBox { min: bounds.min - 1e-8, max: bounds.max + 1e-8 };
        let mut ground = 0.0;
        for t in scene.triangle_ids() {
            let corners = scene.corners(t);
            let source = TriangleId(scene.triangle(t).source);
            assert_eq!(scene.triangle(t).face, whole.triangle(source).face);
            assert!(scene.normal(t).dot(whole.normal(source)) > 1.0 - 1e-6);
            if slack.contains(middle(corners)) {
                assert!(corners.iter().all(|&corner| slack.contains(corner)), "{corners:?}");
                ground += if source.0 < 2 { scene.area(t) } else { 0.0 };
            }
        }
        assert!((ground - 4.2 * 2.0).abs() < 1e-9, "{ground}");
        let cut = scene.triangles().len() - whole.triangles().len();
        assert!((20..500).contains(&cut), "{cut} more triangles");
    }

    /// A sphere that is split by a plane has no cracks: every edge has two triangles, one in each direction.
    #[test]
    fn what_was_closed_stays_closed() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        shapes::sphere(&mut b, DVec3::new(0.1, 0.2, 0.3), 1.0, 3, Facing::Outward, |_| m);
        b.split_at(&bounds([-9.0, -0.45, -9.0], [9.0; 3]));
        let scene = b.build().unwrap().scene;
        let mut edges = HashMap::new();
        for t in scene.triangle_ids() {
            let v = scene.triangle(t).vertices;
            for (from, to) in [(v[0], v[1]), (v[1], v[2]), (v[2], v[0])] {
                assert_eq!(edges.insert((from, to), t), None);
            }
        }
        assert!(edges.keys().all(|&(from, to)| edges.contains_key(&(to, from))));
    }

    /// Splitting changes neither colors from the corners nor texture coordinates.
    #[test]
    fn what_varies_goes_on() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        let places = [DVec3::ZERO, DVec3::new(4.0, 0.0, 1.0), DVec3::new(0.0, 3.0, 0.5)];
        let corners = places.map(|place| b.add_vertex(place));
        b.add_polygon(&corners, m);
        let tint =
            [Vec4::new(1.0, 0.0, 0.2, 1.0), Vec4::new(0.0, 1.0, 0.4, 0.5), Vec4::new(0.5, 0.5, 0.0, 0.25)];
        b.set_corners(&[[Vec2::ZERO, Vec2::new(4.0, -8.0), Vec2::new(1.0, 2.0)]], Some(tint));
        let whole = b.clone().build().unwrap().scene;
        b.split_at(&bounds([0.5, 0.25, -1.0], [1.5, 5.0, 2.0]));
        let scene = b.build().unwrap().scene;
        assert!(scene.triangles().len() > 5);
        for t in scene.triangle_ids() {
            let corners = scene.corners(t);
            let third = Barycentric { v: 1.0 / 3.0, w: 1.0 / 3.0 };
            let before = Barycentric::of(middle(corners), places);
            let first = TriangleId(0);
            assert!((scene.opacity_at(t, third) - whole.opacity_at(first, before)).abs() < 1e-6);
            let off = scene.reflectance_at(t, third) - whole.reflectance_at(first, before);
            assert!(off.abs().max_element() < 1e-6, "{off}");
        }
        assert_eq!(scene.appearance.coordinates.len(), 1 + scene.triangles().len());
    }

    #[test]
    fn what_lies_in_a_box_or_passes_by_stays_whole() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        shapes::cuboid(&mut b, DVec3::ZERO, DVec3::ONE, [m; 6], Facing::Inward);
        let triangle = |b: &mut SceneBuilder, places: [[f64; 3]; 3]| {
            let corners = places.map(|place| b.add_vertex(place.into()));
            b.add_polygon(&corners, m);
        };
        triangle(&mut b, [[2.0, 0.5, 0.5], [0.5, 2.0, 0.5], [3.0, 3.0, 0.5]]);
        triangle(&mut b, [[f64::NAN; 3], [0.0; 3], [2.0, 2.0, 2.0]]);
        let before = b.clone().build().unwrap().scene;
        b.split_at(&bounds([0.0; 3], [1.0; 3]));
        let after = b.build().unwrap().scene;
        assert_eq!((before.triangles(), before.vertices()), (after.triangles(), after.vertices()));
    }
}
