//! Incremental convex hull of points in space (Clarkson and Shor 1989; Barber, Dobkin and Huhdanpaa 1996, *The
//! quickhull algorithm for convex hulls*).
//!
//! The hull grows from a tetrahedron. Every point outside of the current hull is in the outside list of one facet that
//! it is above. Each step takes the farthest point of a list: the facets visible from it are replaced by the facets
//! between their horizon and the point. The points in the lists of the removed facets are assigned to the new facets;
//! points above none of these are inside and are discarded.
//!
//! A facet is visible only from points strictly above its plane, which is decided exactly. The facets visible from a
//! point are therefore those visible from a position slightly nearer to the hull, which lies in the plane of no facet.
//! They form a disc, whose horizon is one closed path without an edge collinear with the point. So coplanar points need
//! no special cases, and rounding cannot break the topology. Each step permanently removes one point from the lists.

use glam::DVec3;

use crate::hull::grid::{Plane, volume};

/// Index that stands for no facet or no point.
const NONE: u32 = u32::MAX;

struct Facet {
    /// Corners, counterclockwise seen from outside.
    corners: [u32; 3],
    /// Facets beyond the edges from each corner to the next.
    neighbors: [u32; 3],
    plane: Plane,
    /// First point of the outside list.
    first: u32,
    /// Point of the outside list that is farthest from the plane.
    farthest: u32,
    /// Height of the farthest point.
    height: f64,
    /// Last point from which the facet was found visible.
    visible_from: u32,
}

struct Hull<'a> {
    points: &'a [DVec3],
    facets: Vec<Facet>,
    /// Unused places in `facets`.
    free: Vec<u32>,
    /// Linked outside lists: for each point, the next point of the same list.
    next: Vec<u32>,
}

/// Edge of the horizon, in its direction in the visible facet, and the facet beyond it.
struct Edge {
    corners: [u32; 2],
    beyond: u32,
}

/// Returns the triangles of the hull as indices of points. `base` and `apex` are a non-degenerate tetrahedron.
pub(super) fn facets(points: &[DVec3], base: [u32; 3], apex: u32) -> Vec<[u32; 3]> {
    let mut hull = Hull { points, facets: Vec::new(), free: Vec::new(), next: vec![NONE; points.len()] };
    hull.begin(base, apex);
    let mut waiting: Vec<u32> = (0..4).collect();
    // For each corner of the horizon, the new facet at the edge that begins there.
    let mut facet_from = vec![NONE; points.len()];
    let (mut horizon, mut orphans) = (Vec::new(), Vec::new());
    while let Some(facet) = waiting.pop() {
        // A facet that has been replaced has an empty list.
        if hull.facets[facet as usize].first == NONE {
            continue;
        }
        let eye = hull.facets[facet as usize].farthest;
        hull.remove_visible(eye, facet, &mut horizon, &mut orphans);
        let new = waiting.len();
        for edge in &horizon {
            let facet = hull.add([edge.corners[0], edge.corners[1], eye]);
            facet_from[edge.corners[0] as usize] = facet;
            waiting.push(facet);
        }
        for (edge, &facet) in horizon.iter().zip(&waiting[new..]) {
            let next = facet_from[edge.corners[1] as usize];
            hull.join(facet, 0, edge.beyond);
            hull.facets[facet as usize].neighbors[1] = next;
            hull.facets[next as usize].neighbors[2] = facet;
        }
        for &point in &orphans {
            hull.assign(point, &waiting[new..]);
        }
    }
    hull.facets.iter().map(|facet| facet.corners).filter(|corners| corners[0] != NONE).collect()
}

impl Hull<'_> {
    fn at(&self, point: u32) -> DVec3 {
        self.points[point as usize]
    }

    /// Creates a tetrahedron and assigns all points to its facets.
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
            self.assign(point, &[0, 1, 2, 3]);
        }
    }

    /// Returns the signed height of a point above a facet.
    #[inline]
    fn height(&self, facet: u32, point: u32) -> f64 {
        let Facet { plane, corners, .. } = &self.facets[facet as usize];
        plane.height(|| corners.map(|i| self.at(i)), self.at(point))
    }

    /// Returns the edge of a facet that leads from one corner to another.
    fn edge_of(&self, facet: u32, [from, to]: [u32; 2]) -> Option<usize> {
        let corners = &self.facets[facet as usize].corners;
        (0..3).find(|&k| corners[k] == from && corners[(k + 1) % 3] == to)
    }

    /// Adds a facet without neighbors and with an empty outside list.
    fn add(&mut self, corners: [u32; 3]) -> u32 {
        let facet = Facet {
            corners,
            neighbors: [NONE; 3],
            plane: Plane::new(corners.map(|i| self.at(i))),
            first: NONE,
            farthest: NONE,
            height: 0.0,
            visible_from: NONE,
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

    /// Adds a point to the outside list of the first of these facets that it is above. A point above none of them is
    /// inside.
    fn assign(&mut self, point: u32, facets: &[u32]) {
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

    /// Removes all facets visible from a point, of which `first` is one. Fills `horizon` with their outline and
    /// `orphans` with the points of their outside lists, except the point itself.
    fn remove_visible(&mut self, eye: u32, first: u32, horizon: &mut Vec<Edge>, orphans: &mut Vec<u32>) {
        horizon.clear();
        orphans.clear();
        let start = self.free.len();
        self.facets[first as usize].visible_from = eye;
        // Visible facets are connected. The list of free places serves as the queue of the search.
        self.free.push(first);
        let mut i = start;
        while let Some(&facet) = self.free.get(i) {
            i += 1;
            let Facet { corners, neighbors, .. } = self.facets[facet as usize];
            for (k, &beyond) in neighbors.iter().enumerate() {
                if self.facets[beyond as usize].visible_from == eye {
                    continue;
                }
                if self.height(beyond, eye) > 0.0 {
                    self.facets[beyond as usize].visible_from = eye;
                    self.free.push(beyond);
                } else {
                    horizon.push(Edge { corners: [corners[k], corners[(k + 1) % 3]], beyond });
                }
            }
        }
        for place in start..self.free.len() {
            let facet = &mut self.facets[self.free[place] as usize];
            facet.corners = [NONE; 3];
            let mut point = std::mem::replace(&mut facet.first, NONE);
            while point != NONE {
                if point != eye {
                    orphans.push(point);
                }
                point = self.next[point as usize];
            }
        }
    }
}
