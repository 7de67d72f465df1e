//! Default camera, for scenes that specify none.

use std::collections::BTreeMap;

use glam::DVec3;
use sir_accel::{Accel, Tracer};
use sir_geom::{BoundingBox, Camera, Scene, TriangleId, luminance};

use crate::camera_rays::CameraRays;
use crate::display::DisplayMesh;

/// Vertical field of view \[rad\]: about 65°, wide enough for rooms.
const FIELD: f64 = 1.13;

/// Width over height of the probe pictures.
const ASPECT: f64 = 4.0 / 3.0;

/// Rays of a probe picture across and down.
const RAYS: (u32, u32) = (20, 15);

/// Eye positions between two opposite walls, as fractions of their distance.
const ACROSS: [f64; 5] = [0.07, 0.28, 0.5, 0.72, 0.93];

/// Eye heights, as fractions of the height of the scene.
const HEIGHTS: [f64; 2] = [0.4, 0.6];

/// Distance from the box at which a surface still counts, in diagonals of the box.
const ROUNDING: f64 = 1e-6;

/// Number of view directions around the vertical.
const TURNS: u32 = 8;

/// Returns a view that shows much of the inside of a box, such as that of the scene, for use when neither the user nor
/// the file specifies one.
///
/// A few hundred views are tried, from places inside the box and from all sides outside of it,
/// each with a few hundred rays. The best view sees lit surfaces near and far, a large part of the total surface area,
/// and many materials and triangles. Little of its picture is empty, outside of the box, dark, or covered by backs of surfaces or by
/// something right before the eye. `up` is the up direction of the scene; see
/// [`up_clues`](crate::up_clues).
#[must_use]
pub fn default_camera(display: &DisplayMesh<'_>, accel: &Accel, up: DVec3, bounds: BoundingBox) -> Camera {
    let scorer = ViewScorer::new(display, bounds);
    let mut tracer = accel.tracer();
    let mut best: Option<(f64, Camera)> = None;
    for camera in candidates(bounds, up) {
        let score = scorer.score(&mut tracer, &camera);
        if best.as_ref().is_none_or(|(most, _)| score > *most) {
            best = Some((score, camera));
        }
    }
    let fallback = || Camera {
        name: String::new(),
        eye: bounds.center(),
        forward: DVec3::X,
        up,
        projection: sir_geom::Projection::Perspective { vertical_fov: FIELD },
        aspect: None,
    };
    let mut camera = best.map_or_else(fallback, |(_, camera)| camera);
    "default".clone_into(&mut camera.name);
    camera
}

fn candidates(bounds: BoundingBox, up: DVec3) -> Vec<Camera> {
    let up = up.normalize_or(DVec3::Y);
    // Horizontal axes: axes of the scene, if `up` is one of them.
    let east = if up.x.abs() < 0.9 { DVec3::X.reject_from(up) } else { DVec3::Z.reject_from(up) }.normalize();
    let north = up.cross(east);
    let (center, size) = (bounds.center(), bounds.size());
    let extent = |axis: DVec3| axis.abs().dot(size);
    let at = |e: f64, n: f64, u: f64| {
        center
            + (e - 0.5) * extent(east) * east
            + (n - 0.5) * extent(north) * north
            + (u - 0.5) * extent(up) * up
    };
    let mut cameras = Vec::new();
    let mut add = |eye: DVec3, target: DVec3| cameras.extend(Camera::looking_at(eye, target, up, FIELD));
    let turned = |k: u32| {
        let angle = f64::from(k) * std::f64::consts::TAU / f64::from(TURNS);
        angle.cos() * east + angle.sin() * north
    };
    for height in HEIGHTS {
        for e in ACROSS {
            for n in ACROSS {
                let eye = at(e, n, height);
                add(eye, center + (eye - center).dot(up) * 0.5 * up);
                for k in 0..TURNS {
                    add(eye, eye + turned(k) - 0.1 * up);
                }
            }
        }
    }
    // Views through an open side, from the distance at which it fills the height of the picture.
    for (axis, size) in
        [(east, extent(east)), (-east, extent(east)), (north, extent(north)), (-north, extent(north))]
    {
        add(center + (0.5 * size + 0.5 * extent(up) / (0.5 * FIELD).tan()) * axis, center);
    }
    let distance = 0.5 * size.length() / (0.5 * FIELD).sin();
    for k in 0..TURNS {
        for height in [0.0, 0.35] {
            add(center + distance * (turned(k) + height * up).normalize(), center);
        }
    }
    cameras
}

/// Scores views of a scene.
struct ViewScorer<'a> {
    display: &'a DisplayMesh<'a>,
    /// Luminance of the radiosity of a well-lit surface \[W/m²\].
    bright: f64,
    /// Box whose surfaces count.
    bounds: BoundingBox,
    /// Area of all surfaces that count \[m²\].
    area: f64,
}

impl<'a> ViewScorer<'a> {
    fn new(display: &'a DisplayMesh<'a>, bounds: BoundingBox) -> Self {
        let scene = display.scene;
        let (mut sum, mut area) = (0.0, 0.0);
        for piece in display.pieces() {
            let is_inside = counts(scene, bounds, piece.triangle);
            if is_inside && scene.exitance(piece.triangle, piece.side) == DVec3::ZERO {
                let patch = display.mesh.patch_of_side(piece.triangle, piece.id);
                let part = display.mesh.covered_area(piece.triangle, patch);
                sum += part * luminance(display.own_radiosity(&piece)).sqrt();
                area += part;
            }
        }
        // The mean of square roots is less sensitive to a few bright spots than the mean of the values.
        let mean = if area > 0.0 { sum / area } else { 0.0 };
        Self {
            display,
            bright: mean * mean,
            bounds,
            area: scene.triangle_ids().filter(|&id| counts(scene, bounds, id)).map(|id| scene.area(id)).sum(),
        }
    }

    fn score(&self, tracer: &mut Tracer<'_>, camera: &Camera) -> f64 {
        let scene = self.display.scene;
        let (rays, diagonal) = (CameraRays::new(camera, ASPECT), self.bounds.size().length());
        let (mut lit, mut near, mut depth) = (0.0, 0.0, 0.0);
        let mut materials: BTreeMap<u32, f64> = BTreeMap::new();
        let mut triangles: BTreeMap<u32, f64> = BTreeMap::new();
        for y in 0..RAYS.1 {
            for x in 0..RAYS.0 {
                let middle = |k: u32, count: u32| (f64::from(k) + 0.5) / f64::from(count);
                let ray = rays.ray(middle(x, RAYS.0), middle(y, RAYS.1));
                let Some(hit) = tracer.closest(&ray.into()) else { continue };
                if !is_within(self.bounds, ray.origin + hit.t * ray.direction) {
                    continue;
                }
                let Some(e) = self.display.irradiance_at(hit.triangle, hit.point, hit.side) else { continue };
                let patch = self.display.mesh.patch_at(hit.triangle, hit.point);
                let b = luminance(self.display.radiosity(hit.triangle, patch, hit.side, e));
                lit += if self.bright > 0.0 { (b / self.bright).min(1.0) } else { 1.0 };
                let far = hit.t / diagonal;
                near += f64::from(u8::from(far < 0.06));
                depth += far.min(1.0).sqrt();
                *materials.entry(scene.triangle(hit.triangle).material.0).or_default() += 1.0;
                *triangles.entry(hit.triangle.0).or_default() += 1.0;
            }
        }
        let count = f64::from(RAYS.0 * RAYS.1);
        let hits: f64 = triangles.values().sum();
        if hits == 0.0 {
            return 0.0;
        }
        let (lit, near, depth) = (lit / hits, near / hits, depth / hits);
        let filled = (hits / count).sqrt();
        let seen = triangles.keys().map(|&t| TriangleId(t)).filter(|&id| counts(scene, self.bounds, id));
        let overview = (seen.map(|id| scene.area(id)).sum::<f64>() / self.area).sqrt();
        filled
            * lit
            * depth
            * overview
            * (1.0 - near).powi(3)
            * (1.0 + entropy(&materials, hits))
            * (2.0 + entropy(&triangles, hits))
    }
}

/// True if the middle of a triangle is in the box.
fn counts(scene: &Scene, bounds: BoundingBox, id: TriangleId) -> bool {
    is_within(bounds, scene.corners(id).into_iter().sum::<DVec3>() / 3.0)
}

/// True if a point is in the box, or so close to it that rounding may have taken it out of a face.
fn is_within(bounds: BoundingBox, point: DVec3) -> bool {
    point.distance(point.clamp(bounds.min, bounds.max)) <= ROUNDING * bounds.size().length()
}

/// Returns the entropy of the shares of `total`: the logarithm of the effective number of things seen.
fn entropy(counts: &BTreeMap<u32, f64>, total: f64) -> f64 {
    counts.values().map(|&c| -(c / total) * (c / total).ln()).sum()
}
