//! The bounding volume hierarchy as it is searched: nodes of many boxes, leaves of many triangles.

use std::ops::Range;

use sir_geom::{Scene, TriangleId};

use crate::build;
use crate::build::Hierarchy;
use crate::grid::Grid;
use crate::lanes::{BOXES, Kit};
use crate::leaf::Leaf;
use crate::memory::collect_in_large_pages;
use crate::triangle::GridTriangle;

/// How much boxes are enlarged, in radii of the scene: more than single precision loses on the way through a node.
pub(crate) const MARGIN: f32 = 3e-6;

/// Boxes, one lane each, in radii of the scene about its centre.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// Smallest coordinates per axis, then largest; an unused lane has an empty box.
    pub(crate) bounds: [[f32; BOXES]; 6],
    /// What the boxes contain.
    pub(crate) children: [u32; BOXES],
}

/// One of the bounds of a node: smallest coordinates per axis, then largest. The number inside is below 6.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound(u8);

impl Bound {
    /// The smallest or the largest coordinates of an axis.
    pub(crate) fn new(largest: bool, axis: usize) -> Self {
        Self(3 * u8::from(largest) + (axis % 3) as u8)
    }
}

impl Node {
    /// A bound of all boxes.
    #[inline(always)]
    pub(crate) fn bound(&self, bound: Bound) -> &[f32; BOXES] {
        // SAFETY: the only way to make a bound gives a number below 6.
        #[allow(unsafe_code, reason = "six checks per node take a tenth of the time of a search")]
        unsafe {
            self.bounds.get_unchecked(usize::from(bound.0))
        }
    }
}

/// The highest bit of a child: set if it is the number of a leaf, and clear if it is that of a node.
pub(crate) const LEAF: u32 = 1 << 31;

/// The hierarchy. Node 0 is the root.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) nodes: Vec<Node>,
    pub(crate) leaves: Vec<Leaf>,
    /// Where in `triangles` those of each leaf begin.
    pub(crate) firsts: Vec<u32>,
    /// In the order of the leaves.
    pub(crate) triangles: Vec<GridTriangle>,
    /// Where in `triangles` each triangle of the scene is.
    places: Vec<u32>,
    /// Most children that wait while the tree is searched in depth.
    pub(crate) most_waiting: usize,
}

impl Tree {
    pub(crate) fn new(scene: &Scene, grid: &Grid) -> Self {
        let triangles: Vec<GridTriangle> = scene
            .triangle_ids()
            .map(|t| GridTriangle::new(scene.corners(t).map(|p| grid.vertex(p)), t))
            .collect();
        let Hierarchy { nodes, leaves: ranges, order } = build::hierarchy(&triangles);
        let mut places = vec![0; triangles.len()];
        order.iter().zip(0..).for_each(|(&i, place)| places[i as usize] = place);
        let triangles = collect_in_large_pages(order.iter().map(|&i| triangles[i as usize]));
        let of = |range: &Range<u32>| triangles[range.start as usize..range.end as usize].iter();
        let leaves = collect_in_large_pages(ranges.iter().map(|range| Leaf::new(of(range))));
        let firsts = ranges.iter().map(|range| range.start).collect();
        let most_waiting = most_waiting(&nodes, 0);
        let nodes = collect_in_large_pages(nodes.into_iter());
        Self { nodes, leaves, firsts, triangles, places, most_waiting }
    }

    /// Begins to bring a child to the caches.
    #[inline(always)]
    pub(crate) fn prefetch<K: Kit>(&self, child: u32) {
        let (nodes, leaves) = (self.nodes.as_ptr().cast::<u8>(), self.leaves.as_ptr().cast::<u8>());
        let (number, leaf) = ((child & !LEAF) as usize, child & LEAF != 0);
        let (list, size) = if leaf { (leaves, size_of::<Leaf>()) } else { (nodes, size_of::<Node>()) };
        K::prefetch(list.wrapping_add(number * size), size_of::<Node>());
        K::prefetch(self.firsts.as_ptr().wrapping_add(number).cast(), 1);
    }

    /// Begins to bring the place of a triangle to the caches.
    #[inline]
    pub(crate) fn prefetch_place(&self, id: TriangleId) {
        crate::memory::prefetch(&self.places[id.index()]);
    }

    /// Begins to bring a triangle to the caches.
    #[inline(always)]
    pub(crate) fn prefetch_triangle<K: Kit>(&self, place: u32) {
        let triangle = self.triangles.as_ptr().wrapping_add(place as usize);
        K::prefetch(triangle.cast(), size_of::<GridTriangle>());
    }

    /// A triangle of the scene.
    pub(crate) fn triangle(&self, id: TriangleId) -> &GridTriangle {
        &self.triangles[self.place(id) as usize]
    }

    /// Where in `triangles` a triangle of the scene is.
    pub(crate) fn place(&self, id: TriangleId) -> u32 {
        self.places[id.index()]
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
            + size_of_val(self.leaves.as_slice())
            + size_of_val(self.firsts.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.places.as_slice())
    }
}

fn most_waiting(nodes: &[Node], root: usize) -> usize {
    let children = nodes[root].children.iter().filter(|&&child| child != 0);
    let below = children.clone().filter(|&child| child & LEAF == 0);
    children.count() + below.map(|&child| most_waiting(nodes, child as usize)).max().unwrap_or(0)
}
