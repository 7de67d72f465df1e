//! Contour lines of values on a grid, by marching squares (Lorensen and Cline 1987, in two dimensions).

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use crate::map::ticks::{multiples, number, step};

/// Ratio of the largest to the smallest value from which levels are spaced by factors.
const WIDE: f64 = 10.0;

/// Ratio of the largest value to the lowest level, at most.
const DEEPEST: f64 = 200.0;

/// Number of steps into which a narrow range is divided, at most.
const STEPS: f64 = 7.0;

/// An edge between neighboring nodes: column and row of its first node, and whether it leads upward.
type Edge = (usize, usize, bool);

/// Returns the levels between two values with their texts: 1, 2 and 5 times powers of ten if the values differ by a factor
/// of ten or more, otherwise multiples of such a number, at most seven.
pub(super) fn levels(least: f64, most: f64) -> Vec<(f64, String)> {
    if !(least < most && most.is_finite() && least.is_finite()) {
        return Vec::new();
    }
    let is_between = |level: &f64| least < *level && *level < most;
    if least < 0.0 || most < WIDE * least {
        let step = step((most - least) / STEPS);
        let all = multiples(step, least, most).filter(is_between);
        return all.map(|level| (level, number(level, step))).collect();
    }
    let lowest = least.max(most / DEEPEST);
    let first = lowest.log10().floor() as i32;
    let powers = (first..first + 4).map(|exponent| 10f64.powi(exponent));
    let all = powers.flat_map(|power| [1.0, 2.0, 5.0].map(|factor| factor * power));
    let all = all.filter(|level| *level >= lowest).filter(is_between);
    all.map(|level| (level, number(level, level))).collect()
}

/// Returns the lines along which values at the centers of cells, interpolated between them, have a level. The values are row
/// by row from the bottom. The coordinates of the lines are in cells from the lower left corner; those of a closed line
/// begin and end at the same point. Up to the edges of the grid the values are those of the cells along it, and next to
/// cells without a value there are no lines.
pub(super) fn contours(values: &[Option<f64>], columns: usize, level: f64) -> Vec<Vec<DVec2>> {
    let rows = values.len().div_ceil(columns.max(1));
    let nodes = Nodes { values, columns, rows };
    let mut neighbors: BTreeMap<Edge, Vec<Edge>> = BTreeMap::new();
    let mut connect = |a: Edge, b: Edge| {
        neighbors.entry(a).or_default().push(b);
        neighbors.entry(b).or_default().push(a);
    };
    for j in 0..=rows {
        for i in 0..=columns {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| nodes.value(i, j));
            let [Some(a), Some(b), Some(c), Some(d)] = corners else { continue };
            let [bottom, right, top, left] =
                [(i, j, false), (i + 1, j, true), (i, j + 1, false), (i, j, true)];
            let is_above = [a, b, c, d].map(|value| value >= level);
            // Edges whose ends are on different sides of the level.
            let sides = [(bottom, 0), (right, 1), (top, 2), (left, 3)];
            let crossed: Vec<Edge> =
                sides.iter().filter(|(_, k)| is_above[*k] != is_above[(k + 1) % 4]).map(|s| s.0).collect();
            match crossed[..] {
                [p, q] => connect(p, q),
                [_, _, _, _] => {
                    // A saddle: the mean decides which two corners are connected.
                    let pairs = if (0.25 * (a + b + c + d) >= level) == is_above[0] {
                        [(bottom, right), (top, left)]
                    } else {
                        [(left, bottom), (right, top)]
                    };
                    pairs.into_iter().for_each(|(p, q)| connect(p, q));
                }
                _ => {}
            }
        }
    }
    let lines = chains(&neighbors).into_iter();
    lines.map(|line| line.into_iter().map(|edge| nodes.crossing(edge, level)).collect()).collect()
}

/// Joins edges that are neighbors to lines: first those with ends, then closed ones.
fn chains(neighbors: &BTreeMap<Edge, Vec<Edge>>) -> Vec<Vec<Edge>> {
    let mut visited = BTreeSet::new();
    let mut all = Vec::new();
    let ends = neighbors.iter().filter(|(_, others)| others.len() == 1);
    for (start, _) in ends.chain(neighbors) {
        if !visited.insert(*start) {
            continue;
        }
        let mut chain = vec![*start];
        let mut last = *start;
        while let Some(&next) = neighbors[&last].iter().find(|next| !visited.contains(*next)) {
            visited.insert(next);
            chain.push(next);
            last = next;
        }
        if chain.len() > 2 && neighbors[&last].contains(start) {
            chain.push(*start);
        }
        all.push(chain);
    }
    all
}

/// Values at the centers of cells, and the same once more at the edges of the grid.
struct Nodes<'v> {
    values: &'v [Option<f64>],
    columns: usize,
    rows: usize,
}

impl Nodes<'_> {
    /// Returns the value of a node. The first and the last of a row or column are at the edges of the grid.
    fn value(&self, i: usize, j: usize) -> Option<f64> {
        let cell = |k: usize, n: usize| k.clamp(1, n.max(1)) - 1;
        let value = self.values.get(cell(j, self.rows) * self.columns + cell(i, self.columns)).copied();
        value.flatten().filter(|value| value.is_finite())
    }

    fn place(&self, i: usize, j: usize) -> DVec2 {
        let along = |k: usize, n: usize| (k as f64 - 0.5).clamp(0.0, n as f64);
        DVec2::new(along(i, self.columns), along(j, self.rows))
    }

    /// Returns the point of an edge at which the value is that of the level.
    fn crossing(&self, (i, j, is_upward): Edge, level: f64) -> DVec2 {
        let (k, l) = if is_upward { (i, j + 1) } else { (i + 1, j) };
        let (from, to) = (self.place(i, j), self.place(k, l));
        let (Some(a), Some(b)) = (self.value(i, j), self.value(k, l)) else { return from };
        from.lerp(to, ((level - a) / (b - a)).clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_round_and_between_the_values() {
        let texts = |least, most| {
            let texts: Vec<_> = levels(least, most).into_iter().map(|(_, text)| text).collect();
            texts.join(" ")
        };
        assert_eq!(texts(150.0, 620.0), "200 300 400 500 600");
        assert_eq!(texts(1.7, 2.9), "1.8 2.0 2.2 2.4 2.6 2.8");
        assert_eq!(texts(3.0, 620.0), "5 10 20 50 100 200 500");
        assert_eq!(texts(0.0, 0.76), "0.005 0.01 0.02 0.05 0.1 0.2 0.5");
        assert_eq!(texts(0.5, 0.5), "");
        assert_eq!(texts(f64::INFINITY, f64::NEG_INFINITY), "");
        assert!(texts(-1.0, 1.0).contains("0.0"));
    }

    #[test]
    fn the_contour_of_a_slope_is_a_straight_line_from_edge_to_edge() {
        // The value is the number of the column and half of the row.
        let values: Vec<_> = (0..12).map(|k| Some((k % 4) as f64 + 0.5 * (k / 4) as f64)).collect();
        let [line] = &contours(&values, 4, 1.75)[..] else { panic!("one line") };
        let inner = line.iter().filter(|p| p.y > 0.5 && p.y < 2.5);
        for p in inner {
            assert!((p.x - 0.5 + 0.5 * (p.y - 0.5) - 1.75).abs() < 1e-12, "{p}");
        }
        let heights = [line[0].y, line[line.len() - 1].y];
        assert_eq!((heights[0].min(heights[1]), heights[0].max(heights[1])), (0.0, 3.0));
    }

    #[test]
    fn a_hill_has_closed_contours() {
        let side = 21;
        let hill = |k: usize| {
            let (x, y) = ((k % side) as f64 - 10.0, (k / side) as f64 - 10.0);
            Some(100.0 - x * x - y * y)
        };
        let values: Vec<_> = (0..side * side).map(hill).collect();
        let [circle] = &contours(&values, side, 51.0)[..] else { panic!("one line") };
        assert_eq!(circle.first(), circle.last());
        for p in circle {
            assert!(((*p - DVec2::splat(10.5)).length() - 7.0).abs() < 0.05, "{p}");
        }
    }

    #[test]
    fn strange_grids_have_no_contours_or_few() {
        assert!(contours(&[], 0, 1.0).is_empty());
        assert!(contours(&[Some(1.0)], 1, 1.0).is_empty());
        assert!(contours(&[Some(0.0), None, Some(f64::NAN), Some(2.0)], 2, 1.0).is_empty());
        // A saddle has two lines.
        assert_eq!(contours(&[Some(0.0), Some(2.0), Some(2.0), Some(0.0)], 2, 1.0).len(), 2);
    }
}
