//! Search for all hits of lines.

use sir_types::{Barycentric, Line, Side, TriangleId};

use crate::grid::{Grid, GridLine};
use crate::hit::Hit;
use crate::line_f32::{LineF32, Span};
use crate::node::LEAF;
use crate::ray::TRange;
use crate::search::candidates::Candidates;
use crate::search::queue::{MAX_LINES, Queue};
use crate::simd::backend::{F32Lanes, F64Lanes, Kernel, LEAF_WIDTH, SimdBackend};
use crate::tree::Tree;

/// A line, or a part of one.
pub(crate) trait Part {
    /// True for parts of lines. Whole lines need no code for their ends.
    const HAS_ENDS: bool;
    fn line(&self) -> &Line;
    fn range(&self) -> TRange;
}

impl Part for Line {
    const HAS_ENDS: bool = false;

    #[inline(always)]
    fn line(&self) -> &Line {
        self
    }

    #[inline(always)]
    fn range(&self) -> TRange {
        TRange::ALL
    }
}

impl Part for (Line, TRange) {
    const HAS_ENDS: bool = true;

    #[inline(always)]
    fn line(&self) -> &Line {
        &self.0
    }

    #[inline(always)]
    fn range(&self) -> TRange {
        self.1
    }
}

/// Scratch memory of the search, and the hits found.
#[derive(Clone, Debug)]
pub(crate) struct AllHitsScratch {
    lines: Vec<(GridLine, LineF32)>,
    /// Searched span of each line; unused for whole lines.
    spans: Vec<Span>,
    nodes: Queue,
    leaves: Queue,
    candidates: Candidates,
    /// Distances of the crossings \[steps of the grid\], sorted by line.
    distances: Vec<f64>,
    /// Index in `distances` of each crossing.
    places: Vec<u32>,
    /// Start of the hits of each line in `hits`, and the end of the last ones.
    pub(crate) starts: [u32; MAX_LINES + 3],
    /// Hits line by line, in order of distance; longer than needed.
    pub(crate) hits: Vec<Hit>,
    /// Number of hits of each line on triangles in stacks.
    pub(crate) stacked: [u32; MAX_LINES],
    /// True for lines whose hits remain to be sorted: they have equal distances, or are many.
    pub(crate) unsorted: [bool; MAX_LINES],
}

impl Default for AllHitsScratch {
    fn default() -> Self {
        Self {
            lines: Vec::new(),
            spans: Vec::new(),
            nodes: Queue::default(),
            leaves: Queue::default(),
            candidates: Candidates::default(),
            distances: Vec::new(),
            places: Vec::new(),
            starts: [0; MAX_LINES + 3],
            hits: Vec::new(),
            stacked: [0; MAX_LINES],
            unsorted: [false; MAX_LINES],
        }
    }
}

impl AllHitsScratch {
    /// Returns the hits found, line by line, in order of distance.
    pub(crate) fn hits(&self) -> &[Hit] {
        &self.hits[..self.starts[MAX_LINES] as usize]
    }

    /// Keeps only the hits for which `keeps`, called with the number of the line and the hit, is true.
    pub(crate) fn retain(&mut self, lines: usize, mut keeps: impl FnMut(usize, &Hit) -> bool) {
        let (mut from, mut kept) = (0, 0);
        for line in 0..lines {
            let to = self.starts[line + 1] as usize;
            for i in from..to {
                let hit = self.hits[i];
                self.hits[kept] = hit;
                kept += usize::from(keeps(line, &hit));
            }
            from = to;
            self.starts[line + 1] = kept as u32;
        }
        self.starts[lines..=MAX_LINES].fill(kept as u32);
    }
}

/// Search for all hits of at most [`MAX_LINES`] (infinite) lines; for parts of lines, all hits in the part and some
/// that lie close to it.
pub(crate) struct AllHits<'a, P> {
    pub(crate) grid: &'a Grid,
    pub(crate) tree: &'a Tree,
    pub(crate) lines: &'a [P],
    pub(crate) scratch: &'a mut AllHitsScratch,
}

impl<P: Part> Kernel for AllHits<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<B: SimdBackend>(self, backend: B) {
        let Self { grid, tree, lines, scratch } = self;
        let AllHitsScratch { lines: traced, spans, nodes, leaves, candidates, .. } = scratch;
        traced.clear();
        spans.clear();
        let (mut node_count, mut leaf_count) = (0, 0);
        let root = &tree.nodes[0];
        let leaf = backend.highest_bits(&root.children);
        for (part, number) in lines.iter().zip(0u8..) {
            // Lines that pass far from the scene hit nothing.
            let line = grid.line(part.line()).unwrap_or(GridLine::far());
            let boxes = LineF32::new(&line);
            traced.push((line, boxes));
            let [mut near, mut far] = root.slabs(backend, &boxes);
            if P::HAS_ENDS {
                let TRange { start, end } = part.range();
                let span = Span::new(grid.steps(start) - line.start, grid.steps(end) - line.start);
                spans.push(span);
                near = near.max(backend.splat_node(span.from));
                far = far.min(backend.splat_node(span.to));
            }
            let hit_boxes = near.mask_le(far);
            node_count = nodes.add(backend, node_count, &root.children, hit_boxes & !leaf, number);
            leaf_count = leaves.add(backend, leaf_count, &root.children, hit_boxes & leaf, number);
        }
        let mut next = 0;
        while next < node_count {
            tree.prefetch(nodes.ahead(next));
            let (node, line) = (&tree.nodes[nodes.items[next] as usize], nodes.lines[next]);
            next += 1;
            let [mut near, mut far] = node.slabs(backend, &traced[usize::from(line)].1);
            if P::HAS_ENDS {
                let Span { from, to } = spans[usize::from(line)];
                near = near.max(backend.splat_node(from));
                far = far.min(backend.splat_node(to));
            }
            let hit_boxes = near.mask_le(far);
            let leaf = backend.highest_bits(&node.children);
            node_count = nodes.add(backend, node_count, &node.children, hit_boxes & !leaf, line);
            leaf_count = leaves.add(backend, leaf_count, &node.children, hit_boxes & leaf, line);
        }
        let mut count = 0;
        for i in 0..leaf_count {
            tree.prefetch(leaves.ahead(i));
            let (number, line) = ((leaves.items[i] & !LEAF) as usize, leaves.lines[i]);
            let span = if P::HAS_ENDS { Some(spans[usize::from(line)]) } else { None };
            let mask = tree.leaves[number].candidates(backend, &traced[usize::from(line)].1, span);
            count = candidates.found.add_range(backend, count, tree.firsts[number], mask, line);
        }
        candidates.prefetch(count, tree);
        candidates.test(backend, count, tree, traced);
        sort(backend, grid, tree, count, scratch);
    }
}

/// Number of hits of a line up to which each is compared with all others. This is faster than sorting, but takes the
/// square of the number.
const MAX_RANKED: usize = 96;

/// Converts crossings to hits, sorted by line and distance.
#[inline(always)]
fn sort<B: SimdBackend>(backend: B, grid: &Grid, tree: &Tree, count: usize, scratch: &mut AllHitsScratch) {
    let AllHitsScratch { lines, candidates, distances, places, starts, hits, stacked, unsorted, .. } =
        scratch;
    // Counting sort by line: while hits are added, each start moves to the start of the next line. Candidates that are
    // not crossed come after all lines.
    starts.fill(0);
    candidates.found.lines[..count].iter().for_each(|&line| starts[usize::from(line) + 2] += 1);
    for line in 2..starts.len() {
        starts[line] += starts[line - 1];
    }
    stacked.fill(0);
    unsorted.fill(false);
    let nothing =
        Hit { t: 0.0, triangle: TriangleId(0), point: Barycentric { v: 0.0, w: 0.0 }, side: Side::Back };
    if hits.len() < count {
        hits.resize(count, nothing);
        places.resize(count, 0);
        distances.resize(count + LEAF_WIDTH, 0.0);
    }
    candidates.locate(count);
    let candidates = &*candidates;
    let of_lines = &candidates.found.lines[..count];
    let t = &candidates.distances()[..count];
    let places = &mut places[..count];
    for i in 0..count {
        let next = &mut starts[usize::from(of_lines[i]) + 1];
        distances[*next as usize] = t[i];
        places[i] = *next;
        *next += 1;
    }
    for i in 0..count {
        let line = usize::from(of_lines[i]);
        let Some((grid_line, _)) = lines.get(line) else { continue };
        let (start, end, place) = (starts[line] as usize, starts[line + 1] as usize, places[i] as usize);
        let crossing = candidates.crossing(i, tree);
        stacked[line] += u32::from(crossing.is_stacked());
        if end - start > MAX_RANKED {
            (unsorted[line], hits[place]) = (true, crossing.hit(grid, grid_line));
            continue;
        }
        let mine = backend.splat_f64(t[i]);
        let (mut rank, mut first) = (0, start);
        while first < end {
            let others = distances[first..].first_chunk().map_or(mine, |chunk| backend.load_f64(chunk));
            let of_line = u32::MAX >> (32 - (end - first).min(LEAF_WIDTH));
            // Bits of this crossing and of those found before it, if they are in this chunk.
            let this = 1u32.checked_shl(place.wrapping_sub(first).min(32) as u32).unwrap_or(0);
            let earlier = if place < first { 0 } else { this.wrapping_sub(1) };
            // Among equal distances, the crossing found first comes first.
            let (before, not_after) = (others.mask_lt(mine), others.mask_le(mine));
            unsorted[line] |= not_after & !before & of_line & !this != 0;
            rank += ((before | (not_after & earlier)) & of_line).count_ones() as usize;
            first += LEAF_WIDTH;
        }
        hits[start + rank] = crossing.hit(grid, grid_line);
    }
}
