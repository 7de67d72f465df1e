//! A tree of emitting surfaces, so that a point need not evaluate each of thousands.
//!
//! As in lightcuts (Walter et al. 2005), a point uses a cut through the tree: near groups in parts, far groups as a
//! whole. A group is chosen by an estimate of its contribution, and a member of it by power. The estimates affect only
//! the noise of a measurement, not its mean.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;

/// Largest number of groups in a cut.
pub(super) const MAX_CUT: usize = 256;

/// A surface in the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    pub(super) corners: [DVec3; 3],
    pub(super) normal: DVec3,
    pub(super) power: f64,
    pub(super) area: f64,
}

/// A hierarchy of groups of surfaces.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// Numbers of the surfaces, in an order in which each group is a range.
    order: Vec<u32>,
    /// Position of each surface in `order`.
    place: Vec<u32>,
    /// Running sums of power in this order, starting with 0.
    sums: Vec<f64>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    start: u32,
    end: u32,
    /// The second child. The first child follows the node itself.
    second: u32,
    center: DVec3,
    radius: f64,
    /// Sum of the normals, weighted by power.
    facing: DVec3,
    power: f64,
    area: f64,
}

/// A group in the construction of a cut.
struct Candidate {
    node: usize,
    weight: f64,
    priority: f64,
}

impl Tree {
    /// Returns the tree of these surfaces, of which there must be at least one.
    pub(super) fn new(leaves: &[Leaf]) -> Self {
        let n = leaves.len();
        let mut tree = Self {
            order: (0..n as u32).collect(),
            place: vec![0; n],
            sums: Vec::with_capacity(n + 1),
            nodes: Vec::with_capacity(2 * n),
        };
        // Both halves have the same size, so the depth of the tree is logarithmic.
        tree.build(leaves, 0..n);
        let mut sum = 0.0;
        tree.sums.push(sum);
        for (place, &k) in (0..).zip(&tree.order) {
            tree.place[k as usize] = place;
            sum += leaves[k as usize].power;
            tree.sums.push(sum);
        }
        tree
    }

    fn build(&mut self, leaves: &[Leaf], range: Range<usize>) {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (mut facing, mut power, mut area) = (DVec3::ZERO, 0.0, 0.0);
        for &k in &self.order[range.clone()] {
            let leaf = &leaves[k as usize];
            for corner in leaf.corners {
                (low, high) = (low.min(corner), high.max(corner));
            }
            facing += leaf.power * leaf.normal;
            power += leaf.power;
            area += leaf.area;
        }
        let node = self.nodes.len();
        self.nodes.push(Node {
            start: range.start as u32,
            end: range.end as u32,
            second: 0,
            center: low.midpoint(high),
            radius: 0.5 * low.distance(high),
            facing,
            power,
            area,
        });
        if range.len() == 1 {
            return;
        }
        let size = high - low;
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let middle = |k: &u32| leaves[*k as usize].corners.iter().map(|p| p[axis]).sum::<f64>();
        let half = range.len() / 2;
        self.order[range.clone()]
            .select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
        self.build(leaves, range.start..range.start + half);
        self.nodes[node].second = self.nodes.len() as u32;
        self.build(leaves, range.start + half..range.end);
    }

    /// Returns a cut for a point that looks in the direction `normal`: groups as ranges in the tree's order, each with
    /// an estimate of the irradiance that it brings. The estimate is zero only if the whole group is behind the point.
    /// `exact` returns the estimate for a single surface.
    pub(super) fn cut(
        &self,
        origin: DVec3,
        normal: DVec3,
        exact: impl Fn(usize) -> f64,
    ) -> Vec<(Range<u32>, f64)> {
        let candidate = |node: usize| {
            let Node { start, end, center, radius, .. } = self.nodes[node];
            let to = center - origin;
            let weight = match end - start {
                1 => exact(self.order[start as usize] as usize),
                _ => self.nodes[node].weight(to, normal),
            };
            let priority =
                if end - start == 1 { 0.0 } else { weight * radius / to.length().max(1e-3 * radius) };
            Candidate { node, weight, priority }
        };
        let mut heap = BinaryHeap::from([candidate(0)]);
        while heap.len() < MAX_CUT {
            // The first candidate is the one to split, if it can be.
            match heap.peek() {
                Some(top) if top.priority > 0.0 => {
                    let node = top.node;
                    heap.pop();
                    heap.push(candidate(node + 1));
                    heap.push(candidate(self.nodes[node].second as usize));
                }
                _ => break,
            }
        }
        let range = |c: Candidate| (self.nodes[c.node].start..self.nodes[c.node].end, c.weight);
        let mut groups: Vec<_> = heap.into_iter().map(range).collect();
        groups.sort_unstable_by_key(|(range, _)| range.start);
        groups
    }

    /// Returns the position of a surface in the tree's order.
    pub(super) fn place(&self, surface: usize) -> u32 {
        self.place[surface]
    }

    /// Returns the share of the power of a group that belongs to the surface at a position in it.
    pub(super) fn share(&self, group: &Range<u32>, place: u32) -> f64 {
        let (low, high) = self.ends(group);
        let place = place as usize;
        if high > low { (self.sums[place + 1] - self.sums[place]) / (high - low) } else { 0.0 }
    }

    /// Chooses a surface of a group in proportion to power, by a number in `[0, 1]`. Returns the surface and the
    /// remainder of the number, rescaled to `[0, 1]`.
    pub(super) fn choose(&self, group: &Range<u32>, u: f64) -> (usize, f64) {
        let (low, high) = self.ends(group);
        let target = low + u * (high - low);
        let (first, last) = (group.start as usize, group.end as usize - 1);
        // Only surfaces of the group are chosen, in spite of rounding.
        let k = first + self.sums[first + 1..=last].partition_point(|&sum| sum <= target);
        let rest = (target - self.sums[k]) / (self.sums[k + 1] - self.sums[k]);
        (self.order[k] as usize, if rest.is_finite() { rest.clamp(0.0, 1.0) } else { 0.5 })
    }

    fn ends(&self, group: &Range<u32>) -> (f64, f64) {
        (self.sums[group.start as usize], self.sums[group.end as usize])
    }
}

impl Node {
    /// Returns an estimate of the irradiance that a group brings. `to` is the vector to its center.
    fn weight(&self, to: DVec3, normal: DVec3) -> f64 {
        let (height, radius) = (to.dot(normal), self.radius);
        if height + radius <= 0.0 || self.area <= 0.0 {
            return 0.0;
        }
        let distance = to.length().max(radius).max(f64::MIN_POSITIVE);
        // For a group that is partly behind the point, the cosine is at least a part of that of its upper end.
        let cosine = (height.max(0.25 * (height + radius)) / distance).min(1.0);
        // The cosine at the group has a lower bound likewise, unless all members face the same way and are far away.
        let mean = -self.facing.dot(to) / (self.power * distance).max(f64::MIN_POSITIVE);
        let spread = (1.0 - self.facing.length() / self.power.max(f64::MIN_POSITIVE)).max(0.0);
        let near = (radius / distance).min(1.0);
        let its_cosine = mean.max(0.25 * (spread + near)).clamp(1e-3, 1.0);
        let factor = self.area * cosine * its_cosine / (distance * distance);
        (self.power / self.area) * (factor.min(f64::MAX) / (PI + factor.min(f64::MAX)))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.priority.total_cmp(&other.priority).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns 1,000 lamps of different power at scattered positions.
    fn strewn() -> Vec<Leaf> {
        let place = |i: u32| {
            let i = f64::from(i);
            DVec3::new((i * 0.618) % 1.0, (i * 0.755) % 1.0, 1.0 + (i * 0.57) % 1.0)
        };
        let leaf = |i: u32| {
            let p = place(i);
            let corners = [p, p + 0.01 * DVec3::Y, p + 0.01 * DVec3::X];
            Leaf { corners, normal: -DVec3::Z, power: 0.1 + f64::from(i % 7), area: 5e-5 }
        };
        (0..1000).map(leaf).collect()
    }

    #[test]
    fn every_surface_is_in_one_group_and_chosen_as_often_as_is_said() {
        let leaves = strewn();
        let tree = Tree::new(&leaves);
        let groups = tree.cut(DVec3::new(0.3, 0.2, 0.0), DVec3::Z, |_| 1.0);
        assert_eq!(groups.len(), MAX_CUT);
        let mut end = 0;
        for (group, weight) in &groups {
            assert_eq!(group.start, end);
            assert!(*weight > 0.0);
            end = group.end;
            let n = 20_000;
            let mut counts = vec![0; group.len()];
            for i in 0..n {
                let (surface, rest) = tree.choose(group, (f64::from(i) + 0.5) / f64::from(n));
                assert!((0.0..=1.0).contains(&rest));
                counts[(tree.place(surface) - group.start) as usize] += 1;
            }
            for (place, count) in (group.start..).zip(counts) {
                let share = tree.share(group, place);
                assert!((f64::from(count) / f64::from(n) - share).abs() < 1e-3, "{count}, {share}");
            }
        }
        assert_eq!(end as usize, leaves.len());
    }

    #[test]
    fn what_is_behind_has_no_weight() {
        let tree = Tree::new(&strewn());
        let groups = tree.cut(DVec3::new(0.5, 0.5, 0.0), -DVec3::Z, |_| 1.0);
        assert!(groups.iter().all(|(_, weight)| *weight == 0.0) && groups.len() == 1, "{groups:?}");
    }
}
