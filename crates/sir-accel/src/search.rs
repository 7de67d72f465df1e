//! Searches the tree for what many lines cross.
//!
//! A line visits few nodes, but has to wait for the memory of each: so many lines are searched at the same time, each a step
//! at a time, and memory is asked for as soon as it is known that it will be needed.

use sir_geom::{Barycentric, Line, Side, TriangleId};

use crate::grid::{Grid, GridLine, RADIUS};
use crate::hit;
use crate::hit::Hit;
use crate::lanes::{BOXES, Doubles, Kit, Packed, Singles, TRIANGLES};
use crate::leaf::Span;
use crate::tree::{Bound, LEAF, Node, Tree};
use crate::triangle::{Crossed, Crossing, Factors, GridTriangle};

/// A line in single precision, in radii of the scene about its centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShortLine {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    inverse: [f32; 3],
    /// Origin times inverse, negative.
    offset: [f32; 3],
    /// Per axis, which bounds of a node are met first, and which last.
    bounds: [[Bound; 3]; 2],
}

impl ShortLine {
    #[inline(always)]
    pub(crate) fn new(line: &GridLine) -> Self {
        let origin = (line.origin * (1.0 / RADIUS)).as_vec3().to_array();
        let direction = line.direction.as_vec3().to_array();
        // A component of zero becomes a tiny one: the slab is then passed or missed as a whole.
        let invert = |d: f32| if d == 0.0 { 1e20 } else { 1.0 / d };
        let inverse = [invert(direction[0]), invert(direction[1]), invert(direction[2])];
        let offset = [-origin[0] * inverse[0], -origin[1] * inverse[1], -origin[2] * inverse[2]];
        let bound = |last: bool, axis: usize| Bound::new((direction[axis] < 0.0) != last, axis);
        let bounds = |last: bool| [bound(last, 0), bound(last, 1), bound(last, 2)];
        Self { origin, direction, inverse, offset, bounds: [bounds(false), bounds(true)] }
    }
}

/// Where a line enters and leaves the boxes of a node \[radii\].
#[inline(always)]
fn slabs<K: Kit>(node: &Node, line: &ShortLine) -> [K::Boxes; 2] {
    let bound = |end: usize, axis: usize| {
        K::Boxes::load(node.bound(line.bounds[end][axis]))
            .times_plus(K::Boxes::splat(line.inverse[axis]), K::Boxes::splat(line.offset[axis]))
    };
    let near = bound(0, 0).max(bound(0, 1)).max(bound(0, 2));
    let far = bound(1, 0).min(bound(1, 1)).min(bound(1, 2));
    [near, far]
}

/// Lines that are searched at the same time for all crossings; their numbers fit a byte.
pub(crate) const LINES: usize = 128;

/// How many steps ahead memory is asked for.
const AHEAD: usize = 12;

/// Nodes, leaves or triangles, each with the number of the line that reaches it.
#[derive(Clone, Debug, Default)]
struct Queue {
    items: Vec<u32>,
    lines: Vec<u8>,
}

impl Queue {
    /// Adds the items whose bits are set in the mask, to a queue with `len` of them; gives how many it has then.
    #[inline(always)]
    fn add<K: Kit>(&mut self, len: usize, items: &[u32; BOXES], mask: u32, line: u8) -> usize {
        if let Some(to) = self.room(len, line) {
            K::compress(items, mask, to);
        }
        len + mask.count_ones() as usize
    }

    /// Adds numbers from `first` on whose bits are set in the mask, to a queue with `len` items; gives how many it has then.
    #[inline(always)]
    fn add_numbers<K: Kit>(&mut self, len: usize, first: u32, mask: u32, line: u8) -> usize {
        if let Some(to) = self.room(len, line) {
            K::numbers(first, mask, to);
        }
        len + mask.count_ones() as usize
    }

    /// Room for `N` more items of a line.
    #[inline(always)]
    fn room<const N: usize>(&mut self, len: usize, line: u8) -> Option<&mut [u32; N]> {
        if self.items.len() < len + N || self.lines.len() < len + N {
            self.grow();
        }
        self.lines[len..len + N].fill(line);
        self.items[len..].first_chunk_mut()
    }

    #[cold]
    #[inline(never)]
    fn grow(&mut self) {
        let len = (2 * self.items.len()).max(16 * LINES);
        self.items.resize(len, 0);
        self.lines.resize(len, 0);
    }

    /// The item some steps after the i-th.
    #[inline(always)]
    fn ahead(&self, i: usize) -> u32 {
        self.items.get(i + AHEAD).copied().unwrap_or(0)
    }
}

/// Triangles that lines may cross, and how they lie to them.
#[derive(Clone, Debug, Default)]
struct Candidates {
    /// Places of the triangles in the tree; the line is `NONE` if it turns out that it does not cross the triangle.
    found: Queue,
    fronts: Vec<bool>,
    factors: Factors<Vec<f64>>,
    pairs: Vec<Pairs>,
}

/// Instead of the number of a line.
const NONE: u8 = LINES as u8;

impl Candidates {
    /// Replaces the last three factors by the distance and the place of each crossing.
    #[inline(always)]
    fn locate(&mut self, len: usize) {
        let [e_ab, e_ca, all, a, ab, ac] = self.factors.each_mut().map(|list| &mut list[..len]);
        for i in 0..len {
            let (t, point) = Crossing::locate([e_ab[i], e_ca[i], all[i], a[i], ab[i], ac[i]]);
            (a[i], ab[i], ac[i]) = (t, point.v, point.w);
        }
    }

    /// Begins to bring the triangles to the caches.
    #[inline(always)]
    fn prefetch<K: Kit>(&self, len: usize, tree: &Tree) {
        self.found.items[..len].iter().for_each(|&place| tree.prefetch_triangle::<K>(place));
    }

    /// A crossing that was located.
    #[inline(always)]
    fn crossing(&self, i: usize, tree: &Tree) -> Crossing {
        let [.., t, v, w] = &self.factors;
        Crossing {
            t: t[i],
            point: Barycentric { v: v[i], w: w[i] },
            side: if self.fronts[i] { Side::Front } else { Side::Back },
            id: tree.triangles[self.found.items[i] as usize].id,
        }
    }

    /// Crosses lines and triangles, eight pairs at a time.
    #[inline(always)]
    fn cross<K: Kit>(&mut self, len: usize, tree: &Tree, lines: &[(GridLine, ShortLine)]) {
        // First all are laid out, lane by lane: vectors that were just written number by number are slow to read.
        let blocks = len.div_ceil(TRIANGLES);
        if self.pairs.len() < blocks {
            self.pairs.resize(blocks, Pairs::NONE);
            self.fronts.resize(blocks * TRIANGLES, false);
            self.factors.iter_mut().for_each(|list| list.resize(blocks * TRIANGLES, 0.0));
        }
        let Queue { items, lines: of_lines } = &mut self.found;
        for (block, pairs) in self.pairs[..blocks].iter_mut().enumerate() {
            for lane in 0..TRIANGLES.min(len - block * TRIANGLES) {
                let i = block * TRIANGLES + lane;
                let line = &lines[usize::from(of_lines[i])].0;
                pairs.set(lane, &tree.triangles[items[i] as usize], line);
            }
        }
        for block in 0..blocks {
            let start = block * TRIANGLES;
            let end = len.min(start + TRIANGLES);
            let crossed = self.pairs[block].cross::<K>();
            for (factor, list) in crossed.factors.iter().zip(&mut self.factors) {
                if let Some(to) = list[start..].first_chunk_mut() {
                    factor.store(to);
                }
            }
            let (met, front) = (crossed.back | crossed.front, crossed.front);
            if let Some(to) = self.fronts[start..].first_chunk_mut::<TRIANGLES>() {
                *to = std::array::from_fn(|lane| front >> lane & 1 == 1);
            }
            if !met & (u32::MAX >> (32 - (end - start))) != 0 {
                for i in start..end {
                    let lane = i - start;
                    if crossed.doubt >> lane & 1 == 1 {
                        let triangle = &tree.triangles[items[i] as usize];
                        let side = triangle.exact_crossing(&lines[usize::from(of_lines[i])].0);
                        self.fronts[i] = side == Some(Side::Front);
                        of_lines[i] = if side.is_none() { NONE } else { of_lines[i] };
                    } else if met >> lane & 1 == 0 {
                        of_lines[i] = NONE;
                    }
                }
            }
        }
    }
}

/// Eight pairs of a line and a triangle, one lane each.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Pairs {
    /// Origin and direction of the line.
    line: [[[f64; TRIANGLES]; 3]; 2],
    corners: [[[i32; TRIANGLES]; 3]; 3],
    certain: [f32; TRIANGLES],
}

impl Pairs {
    const NONE: Self = Self {
        line: [[[0.0; TRIANGLES]; 3]; 2],
        corners: [[[0; TRIANGLES]; 3]; 3],
        certain: [0.0; TRIANGLES],
    };

    #[inline(always)]
    fn set(&mut self, lane: usize, triangle: &GridTriangle, line: &GridLine) {
        let lane = lane % TRIANGLES;
        for axis in 0..3 {
            self.line[0][axis][lane] = line.origin[axis];
            self.line[1][axis][lane] = line.direction[axis];
            for corner in 0..3 {
                self.corners[corner][axis][lane] = triangle.corners[corner][axis];
            }
        }
        self.certain[lane] = triangle.certain;
    }

    #[inline(always)]
    fn cross<K: Kit>(&self) -> Crossed<K::Crossings> {
        let numbers = |v: &[[f64; TRIANGLES]; 3]| {
            [K::Crossings::load(&v[0]), K::Crossings::load(&v[1]), K::Crossings::load(&v[2])]
        };
        let integers = |v: &[[i32; TRIANGLES]; 3]| {
            let of = K::Crossings::of_integers;
            [of(&v[0]), of(&v[1]), of(&v[2])]
        };
        let [a, b, c] = &self.corners;
        let certain = K::Crossings::of_singles(&self.certain);
        let [origin, direction] = &self.line;
        Crossed::new([integers(a), integers(b), integers(c)], certain, numbers(origin), numbers(direction))
    }
}

/// Scratch memory of the search for all hits, and what was found.
#[derive(Clone, Debug)]
pub(crate) struct AllScratch {
    lines: Vec<(GridLine, ShortLine)>,
    nodes: Queue,
    leaves: Queue,
    candidates: Candidates,
    /// Sorted by line: distances \[steps of the grid\].
    distances: Vec<f64>,
    /// Where the distance of each crossing is.
    places: Vec<u32>,
    /// Where the hits of each line begin, and where the last ones end.
    pub(crate) starts: [u32; LINES + 3],
    /// Line by line, in order of distance; longer than needed.
    pub(crate) hits: Vec<Hit>,
    /// Whether hits of a line are close together, so that it is not for their distance to order them.
    pub(crate) close: [bool; LINES],
}

impl Default for AllScratch {
    fn default() -> Self {
        Self {
            lines: Vec::new(),
            nodes: Queue::default(),
            leaves: Queue::default(),
            candidates: Candidates::default(),
            distances: Vec::new(),
            places: Vec::new(),
            starts: [0; LINES + 3],
            hits: Vec::new(),
            close: [false; LINES],
        }
    }
}

impl AllScratch {
    /// The hits found, line by line, in order of distance.
    pub(crate) fn hits(&self) -> &[Hit] {
        &self.hits[..self.starts[LINES] as usize]
    }
}

/// Finds all hits of the (infinite) lines.
#[inline(always)]
pub(crate) fn all<K: Kit>(grid: &Grid, tree: &Tree, lines: &[Line], scratch: &mut AllScratch) {
    let AllScratch { lines: traced, nodes, leaves, candidates, .. } = scratch;
    traced.clear();
    let (mut waiting, mut reached) = (0, 0);
    let root = &tree.nodes[0];
    let leaf = K::highest_bits(&root.children);
    for (line, number) in lines.iter().zip(0u8..) {
        // Lines that pass far from the scene meet nothing.
        let line = grid.line(line).unwrap_or(GridLine::far());
        let boxes = ShortLine::new(&line);
        traced.push((line, boxes));
        let [near, far] = slabs::<K>(root, &boxes);
        let met = near.at_most(far);
        waiting = nodes.add::<K>(waiting, &root.children, met & !leaf, number);
        reached = leaves.add::<K>(reached, &root.children, met & leaf, number);
    }
    let mut next = 0;
    while next < waiting {
        tree.prefetch::<K>(nodes.ahead(next));
        let (node, line) = (&tree.nodes[nodes.items[next] as usize], nodes.lines[next]);
        next += 1;
        let [near, far] = slabs::<K>(node, &traced[usize::from(line)].1);
        let met = near.at_most(far);
        let leaf = K::highest_bits(&node.children);
        waiting = nodes.add::<K>(waiting, &node.children, met & !leaf, line);
        reached = leaves.add::<K>(reached, &node.children, met & leaf, line);
    }
    let mut count = 0;
    for i in 0..reached {
        tree.prefetch::<K>(leaves.ahead(i));
        let (number, line) = ((leaves.items[i] & !LEAF) as usize, leaves.lines[i]);
        let mask = tree.leaves[number].candidates::<K>(&traced[usize::from(line)].1, None);
        count = candidates.found.add_numbers::<K>(count, tree.firsts[number], mask, line);
    }
    candidates.prefetch::<K>(count, tree);
    candidates.cross::<K>(count, tree, traced);
    arrange::<K>(grid, tree, count, scratch);
}

/// Turns crossings into hits, and puts them in order.
#[inline(always)]
fn arrange<K: Kit>(grid: &Grid, tree: &Tree, count: usize, scratch: &mut AllScratch) {
    let AllScratch { lines, candidates, distances, places, starts, hits, close, .. } = scratch;
    // By line, by counting: while hits are added, each start moves to where the next line starts. What is not crossed is put
    // behind all lines.
    starts.fill(0);
    candidates.found.lines[..count].iter().for_each(|&line| starts[usize::from(line) + 2] += 1);
    for line in 2..starts.len() {
        starts[line] += starts[line - 1];
    }
    close.fill(false);
    let nothing =
        Hit { t: 0.0, triangle: TriangleId(0), point: Barycentric { v: 0.0, w: 0.0 }, side: Side::Back };
    if hits.len() < count {
        hits.resize(count, nothing);
        places.resize(count, 0);
        distances.resize(count + TRIANGLES, 0.0);
    }
    candidates.locate(count);
    let candidates = &*candidates;
    let of_lines = &candidates.found.lines[..count];
    let t = &candidates.factors[3][..count];
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
        let mine = K::Crossings::splat(t[i]);
        let (mut rank, mut first, mut near) = (0, start, 0);
        while first < end {
            let some = distances[first..].first_chunk().map_or(mine, K::Crossings::load);
            let of_line = u32::MAX >> (32 - (end - first).min(TRIANGLES));
            // Bits of this crossing and of those found before it, if they are among these.
            let this = 1u32.checked_shl(place.wrapping_sub(first).min(32) as u32).unwrap_or(0);
            let earlier = if place < first { 0 } else { this.wrapping_sub(1) };
            // Of equal ones, the one found first comes first.
            let (before, not_after) = (some.below(mine), some.at_most(mine));
            rank += ((before | (not_after & earlier)) & of_line).count_ones() as usize;
            near |= not_after & mine.at_most(some.plus(K::Crossings::splat(CLOSE))) & of_line & !this;
            first += TRIANGLES;
        }
        close[line] |= near != 0;
        hits[start + rank] = candidates.crossing(i, tree).hit(grid, grid_line);
    }
}

/// Distance \[steps of the grid\] within which hits are close together.
const CLOSE: f64 = 1.001 * hit::CONTACT * RADIUS;

/// Rays that are searched at the same time for their closest crossing.
pub(crate) const RAYS: usize = 64;

/// A ray under way.
#[derive(Clone, Debug)]
struct Flight<R> {
    span: Span,
    /// The place of a triangle that is not met.
    leaving: u32,
    /// How many children wait.
    waiting: usize,
    ray: R,
}

/// Scratch memory of the search for closest crossings.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClosestScratch {
    /// Where the children are entered that wait, per ray.
    entries: Vec<f32>,
    children: Vec<u32>,
    lines: Vec<(GridLine, ShortLine)>,
    candidates: Candidates,
}

/// What a search for closest crossings is about.
pub(crate) trait Rays {
    /// A ray under way.
    type Ray;
    /// The next ray to be searched, the part of its line where crossings matter, and the place of a triangle that is not met;
    /// ends the search with `None`.
    fn next(&mut self) -> Option<(Self::Ray, GridLine, Span, u32)>;
    /// A crossing of a ray; gives the end of the part where further ones matter.
    fn cross(&mut self, ray: &mut Self::Ray, line: &GridLine, crossing: Crossing) -> f32;
    /// All crossings of a ray that matter were found.
    fn done(&mut self, ray: Self::Ray, line: &GridLine);
}

/// Numbers of flights.
#[derive(Clone, Copy)]
struct Flights {
    numbers: [u8; RAYS],
    count: usize,
}

impl Flights {
    const NONE: Self = Self { numbers: [0; RAYS], count: 0 };

    /// Adds a flight if it is one of these.
    #[inline(always)]
    fn add(&mut self, number: u8, belongs: bool) {
        self.numbers[self.count % RAYS] = number;
        self.count += usize::from(belongs);
    }

    fn iter(&self) -> impl Iterator<Item = u8> {
        self.numbers.into_iter().take(self.count)
    }
}

/// What the flights go on with.
struct Agenda {
    nodes: Flights,
    leaves: Flights,
    ended: Flights,
}

impl Agenda {
    const EMPTY: Self = Self { nodes: Flights::NONE, leaves: Flights::NONE, ended: Flights::NONE };

    /// Notes what a flight goes on with: the last of its children.
    #[inline(always)]
    fn note<K: Kit>(&mut self, number: u8, waiting: usize, children: &[u32], tree: &Tree) {
        let next = children[waiting.wrapping_sub(1).min(children.len() - 1)];
        let (ended, leaf) = (waiting == 0, next & LEAF != 0);
        tree.prefetch::<K>(next);
        self.nodes.add(number, !ended & !leaf);
        self.leaves.add(number, !ended & leaf);
        self.ended.add(number, ended);
    }
}

/// Finds the crossings of rays about in order.
#[inline(always)]
pub(crate) fn closest<K: Kit, R: Rays>(tree: &Tree, scratch: &mut ClosestScratch, rays: &mut R) {
    // Room for all children of a node beside those that wait.
    let stride = tree.most_waiting + BOXES;
    let ClosestScratch { entries, children, lines, candidates } = scratch;
    entries.resize(RAYS * stride, 0.0);
    children.resize(RAYS * stride, 0);
    lines.clear();
    let mut flights: Vec<Flight<R::Ray>> = Vec::with_capacity(RAYS);
    let mut agenda = Agenda::EMPTY;
    for number in 0..RAYS as u8 {
        let Some((ray, line, span, leaving)) = rays.next() else { break };
        lines.push((line, ShortLine::new(&line)));
        flights.push(Flight { span, leaving, waiting: 1, ray });
        children[usize::from(number) * stride] = 0;
        agenda.nodes.add(number, true);
    }
    loop {
        let Agenda { nodes, leaves, ended } = std::mem::replace(&mut agenda, Agenda::EMPTY);
        if nodes.count + leaves.count + ended.count == 0 {
            break;
        }
        K::apart(|| {
            for number in nodes.iter() {
                let i = usize::from(number);
                let flight = &mut flights[i];
                let children = &mut children[i * stride..(i + 1) * stride];
                let entries = &mut entries[i * stride..(i + 1) * stride];
                let top = flight.waiting - 1;
                let node = &tree.nodes[children[top] as usize];
                let [near, far] = slabs::<K>(node, &lines[i].1);
                let from = K::Boxes::splat(flight.span.from);
                let to = K::Boxes::splat(flight.span.to);
                let met = near.max(from).at_most(far.min(to));
                let near = near.max(K::Boxes::splat(0.0));
                let Ok(to_entries) = (&mut entries[top..top + BOXES]).try_into() else { continue };
                let Ok(to_children) = (&mut children[top..top + BOXES]).try_into() else { continue };
                K::sort(near, &node.children, met, to_entries, to_children);
                flight.waiting = top + met.count_ones() as usize;
                agenda.note::<K>(number, flight.waiting, children, tree);
            }
        });
        let count = K::apart(|| {
            let mut count = 0;
            for number in leaves.iter() {
                let i = usize::from(number);
                let Flight { span, leaving, waiting, .. } = &mut flights[i];
                *waiting -= 1;
                let leaf = (children[i * stride + *waiting] & !LEAF) as usize;
                let first = tree.firsts[leaf];
                let left = (1u64 << leaving.wrapping_sub(first).min(63)) as u32;
                let mask = tree.leaves[leaf].candidates::<K>(&lines[i].1, Some(*span)) & !left;
                count = candidates.found.add_numbers::<K>(count, first, mask, number);
            }
            candidates.prefetch::<K>(count, tree);
            count
        });
        for number in ended.iter() {
            let i = usize::from(number);
            if let Some((ray, line, span, leaving)) = rays.next() {
                let flight = &mut flights[i];
                rays.done(std::mem::replace(&mut flight.ray, ray), &lines[i].0);
                (flight.span, flight.leaving, flight.waiting) = (span, leaving, 1);
                lines[i] = (line, ShortLine::new(&line));
                children[i * stride] = 0;
                agenda.nodes.add(number, true);
            }
        }
        K::apart(|| candidates.cross::<K>(count, tree, lines));
        candidates.locate(count);
        for k in 0..count {
            let number = candidates.found.lines[k];
            if number != NONE {
                let i = usize::from(number);
                let Flight { span, ray, waiting, .. } = &mut flights[i];
                let crossing = candidates.crossing(k, tree);
                let to = rays.cross(ray, &lines[i].0, crossing);
                if to < span.to {
                    span.to = to;
                    let children = &mut children[i * stride..(i + 1) * stride];
                    let entries = &mut entries[i * stride..(i + 1) * stride];
                    *waiting = keep::<K>(to, *waiting, entries, children);
                }
            }
        }
        for number in leaves.iter() {
            let i = usize::from(number);
            agenda.note::<K>(number, flights[i].waiting, &children[i * stride..(i + 1) * stride], tree);
        }
    }
    for (flight, (line, _)) in flights.into_iter().zip(&*lines) {
        rays.done(flight.ray, line);
    }
}

/// Keeps the first `waiting` children that are entered before the limit; gives their number.
#[inline(always)]
fn keep<K: Kit>(limit: f32, waiting: usize, entries: &mut [f32], children: &mut [u32]) -> usize {
    let mut kept = 0;
    for start in (0..waiting).step_by(BOXES) {
        let (Some(some_entries), Some(some_children)) =
            (entries[start..].first_chunk::<BOXES>(), children[start..].first_chunk::<BOXES>())
        else {
            return waiting;
        };
        let some_entries = K::Boxes::load(some_entries);
        let some_children = *some_children;
        let there = u32::MAX >> (32 - (waiting - start).min(BOXES));
        let mask = some_entries.at_most(K::Boxes::splat(limit)) & there;
        if let Some(to) = entries[kept..].first_chunk_mut() {
            some_entries.compress(mask, to);
        }
        if let Some(to) = children[kept..].first_chunk_mut() {
            K::compress(&some_children, mask, to);
        }
        kept += mask.count_ones() as usize;
    }
    kept
}
