//! The bounding volume hierarchy as it is searched: wide nodes, and leaves of several triangles.

use std::ops::Range;

use sir_types::TriangleId;

use crate::build::{Hierarchy, hierarchy};
use crate::leaf::Leaf;
use crate::memory::{collect_in_huge_pages, prefetch};
use crate::node::{LEAF, Node};
use crate::simd::prefetch::prefetch as prefetch_bytes;
use crate::triangle::GridTriangle;

/// Bounding volume hierarchy. Node 0 is the root.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) nodes: Vec<Node>,
    pub(crate) leaves: Vec<Leaf>,
    /// Place of the first triangle of each leaf: its index in `triangles`.
    pub(crate) firsts: Vec<u32>,
    /// Triangles in the order of the leaves.
    pub(crate) triangles: Vec<GridTriangle>,
    /// Place of each triangle, by its number.
    places: Vec<u32>,
    /// Largest number of entries on the stack of a depth-first search.
    pub(crate) stack_size: usize,
}

impl Tree {
    /// Builds the tree of triangles, which are given in the order of their numbers.
    pub(crate) fn new(triangles: &[GridTriangle]) -> Self {
        let Hierarchy { nodes, leaves: ranges, order } = hierarchy(triangles);
        let mut places = vec![0; triangles.len()];
        order.iter().zip(0..).for_each(|(&i, place)| places[i as usize] = place);
        let triangles = collect_in_huge_pages(order.iter().map(|&i| triangles[i as usize]));
        let of = |range: &Range<u32>| triangles[range.start as usize..range.end as usize].iter();
        let leaves = collect_in_huge_pages(ranges.iter().map(|range| Leaf::new(of(range))));
        let firsts = ranges.iter().map(|range| range.start).collect();
        let stack_size = stack_size(&nodes);
        let nodes = collect_in_huge_pages(nodes.into_iter());
        Self { nodes, leaves, firsts, triangles, places, stack_size }
    }

    /// Prefetches a child of a node: a node or a leaf.
    #[inline(always)]
    pub(crate) fn prefetch(&self, child: u32) {
        let (nodes, leaves) = (self.nodes.as_ptr().cast::<u8>(), self.leaves.as_ptr().cast::<u8>());
        let (number, leaf) = ((child & !LEAF) as usize, child & LEAF != 0);
        let (list, size) = if leaf { (leaves, size_of::<Leaf>()) } else { (nodes, size_of::<Node>()) };
        prefetch_bytes(list.wrapping_add(number * size), size_of::<Node>());
        prefetch_bytes(self.firsts.as_ptr().wrapping_add(number).cast(), 1);
    }

    /// Prefetches the place of a triangle.
    #[inline]
    pub(crate) fn prefetch_place(&self, id: TriangleId) {
        if let Some(place) = self.places.get(id.index()) {
            prefetch(place);
        }
    }

    /// Prefetches the triangle at a place.
    #[inline(always)]
    pub(crate) fn prefetch_triangle(&self, place: u32) {
        let triangle = self.triangles.as_ptr().wrapping_add(place as usize);
        prefetch_bytes(triangle.cast(), size_of::<GridTriangle>());
    }

    /// Returns the places of the triangles of each leaf.
    pub(crate) fn leaf_ranges(&self) -> Vec<Range<u32>> {
        let mut starts = self.firsts.clone();
        starts.sort_unstable();
        starts.push(self.triangles.len() as u32);
        let end = |first: u32| starts[starts.partition_point(|&start| start <= first)];
        self.firsts.iter().map(|&first| first..end(first)).collect()
    }

    /// Returns the triangle with the given number.
    pub(crate) fn triangle(&self, id: TriangleId) -> Option<&GridTriangle> {
        self.triangles.get(self.place(id)? as usize)
    }

    /// Returns the place of the triangle with the given number.
    pub(crate) fn place(&self, id: TriangleId) -> Option<u32> {
        self.places.get(id.index()).copied()
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
            + size_of_val(self.leaves.as_slice())
            + size_of_val(self.firsts.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.places.as_slice())
    }
}

/// Returns the largest number of entries on the stack of a depth-first search. Nodes come after their parents.
fn stack_size(nodes: &[Node]) -> usize {
    let mut sizes = vec![0; nodes.len()];
    for (i, node) in nodes.iter().enumerate().rev() {
        let children = node.children.iter().filter(|&&child| child != 0);
        let below = children.clone().filter(|&child| child & LEAF == 0);
        sizes[i] = children.count() + below.map(|&child| sizes[child as usize]).max().unwrap_or(0);
    }
    sizes.first().copied().unwrap_or(0)
}
