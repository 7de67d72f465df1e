//! Properties of the display mesh: no T-junctions, no lost area, no light leaks, smooth where it should be.

#![allow(clippy::unwrap_used, reason = "a step that fails is a test that fails")]

use std::collections::BTreeSet;

use glam::DVec3;
use proptest::prelude::*;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Barycentric, Material, MaterialId, Rgb, Scene, SceneBuilder, Side, Sides, TriangleId};
use sir_mesh::{PatchMesh, PatchSize, SideId, Subdivision};
use sir_view::DisplayMesh;

fn scene(build: impl FnOnce(&mut SceneBuilder, MaterialId)) -> Scene {
    scene_with(Sides::Front, build)
}

fn scene_with(sides: Sides, build: impl FnOnce(&mut SceneBuilder, MaterialId)) -> Scene {
    let mut builder = SceneBuilder::new();
    let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)).with_sides(sides));
    build(&mut builder, gray);
    builder.build().unwrap().scene
}

/// Returns one irradiance per side, from its triangle and the middle of its patch.
fn field(scene: &Scene, mesh: &PatchMesh, value: impl Fn(TriangleId, Side, DVec3) -> f64) -> Vec<Rgb> {
    let mut irradiance = Vec::new();
    mesh.for_each_side(|t, patch, side, _| {
        irradiance.push(Rgb::splat(value(t, side, mesh.center(scene, t, patch))));
    });
    irradiance
}

/// Adds a rectangle, given its lower left corner and two edges.
fn rectangle(b: &mut SceneBuilder, m: MaterialId, corner: DVec3, right: DVec3, up: DVec3) {
    shapes::quad(b, [corner, corner + right, corner + right + up, corner + up], m);
}

fn values(display: &DisplayMesh<'_>) -> Vec<f32> {
    display.vertices().iter().map(|v| v.irradiance[0]).collect()
}

fn position(display: &DisplayMesh<'_>, vertex: u32) -> DVec3 {
    display.positions()[display.vertices()[vertex as usize].position as usize]
}

fn area(display: &DisplayMesh<'_>) -> f64 {
    let area_of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| position(display, v));
        0.5 * (b - a).cross(c - a).length()
    };
    display.triangles().iter().map(area_of).sum()
}

/// Returns true if a point lies between two others, or is one of them.
fn is_between(p: DVec3, [a, b]: [DVec3; 2]) -> bool {
    p.distance(a) + p.distance(b) - a.distance(b) < 1e-9
}

/// Asserts that along the edges of the scene's triangles, no corner of a triangle lies inside an edge of another one.
/// (Where the inside of a patch touches something, it is covered, and there can be no crack.)
fn assert_conforming(display: &DisplayMesh<'_>, scene: &Scene) {
    let edges_of = |t: TriangleId| {
        let c = scene.corners(t);
        [[c[0], c[1]], [c[1], c[2]], [c[2], c[0]]]
    };
    // Edges of patches, not those between the triangles of one.
    let mut edges: Vec<(TriangleId, [DVec3; 2])> = Vec::new();
    for piece in display.pieces() {
        let of_piece = |t: &[u32; 3]| [0, 1, 2].map(|e| (t[e], t[(e + 1) % 3]));
        let all: BTreeSet<(u32, u32)> = piece.triangles.iter().flat_map(of_piece).collect();
        let outer = all.iter().filter(|&&(from, to)| !all.contains(&(to, from)));
        edges.extend(outer.map(|&(from, to)| (piece.triangle, [from, to].map(|v| position(display, v)))));
    }
    let is_on_edge = |t: TriangleId, p: DVec3| edges_of(t).iter().any(|&e| is_between(p, e));
    let ends = edges.iter().flat_map(|(t, ends)| ends.iter().filter(|&&p| is_on_edge(*t, p)));
    let mut on_edges: Vec<DVec3> = ends.copied().collect();
    on_edges.sort_by(|p, q| p.to_array().partial_cmp(&q.to_array()).unwrap());
    on_edges.dedup();
    for (t, ends) in edges {
        if edges_of(t).iter().any(|&edge| ends.iter().all(|&p| is_between(p, edge))) {
            for &p in &on_edges {
                let is_end = ends.iter().any(|end| end.distance(p) < 1e-6);
                assert!(is_end || !is_between(p, ends), "{p} lies on the edge {ends:?}");
            }
        }
    }
}

#[test]
fn different_divisions_meet_without_t_junctions() {
    // Edges of lengths 3 and 1 along one line, and a strip whose parts fit neither.
    let scene = scene(|b, m| {
        rectangle(b, m, DVec3::ZERO, 3.0 * DVec3::X, 2.0 * DVec3::Y);
        for x in [0.0, 1.0, 2.0] {
            rectangle(b, m, DVec3::new(x, -0.7, 0.0), DVec3::X, 0.7 * DVec3::Y);
        }
        rectangle(b, m, DVec3::new(-0.3, 2.0, 0.0), 3.6 * DVec3::X, 0.1 * DVec3::Z);
    });
    let mut fans = 0;
    for max in [9.0, 0.3, 0.05] {
        let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(max))).unwrap();
        let irradiance = field(&scene, &mesh, |_, _, _| 1.0);
        let display = DisplayMesh::new(&scene, &mesh, &irradiance);
        assert_conforming(&display, &scene);
        assert!((area(&display) / scene.total_area() - 1.0).abs() < 1e-12);
        assert!(values(&display).iter().all(|&v| (v - 1.0).abs() < 1e-6));
        fans += display.pieces().filter(|p| p.triangles.len() > 1).count();
    }
    assert!(fans > 10, "the scene must not be conforming by itself");
}

#[test]
fn patches_that_fit_stay_one_triangle() {
    let scene = scene(|b, m| rectangle(b, m, DVec3::ZERO, 2.0 * DVec3::X, DVec3::Y));
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(0.01))).unwrap();
    let irradiance = field(&scene, &mesh, |_, _, _| 1.0);
    let display = DisplayMesh::new(&scene, &mesh, &irradiance);
    assert_eq!(display.triangles().len(), mesh.patch_count());
}

#[test]
fn a_linear_field_is_reproduced_inside() {
    let linear = |p: DVec3| 3.0 + p.x - 2.0 * p.y;
    let scene = scene(|b, m| rectangle(b, m, DVec3::ZERO, 2.0 * DVec3::X, DVec3::new(0.3, 1.0, 0.0)));
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::Count(2 * 9 * 9))).unwrap();
    let irradiance = field(&scene, &mesh, |_, _, p| linear(p));
    let display = DisplayMesh::new(&scene, &mesh, &irradiance);
    let mut inside = 0;
    for v in display.vertices() {
        let p = display.positions()[v.position as usize];
        let (x, y) = (p.x - 0.3 * p.y, p.y);
        if x > 1e-6 && x < 2.0 - 1e-6 && y > 1e-6 && y < 1.0 - 1e-6 {
            assert!((f64::from(v.irradiance[1]) - linear(p)).abs() < 1e-6, "at {p}");
            inside += 1;
        }
    }
    assert_eq!(inside, 8 * 8);
    for (v, w) in [(0.4, 0.3), (0.31, 0.45), (0.5, 0.25)] {
        let point = Barycentric { v, w };
        let e = display.irradiance_at(TriangleId(0), point, Side::Front).unwrap();
        assert!((e.z - linear(point.point(scene.corners(TriangleId(0))))).abs() < 1e-6);
    }
}

/// Returns the values of two squares of irradiance 0 and 1 that meet in one edge at the given angle (180° is flat).
fn shared_values(degrees: f64) -> Vec<f32> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let scene = scene(|b, m| {
        rectangle(b, m, DVec3::ZERO, DVec3::X, DVec3::Y);
        rectangle(b, m, DVec3::ZERO, DVec3::Y, DVec3::new(cos, 0.0, sin));
    });
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::Count(4 * 10 * 10))).unwrap();
    let irradiance = field(&scene, &mesh, |t, _, _| f64::from(t.0 / 2));
    values(&DisplayMesh::new(&scene, &mesh, &irradiance))
}

#[test]
fn light_goes_around_a_bend_but_not_around_a_crease() {
    let is_mixed = |values: &[f32]| values.iter().any(|&v| v != 0.0 && v != 1.0);
    for crease in [90.0, 270.0, 140.0, 220.0, 20.0] {
        assert!(!is_mixed(&shared_values(crease)), "{crease}°");
    }
    for bend in [180.0, 160.0, 200.0] {
        let mixed = shared_values(bend).iter().filter(|&&v| v != 0.0 && v != 1.0).count();
        assert_eq!(mixed, 11, "all points of the common edge, at {bend}°");
    }
}

#[test]
fn a_cut_beyond_a_crease_does_not_bend_the_light() {
    // The floor has two triangles; three walls side by side divide its edge into three parts.
    let scene = scene(|b, m| {
        rectangle(b, m, DVec3::ZERO, 3.0 * DVec3::X, 2.0 * DVec3::Y);
        for x in [0.0, 1.0, 2.0] {
            rectangle(b, m, DVec3::new(x + 1.0, 0.0, 0.0), -DVec3::X, DVec3::Z);
        }
    });
    let mesh = PatchMesh::new(&scene, Subdivision::PerTriangle).unwrap();
    let irradiance = field(&scene, &mesh, |t, _, _| if t.0 == 1 { 2.0 } else { 0.0 });
    let display = DisplayMesh::new(&scene, &mesh, &irradiance);
    let floor: Vec<_> = display.pieces_of(TriangleId(0)).flat_map(|p| p.triangles).flatten().collect();
    let along_edge = |x: f64| {
        let there = floor.iter().find(|&&&v| position(&display, v).distance(x * DVec3::X) < 1e-9).unwrap();
        f64::from(display.vertices()[**there as usize].irradiance[0])
    };
    let (start, end) = (along_edge(0.0), along_edge(3.0));
    assert!(start > 0.5 && end == 0.0);
    assert!((along_edge(1.0) - 2.0 / 3.0 * start).abs() < 1e-6);
    assert!((along_edge(2.0) - 1.0 / 3.0 * start).abs() < 1e-6);
}

#[test]
fn a_wall_between_two_halves_of_a_ceiling_keeps_their_light_apart() {
    for (wall, mixed) in [(false, true), (true, false)] {
        let scene = scene(|b, m| {
            // Seen from below.
            rectangle(b, m, DVec3::ZERO, DVec3::Y, DVec3::X);
            rectangle(b, m, DVec3::X, DVec3::Y, DVec3::X);
            if wall {
                rectangle(b, m, DVec3::X, DVec3::Y, -DVec3::Z);
            }
        });
        let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::Count(300))).unwrap();
        let irradiance = field(&scene, &mesh, |t, _, _| if t.0 / 2 == 0 { 0.0 } else { 1.0 });
        let display = DisplayMesh::new(&scene, &mesh, &irradiance);
        assert_eq!(values(&display).iter().any(|&v| v != 0.0 && v != 1.0), mixed, "wall: {wall}");
    }
}

#[test]
fn front_and_back_are_never_averaged() {
    let scene = scene_with(Sides::Both, |b, m| {
        shapes::sphere(b, DVec3::ZERO, 1.0, 2, Facing::Outward, |_| m);
        rectangle(b, m, DVec3::X, DVec3::X, DVec3::Y);
    });
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::Count(2000))).unwrap();
    let irradiance = field(&scene, &mesh, |_, side, _| if side == Side::Front { 1.0 } else { 2.0 });
    let display = DisplayMesh::new(&scene, &mesh, &irradiance);
    for piece in display.pieces() {
        let expected = if piece.side == Side::Front { 1.0 } else { 2.0 };
        let outward = scene.normal(piece.triangle) * (3.0 - 2.0 * expected);
        for t in piece.triangles {
            let [a, b, c] = t.map(|v| position(&display, v));
            assert!((b - a).cross(c - a).dot(outward) > 0.0, "a back is wound the other way");
            for &v in t {
                let got = f64::from(display.vertices()[v as usize].irradiance[0]);
                assert!((got - expected).abs() < 1e-6);
            }
        }
    }
    assert!((area(&display) / (2.0 * scene.total_area()) - 1.0).abs() < 1e-9);
}

#[test]
fn a_sphere_is_smooth() {
    let scene = scene(|b, m| shapes::sphere(b, DVec3::ZERO, 1.0, 2, Facing::Outward, |_| m));
    for subdivision in [Subdivision::PerTriangle, Subdivision::Triangles(PatchSize::Count(5000))] {
        let mesh = PatchMesh::new(&scene, subdivision).unwrap();
        let irradiance = field(&scene, &mesh, |_, _, p| 1.0 + p.z);
        let display = DisplayMesh::new(&scene, &mesh, &irradiance);
        let positions: BTreeSet<u32> = display.vertices().iter().map(|v| v.position).collect();
        assert_eq!(positions.len(), display.vertices().len(), "one irradiance at each position");
    }
}

#[test]
fn what_covers_a_surface_is_not_darkened_by_it() {
    // The same two squares twice; light falls on the later ones, which lie on top.
    let scene = scene(|b, m| {
        for _ in 0..2 {
            rectangle(b, m, DVec3::ZERO, DVec3::X, DVec3::Y);
            rectangle(b, m, DVec3::X, DVec3::X, DVec3::Y);
        }
    });
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::Count(400))).unwrap();
    let irradiance = field(&scene, &mesh, |t, _, _| if t.0 < 4 { 0.0 } else { 1.0 });
    let display = DisplayMesh::new(&scene, &mesh, &irradiance);
    for piece in display.pieces().filter(|p| p.triangle.0 >= 4) {
        for &v in piece.triangles.iter().flatten() {
            assert_eq!(display.vertices()[v as usize].irradiance, [1.0; 3]);
        }
    }
}

#[test]
fn faces_as_patches_are_covered_by_their_triangles() {
    let scene = scene(|b, m| {
        shapes::cuboid(b, DVec3::ZERO, DVec3::ONE, [m; 6], Facing::Inward);
    });
    let mesh = PatchMesh::new(&scene, Subdivision::PerFace).unwrap();
    let irradiance: Vec<Rgb> = (0..6).map(|i| Rgb::splat(f64::from(i))).collect();
    let display = DisplayMesh::new(&scene, &mesh, &irradiance);
    assert_eq!(display.pieces().count(), 12);
    assert!((area(&display) - 6.0).abs() < 1e-12);
    for piece in display.pieces() {
        for &v in piece.triangles.iter().flatten() {
            assert_eq!(f64::from(display.vertices()[v as usize].irradiance[0]), f64::from(piece.id.0));
        }
    }
    assert_eq!(display.pieces().map(|p| p.id).collect::<BTreeSet<SideId>>().len(), 6);
}

/// A rectangle of 2 m x 1 m in two triangles, or in slivers.
fn floor(slivers: u32) -> Scene {
    scene(|b, m| {
        let corners = |n: u32| {
            (0..=n).map(move |i| DVec3::new(2.0 * f64::from(i) / f64::from(n), 1.0, 0.0)).collect::<Vec<_>>()
        };
        let start = b.add_vertex(DVec3::ZERO);
        let far: Vec<_> = corners(slivers).into_iter().map(|p| b.add_vertex(p)).collect();
        for ends in far.windows(2) {
            b.add_polygon(&[start, ends[1], ends[0]], m);
        }
        let right = b.add_vertex(2.0 * DVec3::X);
        b.add_polygon(&[start, right, far[far.len() - 1]], m);
    })
}

#[test]
fn cells_are_squares_whatever_the_triangles() {
    let linear = |p: DVec3| 3.0 + p.x - 2.0 * p.y;
    for slivers in [1, 40] {
        let scene = floor(slivers);
        let mesh = PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::MaxEdge(0.1))).unwrap();
        let irradiance = field(&scene, &mesh, |_, _, p| linear(p));
        let display = DisplayMesh::new(&scene, &mesh, &irradiance);
        assert_eq!((mesh.patch_count(), display.pieces().count()), (200, 200));
        assert!((area(&display) - 2.0).abs() < 1e-12);
        assert_conforming(&display, &scene);
        // The points of the slivers on the upper edge divide it.
        let on_edge = if slivers == 1 { 21 } else { 41 };
        assert_eq!(display.positions().iter().filter(|p| (p.y - 1.0).abs() < 1e-9).count(), on_edge);
        let inside = |x: f64, y: f64| x > 0.099 && x < 1.901 && y > 0.099 && y < 0.901;
        for v in display.vertices() {
            let p = display.positions()[v.position as usize];
            if inside(p.x, p.y) {
                assert!((f64::from(v.irradiance[1]) - linear(p)).abs() < 1e-6, "at {p}");
            }
        }
        for t in scene.triangle_ids() {
            for point in [(0.4, 0.3), (0.31, 0.45), (0.5, 0.25)].map(|(v, w)| Barycentric { v, w }) {
                let p = point.point(scene.corners(t));
                let e = display.irradiance_at(t, point, Side::Front).unwrap();
                assert!(!inside(p.x, p.y) || (e.z - linear(p)).abs() < 1e-6, "at {p}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Boxes whose corners are small integers touch and overlap in every way.
    #[test]
    fn any_heap_of_boxes_is_conforming(
        boxes in prop::collection::vec((prop::array::uniform3(0u8..4), prop::array::uniform3(1u8..4)), 1..4),
        both in any::<bool>(),
        max_area in 0.5..12.0f64,
        of_surfaces in any::<bool>(),
        seed in 0u32..1000,
    ) {
        let vector = |v: [u8; 3]| DVec3::from_array(v.map(f64::from));
        let scene = scene_with(if both { Sides::Both } else { Sides::Front }, |b, m| {
            for &(min, size) in &boxes {
                shapes::cuboid(b, vector(min), vector(min) + vector(size), [m; 6], Facing::Outward);
            }
        });
        let size = PatchSize::MaxArea(max_area);
        let rule = if of_surfaces { Subdivision::Surfaces(size) } else { Subdivision::Triangles(size) };
        let mesh = PatchMesh::new(&scene, rule).unwrap();
        let mut next = seed;
        let mut random = || {
            next = next.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(next >> 8) / f64::from(1 << 24)
        };
        let irradiance: Vec<Rgb> = (0..mesh.side_count()).map(|_| Rgb::splat(1.0 + random())).collect();
        let display = DisplayMesh::new(&scene, &mesh, &irradiance);
        assert_conforming(&display, &scene);
        let sides = if both { 2.0 } else { 1.0 };
        prop_assert!((area(&display) / (sides * scene.total_area()) - 1.0).abs() < 1e-9);
        for (vertex, value) in values(&display).into_iter().enumerate() {
            let place = position(&display, vertex as u32);
            prop_assert!((0.999_999..=2.0).contains(&value), "{value} at {place}");
        }
        for t in scene.triangle_ids() {
            let point = Barycentric { v: 0.5 * random(), w: 0.5 * random() };
            let e = display.irradiance_at(t, point, Side::Front).unwrap();
            prop_assert!((0.999_999..=2.000_001).contains(&e.x));
            prop_assert_eq!(display.irradiance_at(t, point, Side::Back).is_some(), both);
        }
    }
}
