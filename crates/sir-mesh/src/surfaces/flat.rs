//! Flat surfaces: triangles that continue each other in one plane.

use glam::DVec3;
use sir_geom::{BoundingBox, Scene, TriangleId};

use crate::surfaces::adjacency::Adjacency;
use crate::surfaces::overlap::without_overlaps;

/// Largest distance of the corners from the plane of a surface, relative to the size of the surface. Files give positions
/// to five or six digits.
const FLATNESS: f64 = 1e-5;

/// Difference up to which edges have one direction, in [`turn`]s: about half a degree.
const SAME_DIRECTION: f64 = 0.01;

/// A flat surface.
#[derive(Clone, Debug)]
pub(crate) struct FlatSurface {
    /// Its triangles. None overlap.
    pub(crate) triangles: Vec<TriangleId>,
    pub(crate) area: f64,
    pub(crate) normal: DVec3,
    /// Unit vectors of the smallest rectangle around it along its longest edges; seen from the front, the second is to the
    /// left of the first.
    pub(crate) axes: [DVec3; 2],
    /// Corner of that rectangle, and its lengths along the axes.
    pub(crate) origin: DVec3,
    pub(crate) extent: [f64; 2],
    pub(crate) bounds: BoundingBox,
    /// True if it may be cut.
    pub(crate) is_inside: bool,
    /// True if its patches are parts of one triangle: a lamp with a texture, each patch of which is a light source.
    pub(crate) is_single: bool,
}

/// Plane through the triangles that a surface has so far.
#[derive(Clone, Copy)]
struct Plane {
    /// Sum of the normals times twice the areas.
    normal: DVec3,
    /// Sum of the centroids times twice the areas, and sum of these.
    moment: DVec3,
    weight: f64,
    low: DVec3,
    high: DVec3,
}

impl Plane {
    fn of(scene: &Scene, t: TriangleId) -> Self {
        let [a, b, c] = scene.corners(t);
        let normal = (b - a).cross(c - a);
        let weight = normal.length();
        let moment = weight / 3.0 * (a + b + c);
        Self { normal, moment, weight, low: a.min(b).min(c), high: a.max(b).max(c) }
    }

    fn and(&self, other: &Self) -> Self {
        Self {
            normal: self.normal + other.normal,
            moment: self.moment + other.moment,
            weight: self.weight + other.weight,
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// True if a triangle lies in the plane and shows its front on the same side.
    fn contains(&self, scene: &Scene, t: TriangleId, of_triangle: &Self) -> bool {
        let (normal, center) = (self.normal.normalize_or_zero(), self.moment / self.weight);
        let extent = self.high.max(of_triangle.high) - self.low.min(of_triangle.low);
        let most = FLATNESS * extent.length();
        of_triangle.normal.dot(normal) > 0.0
            && scene.corners(t).iter().all(|&corner| (corner - center).dot(normal).abs() <= most)
    }
}

/// Returns the flat surfaces of a scene, in the order of their first triangles, and the surface of each triangle. Those
/// whose centroid is not in the box, if one is given, are not inside.
pub(crate) fn flat_surfaces(
    scene: &Scene,
    adjacency: &Adjacency,
    bounds: Option<BoundingBox>,
) -> (Vec<FlatSurface>, Vec<u32>) {
    const NONE: u32 = u32::MAX;
    let inside: Vec<bool> = scene
        .triangle_ids()
        .map(|t| bounds.is_none_or(|bounds| bounds.contains(crate::subdivision::centroid(scene, t))))
        .collect();
    let mut of_triangle = vec![NONE; inside.len()];
    let mut found: Vec<Vec<TriangleId>> = Vec::new();
    for seed in by_width(scene) {
        if of_triangle[seed.index()] != NONE {
            continue;
        }
        let number = found.len() as u32;
        let is_single = |t: TriangleId| scene.emits(t) && scene.is_varied(t);
        let (grown, normal) = grow(scene, adjacency, seed, |t| {
            of_triangle[t.index()] == NONE
                && inside[t.index()] == inside[seed.index()]
                && !is_single(t)
                && !is_single(seed)
        });
        let (kept, _) = without_overlaps(scene, grown, normal);
        kept.iter().for_each(|t| of_triangle[t.index()] = number);
        found.push(kept);
    }
    found.iter_mut().for_each(|triangles| triangles.sort_unstable());
    found.sort_unstable_by_key(|triangles| triangles[0]);
    for (number, triangles) in (0..).zip(&found) {
        triangles.iter().for_each(|t| of_triangle[t.index()] = number);
    }
    let surfaces = found
        .into_iter()
        .zip(0..)
        .map(|(triangles, number)| {
            let is_inside = inside[triangles[0].index()];
            let is_rim = |t: TriangleId, edge: u8| {
                let beyond = adjacency.of(t).iter().filter(|(e, _)| *e == edge);
                !beyond.into_iter().any(|(_, other)| of_triangle[other.index()] == number)
            };
            FlatSurface::new(scene, triangles, is_rim, is_inside)
        })
        .collect();
    (surfaces, of_triangle)
}

/// Returns the triangles in the order of the radii of their inscribed circles, the widest first: their planes are known
/// best.
fn by_width(scene: &Scene) -> Vec<TriangleId> {
    let width = |t| {
        let [a, b, c] = scene.corners(t);
        scene.area(t) / (a.distance(b) + b.distance(c) + c.distance(a))
    };
    let widths: Vec<f64> = scene.triangle_ids().map(width).collect();
    let mut order: Vec<TriangleId> = scene.triangle_ids().collect();
    order.sort_by(|a, b| widths[b.index()].total_cmp(&widths[a.index()]).then(a.cmp(b)));
    order
}

/// Returns the triangles that continue a triangle in its plane, with it as the first one, and their normal.
fn grow(
    scene: &Scene,
    adjacency: &Adjacency,
    seed: TriangleId,
    is_free: impl Fn(TriangleId) -> bool,
) -> (Vec<TriangleId>, DVec3) {
    let mut plane = Plane::of(scene, seed);
    let mut grown = vec![seed];
    let mut taken = std::collections::BTreeSet::from([seed]);
    let mut next = 0;
    while next < grown.len() {
        for &(_, t) in adjacency.of(grown[next]) {
            if taken.contains(&t) || !is_free(t) {
                continue;
            }
            let of_triangle = Plane::of(scene, t);
            if plane.contains(scene, t, &of_triangle) {
                plane = plane.and(&of_triangle);
                taken.insert(t);
                grown.push(t);
            }
        }
        next += 1;
    }
    // The plane has moved a little with each triangle.
    grown.retain(|&t| t == seed || plane.contains(scene, t, &Plane::of(scene, t)));
    (grown, plane.normal.normalize())
}

impl FlatSurface {
    fn new(
        scene: &Scene,
        triangles: Vec<TriangleId>,
        is_rim: impl Fn(TriangleId, u8) -> bool,
        is_inside: bool,
    ) -> Self {
        let planes = triangles.iter().map(|&t| Plane::of(scene, t));
        let plane = planes.reduce(|a, b| a.and(&b)).unwrap_or_else(|| Plane::of(scene, triangles[0]));
        let normal = plane.normal.normalize();
        let axis = longest_direction(scene, &triangles, normal, is_rim);
        let axes = [axis, normal.cross(axis)];
        let corners = || triangles.iter().flat_map(|&t| scene.corners(t));
        let along = |axis: DVec3| {
            let all = corners().map(|p| (p - plane.low).dot(axis));
            all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
        };
        let [(x, to_x), (y, to_y)] = axes.map(along);
        Self {
            area: triangles.iter().map(|&t| scene.area(t)).sum(),
            normal,
            axes,
            origin: plane.low + x * axes[0] + y * axes[1],
            extent: [to_x - x, to_y - y],
            bounds: BoundingBox { min: plane.low, max: plane.high },
            is_inside,
            is_single: scene.emits(triangles[0]) && scene.is_varied(triangles[0]),
            triangles,
        }
    }
}

/// Returns the direction in which the outline of a surface runs the longest way, there and across.
fn longest_direction(
    scene: &Scene,
    triangles: &[TriangleId],
    normal: DVec3,
    is_rim: impl Fn(TriangleId, u8) -> bool,
) -> DVec3 {
    let [u, v] = <[DVec3; 2]>::from(normal.any_orthonormal_pair());
    // Length, turn and direction of each edge of the outline.
    let mut edges: Vec<(f64, f64, DVec3)> = Vec::new();
    for &t in triangles {
        let corners = scene.corners(t);
        for number in 0..3u8 {
            let (a, b) = (corners[usize::from(number)], corners[(usize::from(number) + 1) % 3]);
            let along = (b - a).reject_from_normalized(normal);
            if along != DVec3::ZERO && is_rim(t, number) {
                edges.push((along.length(), turn(along.dot(u), along.dot(v)), along));
            }
        }
    }
    edges.sort_by(|a, b| a.1.total_cmp(&b.1));
    // The window of directions with the greatest length. Its start is repeated after the end.
    let count = edges.len();
    let turn_of = |i: usize| edges[i % count].1 + if i < count { 0.0 } else { 1.0 };
    let (mut best, mut window) = ((0.0, 0..0), 0.0);
    let mut end = 0;
    for start in 0..count {
        while end < start + count && turn_of(end) <= turn_of(start) + SAME_DIRECTION {
            window += edges[end % count].0;
            end += 1;
        }
        if window > best.0 * (1.0 + 1e-9) {
            best = (window, start..end);
        }
        window -= edges[start].0;
    }
    let longest =
        best.1.map(|i| edges[i % count]).max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
    longest.map_or(u, |edge| edge.2.normalize())
}

/// Returns a measure of the angle of a direction modulo 90°, in `[0, 1)`, of which about 0.01 is half a degree. It needs
/// divisions only, so that it has the same bits on all machines.
fn turn(x: f64, y: f64) -> f64 {
    let (x, y) = match (x > 0.0, y > 0.0) {
        (true, true) => (x, y),
        (false, true) => (y, -x),
        (true, false) => (-y, x),
        (false, false) => (-x, -y),
    };
    if x + y > 0.0 { (y / (x + y)).rem_euclid(1.0) } else { 0.0 }
}
