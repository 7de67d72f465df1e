//! Statistics of random lines in a scene: they show whether it is closed, and which sides of its surfaces face each
//! other.
//!
//! The random numbers are the same every time.

use serde::Serialize;
use sir_accel::{Accel, Hit, Ray};
use sir_geom::{Barycentric, Line, Scene, Side, TriangleId};
use sir_lines::{Allocation, Domain, Purpose, Streams, cosine_direction, point_on_triangle};
use sir_radiosity::{Emitter, Source};

/// Number of lines of each kind, unless each of them crosses very many triangles.
const LINES: u64 = 100_000;

/// Number of lines whose crossings are counted first.
const PILOT: u64 = 1 << 10;

/// Number of crossings by lines from surfaces above which fewer lines of each kind are traced.
const CROSSINGS: u64 = 4_000_000;

/// Number of lines that are traced together.
const BLOCK: u64 = 1 << 12;

/// Statistics of all random lines.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Lines {
    /// Number of lines of each kind.
    pub lines_of_each_kind: u64,
    /// Uniform global lines.
    pub global: Global,
    /// Lines from the fronts of all surfaces.
    pub from_fronts: Fates,
    /// Lines from the backs of all surfaces, including those that only absorb.
    pub from_backs: Fates,
    /// Lines from emitting surfaces; `None` if there are none.
    pub from_emitters: Option<Fates>,
    /// Light after its first reflection: lines from the points where lines from emitting surfaces hit a reflecting
    /// side, or where lines from fronts did if nothing emits. `None` if there are no such points.
    pub reflected: Option<Fates>,
}

/// Crossings of uniform lines through the convex hull.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Global {
    /// Number of lines that cross something.
    pub met: u64,
    /// Share of these lines that cross an odd number of triangles; zero if all surfaces are closed.
    pub odd: f64,
    /// Share of segments (between neighboring crossings) with a front at one end and a back at the other; zero if the
    /// winding of closed surfaces is consistent.
    pub mixed: f64,
    /// Share of crossings after which the next one is of a triangle in contact that has other corners.
    pub coincident: f64,
}

/// First hits of diffuse lines from surfaces, as shares that add up to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fates {
    /// Share that hits a front.
    pub front: f64,
    /// Share that hits a back that reflects.
    pub back: f64,
    /// Share that hits the back of a one-sided surface, which absorbs.
    pub absorbed: f64,
    /// Share that hits nothing and leaves the scene.
    pub escaped: f64,
}

/// Returns the number of lines of each kind that a scene allows: fewer if lines from surfaces cross very many triangles,
/// as the time of a line is in proportion to its crossings.
pub(super) fn affordable(scene: &Scene, accel: &Accel) -> u64 {
    let sides: Vec<_> = scene.triangle_ids().map(|id| (id, Side::Front, scene.area(id))).collect();
    let streams = Streams::new(1, Purpose::PROBE);
    let rays = starts(&sides, PILOT, 1).into_iter().zip(0..);
    let lines: Vec<Line> = rays.map(|(start, i)| start.ray(scene, streams.line(i).point()).line).collect();
    let mut crossings = 0;
    accel.tracer().all_hits_each(&lines, |found| crossings += found.hits().len() as u64);
    (CROSSINGS * PILOT / crossings.max(1)).clamp(BLOCK, LINES)
}

/// Traces a number of lines of each kind.
pub(super) fn trace(scene: &Scene, accel: &Accel, sources: &[Source], lines: u64) -> Lines {
    let from = |side: Side, kind| {
        let sides: Vec<_> = scene.triangle_ids().map(|id| (id, side, scene.area(id))).collect();
        local(scene, accel, &starts(&sides, lines, kind), kind)
    };
    let (from_fronts, mut arrived) = from(Side::Front, 1);
    let (from_backs, _) = from(Side::Back, 2);
    let emitters: Vec<_> = sources.iter().filter_map(emitting_side).collect();
    let from_emitters = (!emitters.is_empty()).then(|| {
        let (fates, lit) = local(scene, accel, &starts(&emitters, lines, 3), 3);
        arrived = lit;
        fates
    });
    let reflected = (!arrived.is_empty()).then(|| local(scene, accel, &arrived, 4).0);
    Lines {
        lines_of_each_kind: lines,
        global: global(scene, accel, lines),
        from_fronts,
        from_backs,
        from_emitters,
        reflected,
    }
}

fn emitting_side(source: &Source) -> Option<(TriangleId, Side, f64)> {
    match source.emitter {
        Emitter::Surface { triangle, side, .. } => Some((triangle, side, source.power.element_sum())),
        _ => None,
    }
}

fn global(scene: &Scene, accel: &Accel, lines: u64) -> Global {
    let (domain, streams) = (Domain::hull(scene.vertices()), Streams::new(0, Purpose::PROBE));
    let (mut met, mut odd, mut segments, mut mixed, mut crossings, mut coincident) = (0, 0, 0, 0, 0, 0);
    let mut tracer = accel.tracer();
    for first in (0..lines).step_by(BLOCK as usize) {
        let block = first..lines.min(first + BLOCK);
        let drawn: Vec<Line> = block.map(|i| domain.line(streams.line(i).point())).collect();
        tracer.all_hits_each(&drawn, |found| {
            for range in found.lines() {
                let hits = &found.hits()[range];
                met += u64::from(!hits.is_empty());
                odd += u64::from(hits.len() % 2 == 1);
                crossings += hits.len() as u64;
                for pair in hits.windows(2) {
                    segments += 1;
                    // A line that hits a front leaves through the back, and the next hit names the side that faces that
                    // back.
                    mixed += u64::from(pair[0].side == pair[1].side);
                    coincident += u64::from(coincide(scene, accel, pair));
                }
            }
        });
    }
    Global {
        met,
        odd: share(odd, met),
        mixed: share(mixed, segments),
        coincident: share(coincident, crossings),
    }
}

/// Returns true if two triangles are in contact and do not have the same corners.
fn coincide(scene: &Scene, accel: &Accel, hits: &[Hit]) -> bool {
    let corners = |hit: &Hit| {
        let mut corners = scene.triangle(hit.triangle).vertices;
        corners.sort_unstable();
        corners
    };
    let [a, b] = [&hits[0], &hits[1]];
    accel.are_in_contact(a.triangle, b.triangle) && corners(a) != corners(b)
}

/// Origin of a diffuse line: a point on a side.
#[derive(Clone, Copy)]
struct Start {
    triangle: TriangleId,
    side: Side,
    point: Barycentric,
}

impl Start {
    /// Returns a diffuse ray. `point` is uniform in the unit square.
    fn ray(&self, scene: &Scene, point: [f64; 2]) -> Ray {
        let normal = match self.side {
            Side::Front => scene.normal(self.triangle),
            Side::Back => -scene.normal(self.triangle),
        };
        let origin = self.point.point(scene.corners(self.triangle));
        Ray::leaving(Line { origin, direction: cosine_direction(normal, point) }, self.triangle)
    }
}

/// Returns random points on sides, distributed in proportion to the weights. `kind` is the number of the kind of lines.
fn starts(sides: &[(TriangleId, Side, f64)], lines: u64, kind: u64) -> Vec<Start> {
    let weights: Vec<f64> = sides.iter().map(|side| side.2).collect();
    let allocation = Allocation::new(&weights, lines, 0.5);
    // A stream different from that of the directions.
    let streams = Streams::new(kind + 10, Purpose::PROBE);
    let owners = allocation.owners(0).zip(0..lines);
    owners
        .map(|(owner, i)| {
            let (triangle, side, _) = sides[owner];
            Start { triangle, side, point: point_on_triangle(streams.line(i).point()) }
        })
        .collect()
}

/// Traces a diffuse line from each start. Returns the shares of first hits, and the points hit on reflecting sides.
fn local(scene: &Scene, accel: &Accel, starts: &[Start], kind: u64) -> (Fates, Vec<Start>) {
    let streams = Streams::new(kind, Purpose::PROBE);
    let [mut front, mut back, mut absorbed, mut escaped] = [0; 4];
    let mut arrived = Vec::with_capacity(starts.len());
    let mut tracer = accel.tracer();
    let mut numbers = 0..;
    for block in starts.chunks(BLOCK as usize) {
        let rays = block.iter().zip(&mut numbers).map(|(start, i)| start.ray(scene, streams.line(i).point()));
        let rays: Vec<Ray> = rays.collect();
        // Hits arrive in any order, but the lines that start at them must be the same every time.
        let mut hits = vec![None; rays.len()];
        tracer.closest_each(&rays, |i, hit| hits[i] = hit);
        for hit in hits {
            match hit {
                None => escaped += 1,
                Some(hit) if !scene.is_active(hit.triangle, hit.side) => absorbed += 1,
                Some(Hit { triangle, side, point, .. }) => {
                    *(if side == Side::Front { &mut front } else { &mut back }) += 1;
                    arrived.push(Start { triangle, side, point });
                }
            }
        }
    }
    let [front, back, absorbed, escaped] =
        [front, back, absorbed, escaped].map(|n| share(n, starts.len() as u64));
    (Fates { front, back, absorbed, escaped }, arrived)
}

fn share(part: u64, whole: u64) -> f64 {
    part as f64 / whole.max(1) as f64
}
