//! A place for a lamp in a scene that has none: in free space below a ceiling.

use glam::DVec3;
use sir_accel::{Accel, Hit, Ray};
use sir_geom::{Line, Scene, Side};

use crate::info::shape::Extent;

/// Vertical lines across each side of the room.
const LINES: usize = 9;

/// Height of the lamp, as a share of the free height.
const HEIGHT: f64 = 0.9;

/// Largest edges of the lamp, as a share of the width of the room there, and of the free distance to each side.
const OF_ROOM: f64 = 0.25;
const OF_FREE: f64 = 0.3;

/// Weight of places with a side above or below that does not reflect, as in solid walls.
const UNLIKELY: f64 = 0.2;

/// A rectangle in free space that faces down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LampPlace {
    /// One of its corners \[m\].
    pub corner: DVec3,
    /// Vectors to the adjacent corners \[m\], whose cross product points down.
    pub edges: [DVec3; 2],
    /// Area of the floor around it, up to the walls \[m²\].
    pub floor: f64,
}

impl LampPlace {
    /// Returns a place high in free space of a room, as close to its middle as the heights of the spaces suggest.
    pub(crate) fn find(scene: &Scene, accel: &Accel, up: DVec3, room: Extent) -> Self {
        let size = room.size();
        let east = if up.x.abs() < 0.9 { DVec3::X.reject_from(up) } else { DVec3::Z.reject_from(up) };
        let east = east.normalize_or(DVec3::X);
        // Their cross product points down.
        let axes = [east, east.cross(up)];
        let [wide, deep] = axes.map(|axis| axis.abs().dot(size));
        let top = room.center() + 0.5 * up.abs().dot(size) * up;
        let offset = |i: usize| (i as f64 + 0.5) / LINES as f64 - 0.5;
        let offsets = (0..LINES * LINES).map(|i| [offset(i / LINES), offset(i % LINES)]);
        let mut spaces = Vec::new();
        let mut tracer = accel.tracer();
        for [a, b] in offsets {
            let line = Line { origin: top + a * wide * axes[0] + b * deep * axes[1], direction: -up };
            let weight = 1.0 - a.abs().max(b.abs());
            tracer.all_hits_each(&[line], |found| {
                for pair in found.hits().windows(2) {
                    let height = pair[1].t - pair[0].t;
                    let place = line.origin + (pair[0].t + (1.0 - HEIGHT) * height) * line.direction;
                    spaces.push((weight * likelihood(scene, &pair[0], &pair[1]) * height, place));
                }
            });
        }
        let best = spaces.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let center = best.map_or(top + (HEIGHT - 1.0) * up.abs().dot(size) * up, |(_, place)| place);
        let mut free = |direction: DVec3, width: f64| {
            let ray = Ray::from(Line { origin: center, direction });
            tracer.closest(&ray).map_or(width, |hit| hit.t.min(width))
        };
        let widths = [(axes[0], wide), (axes[1], deep)]
            .map(|(axis, width)| (axis, [free(axis, width), free(-axis, width)]));
        let edges = widths.map(|(axis, [a, b])| (OF_ROOM * (a + b)).min(2.0 * OF_FREE * a.min(b)) * axis);
        let floor = widths.map(|(_, [a, b])| a + b).iter().product();
        Self { corner: center - 0.5 * (edges[0] + edges[1]), edges, floor }
    }
}

/// Returns the weight of the space between two hits of a line that points down.
fn likelihood(scene: &Scene, above: &Hit, below: &Hit) -> f64 {
    let ceiling = match above.side {
        Side::Front => Side::Back,
        Side::Back => Side::Front,
    };
    let reflect = scene.is_active(above.triangle, ceiling) && scene.is_active(below.triangle, below.side);
    if reflect { 1.0 } else { UNLIKELY }
}
