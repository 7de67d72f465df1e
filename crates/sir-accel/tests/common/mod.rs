//! Closed scenes and difficult lines, shared by the tests.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail like tests")]
#![allow(dead_code, reason = "not all tests use all of it")]

use glam::DVec3;
use sir_accel::{Accel, Options};
use sir_geom::shapes::{self, Facing};
use sir_geom::{Line, Material, Opacities, Opacity, Rgb, Scene, SceneBuilder};
use sir_lines::{Stream, unit_vector};

/// Returns the positions, and the corners of the triangles, of a scene.
pub(crate) fn mesh(scene: &Scene) -> (&[DVec3], Vec<[u32; 3]>) {
    (scene.vertices(), scene.triangles().iter().map(|t| t.vertices.map(|v| v.0)).collect())
}

/// Returns options with the transparent triangles of a scene and their opacity.
pub(crate) fn options(scene: &Scene) -> Options<'static> {
    let Some(opacities) = Opacities::of(scene) else { return Options::default() };
    let is_transparent = scene.triangle_ids().map(|t| scene.is_transparent(t)).collect();
    Options::default().opacity(is_transparent, move |t, p| opacities.at(t, p).unwrap_or(1.0))
}

/// Returns the acceleration structure of a scene.
pub(crate) fn arrange(scene: &Scene) -> Accel {
    let (positions, indices) = mesh(scene);
    Accel::build(positions, &indices, options(scene)).unwrap()
}

/// Returns a room with two spheres, overlapping boxes and a box that touches floor and wall: all closed.
pub(crate) fn furnished_room() -> Scene {
    furnished_room_of(Opacity::default())
}

/// Returns the same room with surfaces of this opacity.
pub(crate) fn furnished_room_of(opacity: Opacity) -> Scene {
    let mut b = SceneBuilder::new();
    let m = b.add_material(Material { opacity, ..Material::diffuse("m", Rgb::splat(0.5)) });
    let at = |x, y, z| DVec3::new(x, y, z);
    shapes::cuboid(&mut b, at(-3.0, 0.0, -2.0), at(3.0, 2.5, 2.0), [m; 6], Facing::Inward);
    shapes::cuboid(&mut b, at(-3.0, 0.0, -1.0), at(-2.0, 0.75, 1.0), [m; 6], Facing::Outward);
    shapes::cuboid(&mut b, at(0.25, 0.5, 0.1), at(1.25, 0.75, 1.1), [m; 6], Facing::Outward);
    shapes::cuboid(&mut b, at(1.0, 0.1, 0.3), at(1.5, 1.75, 0.7), [m; 6], Facing::Outward);
    shapes::sphere(&mut b, at(-0.5, 1.0, 0.0), 0.6, 4, Facing::Outward, |_| m);
    shapes::sphere(&mut b, at(2.0, 1.3, -1.0), 0.4, 3, Facing::Outward, |_| m);
    b.build().unwrap().scene
}

fn pick(count: usize, s: &mut Stream) -> usize {
    (s.unit() * count as f64) as usize
}

fn any_origin(scene: &Scene, s: &mut Stream) -> DVec3 {
    let sphere = scene.bounding_sphere();
    sphere.center + sphere.radius * unit_vector(s.point())
}

fn through(origin: DVec3, target: DVec3) -> Option<Line> {
    Some(Line { origin, direction: (target - origin).try_normalize()? })
}

/// Returns a line of the given kind: anywhere, through a vertex, through a point of an edge, along an edge, through two
/// vertices, along an axis through a vertex, or in the plane of a triangle.
pub(crate) fn difficult_line(scene: &Scene, kind: usize, s: &mut Stream) -> Option<Line> {
    let triangle =
        |s: &mut Stream| scene.corners(sir_geom::TriangleId::new(pick(scene.triangles().len(), s)));
    let vertex = |s: &mut Stream| scene.vertices()[pick(scene.vertices().len(), s)];
    match kind {
        0 => through(any_origin(scene, s), any_origin(scene, s)),
        1 => through(any_origin(scene, s), vertex(s)),
        2 => {
            let [a, b, _] = triangle(s);
            through(any_origin(scene, s), a.lerp(b, s.unit()))
        }
        3 => {
            let [a, b, _] = triangle(s);
            through(a + (a - b), b)
        }
        4 => {
            let (a, b) = (vertex(s), vertex(s));
            through(a + (a - b), b)
        }
        5 => {
            let axis = DVec3::AXES[pick(3, s)];
            Some(Line { origin: vertex(s) - 3.0 * axis, direction: axis })
        }
        _ => {
            let [a, b, c] = triangle(s);
            through(a.lerp(b, s.unit()), c.lerp(b, s.unit()))
        }
    }
}

/// Number of kinds of lines.
pub(crate) const KINDS: usize = 7;
