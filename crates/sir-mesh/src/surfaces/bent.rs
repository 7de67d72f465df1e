//! Bent surfaces: small flat surfaces that continue each other, joined to patches.

use glam::DVec3;
use sir_geom::BoundingBox;

use crate::surfaces::beside::Surfaces;
use crate::surfaces::flat::FlatSurface;

/// Cosine of the largest angle between the normals of a patch and its parts: 15°.
const MIN_COSINE: f64 = 0.965_925_826_289_068_3;

/// Greatest distance of the parts of a patch from its middle, in widths of a cell: a little more than that of a disc with
/// the area of a cell.
const REACH: f64 = 0.6;

/// Largest diagonal of the box around a patch, in widths of a cell.
const DIAGONAL: f64 = 1.5;

/// Share of the area of a cell below which a patch is a fragment, which joins a neighbor.
const FRAGMENT: f64 = 0.3;

/// Flat surfaces that are one patch.
#[derive(Clone, Debug)]
struct Group {
    members: Vec<u32>,
    area: f64,
    /// Sum of the normals times the areas.
    normal: DVec3,
    bounds: BoundingBox,
}

impl Group {
    fn of(surfaces: &Surfaces, number: u32) -> Self {
        let flat = &surfaces.flat[number as usize];
        Self { members: vec![number], area: flat.area, normal: flat.area * flat.normal, bounds: flat.bounds }
    }

    /// True if this group lies in a sphere.
    fn is_within(&self, middle: DVec3, radius: f64) -> bool {
        self.bounds.center().distance(middle) + 0.5 * self.bounds.size().length() <= radius
    }

    /// True if the normals of two groups differ by at most the largest angle.
    fn continues(&self, other: &Self) -> bool {
        self.normal.dot(other.normal) >= MIN_COSINE * self.normal.length() * other.normal.length()
    }

    fn bounds_with(&self, other: &Self) -> BoundingBox {
        BoundingBox { min: self.bounds.min.min(other.bounds.min), max: self.bounds.max.max(other.bounds.max) }
    }

    fn add(&mut self, other: Self) {
        self.bounds = self.bounds_with(&other);
        self.area += other.area;
        self.normal += other.normal;
        self.members.extend(other.members);
    }
}

/// Returns groups of surfaces that are one patch each. `width` returns the width of a cell for a surface that may be part
/// of a larger patch, and `None` for others, which are in no group.
pub(crate) fn join(surfaces: &Surfaces, width: impl Fn(&FlatSurface) -> Option<f64>) -> Vec<Vec<u32>> {
    let widths: Vec<Option<f64>> = surfaces.flat.iter().map(width).collect();
    let mut of_surface = vec![NONE; surfaces.flat.len()];
    let mut groups: Vec<Group> = Vec::new();
    for seed in 0..surfaces.flat.len() as u32 {
        let Some(width) = widths[seed as usize].filter(|_| of_surface[seed as usize] == NONE) else {
            continue;
        };
        let number = groups.len() as u32;
        of_surface[seed as usize] = number;
        let mut group = Group::of(surfaces, seed);
        let (first, middle) = (group.clone(), group.bounds.center());
        let mut next = 0;
        while next < group.members.len() {
            for &other in surfaces.beside(group.members[next]) {
                if of_surface[other as usize] != NONE || widths[other as usize] != Some(width) {
                    continue;
                }
                let of_other = Group::of(surfaces, other);
                if of_other.is_within(middle, REACH * width) && of_other.continues(&first) {
                    of_surface[other as usize] = number;
                    group.add(of_other);
                }
            }
            next += 1;
        }
        groups.push(group);
    }
    join_fragments(surfaces, &widths, &mut of_surface, &mut groups);
    groups.into_iter().map(|group| group.members).filter(|members| !members.is_empty()).collect()
}

/// Joins groups that are small to a neighbor. Joined groups lose their members.
fn join_fragments(surfaces: &Surfaces, widths: &[Option<f64>], of_surface: &mut [u32], groups: &mut [Group]) {
    let width = |group: &Group| widths[group.members[0] as usize].unwrap_or(0.0);
    let is_fragment = |group: &Group| group.area < FRAGMENT * width(group) * width(group);
    let mut fragments: Vec<usize> = (0..groups.len()).filter(|&g| is_fragment(&groups[g])).collect();
    fragments.sort_by(|&a, &b| groups[a].area.total_cmp(&groups[b].area).then(a.cmp(&b)));
    for number in fragments {
        let group = &groups[number];
        if !is_fragment(group) {
            continue;
        }
        let own = width(group);
        let beside = group.members.iter().flat_map(|&member| surfaces.beside(member));
        let others = beside.map(|&other| of_surface[other as usize]).filter(|&g| g != NONE);
        let allowed = others.map(|g| g as usize).filter(|&g| {
            let other = &groups[g];
            g != number
                && width(other) == own
                && group.continues(other)
                && group.bounds_with(other).size().length() <= DIAGONAL * own
        });
        let size = |g: usize| group.bounds_with(&groups[g]).size().length();
        let best = allowed.min_by(|&a, &b| size(a).total_cmp(&size(b)).then(a.cmp(&b)));
        if let Some(best) = best {
            let members = std::mem::take(&mut groups[number].members);
            members.iter().for_each(|&member| of_surface[member as usize] = best as u32);
            let joined = Group { members, ..groups[number].clone() };
            groups[best].add(joined);
        }
    }
}

/// Mark of a surface in no group.
const NONE: u32 = u32::MAX;
