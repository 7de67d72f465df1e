//! Convex hulls are closed and convex, contain all points, and have the known surface areas.

#![allow(clippy::unwrap_used, reason = "test helpers fail by panicking")]

use std::collections::{BTreeMap, HashMap};

use glam::{DMat3, DQuat, DVec3};
use proptest::prelude::*;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_lines::ConvexHull;

/// Returns six times the signed volume of a tetrahedron.
fn volume([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    (b - a).cross(c - a).dot(p - a)
}

#[track_caller]
fn assert_below(facet: [DVec3; 3], points: &[DVec3], slack: f64) {
    let [a, b, c] = facet;
    let longest = [b - a, c - b, a - c].iter().map(|e| e.length()).fold(0.0, f64::max);
    for &p in points {
        let (height, reach) = (volume(facet, p), longest.max(p.distance(a)));
        assert!(height <= slack * longest * reach, "{p} is above {facet:?}: {height:e}");
    }
}

/// Fails unless the facets at every edge have the same orientation, all facets form one closed surface of genus 0, and
/// no point lies above a facet by more than errors of `slack` in the corners explain.
#[track_caller]
fn assert_is_hull(hull: &ConvexHull, points: &[DVec3], slack: f64) {
    let bits = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
    let known: HashMap<_, _> = points.iter().enumerate().map(|(i, &p)| (bits(p), i)).collect();
    let mut edges: BTreeMap<[usize; 2], u32> = BTreeMap::new();
    let mut corners = Vec::new();
    for facet in hull.facets() {
        let ids = facet.map(|p| known[&bits(p)]);
        corners.extend(ids);
        for k in 0..3 {
            *edges.entry([ids[k], ids[(k + 1) % 3]]).or_default() += 1;
        }
        assert_below(*facet, points, slack);
    }
    // Both sides of a flat hull are cut along the same diagonals.
    let flat = points.iter().all(|&p| volume(hull.facets()[0], p) == 0.0);
    for (&[a, b], &count) in &edges {
        assert!(count == 1 || count == 2 && flat);
        assert_eq!(edges.get(&[b, a]), Some(&count), "edge {} {}", points[a], points[b]);
    }
    corners.sort_unstable();
    corners.dedup();
    let (v, e, f) = (corners.len() as u32, edges.values().sum::<u32>() / 2, hull.facets().len() as u32);
    assert_eq!(v + f, e + 2, "{v} corners, {e} edges, {f} facets");
}

/// Returns points on the surface of a cube: a regular mesh of `n × n` cells on each face.
fn subdivided_cube(n: u32) -> Vec<DVec3> {
    let mut points = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            for k in 0..=n {
                if [i, j, k].iter().any(|&x| x == 0 || x == n) {
                    points.push(DVec3::new(f64::from(i), f64::from(j), f64::from(k)) / f64::from(n));
                }
            }
        }
    }
    points
}

fn sphere(level: u32) -> sir_geom::Scene {
    let mut b = SceneBuilder::new();
    let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
    shapes::sphere(&mut b, DVec3::new(0.1, -20.0, 3.0), 1.7, level, Facing::Inward, |_| m);
    b.build().unwrap().scene
}

#[test]
fn known_bodies_have_their_surfaces() {
    let turned = DMat3::from_quat(DQuat::from_xyzw(0.1, 0.7, -0.3, 0.4).normalize());
    let size = DVec3::new(10.0, 0.3, 4.0);
    let cuboid = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    let tetrahedron = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let slope = 3f64.sqrt() / 2.0;
    for (what, points, surface) in [
        ("cube", subdivided_cube(1), 6.0),
        ("cube with masses of points", subdivided_cube(24), 6.0),
        ("cube of a size that has no short digits", subdivided_cube(7), 6.0),
        ("cuboid", subdivided_cube(6).iter().map(|p| size * p).collect(), cuboid),
        ("cuboid, turned", subdivided_cube(6).iter().map(|p| turned * (size * p)).collect(), cuboid),
        ("cuboid far away", subdivided_cube(6).iter().map(|p| size * p + 1024.0).collect(), cuboid),
        ("tetrahedron", tetrahedron, 1.5 + slope),
        (
            "octahedron",
            [DVec3::X, DVec3::Y, DVec3::Z].iter().flat_map(|&a| [a, -a]).collect(),
            4.0 * 3f64.sqrt(),
        ),
    ] {
        let hull = ConvexHull::of(&points).unwrap();
        let error = hull.surface_area() / surface - 1.0;
        assert!(error.abs() < 1e-11, "{what}: off by {error:e}");
        assert_is_hull(&hull, &points, 1e-10);
    }
}

#[test]
fn hull_of_a_round_mesh_is_the_mesh() {
    for level in [0, 2, 4] {
        let scene = sphere(level);
        let hull = ConvexHull::of(scene.vertices()).unwrap();
        assert_eq!(hull.facets().len(), scene.triangles().len());
        assert!((hull.surface_area() / scene.total_area() - 1.0).abs() < 1e-12);
    }
}

#[test]
fn what_is_inside_does_not_matter() {
    let mut points = sphere(3).vertices().to_vec();
    let hull = ConvexHull::of(&points).unwrap();
    let inside: Vec<DVec3> = points.iter().map(|&p| p.lerp(points[0], 0.4)).collect();
    points.extend(inside);
    points.extend_from_within(..);
    assert!((ConvexHull::of(&points).unwrap().surface_area() / hull.surface_area() - 1.0).abs() < 1e-13);
}

#[test]
fn flat_hulls_have_two_sides() {
    let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    let triangle = [DVec3::new(5.0, 0.0, 1.0), DVec3::new(5.0, 3.0, 1.0), DVec3::new(5.0, 0.0, 5.0)];
    let mut mesh = Vec::new();
    for i in 0..=20 {
        for j in 0..=10 {
            // In the plane z = x + 2y.
            let (x, y) = (f64::from(i) / 8.0, f64::from(j) / 4.0);
            mesh.push(DVec3::new(x, y, x + 2.0 * y));
        }
    }
    for (points, area) in [
        (&square[..], 1.0),
        (&triangle[..], 6.0),
        // Two triangles with a gap between them.
        (&[square[0], square[1], square[2], 3.0 * square[0], 3.0 * square[1], 3.0 * square[2]], 4.5),
        (&mesh, 2.5 * 2.5 * 6f64.sqrt()),
    ] {
        let hull = ConvexHull::of(points).unwrap();
        assert!((hull.surface_area() - 2.0 * area).abs() < 1e-12, "{}", hull.surface_area());
        assert_is_hull(&hull, points, 1e-12);
    }
}

#[test]
fn nearly_flat_bodies_are_no_exception() {
    for thickness in [1e-3, 1e-9, 1e-11, 2e-12, 1e-12, 5e-13, 1e-13, 1e-16] {
        for tilt in [0.0, 0.3] {
            let bend = |p: DVec3| DVec3::new(p.x, p.y, thickness * p.z + tilt * p.x);
            let points: Vec<DVec3> = subdivided_cube(9).into_iter().map(bend).collect();
            let hull = ConvexHull::of(&points).unwrap();
            let surface = 2.0 * (f64::hypot(1.0, tilt) + 2.0 * thickness);
            assert!((hull.surface_area() / surface - 1.0).abs() < 1e-11, "{thickness:e} {tilt}");
        }
    }
}

#[test]
fn a_line_has_no_hull() {
    let line: Vec<DVec3> = (0..50).map(|i| DVec3::new(0.5, 1.0, -2.0) * f64::from(i)).collect();
    for points in [&[][..], &line[..1], &line[..2], &line, &[DVec3::ONE; 9]] {
        assert_eq!(ConvexHull::of(points), None);
    }
    // Collinear only to the precision of the hull, not to that of doubles.
    let bent = [DVec3::ZERO, DVec3::new(1.0, 1e-14, 0.0), DVec3::new(2.0, 0.0, 0.0)];
    assert_eq!(ConvexHull::of(&bent), None);
}

/// Third-party scenes may contain any values.
#[test]
fn coordinates_that_make_no_sense_do_no_harm() {
    let odd = [f64::NAN, f64::INFINITY, -f64::INFINITY, f64::MAX, f64::MIN_POSITIVE, 0.0, 1.0];
    for x in odd {
        for y in odd {
            let points: Vec<DVec3> = odd.iter().map(|&z| DVec3::new(x, y, z)).chain([DVec3::ONE]).collect();
            let _ = ConvexHull::of(&points);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    /// On a tiny grid, most points are coplanar, collinear or equal. All numbers are exact.
    #[test]
    fn hulls_of_tiny_grids(
        points in prop::collection::vec(prop::array::uniform3(0..4i32), 1..40),
        shear in prop::array::uniform3(-2..3i32),
    ) {
        let points: Vec<DVec3> = points
            .into_iter()
            .map(|[x, y, z]| [x + shear[0] * y, y + shear[1] * z, z + shear[2] * x])
            .map(|p| DVec3::from_array(p.map(f64::from)))
            .collect();
        match ConvexHull::of(&points) {
            Some(hull) => assert_is_hull(&hull, &points, 0.0),
            None => {
                let collinear = |p: &DVec3| {
                    let far = points.iter().find(|q| **q != points[0]).map_or(DVec3::ZERO, |q| q - points[0]);
                    far.cross(p - points[0]) == DVec3::ZERO
                };
                prop_assert!(points.iter().all(collinear));
            }
        }
    }

    /// General points, some of them in planes that doubles do not represent exactly.
    #[test]
    fn hulls_of_any_points(
        points in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 4..60),
        flat in prop::array::uniform3(-1.0..1.0f64),
        offset in prop_oneof![Just(0.0), Just(1e3)],
    ) {
        let flat = DVec3::from_array(flat);
        let points: Vec<DVec3> = points
            .into_iter()
            .map(DVec3::from_array)
            .enumerate()
            .map(|(i, p)| if i % 3 == 0 { p } else { DVec3::new(p.x, p.y, flat.dot(p.with_z(1.0))) } + offset)
            .collect();
        let hull = ConvexHull::of(&points).unwrap();
        for facet in hull.facets() {
            assert_below(*facet, &points, 1e-11);
        }
        prop_assert_eq!(&ConvexHull::of(&points), &Some(hull));
    }
}
