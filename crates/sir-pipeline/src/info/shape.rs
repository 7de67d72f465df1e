//! The size of a scene, duplicate triangles, and a part that dwarfs the rest.

use glam::DVec3;
use serde::Serialize;
use sir_geom::{BoundingBox, Scene, Side, Triangle, TriangleId};

/// Share of the area above which a part may dominate.
const DOMINANT_AREA: f64 = 0.5;

/// Extent of everything else, relative to the whole scene, below which such a part dominates.
const SMALL_REST: f64 = 0.2;

/// The same for a part that may be a room around the rest: a sky dome is larger.
const TINY_REST: f64 = 0.05;

/// Share of the area of a part that is left when opposite directions cancel, above which it is open like a ground.
const OPEN: f64 = 0.5;

/// Axis-aligned box \[m\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extent {
    /// Smallest coordinates.
    pub min: [f64; 3],
    /// Largest coordinates.
    pub max: [f64; 3],
}

impl Extent {
    /// Returns the lengths of the edges \[m\].
    #[must_use]
    pub fn size(&self) -> DVec3 {
        DVec3::from(self.max) - DVec3::from(self.min)
    }

    /// Returns the center of the box \[m\].
    #[must_use]
    pub fn center(&self) -> DVec3 {
        DVec3::from(self.min).midpoint(self.max.into())
    }

    /// Returns a stage `Focus` on the box, as a pipeline has it. Its corners are rounded outward, to about a thousandth
    /// of the size.
    #[must_use]
    pub fn focus(&self) -> String {
        let digits = 3 - self.size().max_element().log10().floor() as i32;
        let step = 10f64.powi(-digits);
        let corner = |corner: [f64; 3], round: fn(f64) -> f64| {
            let [x, y, z] = corner.map(|x| {
                let rounded = round(x / step) * step;
                format!("{:.*}", digits.max(0) as usize, if rounded == 0.0 { 0.0 } else { rounded })
            });
            format!("({x}, {y}, {z})")
        };
        format!("Focus(min: {}, max: {})", corner(self.min, f64::floor), corner(self.max, f64::ceil))
    }
}

impl From<BoundingBox> for Extent {
    fn from(bounds: BoundingBox) -> Self {
        Self { min: bounds.min.into(), max: bounds.max.into() }
    }
}

/// Counts of triangles with the same three corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Twins {
    /// Number of triangles with the corners of an earlier one.
    pub twins: usize,
    /// Number of these that also face the same way as an earlier one, so that one of the two is never visible.
    pub alike: usize,
}

/// Part of the scene that has most of the area and is much larger than everything else.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dominant {
    /// Description of the part, with its name.
    pub what: String,
    /// Share of the part in the area.
    pub share: f64,
    /// Bounding box of everything else \[m\].
    pub rest: Extent,
}

/// Counts triangles with the same corners.
pub(super) fn twins(scene: &Scene) -> Twins {
    let mut keys: Vec<_> = scene.triangles().iter().map(key).collect();
    keys.sort_unstable();
    let same = |equal: fn(&Key, &Key) -> bool| keys.windows(2).filter(|k| equal(&k[0], &k[1])).count();
    Twins { twins: same(|a, b| a.0 == b.0), alike: same(|a, b| a == b) }
}

/// Corners in ascending order, and true if sorting reverses the winding.
type Key = ([u32; 3], bool);

fn key(triangle: &Triangle) -> Key {
    let [a, b, c] = triangle.vertices.map(|v| v.0);
    let mut sorted = [a, b, c];
    sorted.sort_unstable();
    let turned = [[a, b, c], [b, c, a], [c, a, b]].iter().all(|turn| *turn != sorted);
    (sorted, turned)
}

/// Returns the polygon, named part or material that dwarfs everything else.
pub(super) fn dominant(scene: &Scene) -> Option<Dominant> {
    let material = |t: &Triangle| t.material.index();
    let group = |t: &Triangle| t.group.index();
    let polygon = |t: &Triangle| t.face.index();
    largest(scene, polygon)
        .map(|(_, share, rest)| (String::from("one polygon"), share, rest))
        .or_else(|| {
            let (i, share, rest) = largest(scene, group)?;
            Some((format!("the part {:?}", scene.groups().get(i)?), share, rest))
        })
        .or_else(|| {
            let (i, share, rest) = largest(scene, material)?;
            Some((format!("the material {:?}", scene.materials().get(i)?.name), share, rest))
        })
        .map(|(what, share, rest)| Dominant { what, share, rest })
}

/// Returns the number, share of the area and bounding box of the rest for the part with the largest area, if it
/// dominates. `of` returns the part of a triangle.
fn largest(scene: &Scene, of: impl Fn(&Triangle) -> usize) -> Option<(usize, f64, Extent)> {
    let areas = sums(scene, &of, |id| scene.area(id));
    let (part, area) = areas.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    let share = area / scene.total_area();
    if share <= DOMINANT_AREA {
        return None;
    }
    let is_part = |id: &TriangleId| of(scene.triangle(*id)) == part;
    let others = || scene.triangle_ids().filter(|id| !is_part(id));
    // A room may be all of one material, and its lamps of another.
    let emits = |id| [Side::Front, Side::Back].iter().any(|&side| scene.exitance(id, side) != DVec3::ZERO);
    if others().all(emits) {
        return None;
    }
    let rest = BoundingBox::of(others().flat_map(|id| scene.corners(id)))?;
    let net: DVec3 = scene.triangle_ids().filter(is_part).map(|id| scene.area(id) * scene.normal(id)).sum();
    let limit = if net.length() > OPEN * area { SMALL_REST } else { TINY_REST };
    let small = rest.size().length() < limit * scene.bounding_box().size().length();
    small.then(|| (part, share, rest.into()))
}

/// Returns the sum of `what` over the triangles of each part. `of` returns the part of a triangle.
pub(super) fn sums<T: Clone + Default + std::ops::AddAssign>(
    scene: &Scene,
    of: impl Fn(&Triangle) -> usize,
    what: impl Fn(TriangleId) -> T,
) -> Vec<T> {
    let parts = scene.triangles().iter().map(|t| of(t) + 1).max().unwrap_or(0);
    let mut sums = vec![T::default(); parts];
    for id in scene.triangle_ids() {
        sums[of(scene.triangle(id))] += what(id);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_geom::shapes::{self, Facing};
    use sir_geom::{Material, Rgb, SceneBuilder};

    /// Returns true if something dwarfs the rest in a scene with an outer cuboid of the given size, whose front faces
    /// inward, and what `add` adds to it with a gray material of its own.
    fn dwarfs(size: f64, add: impl FnOnce(&mut SceneBuilder, sir_geom::MaterialId)) -> bool {
        let mut b = SceneBuilder::new();
        let [outer, inner] =
            ["outer", "inner"].map(|name| b.add_material(Material::diffuse(name, Rgb::splat(0.5))));
        shapes::cuboid(&mut b, DVec3::ZERO, DVec3::splat(size), [outer; 6], Facing::Inward);
        add(&mut b, inner);
        dominant(&b.build().unwrap().scene).is_some()
    }

    fn square(b: &mut SceneBuilder, width: f64, y: f64, material: sir_geom::MaterialId) {
        let corners = [(0.0, 0.0), (0.0, width), (width, width), (width, 0.0)];
        shapes::quad(b, corners.map(|(x, z)| DVec3::new(x, y, z)), material);
    }

    #[test]
    fn a_room_does_not_dwarf_what_is_in_it_but_grounds_and_sky_domes_do() {
        let table = |b: &mut SceneBuilder, m| square(b, 1.0, 1.0, m);
        assert!(!dwarfs(10.0, table));
        assert!(dwarfs(1000.0, table));
        assert!(!dwarfs(1000.0, |b, _| {
            let lamp = b.add_material(Material::diffuse("lamp", Rgb::ZERO).emitting(Rgb::ONE));
            square(b, 1.0, 1.0, lamp);
        }));
        assert!(dwarfs(10.0, |b, m| square(b, 1000.0, -1.0, m)));
    }
}
