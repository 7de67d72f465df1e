//! Search for the crossings of rays, nearest boxes first, until a crossing ends it.

use crate::grid::GridLine;
use crate::line_f32::{LineF32, Span};
use crate::node::LEAF;
use crate::search::candidates::{Candidates, NO_LINE};
use crate::simd::backend::{F32Lanes, Kernel, NODE_WIDTH, SimdBackend};
use crate::tree::Tree;
use crate::triangle::Crossing;

/// Largest number of rays that are searched at the same time.
pub(crate) const MAX_RAYS: usize = 64;

/// Query that a search answers: supplies the rays and decides which crossings count.
pub(crate) trait Rays {
    /// Result for a ray so far.
    type Ray;
    /// True if the first crossing that counts ends the search for a ray.
    const FIRST_ENDS: bool;
    /// Returns the next ray to search, the part of its line where crossings count, and the place of a triangle to skip;
    /// `None` at the end.
    fn next(&mut self) -> Option<(Self::Ray, GridLine, Span, u32)>;
    /// Processes a crossing of a ray, and returns the end of the part where further crossings count \[radii\].
    fn cross(&mut self, ray: &mut Self::Ray, line: &GridLine, crossing: Crossing) -> f32;
    /// Finishes a ray for which all crossings that count have been found.
    fn done(&mut self, ray: Self::Ray, line: &GridLine);
}

/// State of a ray during the search.
#[derive(Clone, Debug)]
struct Active<R> {
    span: Span,
    /// Place of a triangle to skip.
    leaving: u32,
    /// Number of entries on the stack.
    depth: usize,
    ray: R,
}

/// Scratch memory of the search.
#[derive(Clone, Debug, Default)]
pub(crate) struct FirstHitScratch {
    /// Stacks of all rays, the next child last: distances at which the ray enters the children still to be visited.
    entries: Vec<f32>,
    /// Children on these stacks.
    children: Vec<u32>,
    lines: Vec<(GridLine, LineF32)>,
    candidates: Candidates,
}

/// Numbers of active rays.
#[derive(Clone, Copy)]
struct RayList {
    numbers: [u8; MAX_RAYS],
    count: usize,
}

impl RayList {
    const EMPTY: Self = Self { numbers: [0; MAX_RAYS], count: 0 };

    /// Adds a ray if `belongs` is true.
    #[inline(always)]
    fn add(&mut self, number: u8, belongs: bool) {
        self.numbers[self.count % MAX_RAYS] = number;
        self.count += usize::from(belongs);
    }

    fn iter(&self) -> impl Iterator<Item = u8> {
        self.numbers.into_iter().take(self.count)
    }
}

/// Active rays by their next step.
struct Steps {
    nodes: RayList,
    leaves: RayList,
    ended: RayList,
}

impl Steps {
    const EMPTY: Self = Self { nodes: RayList::EMPTY, leaves: RayList::EMPTY, ended: RayList::EMPTY };

    /// Prefetches the last entry of the stack of a ray, and adds the ray to the list for that step.
    #[inline(always)]
    fn note(&mut self, number: u8, depth: usize, children: &[u32], tree: &Tree) {
        let next = children[depth.wrapping_sub(1).min(children.len() - 1)];
        let (ended, leaf) = (depth == 0, next & LEAF != 0);
        tree.prefetch(next);
        self.nodes.add(number, !ended & !leaf);
        self.leaves.add(number, !ended & leaf);
        self.ended.add(number, ended);
    }
}

/// Search for the crossings of rays, approximately in order of distance.
pub(crate) struct FirstHits<'a, R> {
    pub(crate) tree: &'a Tree,
    pub(crate) scratch: &'a mut FirstHitScratch,
    pub(crate) rays: &'a mut R,
}

impl<R: Rays> Kernel for FirstHits<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run<B: SimdBackend>(self, backend: B) {
        let Self { tree, scratch, rays } = self;
        // Room for all children of a node in addition to those on the stack.
        let stride = tree.stack_size + NODE_WIDTH;
        let FirstHitScratch { entries, children, lines, candidates } = scratch;
        entries.resize(MAX_RAYS * stride, 0.0);
        children.resize(MAX_RAYS * stride, 0);
        lines.clear();
        let mut active: Vec<Active<R::Ray>> = Vec::with_capacity(MAX_RAYS);
        let mut steps = Steps::EMPTY;
        for number in 0..MAX_RAYS as u8 {
            let Some((ray, line, span, leaving)) = rays.next() else { break };
            lines.push((line, LineF32::new(&line)));
            active.push(Active { span, leaving, depth: 1, ray });
            children[usize::from(number) * stride] = 0;
            steps.nodes.add(number, true);
        }
        loop {
            let Steps { nodes, leaves, ended } = std::mem::replace(&mut steps, Steps::EMPTY);
            if nodes.count + leaves.count + ended.count == 0 {
                break;
            }
            backend.outline(|| {
                for number in nodes.iter() {
                    let i = usize::from(number);
                    let active = &mut active[i];
                    let children = &mut children[i * stride..(i + 1) * stride];
                    let entries = &mut entries[i * stride..(i + 1) * stride];
                    let top = active.depth - 1;
                    let node = &tree.nodes[children[top] as usize];
                    let [near, far] = node.slabs(backend, &lines[i].1);
                    let from = backend.splat_node(active.span.from);
                    let to = backend.splat_node(active.span.to);
                    let hit_boxes = near.max(from).mask_le(far.min(to));
                    let near = near.max(backend.splat_node(0.0));
                    let Ok(to_entries) = (&mut entries[top..top + NODE_WIDTH]).try_into() else { continue };
                    let Ok(to_children) = (&mut children[top..top + NODE_WIDTH]).try_into() else { continue };
                    backend.sort(near, &node.children, hit_boxes, to_entries, to_children);
                    active.depth = top + hit_boxes.count_ones() as usize;
                    steps.note(number, active.depth, children, tree);
                }
            });
            let count = backend.outline(|| {
                let mut count = 0;
                for number in leaves.iter() {
                    let i = usize::from(number);
                    let Active { span, leaving, depth, .. } = &mut active[i];
                    *depth -= 1;
                    let leaf = (children[i * stride + *depth] & !LEAF) as usize;
                    let first = tree.firsts[leaf];
                    let leaving_bit = (1u64 << leaving.wrapping_sub(first).min(63)) as u32;
                    let mask = tree.leaves[leaf].candidates(backend, &lines[i].1, Some(*span)) & !leaving_bit;
                    count = candidates.found.add_range(backend, count, first, mask, number);
                }
                candidates.prefetch(count, tree);
                count
            });
            for number in ended.iter() {
                let i = usize::from(number);
                if let Some((ray, line, span, leaving)) = rays.next() {
                    let active = &mut active[i];
                    rays.done(std::mem::replace(&mut active.ray, ray), &lines[i].0);
                    (active.span, active.leaving, active.depth) = (span, leaving, 1);
                    lines[i] = (line, LineF32::new(&line));
                    children[i * stride] = 0;
                    steps.nodes.add(number, true);
                }
            }
            backend.outline(|| candidates.test(backend, count, tree, lines));
            candidates.locate(count);
            for k in 0..count {
                let number = candidates.found.lines[k];
                if number != NO_LINE {
                    let i = usize::from(number);
                    let Active { span, ray, depth, .. } = &mut active[i];
                    let crossing = candidates.crossing(k, tree);
                    let to = rays.cross(ray, &lines[i].0, crossing);
                    if to < span.to {
                        span.to = to;
                        let children = &mut children[i * stride..(i + 1) * stride];
                        let entries = &mut entries[i * stride..(i + 1) * stride];
                        *depth = if R::FIRST_ENDS { 0 } else { keep(backend, to, *depth, entries, children) };
                    }
                }
            }
            for number in leaves.iter() {
                let i = usize::from(number);
                steps.note(number, active[i].depth, &children[i * stride..(i + 1) * stride], tree);
            }
        }
        for (active, (line, _)) in active.into_iter().zip(&*lines) {
            rays.done(active.ray, line);
        }
    }
}

/// Keeps those of the first `depth` entries of a stack whose distance is within the limit, and returns their number.
#[inline(always)]
fn keep<B: SimdBackend>(
    backend: B,
    limit: f32,
    depth: usize,
    entries: &mut [f32],
    children: &mut [u32],
) -> usize {
    // Distances before the origin of the line on the grid are stored as zero.
    let limit = backend.splat_node(limit.max(0.0));
    let mut kept = 0;
    for start in (0..depth).step_by(NODE_WIDTH) {
        let (Some(chunk_entries), Some(chunk_children)) =
            (entries[start..].first_chunk::<NODE_WIDTH>(), children[start..].first_chunk::<NODE_WIDTH>())
        else {
            return depth;
        };
        let chunk_entries = backend.load_node(chunk_entries);
        let chunk_children = *chunk_children;
        let in_stack = u32::MAX >> (32 - (depth - start).min(NODE_WIDTH));
        let mask = chunk_entries.mask_le(limit) & in_stack;
        if let Some(to) = entries[kept..].first_chunk_mut() {
            chunk_entries.compress(mask, to);
        }
        if let Some(to) = children[kept..].first_chunk_mut() {
            backend.compress(&chunk_children, mask, to);
        }
        kept += mask.count_ones() as usize;
    }
    kept
}
