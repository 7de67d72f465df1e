//! The cells of a flat surface as patches.

use sir_geom::{Scene, TriangleId};

use crate::lattice::{Cut, Frame, Placement, Size};
use crate::parts::Part;
use crate::surfaces::Adjacency;

/// Share of a cell below which what the surface covers of it is a fragment, which joins a neighbor.
const FRAGMENT: f64 = 0.3;

/// Largest number of passes in which fragments join neighbors.
const MAX_PASSES: usize = 8;

/// Mark of an entry of a table that is not a patch: the rest is the number of a [`Split`].
pub(crate) const SPLIT: u32 = 1 << 31;

/// Patches of the triangles in a cell in which the surface has several parts that do not continue each other, sorted by
/// triangle.
pub(crate) type Split = Vec<(TriangleId, u32)>;

/// Patches of a flat surface: the cells of a lattice, cut by the outline of the surface and by what stands on it. Fragments
/// have joined the neighbor with which they share the longest border.
pub(crate) struct Cells {
    pub(crate) placements: Vec<(TriangleId, Placement)>,
    /// Parts with the number of their patch, sorted by it.
    pub(crate) parts: Vec<(u32, Part)>,
    /// Number of the patch of each cell, or [`SPLIT`] and the number of a split. Cells that the surface does not meet have
    /// that of a cell near by, so that rounding cannot put a point on none. Empty if the cells are the patches.
    pub(crate) table: Vec<u32>,
    pub(crate) splits: Vec<Split>,
    pub(crate) patches: u32,
}

/// Part of a triangle in a cell.
#[derive(Clone, Copy)]
struct InCell {
    part: Part,
    /// Lengths of the borders with the next column and with the next row, in widths of a cell.
    borders: [f64; 2],
    /// Number of the connected parts of a cell to which it belongs.
    group: u32,
}

impl Cells {
    /// Cuts the triangles of a flat surface.
    pub(crate) fn new(
        scene: &Scene,
        adjacency: &Adjacency,
        triangles: &[TriangleId],
        frame: &Frame,
        size: Size,
    ) -> Self {
        let place = |&t: &TriangleId| (t, Placement::new(frame, scene.corners(t)));
        let placements: Vec<(TriangleId, Placement)> = triangles.iter().map(place).collect();
        let mut parts = Vec::new();
        for &(triangle, placement) in &placements {
            let all = scene.area(triangle);
            placement.for_each_cell(size, triangle, |Cut { cell, piece, borders }| {
                let part = Part { triangle, cell, end: all * piece.share() };
                parts.push(InCell { part, borders, group: 0 });
            });
        }
        parts.sort_unstable_by_key(|p| (p.part.cell, p.part.triangle));
        let mut groups = connect(&mut parts, adjacency);
        let borders = borders(&parts, adjacency, size);
        let full = 1.0 / frame.axes[0].cross(frame.axes[1]).length();
        groups.join_fragments(&borders, FRAGMENT * full);
        let (of_group, patches) = groups.numbers();
        let (table, splits) = table(&parts, &of_group, size);
        let mut parts: Vec<(u32, Part)> =
            parts.iter().map(|p| (of_group[p.group as usize], p.part)).collect();
        parts.sort_by_key(|(patch, _)| *patch);
        let is_plain = splits.is_empty() && patches == size.cells();
        Self { placements, parts, table: if is_plain { Vec::new() } else { table }, splits, patches }
    }
}

/// Finds the parts of each cell that continue each other, and numbers them in the order of the cells.
fn connect(parts: &mut [InCell], adjacency: &Adjacency) -> Groups {
    let mut areas = Vec::new();
    for in_cell in parts.chunk_by_mut(|a, b| a.part.cell == b.part.cell) {
        let count = in_cell.len();
        // Few parts, so that a search from each is fast.
        let mut group = vec![u32::MAX; count];
        for start in 0..count {
            if group[start] != u32::MAX {
                continue;
            }
            let number = areas.len() as u32;
            let (mut area, mut open) = (0.0, vec![start]);
            group[start] = number;
            while let Some(i) = open.pop() {
                area += in_cell[i].part.end;
                for (_, other) in adjacency.of(in_cell[i].part.triangle) {
                    if let Ok(j) = in_cell.binary_search_by_key(other, |p| p.part.triangle)
                        && group[j] == u32::MAX
                    {
                        group[j] = number;
                        open.push(j);
                    }
                }
            }
            areas.push(area);
        }
        in_cell.iter_mut().zip(group).for_each(|(part, group)| part.group = group);
    }
    Groups { parents: (0..areas.len() as u32).collect(), areas }
}

/// Returns the lengths of the borders between groups of parts in neighboring cells: each with a group on one side and on the
/// other, sorted, in both orders.
fn borders(parts: &[InCell], adjacency: &Adjacency, size: Size) -> Vec<(u32, u32, f64)> {
    let find = |cell: u32, triangle: TriangleId| {
        parts.binary_search_by_key(&(cell, triangle), |p| (p.part.cell, p.part.triangle)).ok()
    };
    let mut borders = Vec::new();
    for here in parts {
        for (length, step) in here.borders.into_iter().zip([1, u32::from(size.columns)]) {
            if length <= 0.0 {
                continue;
            }
            let Part { triangle, cell, .. } = here.part;
            // An edge of the triangle may lie in the border.
            let beyond = find(cell + step, triangle)
                .or_else(|| adjacency.of(triangle).iter().find_map(|(_, other)| find(cell + step, *other)));
            if let Some(there) = beyond {
                let there = parts[there].group;
                borders.extend([(here.group, there, length), (there, here.group, length)]);
            }
        }
    }
    borders.sort_by_key(|&(a, b, _)| (a, b));
    borders.dedup_by(|next, kept| {
        let same = (next.0, next.1) == (kept.0, kept.1);
        if same {
            kept.2 += next.2;
        }
        same
    });
    borders
}

/// Disjoint sets of groups of parts (union-find), with the area of each set.
struct Groups {
    parents: Vec<u32>,
    areas: Vec<f64>,
}

impl Groups {
    fn root(&mut self, mut group: u32) -> u32 {
        while self.parents[group as usize] != group {
            self.parents[group as usize] = self.parents[self.parents[group as usize] as usize];
            group = self.parents[group as usize];
        }
        group
    }

    /// Unites sets whose area is below `least` with a neighbor.
    fn join_fragments(&mut self, borders: &[(u32, u32, f64)], least: f64) {
        let area = |groups: &Self, group: u32| groups.areas[group as usize];
        let all = 0..self.parents.len() as u32;
        let mut fragments: Vec<u32> = all.filter(|&group| area(self, group) < least).collect();
        fragments.sort_by(|&a, &b| area(self, a).total_cmp(&area(self, b)).then(a.cmp(&b)));
        for _ in 0..MAX_PASSES {
            let mut has_changed = false;
            for &group in &fragments {
                let root = self.root(group);
                if area(self, root) >= least {
                    continue;
                }
                let mut best: Option<(f64, u32)> = None;
                let start = borders.partition_point(|border| border.0 < group);
                for &(_, neighbor, length) in borders[start..].iter().take_while(|border| border.0 == group) {
                    let other = self.root(neighbor);
                    if other != root && best.is_none_or(|(most, _)| length > most) {
                        best = Some((length, other));
                    }
                }
                if let Some((_, other)) = best {
                    self.areas[other as usize] += self.areas[root as usize];
                    self.parents[root as usize] = other;
                    has_changed = true;
                }
            }
            if !has_changed {
                break;
            }
        }
    }

    /// Numbers the sets: returns the number of the set of each group, and the number of sets.
    fn numbers(&mut self) -> (Vec<u32>, u32) {
        let mut of_root = vec![u32::MAX; self.parents.len()];
        let mut count = 0;
        let numbers = (0..self.parents.len() as u32).map(|group| {
            let root = self.root(group) as usize;
            if of_root[root] == u32::MAX {
                of_root[root] = count;
                count += 1;
            }
            of_root[root]
        });
        (numbers.collect(), count)
    }
}

/// Returns the patch or the split of each cell, and the splits.
fn table(parts: &[InCell], of_group: &[u32], size: Size) -> (Vec<u32>, Vec<Split>) {
    const NONE: u32 = u32::MAX;
    let (mut table, mut splits) = (vec![NONE; size.cells() as usize], Vec::new());
    let patch = |p: &InCell| of_group[p.group as usize];
    for in_cell in parts.chunk_by(|a, b| a.part.cell == b.part.cell) {
        let first = patch(&in_cell[0]);
        table[in_cell[0].part.cell as usize] = if in_cell.iter().all(|p| patch(p) == first) {
            first
        } else {
            splits.push(in_cell.iter().map(|p| (p.part.triangle, patch(p))).collect());
            SPLIT | (splits.len() as u32 - 1)
        };
    }
    // From the covered cells outwards.
    let mut ring: Vec<u32> = (0..size.cells()).filter(|&cell| table[cell as usize] != NONE).collect();
    while !ring.is_empty() {
        let mut next = Vec::new();
        for &cell in &ring {
            for beside in neighbors(size, cell) {
                if table[beside as usize] == NONE {
                    table[beside as usize] = table[cell as usize];
                    next.push(beside);
                }
            }
        }
        ring = next;
    }
    (table, splits)
}

/// Returns the cells beside a cell.
fn neighbors(size: Size, cell: u32) -> impl Iterator<Item = u32> {
    let (columns, rows) = (u32::from(size.columns), u32::from(size.rows));
    let (column, row) = (cell % columns, cell / columns);
    let beside = [
        (column > 0).then(|| cell - 1),
        (column + 1 < columns).then_some(cell + 1),
        (row > 0).then(|| cell - columns),
        (row + 1 < rows).then_some(cell + columns),
    ];
    beside.into_iter().flatten()
}
