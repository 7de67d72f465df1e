//! The bounding volume hierarchy: built by `obvhs`, flattened into nodes of eight boxes.

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use sir_geom::{Scene, TriangleId};

use crate::grid::{Grid, GridLine, RADIUS};
use crate::triangle::GridTriangle;

/// Boxes per node.
pub(crate) const WIDTH: usize = 8;

/// How much boxes are enlarged, in radii of the scene: more than single precision loses on the way through a node.
const MARGIN: f32 = 3e-6;

/// Up to eight boxes, one lane each, in radii of the scene about its centre.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// Smallest and largest coordinates per axis; an unused lane has an empty box.
    bounds: [[[f32; WIDTH]; 3]; 2],
    children: [Child; WIDTH],
}

/// What a box contains: a node, or triangles.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Child {
    /// Number of the node or of the first triangle.
    pub(crate) first: u32,
    /// How many triangles; zero for a node.
    pub(crate) count: u32,
}

/// A line as the boxes see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxLine {
    origin: [f32; 3],
    inverse: [f32; 3],
    /// Per axis: 1 if the direction is negative, so that the far bound is met first.
    reversed: [usize; 3],
}

impl BoxLine {
    #[inline]
    pub(crate) fn new(line: &GridLine) -> Self {
        let direction = line.direction.to_array();
        Self {
            origin: (line.origin / RADIUS).to_array().map(|x| x as f32),
            // A component of zero becomes a tiny one: the slab is then passed or missed as a whole.
            inverse: direction.map(|d| if d.abs() < 1e-20 { 1e20 } else { (1.0 / d) as f32 }),
            reversed: direction.map(|d| usize::from(d < 0.0)),
        }
    }
}

impl Node {
    /// Distances, in radii, at which the line enters each box, or infinity where it misses the part between `from`
    /// and `to`.
    #[inline]
    pub(crate) fn enter(&self, line: &BoxLine, from: f32, to: f32) -> [f32; WIDTH] {
        let mut near = [from; WIDTH];
        let mut far = [to; WIDTH];
        for axis in 0..3 {
            let entry = &self.bounds[line.reversed[axis]][axis];
            let exit = &self.bounds[1 - line.reversed[axis]][axis];
            let (o, inverse) = (line.origin[axis], line.inverse[axis]);
            for lane in 0..WIDTH {
                let t0 = (entry[lane] - o) * inverse;
                let t1 = (exit[lane] - o) * inverse;
                near[lane] = if t0 > near[lane] { t0 } else { near[lane] };
                far[lane] = if t1 < far[lane] { t1 } else { far[lane] };
            }
        }
        std::array::from_fn(|lane| if near[lane] <= far[lane] { near[lane] } else { f32::INFINITY })
    }

    #[inline]
    pub(crate) fn child(&self, lane: usize) -> Child {
        self.children[lane]
    }
}

/// The hierarchy. Node 0 is the root.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) nodes: Vec<Node>,
    /// In the order of the leaves.
    pub(crate) triangles: Vec<GridTriangle>,
    /// Where in `triangles` each triangle of the scene is.
    places: Vec<u32>,
}

impl Tree {
    pub(crate) fn new(scene: &Scene, grid: &Grid) -> Self {
        let triangles: Vec<GridTriangle> = scene
            .triangle_ids()
            .map(|t| GridTriangle::new(scene.corners(t).map(|p| grid.vertex(p)), t))
            .collect();
        let boxes: Vec<Aabb> = triangles.iter().map(bounding_box).collect();
        let parameters = BvhBuildParams { max_prims_per_leaf: 4, ..BvhBuildParams::medium_build() };
        let binary = build_bvh2(&boxes, parameters, &mut std::time::Duration::default());
        let mut nodes = Vec::with_capacity(binary.nodes.len() / WIDTH + 1);
        flatten(&binary, &mut nodes);
        let mut places = vec![0; triangles.len()];
        for (place, &i) in binary.primitive_indices.iter().enumerate() {
            places[i as usize] = place as u32;
        }
        let triangles = binary.primitive_indices.iter().map(|&i| triangles[i as usize]).collect();
        Self { nodes, triangles, places }
    }

    pub(crate) fn triangle(&self, id: TriangleId) -> &GridTriangle {
        &self.triangles[self.places[id.index()] as usize]
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.places.as_slice())
    }
}

fn bounding_box(triangle: &GridTriangle) -> Aabb {
    let points = triangle.corners().map(|p| Vec3A::from_array(p.map(|x| (f64::from(x) / RADIUS) as f32)));
    let mut b = Aabb::from_points(&points);
    b.min -= MARGIN;
    b.max += MARGIN;
    b
}

/// Makes nodes of up to eight boxes by opening, again and again, the largest box of a node that can be opened.
fn flatten(binary: &Bvh2, nodes: &mut Vec<Node>) {
    let empty = Node {
        bounds: [[[f32::INFINITY; WIDTH]; 3], [[f32::NEG_INFINITY; WIDTH]; 3]],
        children: [Child::default(); WIDTH],
    };
    nodes.push(empty);
    // Pairs of a wide node that waits to be filled and the binary node it stands for.
    let mut waiting = vec![(0usize, 0usize)];
    while let Some((wide, root)) = waiting.pop() {
        let mut members = vec![root];
        while members.len() < WIDTH {
            let largest =
                members.iter().enumerate().filter(|&(_, &m)| !binary.nodes[m].is_leaf()).max_by(|a, b| {
                    let area = |m: usize| binary.nodes[m].aabb.half_area();
                    area(*a.1).total_cmp(&area(*b.1)).then(b.0.cmp(&a.0))
                });
            let Some((position, &opened)) = largest else { break };
            let first = binary.nodes[opened].first_index as usize;
            members[position] = first;
            members.push(first + 1);
        }
        for (lane, &m) in members.iter().enumerate() {
            let node = &binary.nodes[m];
            for axis in 0..3 {
                nodes[wide].bounds[0][axis][lane] = node.aabb.min[axis];
                nodes[wide].bounds[1][axis][lane] = node.aabb.max[axis];
            }
            nodes[wide].children[lane] = if node.is_leaf() {
                Child { first: node.first_index, count: node.prim_count }
            } else {
                waiting.push((nodes.len(), m));
                nodes.push(empty);
                Child { first: nodes.len() as u32 - 1, count: 0 }
            };
        }
    }
}
