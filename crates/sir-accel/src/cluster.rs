//! Binary trees by parallel locally ordered clustering (PLOC; Meister and Bittner 2018, *Parallel locally-ordered
//! clustering for bounding volume hierarchy construction*).
//!
//! Boxes are sorted along a Morton curve. In each pass every box looks for the neighbor with which it has the smallest
//! union, and two boxes that choose each other are merged.
//!
//! `obvhs` builds the same trees, but merges only one pair per pass where the unions of neighbors are equal, or grow
//! along the curve: triangles in one place, or a fan with many corners. That takes quadratic time, and makes trees as
//! deep as there are triangles. Here a pass that finds few pairs merges all neighbors instead.

use glam::DVec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::{Bvh2, DEFAULT_MAX_STACK_DEPTH};
use obvhs::ploc::morton::morton_encode_u64_unorm;

/// Number of neighbors on each side that are compared.
const REACH: usize = 14;

/// Number of passes that compare only the next neighbors. They are faster, and merge most boxes.
const NEAR_PASSES: usize = 3;

/// A pass that would merge fewer than one pair per this many boxes merges all neighbors. Passes of ordinary scenes find
/// one pair per three to six boxes.
const MAX_BOXES_PER_PAIR: usize = 16;

/// Number of boxes up to which a pass may merge a single pair. The last few boxes decide most about the quality of a
/// tree, and cost little.
const FEW: usize = 128;

/// Builds a binary tree with one box per leaf.
pub(crate) fn binary_tree(boxes: &[Aabb]) -> Bvh2 {
    let mut binary = Bvh2::zeroed(boxes.len());
    binary.primitive_indices = (0..boxes.len() as u32).collect();
    let mut current = sorted_leaves(boxes);
    let (mut end, mut passes) = (2 * boxes.len() - 1, 0);
    binary.nodes.resize(end, Bvh2Node::default());
    let (mut next, mut best) = (Vec::with_capacity(boxes.len()), Vec::new());
    while current.len() > 1 {
        let reach = if passes < NEAR_PASSES { 1 } else { REACH };
        choose(&current, reach, &mut best);
        let pairs = (0..best.len()).filter(|&i| best[i] > i && best[best[i]] == i).count();
        if pairs * MAX_BOXES_PER_PAIR < best.len() && best.len() > FEW {
            // The last of an odd number of boxes chooses itself.
            let last = best.len() - 1;
            best.iter_mut().enumerate().for_each(|(i, best)| *best = (i ^ 1).min(last));
        }
        next.clear();
        for (i, (&node, &other)) in current.iter().zip(&best).enumerate() {
            if best[other] != i || other == i {
                next.push(node);
            } else if i < other {
                end -= 2;
                let sibling = current[other];
                binary.nodes[end..end + 2].copy_from_slice(&[node, sibling]);
                next.push(Bvh2Node::new(node.aabb().union(sibling.aabb()), 0, end as u32));
            }
        }
        std::mem::swap(&mut current, &mut next);
        passes += 1;
    }
    binary.nodes[..1].copy_from_slice(&current);
    binary.max_depth = DEFAULT_MAX_STACK_DEPTH.max(passes + 1);
    binary.children_are_ordered_after_parents = true;
    binary
}

/// Returns a leaf per box, in the order of their centers along a Morton curve.
fn sorted_leaves(boxes: &[Aabb]) -> Vec<Bvh2Node> {
    let mut all = Aabb::empty();
    boxes.iter().for_each(|b| all = all.union(b));
    let (start, scale) = (all.min.as_dvec3(), 1.0 / all.diagonal().as_dvec3());
    let code = |b: &Aabb| -> u64 {
        let place: DVec3 = (b.center().as_dvec3() - start) * scale;
        morton_encode_u64_unorm(place)
    };
    let mut order: Vec<(u64, u32)> = boxes.iter().map(code).zip(0..).collect();
    order.sort_unstable();
    order.iter().map(|&(_, i)| Bvh2Node::new(boxes[i as usize], 1, i)).collect()
}

/// Finds for each node the node within `reach` with which it has the smallest union; the last of several.
fn choose(nodes: &[Bvh2Node], reach: usize, best: &mut Vec<usize>) {
    // Costs of the last nodes with the nodes that follow each of them.
    let mut costs = [[0.0; REACH]; REACH];
    best.clear();
    for (i, node) in nodes.iter().enumerate() {
        let (mut least, mut chosen) = (f32::INFINITY, i);
        let mut compare = |other, cost| {
            if cost <= least {
                (least, chosen) = (cost, other);
            }
        };
        for back in (1..=reach.min(i)).rev() {
            compare(i - back, costs[(i - back) % REACH][back - 1]);
        }
        let row = &mut costs[i % REACH];
        for ((other, after), cost) in (i + 1..).zip(&nodes[i + 1..]).zip(row.iter_mut().take(reach)) {
            *cost = node.aabb().union(after.aabb()).half_area();
            compare(other, *cost);
        }
        best.push(chosen);
    }
}
