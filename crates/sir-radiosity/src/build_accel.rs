//! The acceleration structure of a scene.

use std::collections::HashMap;

use sir_accel::{Accel, AccelError, Barycentric, Opacity, Options, TriangleId};
use sir_geom::{Opacities, Scene, VertexId};
use sir_types::DisjointSets;

/// Builds the acceleration structure over the triangles of a scene, with their opacities.
///
/// Of surfaces in contact, an emitting one lies on top of others, a small one on top of a large one, and otherwise those
/// later in the scene on top of earlier ones.
///
/// # Errors
///
/// If there are too many triangles, or the scene is too large or too small for its lengths to be squared.
pub fn build_accel(scene: &Scene) -> Result<Accel, AccelError> {
    let indices: Vec<[u32; 3]> =
        scene.triangles().iter().map(|triangle| triangle.vertices.map(|v| v.0)).collect();
    let options = Options::default().contact_priorities(|triangles| contact_priorities(scene, triangles));
    let options = match Opacities::of(scene) {
        Some(opacities) => {
            let is_transparent = scene.triangle_ids().map(|t| scene.is_transparent(t)).collect();
            options.opacity(is_transparent, SceneOpacity(opacities))
        }
        None => options,
    };
    Accel::build(scene.vertices(), &indices, options)
}

/// The opacities of a scene.
struct SceneOpacity(Opacities);

impl Opacity for SceneOpacity {
    fn opacity(&self, triangle: TriangleId, point: Barycentric) -> f64 {
        self.0.at(triangle, point).unwrap_or(1.0)
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

/// Returns the contact priorities of triangles: emitting ones above others, then smaller polygons above larger ones.
///
/// A polygon is what a viewer takes for one: connected triangles of the same material and group.
fn contact_priorities(scene: &Scene, triangles: &[TriangleId]) -> Vec<u32> {
    let areas = polygon_areas(scene, triangles);
    // Areas that are equal up to rounding must be equal here: four digits are kept, rounded to the nearest.
    let rounded = |area: f64| (area.to_bits() + (1 << 38)) >> 39;
    let ranks =
        triangles.iter().zip(areas).map(|(&t, area)| (scene.emits(t), std::cmp::Reverse(rounded(area))));
    let ranks: Vec<_> = ranks.collect();
    let mut sorted = ranks.clone();
    sorted.sort_unstable();
    sorted.dedup();
    ranks.iter().map(|rank| sorted.partition_point(|other| other < rank) as u32).collect()
}

/// Returns for each of some triangles the area of all those of its polygon among them.
fn polygon_areas(scene: &Scene, triangles: &[TriangleId]) -> Vec<f64> {
    let count = triangles.len() as u32;
    let mut polygons = DisjointSets::new(count);
    // The first triangle with an edge, a material and a group.
    let mut with_edge: HashMap<([VertexId; 2], u32, u32), u32> = HashMap::new();
    for (i, &t) in (0..).zip(triangles) {
        let triangle = scene.triangle(t);
        let [a, b, c] = triangle.vertices;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let key = ([from.min(to), from.max(to)], triangle.material.0, triangle.group.0);
            polygons.merge(i, *with_edge.entry(key).or_insert(i));
        }
    }
    let mut areas = vec![0.0; triangles.len()];
    let of: Vec<usize> = (0..count).map(|i| polygons.first(i) as usize).collect();
    triangles.iter().zip(&of).for_each(|(&t, &polygon)| areas[polygon] += scene.area(t));
    of.iter().map(|&polygon| areas[polygon]).collect()
}
