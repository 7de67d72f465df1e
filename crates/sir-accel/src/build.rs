//! Construction of the hierarchy: a binary tree is optimized by `obvhs` and collapsed into nodes of sixteen boxes.

use std::ops::Range;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;

use crate::cluster;
use crate::grid::RADIUS;
use crate::node::{LEAF, MARGIN, Node};
use crate::simd::backend::{LEAF_WIDTH, NODE_WIDTH};
use crate::triangle::GridTriangle;

/// Cost of a node relative to a triangle, which decides which triangles share a leaf. Between 2 and 6 the search time
/// hardly changes; a higher cost saves memory.
const COLLAPSE_COST: f32 = 4.0;

/// A tree whose leaves refer to triangles by their index in `order`.
pub(crate) struct Hierarchy {
    pub(crate) nodes: Vec<Node>,
    /// Triangles of each leaf.
    pub(crate) leaves: Vec<Range<u32>>,
    pub(crate) order: Vec<u32>,
}

/// Builds the hierarchy of the triangles; there may be none.
pub(crate) fn hierarchy(triangles: &[GridTriangle]) -> Hierarchy {
    if triangles.is_empty() {
        return Hierarchy { nodes: vec![Node::empty()], leaves: Vec::new(), order: Vec::new() };
    }
    let boxes: Vec<Aabb> = triangles.iter().map(bounding_box).collect();
    let binary = binary_tree(&boxes);
    let mut nodes = Vec::with_capacity(binary.nodes.len() / NODE_WIDTH + 1);
    let mut leaves = Vec::new();
    flatten(&binary, &mut nodes, |range| {
        leaves.push(range);
        leaves.len() as u32 - 1
    });
    Hierarchy { nodes, leaves, order: binary.primitive_indices }
}

/// Builds a binary tree as `obvhs::bvh2::builder::build_bvh2` does, but from a clustering of our own. That function also
/// validates the tree in debug builds, and panics if the tree is deeper than the traversals of `obvhs` allow; these are
/// not used here.
fn binary_tree(boxes: &[Aabb]) -> Bvh2 {
    let parameters = BvhBuildParams::medium_build();
    let mut binary = cluster::binary_tree(boxes);
    let mut optimizer = ReinsertionOptimizer::default();
    let ratio = parameters.reinsertion_batch_ratio;
    optimizer.run(&mut binary, ratio, None);
    collapse(&mut binary, LEAF_WIDTH as u32, COLLAPSE_COST);
    optimizer.run(&mut binary, ratio * parameters.post_collapse_reinsertion_batch_ratio_multiplier, None);
    binary
}

fn bounding_box(triangle: &GridTriangle) -> Aabb {
    let points = triangle.corners.map(|p| Vec3A::from_array(p.map(|x| (f64::from(x) / RADIUS) as f32)));
    let mut b = Aabb::from_points(&points);
    b.min -= MARGIN;
    b.max += MARGIN;
    b
}

/// The cheapest ways to collapse the binary tree into wide nodes.
///
/// The cost of a line is about the sum of the surface areas of all nodes (surface-area heuristic). The algorithm is
/// that of Ylitie, Karras and Laine (2017), *Efficient incoherent ray traversal on GPUs through compressed wide BVHs*:
/// the least cost of a subtree that occupies at most `k` boxes of a wide node follows from the least costs of its two
/// halves.
struct Cuts {
    /// Least cost per binary node with at most `k` boxes, at index `k − 1`.
    costs: Vec<[f32; NODE_WIDTH - 1]>,
    /// Number of the `k` boxes that the first half occupies; 0 if the node itself is the only box.
    firsts: Vec<[u8; NODE_WIDTH - 1]>,
    /// Number of boxes of a wide node that the first half occupies.
    of_node: Vec<u8>,
}

impl Cuts {
    fn new(binary: &Bvh2) -> Self {
        let count = binary.nodes.len();
        let mut cuts = Self {
            costs: vec![[0.0; NODE_WIDTH - 1]; count],
            firsts: vec![[0; NODE_WIDTH - 1]; count],
            of_node: vec![0; count],
        };
        // Breadth-first order: children after their parents.
        let mut order = vec![0usize];
        let mut next = 0;
        while next < order.len() {
            let node = &binary.nodes[order[next]];
            next += 1;
            if !node.is_leaf() {
                order.extend([node.first_index as usize, node.first_index as usize + 1]);
            }
        }
        for &i in order.iter().rev() {
            let node = &binary.nodes[i];
            // The cost of a leaf does not depend on the cut.
            if !node.is_leaf() {
                let (a, b) = (node.first_index as usize, node.first_index as usize + 1);
                let (a, b) = (cuts.costs[a], cuts.costs[b]);
                let split = |k: usize| -> (f32, u8) {
                    let of = |first: usize| (a[first - 1] + b[k - first - 1], first as u8);
                    (1..k).map(of).min_by(|x, y| x.0.total_cmp(&y.0)).unwrap_or((f32::INFINITY, 0))
                };
                let (below, first) = split(NODE_WIDTH);
                cuts.of_node[i] = first;
                let mut least = (node.aabb.half_area() + below, 0);
                for k in 1..NODE_WIDTH {
                    let cut = split(k);
                    if cut.0 < least.0 {
                        least = cut;
                    }
                    (cuts.costs[i][k - 1], cuts.firsts[i][k - 1]) = least;
                }
            }
        }
        cuts
    }

    /// Returns the binary nodes whose boxes form a wide node.
    fn members(&self, binary: &Bvh2, root: usize) -> Vec<usize> {
        let mut members = Vec::with_capacity(NODE_WIDTH);
        if binary.nodes[root].is_leaf() {
            return vec![root];
        }
        let mut waiting = Vec::new();
        let halves = |i: usize, first: u8, k: u8, waiting: &mut Vec<(usize, u8)>| {
            let child = binary.nodes[i].first_index as usize;
            waiting.extend([(child + 1, k - first), (child, first)]);
        };
        halves(root, self.of_node[root], NODE_WIDTH as u8, &mut waiting);
        while let Some((i, mut k)) = waiting.pop() {
            // Use no more boxes than lower the cost.
            while k > 1 && self.costs[i][usize::from(k) - 2] == self.costs[i][usize::from(k) - 1] {
                k -= 1;
            }
            let first = self.firsts[i][usize::from(k) - 1];
            if binary.nodes[i].is_leaf() || first == 0 {
                members.push(i);
            } else {
                halves(i, first, k, &mut waiting);
            }
        }
        members
    }
}

/// Collapses the binary tree into wide nodes.
fn flatten(binary: &Bvh2, nodes: &mut Vec<Node>, mut leaf: impl FnMut(Range<u32>) -> u32) {
    let cuts = Cuts::new(binary);
    nodes.push(Node::empty());
    // Pairs of a wide node that is still empty and the binary node that it replaces.
    let mut waiting = vec![(0usize, 0usize)];
    while let Some((wide, root)) = waiting.pop() {
        for (lane, m) in cuts.members(binary, root).into_iter().enumerate() {
            let node = &binary.nodes[m];
            for axis in 0..3 {
                nodes[wide].bounds[axis][lane] = node.aabb.min[axis];
                nodes[wide].bounds[3 + axis][lane] = node.aabb.max[axis];
            }
            nodes[wide].children[lane] = if node.is_leaf() {
                LEAF | leaf(node.first_index..node.first_index + node.prim_count)
            } else {
                waiting.push((nodes.len(), m));
                nodes.push(Node::empty());
                nodes.len() as u32 - 1
            };
        }
    }
}
