//! The hull of points in space, one point after the other (Clarkson and Shor 1989; Barber, Dobkin and Huhdanpaa 1996,
//! *The quickhull algorithm for convex hulls*).
//!
//! The hull grows from a tetrahedron. Every point outside is kept in the list of one facet that it is above of. The farthest
//! point of a list is taken next: the facets that it sees are replaced by those from their outline to the point, and
//! the points that they kept are shared among the new ones, or are inside and forgotten.
//!
//! A facet is seen only by points strictly above its plane, which is decided exactly. A point then sees what it would see
//! from a little nearer to the hull, where it is in the plane of no facet: a disc, whose outline is one closed path and has
//! no edge in a line with the point. So masses of points in a plane need no rules of their own, and there is nothing to
//! go wrong by rounding. Each step takes one point from the lists for good.

use glam::DVec3;

use crate::hull::grid::{Plane, volume};

/// No facet, or no point.
const NONE: u32 = u32::MAX;

struct Facet {
    /// Counter-clockwise seen from outside.
    corners: [u32; 3],
    /// The facets beyond the edges from each corner to the next.
    neighbors: [u32; 3],
    plane: Plane,
    /// The first of the points that it keeps.
    first: u32,
    /// The one that is farthest from the plane, and its height.
    farthest: u32,
    height: f64,
    /// The last point that was found to see it.
    seen_from: u32,
}

struct Hull<'a> {
    points: &'a [DVec3],
    facets: Vec<Facet>,
    /// Places in `facets` that are not in use.
    free: Vec<u32>,
    /// Of each point that a facet keeps, the next one of the same facet.
    next: Vec<u32>,
}

/// An edge of the outline, in the direction in which the facet that is seen has it, and the facet beyond it.
struct Edge {
    corners: [u32; 2],
    beyond: u32,
}

/// The triangles of the hull, by the numbers of the points. `base` and `apex` are a tetrahedron with a volume.
pub(super) fn facets(points: &[DVec3], base: [u32; 3], apex: u32) -> Vec<[u32; 3]> {
    let mut hull = Hull { points, facets: Vec::new(), free: Vec::new(), next: vec![NONE; points.len()] };
    hull.begin(base, apex);
    let mut waiting: Vec<u32> = (0..4).collect();
    // The edge of the outline that begins at a point, as the facet that was put there.
    let mut facet_from = vec![NONE; points.len()];
    let (mut outline, mut kept) = (Vec::new(), Vec::new());
    while let Some(facet) = waiting.pop() {
        // A facet that has been replaced keeps none.
        if hull.facets[facet as usize].first == NONE {
            continue;
        }
        let eye = hull.facets[facet as usize].farthest;
        hull.remove_seen(eye, facet, &mut outline, &mut kept);
        let new = waiting.len();
        for edge in &outline {
            let facet = hull.add([edge.corners[0], edge.corners[1], eye]);
            facet_from[edge.corners[0] as usize] = facet;
            waiting.push(facet);
        }
        for (edge, &facet) in outline.iter().zip(&waiting[new..]) {
            let next = facet_from[edge.corners[1] as usize];
            hull.join(facet, 0, edge.beyond);
            hull.facets[facet as usize].neighbors[1] = next;
            hull.facets[next as usize].neighbors[2] = facet;
        }
        for &point in &kept {
            hull.keep(point, &waiting[new..]);
        }
    }
    hull.facets.iter().map(|facet| facet.corners).filter(|corners| corners[0] != NONE).collect()
}

impl Hull<'_> {
    fn at(&self, point: u32) -> DVec3 {
        self.points[point as usize]
    }

    /// Makes a tetrahedron, and shares all points among its facets.
    fn begin(&mut self, [a, b, c]: [u32; 3], apex: u32) {
        let inward = volume([a, b, c].map(|i| self.at(i)), self.at(apex)) > 0;
        let [b, c] = if inward { [c, b] } else { [b, c] };
        for corners in [[a, b, c], [b, a, apex], [c, b, apex], [a, c, apex]] {
            self.add(corners);
        }
        for facet in 0..4 {
            for edge in 0..3 {
                let [from, to] = [edge, (edge + 1) % 3].map(|k| self.facets[facet as usize].corners[k]);
                let beyond = (0..4).find(|&other| self.edge_of(other, [to, from]).is_some());
                self.facets[facet as usize].neighbors[edge] = beyond.unwrap_or(NONE);
            }
        }
        for point in 0..self.points.len() as u32 {
            self.keep(point, &[0, 1, 2, 3]);
        }
    }

    /// How far a point is above a facet.
    #[inline]
    fn height(&self, facet: u32, point: u32) -> f64 {
        let Facet { plane, corners, .. } = &self.facets[facet as usize];
        plane.height(|| corners.map(|i| self.at(i)), self.at(point))
    }

    /// Which of its edges a facet has from one corner to the other.
    fn edge_of(&self, facet: u32, [from, to]: [u32; 2]) -> Option<usize> {
        let corners = &self.facets[facet as usize].corners;
        (0..3).find(|&k| corners[k] == from && corners[(k + 1) % 3] == to)
    }

    /// Adds a facet that has no neighbors and keeps no points yet.
    fn add(&mut self, corners: [u32; 3]) -> u32 {
        let facet = Facet {
            corners,
            neighbors: [NONE; 3],
            plane: Plane::new(corners.map(|i| self.at(i))),
            first: NONE,
            farthest: NONE,
            height: 0.0,
            seen_from: NONE,
        };
        if let Some(place) = self.free.pop() {
            self.facets[place as usize] = facet;
            return place;
        }
        self.facets.push(facet);
        self.facets.len() as u32 - 1
    }

    /// Makes two facets neighbors at an edge of the first one.
    fn join(&mut self, facet: u32, edge: usize, other: u32) {
        let [from, to] = [edge, (edge + 1) % 3].map(|k| self.facets[facet as usize].corners[k]);
        self.facets[facet as usize].neighbors[edge] = other;
        if let Some(back) = self.edge_of(other, [to, from]) {
            self.facets[other as usize].neighbors[back] = facet;
        }
    }

    /// Lets the first of these facets that a point is above of keep it. A point that is above of none is inside.
    fn keep(&mut self, point: u32, facets: &[u32]) {
        for &facet in facets {
            let height = self.height(facet, point);
            if height > 0.0 {
                let facet = &mut self.facets[facet as usize];
                self.next[point as usize] = std::mem::replace(&mut facet.first, point);
                if height > facet.height {
                    (facet.farthest, facet.height) = (point, height);
                }
                return;
            }
        }
    }

    /// Removes all facets that a point sees, of which `first` is one: gives their outline, and the points that they kept,
    /// but for the point itself.
    fn remove_seen(&mut self, eye: u32, first: u32, outline: &mut Vec<Edge>, kept: &mut Vec<u32>) {
        outline.clear();
        kept.clear();
        let start = self.free.len();
        self.facets[first as usize].seen_from = eye;
        // What is seen hangs together; the free places serve as the list of it.
        self.free.push(first);
        let mut i = start;
        while let Some(&facet) = self.free.get(i) {
            i += 1;
            let Facet { corners, neighbors, .. } = self.facets[facet as usize];
            for (k, &beyond) in neighbors.iter().enumerate() {
                if self.facets[beyond as usize].seen_from == eye {
                    continue;
                }
                if self.height(beyond, eye) > 0.0 {
                    self.facets[beyond as usize].seen_from = eye;
                    self.free.push(beyond);
                } else {
                    outline.push(Edge { corners: [corners[k], corners[(k + 1) % 3]], beyond });
                }
            }
        }
        for place in start..self.free.len() {
            let facet = &mut self.facets[self.free[place] as usize];
            facet.corners = [NONE; 3];
            let mut point = std::mem::replace(&mut facet.first, NONE);
            while point != NONE {
                if point != eye {
                    kept.push(point);
                }
                point = self.next[point as usize];
            }
        }
    }
}
