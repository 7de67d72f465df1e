//! Tracing lines.

use sir_geom::{Line, Side, TriangleId};

use crate::grid::{GridLine, RADIUS};
use crate::hit::{self, Hit};
use crate::tree::{BoxLine, Child, WIDTH};
use crate::triangle::{Crossing, GridTriangle};
use crate::{Accel, grid::Grid};

/// Traces lines through a scene. Holds scratch memory, so it belongs to one thread.
#[derive(Clone, Debug)]
pub struct Tracer<'a> {
    accel: &'a Accel,
    stack: Vec<(Child, f32)>,
    found: Vec<Found>,
    hits: Vec<Hit>,
}

/// A crossing and the place of its triangle in the tree's list.
#[derive(Clone, Copy, Debug)]
struct Found {
    crossing: Crossing,
    id: TriangleId,
    place: u32,
}

impl<'a> Tracer<'a> {
    pub(crate) fn new(accel: &'a Accel) -> Self {
        Self { accel, stack: Vec::with_capacity(256), found: Vec::new(), hits: Vec::new() }
    }

    /// The first triangle that a ray meets.
    ///
    /// A ray that leaves a surface names its triangle in `leaving`: that triangle is not met again, and among
    /// surfaces in contact with it only those are met that lie on top of the side which the ray leaves.
    pub fn closest(&mut self, ray: &Line, leaving: Option<TriangleId>) -> Option<Hit> {
        let line = self.accel.grid.line(ray)?;
        let start = leaving.map(|id| Start::new(self.accel, id, &line));
        let mut best: Option<Found> = None;
        let mut limit = f32::INFINITY;
        let boxes = BoxLine::new(&line);
        let slack = (2.0 * hit::CONTACT) as f32;
        self.stack.clear();
        self.stack.push((Child::default(), 0.0));
        while let Some((child, entry)) = self.stack.pop() {
            if entry > limit {
                continue;
            }
            if child.count == 0 {
                let node = &self.accel.tree.nodes[child.first as usize];
                let enter = node.enter(&boxes, -slack, limit);
                push_far_to_near(&mut self.stack, &enter, |lane| node.child(lane));
                continue;
            }
            for place in child.first..child.first + child.count {
                let triangle = &self.accel.tree.triangles[place as usize];
                let Some(crossing) = triangle.cross(&line) else { continue };
                let candidate = Found { crossing, id: triangle.id, place };
                let begins = match &start {
                    Some(s) => s.is_before(&candidate, &line, self.accel),
                    None => crossing.t + line.start >= 0.0,
                };
                if begins && best.is_none_or(|b| precedes(&candidate, &b, self.accel)) {
                    best = Some(candidate);
                    limit = (crossing.t / RADIUS) as f32 + slack;
                }
            }
        }
        best.map(|f| f.hit(&self.accel.grid, &line))
    }

    /// All triangles that the infinite line crosses, in order along it, those behind its origin included.
    pub fn all_hits(&mut self, line: &Line) -> &[Hit] {
        self.hits.clear();
        let Some(line) = self.accel.grid.line(line) else { return &self.hits };
        self.found.clear();
        let boxes = BoxLine::new(&line);
        self.stack.clear();
        self.stack.push((Child::default(), 0.0));
        while let Some((child, _)) = self.stack.pop() {
            if child.count == 0 {
                let node = &self.accel.tree.nodes[child.first as usize];
                let enter = node.enter(&boxes, f32::NEG_INFINITY, f32::INFINITY);
                for (lane, t) in enter.iter().enumerate() {
                    if *t < f32::INFINITY {
                        self.stack.push((node.child(lane), 0.0));
                    }
                }
                continue;
            }
            for place in child.first..child.first + child.count {
                let triangle = &self.accel.tree.triangles[place as usize];
                if let Some(crossing) = triangle.cross(&line) {
                    self.found.push(Found { crossing, id: triangle.id, place });
                }
            }
        }
        self.sort();
        self.hits.extend(self.found.iter().map(|f| f.hit(&self.accel.grid, &line)));
        &self.hits
    }

    /// Sorts what was found along the line: by distance, then hits in contact by their rule.
    fn sort(&mut self) {
        self.found.sort_unstable_by(|a, b| a.crossing.t.total_cmp(&b.crossing.t).then(a.id.cmp(&b.id)));
        for i in 1..self.found.len() {
            for j in (1..=i).rev() {
                let (first, second) = (self.found[j - 1], self.found[j]);
                if !in_contact(&first, &second, self.accel) || contact_order(&first, &second) {
                    break;
                }
                self.found.swap(j - 1, j);
            }
        }
    }
}

impl Found {
    fn hit(&self, grid: &Grid, line: &GridLine) -> Hit {
        let Crossing { t, point, side } = self.crossing;
        Hit { t: grid.length(t + line.start), triangle: self.id, point, side }
    }

    fn triangle<'a>(&self, accel: &'a Accel) -> &'a GridTriangle {
        &accel.tree.triangles[self.place as usize]
    }
}

/// The surface that a ray leaves.
struct Start<'a> {
    triangle: &'a GridTriangle,
    /// The side that the ray does not leave: it would face the origin if the line were followed from behind.
    side: Side,
}

impl<'a> Start<'a> {
    fn new(accel: &'a Accel, id: TriangleId, line: &GridLine) -> Self {
        let triangle = accel.tree.triangle(id);
        let side = if triangle.scaled_normal().dot(line.direction) > 0.0 { Side::Back } else { Side::Front };
        Self { triangle, side }
    }

    /// Whether a crossing lies ahead of the start.
    fn is_before(&self, other: &Found, line: &GridLine, accel: &Accel) -> bool {
        if other.id == self.triangle.id {
            return false;
        }
        let t = other.crossing.t;
        let near = t.abs() <= hit::CONTACT * RADIUS;
        if near && parallel(self.triangle, other.triangle(accel)) {
            // A line that does not cross the start itself left it on an edge, and this is its neighbour there.
            self.triangle.cross(line).is_some()
                && hit::contact_order((self.triangle.id, self.side), (other.id, other.crossing.side))
        } else {
            t > 0.0
        }
    }
}

/// Whether two triangles are parallel: the squared sine of their angle is small.
fn parallel(a: &GridTriangle, b: &GridTriangle) -> bool {
    let (a, b) = (a.scaled_normal(), b.scaled_normal());
    a.cross(b).length_squared() <= hit::PARALLEL * a.length_squared() * b.length_squared()
}

/// Whether two crossings are of surfaces in contact.
#[inline]
fn in_contact(a: &Found, b: &Found, accel: &Accel) -> bool {
    (a.crossing.t - b.crossing.t).abs() <= hit::CONTACT * RADIUS
        && parallel(a.triangle(accel), b.triangle(accel))
}

fn contact_order(a: &Found, b: &Found) -> bool {
    hit::contact_order((a.id, a.crossing.side), (b.id, b.crossing.side))
}

/// Whether `a` comes before `b` along the line.
fn precedes(a: &Found, b: &Found, accel: &Accel) -> bool {
    if in_contact(a, b, accel) { contact_order(a, b) } else { (a.crossing.t, a.id) < (b.crossing.t, b.id) }
}

/// Pushes the children that are entered so that the nearest is popped first.
#[inline]
fn push_far_to_near(stack: &mut Vec<(Child, f32)>, enter: &[f32; WIDTH], child: impl Fn(usize) -> Child) {
    let base = stack.len();
    for (lane, &t) in enter.iter().enumerate() {
        if t < f32::INFINITY {
            stack.push((child(lane), t));
            let mut i = stack.len() - 1;
            while i > base && stack[i - 1].1 < t {
                stack.swap(i - 1, i);
                i -= 1;
            }
        }
    }
}
