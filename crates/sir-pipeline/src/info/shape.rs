//! Size, doubled triangles, and whether one part dwarfs the rest.

use glam::DVec3;
use serde::Serialize;
use sir_geom::{BoundingBox, Scene, Triangle, TriangleId};

/// Share of the area from which a part may dominate.
const DOMINANT_AREA: f64 = 0.5;

/// Extent of everything else, relative to the whole, below which it does.
const SMALL_REST: f64 = 0.2;

/// A box along the axes \[m\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extent {
    /// Smallest coordinates.
    pub min: [f64; 3],
    /// Largest coordinates.
    pub max: [f64; 3],
}

impl Extent {
    /// Edges of the box \[m\].
    #[must_use]
    pub fn size(&self) -> DVec3 {
        DVec3::from(self.max) - DVec3::from(self.min)
    }

    /// Its center \[m\].
    #[must_use]
    pub fn center(&self) -> DVec3 {
        DVec3::from(self.min).midpoint(self.max.into())
    }
}

impl From<BoundingBox> for Extent {
    fn from(bounds: BoundingBox) -> Self {
        Self { min: bounds.min.into(), max: bounds.max.into() }
    }
}

/// Triangles with the same three corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Twins {
    /// Triangles with the corners of an earlier one.
    pub twins: usize,
    /// Those of them that also face the way of an earlier one: one of the two is never seen.
    pub alike: usize,
}

/// A part of the scene that has most of the area, and is much larger than all the rest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dominant {
    /// What it is, with its name.
    pub what: String,
    /// Its share of the area.
    pub share: f64,
    /// Where the rest is \[m\].
    pub rest: Extent,
}

/// Finds triangles with the same corners.
pub(super) fn twins(scene: &Scene) -> Twins {
    let mut keys: Vec<_> = scene.triangles().iter().map(key).collect();
    keys.sort_unstable();
    let same = |equal: fn(&Key, &Key) -> bool| keys.windows(2).filter(|k| equal(&k[0], &k[1])).count();
    Twins { twins: same(|a, b| a.0 == b.0), alike: same(|a, b| a == b) }
}

/// Corners in ascending order, and whether that changes the winding.
type Key = ([u32; 3], bool);

fn key(triangle: &Triangle) -> Key {
    let [a, b, c] = triangle.vertices.map(|v| v.0);
    let mut sorted = [a, b, c];
    sorted.sort_unstable();
    let turned = [[a, b, c], [b, c, a], [c, a, b]].iter().all(|turn| *turn != sorted);
    (sorted, turned)
}

/// A polygon, named part or material beside which all the rest is small.
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

/// Of the parts that `of` numbers, the one with the largest area, if it dominates.
fn largest(scene: &Scene, of: impl Fn(&Triangle) -> usize) -> Option<(usize, f64, Extent)> {
    let areas = sums(scene, &of, |id| scene.area(id));
    let (part, area) = areas.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    let share = area / scene.total_area();
    if share <= DOMINANT_AREA {
        return None;
    }
    let others = scene.triangle_ids().filter(|id| of(scene.triangle(*id)) != part);
    let rest = BoundingBox::of(others.flat_map(|id| scene.corners(id)))?;
    let small = rest.size().length() < SMALL_REST * scene.bounding_box().size().length();
    small.then(|| (part, share, rest.into()))
}

/// Sums of `what` over the triangles of each part that `of` numbers.
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
