//! Outlines of patches that consist of several pieces.

use glam::DVec3;

use crate::display::node::Node;

/// Finds outlines. The buffers are reused.
#[derive(Default)]
pub(super) struct Outlines {
    /// Directed edges, as pairs of points.
    edges: Vec<(u32, u32)>,
}

impl Outlines {
    /// Returns the outline of polygons that lie side by side; `None` if it is not one line that meets itself nowhere.
    pub(super) fn of<'a>(&mut self, polygons: impl Iterator<Item = &'a [Node]>) -> Option<Vec<u32>> {
        self.edges.clear();
        for nodes in polygons.filter(|nodes| nodes.len() > 2) {
            let ends = nodes.iter().zip(nodes.iter().cycle().skip(1));
            self.edges.extend(ends.map(|(a, b)| (a.point, b.point)));
        }
        // What two pieces share is run along in both directions.
        self.edges.sort_unstable();
        let is_inner = |&(a, b): &(u32, u32)| self.edges.binary_search(&(b, a)).is_ok();
        let outer: Vec<(u32, u32)> = self.edges.iter().filter(|edge| !is_inner(edge)).copied().collect();
        if outer.len() < 3 || outer.windows(2).any(|next| next[0].0 == next[1].0) {
            return None;
        }
        let mut outline = Vec::with_capacity(outer.len());
        let mut at = outer[0].0;
        loop {
            outline.push(at);
            let next = outer.binary_search_by_key(&at, |edge| edge.0).ok()?;
            at = outer[next].1;
            if at == outer[0].0 {
                break;
            }
            if outline.len() == outer.len() {
                return None;
            }
        }
        (outline.len() == outer.len()).then_some(outline)
    }
}

/// True if the middle one of three points lies between the others.
pub(super) fn is_straight([a, b, c]: [DVec3; 3], tolerance: f64) -> bool {
    let along = (c - a).normalize_or_zero();
    let to = b - a;
    to.dot(along) > 0.0
        && (c - b).dot(along) > 0.0
        && to.reject_from(along).length() <= tolerance
        && along != DVec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(polygons: &[&[u32]]) -> Option<Vec<u32>> {
        let nodes: Vec<Vec<Node>> = polygons
            .iter()
            .map(|polygon| polygon.iter().map(|&point| Node { point, is_corner: true }).collect())
            .collect();
        Outlines::default().of(nodes.iter().map(Vec::as_slice))
    }

    #[test]
    fn inner_edges_vanish() {
        assert_eq!(outline(&[&[0, 1, 2], &[0, 2, 3]]).unwrap(), [0, 1, 2, 3]);
        assert_eq!(outline(&[&[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]]).unwrap(), [0, 1, 2, 3]);
    }

    #[test]
    fn an_outline_in_several_parts_is_none() {
        assert_eq!(outline(&[&[0, 1, 2], &[3, 4, 5]]), None, "apart");
        assert_eq!(outline(&[&[0, 1, 2], &[0, 3, 4]]), None, "they touch in a point");
        let ring: Vec<[u32; 4]> = (0..4).map(|i| [i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i]).collect();
        assert_eq!(outline(&ring.iter().map(|p| &p[..]).collect::<Vec<_>>()), None, "a hole");
    }

    #[test]
    fn a_point_on_a_line_is_straight() {
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        assert!(is_straight([at(0.0, 0.0), at(1.0, 1e-7), at(3.0, 0.0)], 1e-6));
        assert!(!is_straight([at(0.0, 0.0), at(1.0, 1e-5), at(3.0, 0.0)], 1e-6));
        assert!(!is_straight([at(0.0, 0.0), at(4.0, 0.0), at(3.0, 0.0)], 1e-6), "back");
        assert!(!is_straight([at(0.0, 0.0), at(4.0, 0.0), at(0.0, 0.0)], 1e-6));
    }
}
