//! The scenes are closed, and their solids do not touch.

use std::collections::BTreeMap;

use glam::DVec3;
use sir_geom::{BoundingBox, Scene, SceneError};
use sir_scenes::{
    FURNACE_EXITANCE, FURNACE_REFLECTANCE, INNER_SPHERE, OUTER_SPHERE, airplane_cabin, concentric_spheres,
    furnace, museum_stairs, office, reading_room,
};

/// Room of the office.
const OFFICE: BoundingBox = BoundingBox { min: DVec3::ZERO, max: DVec3::new(12.6, 2.8, 8.4) };

fn closed_scenes() -> Result<[(&'static str, Scene); 6], SceneError> {
    Ok([
        ("furnace", furnace(1.0, FURNACE_REFLECTANCE, FURNACE_EXITANCE)?.scene),
        ("concentric spheres", concentric_spheres(INNER_SPHERE, OUTER_SPHERE, 2)?.scene),
        ("museum stairs", museum_stairs()?.scene),
        ("reading room", reading_room()?.scene),
        ("airplane cabin", airplane_cabin()?.scene),
        ("office", office()?.scene),
    ])
}

#[test]
fn every_edge_joins_two_triangles_that_run_along_it_in_opposite_directions() {
    for (name, scene) in closed_scenes().unwrap() {
        let mut balance: BTreeMap<[u32; 2], (u32, i32)> = BTreeMap::new();
        for t in scene.triangles() {
            for i in 0..3 {
                let (a, b) = (t.vertices[i].0, t.vertices[(i + 1) % 3].0);
                let entry = balance.entry([a.min(b), a.max(b)]).or_default();
                entry.0 += 1;
                entry.1 += if a < b { 1 } else { -1 };
            }
        }
        for (edge, tally) in balance {
            let ends = edge.map(|v| scene.vertices()[v as usize]);
            assert_eq!(tally, (2, 0), "{name}: triangles and direction at the edge {ends:?}");
        }
    }
}

/// A line from outside enters a room through a back, then hits the front and the back of each solid alternately, and
/// leaves through a front. The office is a room in a solid, so that lines meet its front first. Solids that overlap or face the wrong way break the alternation.
#[test]
fn lines_meet_backs_and_fronts_in_turn() {
    for (name, scene) in closed_scenes().unwrap() {
        let in_open = name == "office";
        // Most lines through the street would miss the room.
        let bounds = if in_open { OFFICE } else { scene.bounding_box() };
        let mut state = 1u64;
        let mut hit_count = 0;
        for _ in 0..1500 {
            let [p, q] = [0, 1].map(|_| bounds.min + bounds.size() * in_unit_cube(&mut state));
            let beyond = 2.0 * scene.bounding_box().size().length() / p.distance(q) * (q - p);
            let (from, to) = (p - beyond, p + beyond);
            let mut hits: Vec<(f64, bool, DVec3)> = scene
                .triangle_ids()
                .filter_map(|t| hit(scene.corners(t), from, to))
                .map(|(s, front)| (s, front, from.lerp(to, s)))
                .collect();
            hits.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(hits.len().is_multiple_of(2), "{name}: {hits:?}");
            for (i, h) in hits.iter().enumerate() {
                assert_eq!(
                    h.1,
                    (i % 2 == 1) != in_open,
                    "{name}: hit {i} at {} on the wrong side: {hits:?}",
                    h.2
                );
            }
            hit_count += hits.len();
        }
        assert!(hit_count > 400, "{name}: only {hit_count} hits");
    }
}

/// Returns the parameter (0 to 1) at which the segment from `from` to `to` crosses a triangle, and true if it hits the
/// front. `None` if it misses.
fn hit([a, b, c]: [DVec3; 3], from: DVec3, to: DVec3) -> Option<(f64, bool)> {
    let volume = |p: DVec3, q: DVec3| (to - from).dot((p - from).cross(q - from));
    let (u, v, w) = (volume(b, c), volume(c, a), volume(a, b));
    let (front, back) = (u < 0.0 && v < 0.0 && w < 0.0, u > 0.0 && v > 0.0 && w > 0.0);
    let normal = (b - a).cross(c - a);
    (front || back).then(|| (normal.dot(a - from) / normal.dot(to - from), normal.dot(to - from) < 0.0))
}

fn in_unit_cube(state: &mut u64) -> DVec3 {
    let mut coordinate = || {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1u64 << 53) as f64
    };
    DVec3::new(coordinate(), coordinate(), coordinate())
}
