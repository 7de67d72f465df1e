//! Checks the lines of all domains against results of integral geometry, within four standard errors.

#![allow(clippy::unwrap_used, reason = "test helpers fail by panicking")]

use glam::{DMat3, DQuat, DVec3};
use sir_geom::{Material, Rgb, Scene, SceneBuilder};
use sir_lines::{Domain, Purpose, Stream, Streams, point_on_triangle};
use sir_types::Line;

const LINES: u64 = 200_000;

/// Corners of a tetrahedron without symmetry.
const TETRAHEDRON: [DVec3; 4] = [
    DVec3::new(1.0, -2.0, 3.0),
    DVec3::new(4.0, -1.0, 3.5),
    DVec3::new(1.5, 0.5, 2.5),
    DVec3::new(2.0, -1.0, 5.0),
];

/// Corners of the faces of the tetrahedron, counterclockwise seen from outside.
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn face(f: usize) -> [DVec3; 3] {
    FACES[f].map(|i| TETRAHEDRON[i])
}

/// Returns the outward normal, whose length is twice the area.
fn scaled_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

fn scene(triangles: &[[DVec3; 3]]) -> Scene {
    let mut b = SceneBuilder::new();
    let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
    for corners in triangles {
        let corners = corners.map(|p| b.add_vertex(p));
        b.add_polygon(&corners, m);
    }
    b.build().unwrap().scene
}

fn tetrahedron() -> Scene {
    scene(&[0, 1, 2, 3].map(face))
}

/// Returns the three domains around a scene.
fn domains(scene: &Scene) -> [Domain; 3] {
    let domains = [
        Domain::Sphere(scene.bounding_sphere()),
        Domain::Box(scene.bounding_box()),
        Domain::hull(scene.vertices()),
    ];
    assert_eq!(domains.each_ref().map(Domain::name), ["Sphere", "Box", "Hull"]);
    domains
}

fn lines(domain: &Domain, stage: u64) -> impl Iterator<Item = Line> {
    let streams = Streams::new(3, Purpose(stage));
    (0..LINES).map(move |i| domain.line(streams.line(i).point()))
}

/// Fails unless the mean of `samples` is within four of its standard errors of the expected value.
#[track_caller]
fn assert_mean(samples: impl IntoIterator<Item = f64>, expected: f64, what: &str) {
    let (mut n, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for x in samples {
        (n, sum, squares) = (n + 1.0, sum + x, squares + x * x);
    }
    let mean = sum / n;
    let sigma = ((squares / n - mean * mean) / n).sqrt();
    assert!(n > 1_000.0 && (mean - expected).abs() <= 4.0 * sigma, "{what}: {mean} ± {sigma}, {expected}");
}

/// Returns the distance at which a line leaves the body bounded by these planes (points and outward normals).
fn exit(line: &Line, planes: &[[DVec3; 2]]) -> f64 {
    let along =
        planes.iter().map(|[point, normal]| (normal.dot(point - line.origin), normal.dot(line.direction)));
    along.filter(|(_, rate)| *rate > 0.0).map(|(height, rate)| height / rate).fold(f64::INFINITY, f64::min)
}

/// The mean chord length of a convex body is 4V/S (Cauchy).
#[test]
fn mean_chords_are_those_of_cauchy() {
    let scene = tetrahedron();
    let [sphere, cuboid, hull] = domains(&scene);

    let Domain::Sphere(s) = sphere else { unreachable!() };
    let chord = |line: Line| 2.0 * (s.center - line.origin).dot(line.direction);
    assert_mean(lines(&sphere, 1).map(chord), 4.0 / 3.0 * s.radius, "sphere");

    let bounds = scene.bounding_box();
    let size = bounds.size();
    let surface = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    assert_eq!(cuboid.surface(), surface);
    let planes: Vec<_> =
        DVec3::AXES.iter().flat_map(|&axis| [[bounds.max, axis], [bounds.min, -axis]]).collect();
    let chords = lines(&cuboid, 2).map(|line| exit(&line, &planes));
    assert_mean(chords, 4.0 * size.element_product() / surface, "box");

    let planes = [0, 1, 2, 3].map(|f| [face(f)[0], scaled_normal(face(f))]);
    let surface: f64 = planes.iter().map(|[_, normal]| 0.5 * normal.length()).sum();
    let volume = scaled_normal(face(0)).dot(face(0)[0] - TETRAHEDRON[3]) / 6.0;
    assert!(volume > 0.0 && (hull.surface() / surface - 1.0).abs() < 1e-14);
    assert_mean(lines(&hull, 3).map(|line| exit(&line, &planes)), 4.0 * volume / surface, "hull");
}

/// Lines start on the surface and point inside; entries are uniform by area.
#[test]
fn entries_are_uniform_on_the_surface() {
    let scene = tetrahedron();
    let [_, cuboid, hull] = domains(&scene);
    let bounds = scene.bounding_box();
    let (size, surface) = (bounds.size(), cuboid.surface());
    for axis in 0..3 {
        let area = size.element_product() / size[axis];
        for (end, inward) in [(bounds.min, 1.0), (bounds.max, -1.0)] {
            let here = |line: &Line| (line.origin[axis] - end[axis]).abs() < 1e-14;
            let entries: Vec<Line> = lines(&cuboid, 4).filter(here).collect();
            assert!(entries.iter().all(|line| inward * line.direction[axis] >= 0.0));
            let share = lines(&cuboid, 4).map(|line| f64::from(u8::from(here(&line))));
            assert_mean(share, area / surface, "share of a face");
            let u = entries.iter().map(|line| (line.origin - bounds.min) / size).collect::<Vec<_>>();
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            assert_mean(u.iter().map(|u| u[i]), 0.5, "mean place in a face");
            assert_mean(u.iter().map(|u| u[i] * u[i]), 1.0 / 3.0, "spread in a face");
            assert_mean(u.iter().map(|u| (u[i] - 0.5) * (u[j] - 0.5)), 0.0, "correlation in a face");
        }
    }
    for f in 0..4 {
        let corners = face(f);
        let normal = scaled_normal(corners);
        let area = 0.5 * normal.length();
        let here = |line: &Line| normal.dot(line.origin - corners[0]).abs() < 1e-13;
        let share = lines(&hull, 5).map(|line| f64::from(u8::from(here(&line))));
        assert_mean(share, area / hull.surface(), "share of a facet");
        // Barycentric weights of the corners: the areas of the triangles opposite to them.
        let weights = lines(&hull, 5).filter(here).map(|line| {
            assert!(normal.dot(line.direction) <= 0.0);
            let part =
                |p: DVec3, q: DVec3| scaled_normal([p, q, line.origin]).dot(normal) / normal.length_squared();
            let [a, b, c] = corners;
            [part(b, c), part(c, a), part(a, b)]
        });
        let weights: Vec<[f64; 3]> = weights.collect();
        assert!(weights.iter().flatten().all(|&w| w > -1e-12));
        for k in 0..3 {
            assert_mean(weights.iter().map(|w| w[k]), 1.0 / 3.0, "mean place in a facet");
            assert_mean(weights.iter().map(|w| w[k] * w[k]), 1.0 / 6.0, "spread in a facet");
            assert_mean(weights.iter().map(|w| w[k] * w[(k + 1) % 3]), 1.0 / 12.0, "correlation in a facet");
        }
    }
}

/// The density of directions is in proportion to the projected area of the body: `cos θ/π` about the normal of each
/// facet, so that `E[ω ωᵀ] = Σ (A/S) (1 + n nᵀ)/4`. For a sphere it is uniform.
#[test]
fn directions_are_in_proportion_to_the_shadow() {
    let [sphere, cuboid, hull] = domains(&tetrahedron());
    let size = tetrahedron().bounding_box().size();
    // The faces of a cube have the same sums as a sphere.
    let both = |size: DVec3| DVec3::AXES.map(|a| a * size.element_product() / size).map(|a| [a, -a]);
    let cube = both(DVec3::splat((sphere.surface() / 6.0).sqrt())).concat();
    let box_faces = both(size).concat();
    let hull_faces = (0..4).map(|f| 0.5 * scaled_normal(face(f))).collect();
    for (domain, faces) in [(sphere, cube), (cuboid, box_faces), (hull, hull_faces)] {
        let faces: Vec<DVec3> = faces;
        assert!(lines(&domain, 6).all(|line| (line.direction.length() - 1.0).abs() < 1e-14));
        for i in 0..3 {
            assert_mean(lines(&domain, 6).map(|line| line.direction[i]), 0.0, domain.name());
            for j in 0..3 {
                let term = |a: &DVec3| a.length() * f64::from(u8::from(i == j)) + a[i] * a[j] / a.length();
                let expected = faces.iter().map(term).sum::<f64>() / (4.0 * domain.surface());
                let product = lines(&domain, 6).map(|line| line.direction[i] * line.direction[j]);
                assert_mean(product, expected, domain.name());
            }
        }
    }
}

/// The distribution of the lines that meet a ball does not depend on the domain: their number is that of the forecast,
/// their directions are isotropic, and their squared distance from the center is uniform.
#[test]
fn lines_through_a_ball_do_not_know_where_they_come_from() {
    // A ball slightly smaller than the inscribed one, and another one nearer to a corner.
    let areas = [0, 1, 2, 3].map(|f| 0.5 * scaled_normal(face(f)).length());
    let surface: f64 = areas.iter().sum();
    // Barycentric weights of the corners: the areas of the faces opposite to them.
    let middle = (0..4).map(|f| areas[f] * TETRAHEDRON[[3, 2, 0, 1][f]]).sum::<DVec3>() / surface;
    let volume = scaled_normal(face(0)).dot(face(0)[0] - TETRAHEDRON[3]) / 6.0;
    let largest = 0.99 * 3.0 * volume / surface;
    for (center, radius) in [(middle, largest), (middle.lerp(TETRAHEDRON[3], 0.4), 0.6 * largest)] {
        for f in 0..4 {
            let height = scaled_normal(face(f)).normalize().dot(face(f)[0] - center);
            assert!(height > radius, "the ball is in the tetrahedron: {height}");
        }
        let area = 4.0 * std::f64::consts::PI * radius * radius;
        for domain in domains(&tetrahedron()) {
            let what = domain.name();
            let offset = |line: &Line| {
                let to = center - line.origin;
                (to - to.dot(line.direction) * line.direction) / radius
            };
            let meets = |line: &Line| offset(line).length_squared() < 1.0;
            let counted = lines(&domain, 7).filter(meets).count() as f64;
            // Each of these lines crosses the surface of the ball twice.
            let expected = 0.5 * domain.forecast(LINES).crossings(area);
            let z = (counted - expected) / expected.sqrt();
            assert!(expected > 1_000.0 && z.abs() < 4.0, "{what}: {counted} lines, {expected:.0} expected");
            let through = || lines(&domain, 7).filter(meets);
            assert_mean(through().map(|line| offset(&line).length_squared()), 0.5, what);
            assert_mean(through().map(|line| offset(&line).length_squared().powi(2)), 1.0 / 3.0, what);
            for i in 0..3 {
                assert_mean(through().map(|line| offset(&line)[i]), 0.0, what);
                for j in 0..3 {
                    let expected = if i == j { 1.0 / 3.0 } else { 0.0 };
                    assert_mean(through().map(|line| line.direction[i] * line.direction[j]), expected, what);
                }
            }
        }
    }
}

/// For 200 patches at random positions in the body, the squared normalized deviations of their crossings from the
/// forecast add up to χ².
#[test]
fn crossings_of_patches_are_those_of_the_forecast() {
    let streams = Streams::new(9, Purpose::PROBE);
    let patch = |i: u64| -> [DVec3; 3] {
        let s = &mut streams.line(i);
        let inside = |s: &mut Stream| {
            let on_face = point_on_triangle(s.point()).point(face(0));
            TETRAHEDRON[3].lerp(on_face, 0.3 + 0.6 * s.unit())
        };
        // A small triangle.
        let a = inside(s);
        [a, a.lerp(inside(s), 0.4), a.lerp(inside(s), 0.4)]
    };
    let patches: Vec<[DVec3; 3]> = (0..200).map(patch).collect();
    let crosses = |line: &Line, [a, b, c]: &[DVec3; 3]| {
        let side = |p: &DVec3, q: &DVec3| line.direction.dot((p - line.origin).cross(q - line.origin)) > 0.0;
        side(a, b) == side(b, c) && side(b, c) == side(c, a)
    };
    for domain in domains(&tetrahedron()) {
        let mut counted = vec![0.0; patches.len()];
        for line in lines(&domain, 8) {
            for (count, patch) in counted.iter_mut().zip(&patches) {
                *count += f64::from(u8::from(crosses(&line, patch)));
            }
        }
        let forecast = domain.forecast(LINES);
        let (mut chi2, mut least) = (0.0, f64::INFINITY);
        for (count, patch) in counted.iter().zip(&patches) {
            let expected = forecast.crossings(0.5 * scaled_normal(*patch).length());
            chi2 += (count - expected).powi(2) / expected;
            least = f64::min(least, expected);
        }
        let n = patches.len() as f64;
        let z = (chi2 - n) / (2.0 * n).sqrt();
        assert!(z.abs() < 4.0, "{}: χ² = {chi2:.0} of {n}, at least {least} expected", domain.name());
    }
}

#[test]
fn flat_scenes_have_flat_domains() {
    let turned = DMat3::from_quat(DQuat::from_xyzw(0.1, 0.7, -0.3, 0.4).normalize());
    let corners =
        [DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0), DVec3::new(3.0, 0.0, 2.0), DVec3::new(0.0, 0.0, 2.0)];
    let rectangle = |corners: [DVec3; 4]| {
        let [a, b, c, d] = corners;
        scene(&[[a, b, c], [a, c, d]])
    };
    let straight = rectangle(corners);
    assert!((Domain::hull(straight.vertices()).surface() - 12.0).abs() < 1e-14);
    assert!((Domain::Box(straight.bounding_box()).surface() - 12.0).abs() < 1e-14);
    let slanted = rectangle(corners.map(|p| turned * p));
    assert!((Domain::hull(slanted.vertices()).surface() - 12.0).abs() < 1e-11);
    for domain in [Domain::hull(straight.vertices()), Domain::Box(straight.bounding_box())] {
        let up = |line: Line| {
            assert!(line.origin.y == 0.0 && (0.0..=3.0).contains(&line.origin.x));
            line.direction.y.signum()
        };
        assert_mean(lines(&domain, 10).map(up), 0.0, domain.name());
    }
}

/// The domain of a triangle that is degenerate to twelve digits is its box instead of its hull.
#[test]
fn a_needle_has_a_box() {
    // Slightly longer than a power of two, so that the grid steps are as large as possible.
    let end = DVec3::new(0.5, 0.5, -1.0) * (1.0 + 1.0 / 1024.0);
    let needle = scene(&[[DVec3::ZERO, end, 0.5 * end + DVec3::new(0.9e-12, -0.9e-12, 0.0)]]);
    let domain = Domain::hull(needle.vertices());
    assert_eq!(domain, Domain::Box(needle.bounding_box()));
    assert!(domain.surface() > 0.0);
}

/// The lines of a domain are part of the contract: if they change, earlier results cannot be reproduced.
#[test]
fn lines_never_change() {
    let mut text = String::new();
    for domain in domains(&tetrahedron()) {
        let Line { origin, direction } = domain.line(Streams::new(1, Purpose::GLOBAL).line(0).point());
        text += &format!("{} {origin:.12} {direction:.12}\n", domain.name());
    }
    assert_eq!(
        text,
        "Sphere [2.629017382561, -2.584904838160, 4.492513237084] [-0.804072656913, 0.529348502836, 0.270660903994]\n\
         Box [3.346994459560, -2.000000000000, 4.082627909983] [0.553663102618, 0.825946290483, -0.106159757143]\n\
         Hull [2.199654021065, -0.122995943661, 2.830662491181] [0.571737495566, 0.505363988884, 0.646315306103]\n"
    );
}

/// Any point sequence can be used: with a Halton sequence, the crossings of a square agree with the forecast much
/// better than with random points.
#[test]
fn low_discrepancy_points_make_uniform_lines() {
    let radical_inverse = |base: u64, mut number: u64| {
        let (mut value, mut scale) = (0.0, 1.0);
        while number > 0 {
            scale /= base as f64;
            value += scale * (number % base) as f64;
            number /= base;
        }
        value
    };
    let scene = tetrahedron();
    let middle = TETRAHEDRON.iter().sum::<DVec3>() / 4.0;
    for domain in domains(&scene) {
        let crosses = |i: &u64| {
            let line = domain.line([2, 3, 5, 7, 11, 13].map(|base| radical_inverse(base, *i)));
            let p = line.at((middle.z - line.origin.z) / line.direction.z) - middle;
            p.x.abs() < 0.2 && p.y.abs() < 0.2
        };
        let counted = (1..=LINES).filter(crosses).count() as f64;
        let expected = domain.forecast(LINES).crossings(0.16);
        assert!(
            (counted - expected).abs() < 1.5 * expected.sqrt(),
            "{}: {counted} {expected}",
            domain.name()
        );
    }
}
