//! Patches of surfaces: they do not depend on how a flat surface is cut into triangles, and are complete.

#![allow(clippy::unwrap_used, reason = "tests")]

use glam::DVec3;
use proptest::prelude::*;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Barycentric, Material, MaterialId, Rgb, Scene, SceneBuilder, Side, Sides, TriangleId};
use sir_mesh::{PatchId, PatchMesh, PatchSize, Subdivision};

fn gray(b: &mut SceneBuilder) -> MaterialId {
    b.add_material(Material::diffuse("gray", Rgb::splat(0.5)))
}

fn scene(fill: impl FnOnce(&mut SceneBuilder, MaterialId)) -> Scene {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    fill(&mut b, m);
    b.build().unwrap().scene
}

fn mesh(scene: &Scene, size: PatchSize) -> PatchMesh {
    PatchMesh::new(scene, Subdivision::Surfaces(size)).unwrap()
}

/// Adds triangles of a flat polygon in the plane z = 0, each with corners of its own.
fn add(b: &mut SceneBuilder, m: MaterialId, triangles: &[[[f64; 2]; 3]]) {
    for triangle in triangles {
        let v = triangle.map(|[x, y]| b.add_vertex(DVec3::new(x, y, 0.0)));
        b.add_polygon(&v, m);
    }
}

/// Checks that patches and their pieces are complete: areas add up, numbers are those of a lookup, and random points are in
/// the patch.
fn check_books(scene: &Scene, mesh: &PatchMesh) {
    let mut areas = vec![0.0; mesh.patch_count()];
    for t in scene.triangle_ids() {
        let mut share = 0.0;
        mesh.for_each_piece_of(t, |patch, piece| {
            assert_eq!(piece.triangle, t);
            areas[patch.index()] += scene.area(t) * piece.share();
            share += piece.share();
            let n = piece.corners().len() as f64;
            let sum = |f: fn(&Barycentric) -> f64| piece.corners().iter().map(f).sum::<f64>() / n;
            let middle = Barycentric { v: sum(|p| p.v), w: sum(|p| p.w) };
            if piece.share() > 1e-9 {
                assert_eq!(mesh.patch_at(t, middle), patch, "the middle of a piece");
            }
        });
        assert!((share - 1.0).abs() < 1e-12, "the pieces of a triangle are {share} of it");
    }
    let total: f64 = areas.iter().sum();
    assert!((total / scene.total_area() - 1.0).abs() < 1e-12);
    let mut next = 0;
    mesh.for_each_side(|t, patch, side, id| {
        assert_eq!(id.index(), next);
        next += 1;
        let area = mesh.patch_area(t, patch);
        assert!((area / areas[patch.index()] - 1.0).abs() < 1e-10, "{area}");
        assert_eq!((mesh.patch_of_side(t, id), mesh.side_of(t, patch, side)), (patch, Some(id)));
        let pieces: f64 = mesh.pieces(t, patch).map(|p| scene.area(p.triangle) * p.share()).sum();
        assert!((pieces / area - 1.0).abs() < 1e-10);
        for random in [0.0, 0.3, 0.77, 1.0 - 1e-16] {
            let (triangle, [a, b, c], rest) = mesh.random_part(t, patch, random);
            assert!((0.0..1.0).contains(&rest));
            let middle = Barycentric { v: (a.v + b.v + c.v) / 3.0, w: (a.w + b.w + c.w) / 3.0 };
            let twice = (b.v - a.v) * (c.w - a.w) - (b.w - a.w) * (c.v - a.v);
            if twice > 1e-9 {
                assert_eq!(mesh.patch_at(triangle, middle), patch, "a random point");
            }
        }
    });
    assert_eq!(next, mesh.side_count());
}

/// Areas of the patches, sorted.
fn areas(mesh: &PatchMesh) -> Vec<f64> {
    let mut areas = Vec::new();
    mesh.for_each_side(|t, patch, side, _| {
        if side == Side::Front {
            areas.push(mesh.patch_area(t, patch));
        }
    });
    areas.sort_by(f64::total_cmp);
    areas
}

#[test]
fn the_cells_of_a_rectangle_do_not_depend_on_its_triangles() {
    let plain = scene(|b, m| {
        add(b, m, &[[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]], [[0.0, 0.0], [4.0, 3.0], [0.0, 3.0]]])
    });
    // Slivers from one corner, and a T-junction: the last ones end in the middle of the edge of another.
    let slivers = scene(|b, m| {
        let n = 40;
        for i in 0..n {
            let at = |i: i32| [4.0, 3.0 * f64::from(i) / f64::from(n)];
            add(b, m, &[[[0.0, 0.0], at(i), at(i + 1)]]);
        }
        for i in 0..n {
            let at = |i: i32| [4.0 * f64::from(i) / f64::from(n), 3.0];
            add(b, m, &[[[0.0, 1.5], at(i + 1), at(i)]]);
        }
        add(b, m, &[[[0.0, 0.0], [4.0, 3.0], [0.0, 1.5]]]);
    });
    assert!((plain.total_area() - slivers.total_area()).abs() < 1e-12);
    for size in [PatchSize::Count(1200), PatchSize::MaxArea(0.01), PatchSize::MaxEdge(0.1)] {
        let (one, other) = (mesh(&plain, size), mesh(&slivers, size));
        assert_eq!((one.patch_count(), other.patch_count()), (1200, 1200));
        assert!(areas(&one).iter().chain(&areas(&other)).all(|area| (area - 0.01).abs() < 1e-12));
        check_books(&plain, &one);
        check_books(&slivers, &other);
    }
}

#[test]
fn cells_are_cut_by_the_outline_and_fragments_join_a_neighbor() {
    // A trapezoid with a hole, in 2 + 6 triangles.
    let fill = |b: &mut SceneBuilder, m: MaterialId| {
        let outer = [[0.0, 0.0], [6.0, 0.0], [4.4, 3.3], [0.7, 3.3]];
        let inner = [[2.0, 1.0], [3.1, 1.0], [3.1, 2.1], [2.0, 2.1]];
        for i in 0..4 {
            let j = (i + 1) % 4;
            add(b, m, &[[outer[i], outer[j], inner[j]], [outer[i], inner[j], inner[i]]]);
        }
    };
    let scene = scene(fill);
    let mesh = mesh(&scene, PatchSize::MaxEdge(0.25));
    check_books(&scene, &mesh);
    let areas = areas(&mesh);
    let full = 0.25 * (3.3 / 14.0);
    assert!(areas[0] > 0.3 * full - 1e-9, "{} of {full}", areas[0]);
    assert!(areas[areas.len() - 1] < 2.0 * full);
}

#[test]
fn triangles_that_overlap_are_never_joined() {
    // Two layers that share corners and edges.
    let square = [[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
    let beside = [[[1.0, 0.0], [2.0, 0.0], [2.0, 1.0]], [[1.0, 0.0], [2.0, 1.0], [1.0, 1.0]]];
    let scene = scene(|b, m| {
        add(b, m, &square);
        add(b, m, &beside);
        add(b, m, &square);
    });
    let mesh = mesh(&scene, PatchSize::MaxEdge(0.1));
    check_books(&scene, &mesh);
    assert_eq!(mesh.patch_count(), 300);
    let middle = Barycentric { v: 0.4, w: 0.3 };
    assert_ne!(mesh.patch_at(TriangleId(0), middle), mesh.patch_at(TriangleId(4), middle));
}

#[test]
fn what_stands_on_an_edge_separates_patches() {
    // A floor of two squares; a wall stands on half of the edge between them.
    let floor = |b: &mut SceneBuilder, m: MaterialId| {
        add(b, m, &[[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0]]]);
        add(b, m, &[[[1.0, 0.0], [2.0, 0.0], [2.0, 1.0]], [[1.0, 0.0], [2.0, 1.0], [1.0, 1.0]]]);
    };
    let wall = |b: &mut SceneBuilder, m: MaterialId, to: f64| {
        let corners = [[0.0, 0.0], [to, 0.0], [to, 1.0], [0.0, 1.0]];
        let v = corners.map(|[y, z]| b.add_vertex(DVec3::new(1.0, y, z)));
        b.add_polygon(&v, m);
    };
    // Three columns, the middle one of which the wall divides.
    let size = PatchSize::MaxEdge(0.7);
    let of_floor = |scene: &Scene, mesh: &PatchMesh| {
        let mut patches = Vec::new();
        (0..4).for_each(|t| mesh.for_each_piece_of(TriangleId(t), |patch, _| patches.push(patch)));
        patches.sort();
        patches.dedup();
        check_books(scene, mesh);
        patches.len()
    };
    let open = scene(floor);
    assert_eq!(of_floor(&open, &mesh(&open, size)), 6);
    let whole = scene(|b, m| {
        floor(b, m);
        wall(b, m, 1.0);
    });
    assert_eq!(of_floor(&whole, &mesh(&whole, size)), 8, "two surfaces of two columns");
    // The surface is one around the end of the wall.
    let half = scene(|b, m| {
        floor(b, m);
        add(b, m, &[]);
        wall(b, m, 0.5);
    });
    let number = of_floor(&half, &mesh(&half, size));
    assert!(number >= 6, "{number}");
}

#[test]
fn small_triangles_of_a_bent_surface_are_joined() {
    let scene = scene(|b, m| {
        shapes::cuboid(b, DVec3::splat(-5.0), DVec3::splat(5.0), [m; 6], Facing::Inward);
        shapes::sphere(b, DVec3::ZERO, 1.0, 5, Facing::Outward, |_| m);
    });
    let triangles = scene.triangles().len();
    let mesh = mesh(&scene, PatchSize::Count(3000));
    assert!(triangles > 20_000);
    assert!((mesh.patch_count() as f64 / 3000.0 - 1.0).abs() < 0.02, "{}", mesh.patch_count());
    check_books(&scene, &mesh);
    let width = (scene.total_area() / 3000.0).sqrt();
    mesh.for_each_side(|t, patch, _, _| {
        let corners: Vec<(DVec3, DVec3)> = mesh
            .pieces(t, patch)
            .flat_map(|p| scene.corners(p.triangle).map(|corner| (corner, scene.normal(p.triangle))))
            .collect();
        if t.0 >= 12 {
            for (p, n) in &corners {
                for (q, m) in &corners {
                    assert!(p.distance(*q) < 1.6 * width);
                    assert!(n.dot(*m) > 0.8);
                }
            }
        }
    });
}

#[test]
fn limits_hold() {
    let scene = scene(|b, m| {
        shapes::cuboid(b, DVec3::ZERO, DVec3::new(10.0, 7.0, 3.0), [m; 6], Facing::Inward);
        // A slat.
        shapes::cuboid(b, DVec3::splat(1.0), DVec3::new(3.0, 1.02, 1.02), [m; 6], Facing::Outward);
        shapes::sphere(b, DVec3::new(5.0, 3.0, 1.5), 1.0, 2, Facing::Outward, |_| m);
    });
    for max in [0.5, 0.02] {
        let mesh = mesh(&scene, PatchSize::MaxArea(max));
        check_books(&scene, &mesh);
        mesh.for_each_side(|t, patch, _, _| assert!(mesh.patch_area(t, patch) <= max * (1.0 + 1e-9)));
    }
    let bad = PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::MaxEdge(-1.0)));
    assert!(bad.is_err());
    assert!(PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::Count(1 << 40))).is_err());
    assert!(PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::MaxEdge(1e-9))).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Random points of a turned and moved polygon.
    #[test]
    fn every_point_has_one_patch(seed in 0u64..1000, width in 0.02..2.0f64, turn in 0.0..6.0f64) {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)).with_sides(Sides::Both));
        let n = 3 + seed % 9;
        let corners: Vec<DVec3> = (0..n)
            .map(|i| {
                let angle = std::f64::consts::TAU * i as f64 / n as f64;
                let radius = 1.0 + 0.7 * ((seed * (i + 3)) as f64).sin();
                let flat = DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0);
                glam::DQuat::from_euler(glam::EulerRot::XYZ, turn, 2.0 * turn, 0.3) * flat + DVec3::new(3.0, -2.0, 1.0)
            })
            .collect();
        let v: Vec<_> = corners.iter().map(|&p| b.add_vertex(p)).collect();
        let middle = b.add_vertex(corners.iter().sum::<DVec3>() / n as f64);
        for i in 0..v.len() {
            b.add_polygon(&[v[i], v[(i + 1) % v.len()], middle], m);
        }
        let scene = b.build().unwrap().scene;
        let mesh = mesh(&scene, PatchSize::MaxEdge(width));
        check_books(&scene, &mesh);
        prop_assert_eq!(mesh.side_count(), 2 * mesh.patch_count());
        prop_assert_eq!(mesh.patch_at(TriangleId(0), Barycentric { v: 0.2, w: 0.2 }).0 < mesh.patch_count() as u32, true);
        let _ = PatchId(0);
    }
}
