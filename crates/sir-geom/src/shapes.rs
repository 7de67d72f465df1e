//! Simple shapes for tests, examples and scene generators.

use std::collections::HashMap;

use glam::DVec3;

use crate::builder::SceneBuilder;
use crate::index::{FaceId, MaterialId, VertexId};

/// Direction of the fronts of a closed shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Toward the inside: a room.
    Inward,
    /// Toward the outside: an object.
    Outward,
}

/// Adds one quadrilateral, with corners counterclockwise seen from its front.
pub fn quad(builder: &mut SceneBuilder, corners: [DVec3; 4], material: MaterialId) -> FaceId {
    let corners = corners.map(|p| builder.add_vertex(p));
    builder.add_polygon(&corners, material)
}

/// Adds a closed box of six quadrilaterals. `materials` are those of the faces
/// `x = min, x = max, y = min, y = max, z = min, z = max`. Returns the indices of the faces in the same order.
pub fn cuboid(
    builder: &mut SceneBuilder,
    min: DVec3,
    max: DVec3,
    materials: [MaterialId; 6],
    facing: Facing,
) -> [FaceId; 6] {
    let v: [VertexId; 8] = std::array::from_fn(|i| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
        builder.add_vertex(DVec3::new(pick(0), pick(1), pick(2)))
    });
    // Counterclockwise seen from inside.
    const INWARD: [[usize; 4]; 6] =
        [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
    std::array::from_fn(|face| {
        let mut corners = INWARD[face].map(|i| v[i]);
        if facing == Facing::Outward {
            corners.reverse();
        }
        builder.add_polygon(&corners, materials[face])
    })
}

/// Adds a sphere of `20 · 4^level` triangles: an icosahedron subdivided `level` times, with every vertex on the sphere.
/// `material` returns the material of a triangle for the unit vector from the center to its middle.
pub fn sphere(
    builder: &mut SceneBuilder,
    center: DVec3,
    radius: f64,
    level: u32,
    facing: Facing,
    mut material: impl FnMut(DVec3) -> MaterialId,
) {
    let (mut points, mut triangles) = icosahedron();
    for _ in 0..level {
        let mut middles: HashMap<(usize, usize), usize> = HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a] + points[b]).normalize());
                points.len() - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let vertices: Vec<VertexId> = points.iter().map(|&p| builder.add_vertex(center + radius * p)).collect();
    for [a, b, c] in triangles {
        let outward = (points[a] + points[b] + points[c]).normalize();
        let corners = match facing {
            Facing::Outward => [a, b, c],
            Facing::Inward => [c, b, a],
        };
        let m = material(outward);
        builder.add_polygon(&corners.map(|i| vertices[i]), m);
    }
}

/// Returns unit vectors to the 12 corners of an icosahedron, and its 20 triangles, counterclockwise seen from outside.
fn icosahedron() -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let g = 0.5 * (1.0 + 5.0f64.sqrt());
    let points = [
        [-1.0, g, 0.0],
        [1.0, g, 0.0],
        [-1.0, -g, 0.0],
        [1.0, -g, 0.0],
        [0.0, -1.0, g],
        [0.0, 1.0, g],
        [0.0, -1.0, -g],
        [0.0, 1.0, -g],
        [g, 0.0, -1.0],
        [g, 0.0, 1.0],
        [-g, 0.0, -1.0],
        [-g, 0.0, 1.0],
    ];
    let triangles = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    (points.iter().map(|&p| DVec3::from_array(p).normalize()).collect(), triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;
    use crate::material::Material;

    #[test]
    fn fronts_point_where_asked() {
        for (facing, sign) in [(Facing::Inward, -1.0), (Facing::Outward, 1.0)] {
            let mut b = SceneBuilder::new();
            let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
            cuboid(&mut b, DVec3::splat(-1.0), DVec3::ONE, [m; 6], facing);
            sphere(&mut b, DVec3::ZERO, 3.0, 2, facing, |_| m);
            let scene = b.build().unwrap().scene;
            for t in scene.triangle_ids() {
                let [a, b, c] = scene.corners(t);
                assert!(sign * scene.normal(t).dot(a + b + c) > 0.0);
            }
        }
    }

    #[test]
    fn sphere_area_approaches_the_smooth_one() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        sphere(&mut b, DVec3::ONE, 2.0, 5, Facing::Outward, |_| m);
        let scene = b.build().unwrap().scene;
        assert_eq!(scene.triangles().len(), 20 * 4usize.pow(5));
        let exact = 16.0 * std::f64::consts::PI;
        assert!((scene.total_area() / exact - 1.0).abs() < 1e-3);
    }
}
