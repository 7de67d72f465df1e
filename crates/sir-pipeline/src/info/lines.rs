//! What random lines tell about a scene: whether it is closed, and which sides of its surfaces face each other.
//!
//! The lines are the same every time.

use serde::Serialize;
use sir_accel::{Accel, Hit, Ray};
use sir_geom::{Barycentric, Line, Scene, Side, TriangleId};
use sir_lines::{Allocation, Domain, Purpose, Streams, cosine_direction, point_on_triangle};
use sir_radiosity::{Emitter, Source};

/// Lines of each kind.
pub(super) const LINES: u64 = 100_000;

/// Lines that are traced together.
const BLOCK: u64 = 1 << 12;

/// Distance in radii of the scene within which two parallel surfaces count as coincident.
const CONTACT: f64 = 1e-6;

/// What all these lines have found.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Lines {
    /// Lines of each kind.
    pub lines_of_each_kind: u64,
    /// Lines through the whole scene.
    pub global: Global,
    /// Lines from the fronts of all surfaces.
    pub from_fronts: Fates,
    /// Lines from the backs of all surfaces, those that only absorb included.
    pub from_backs: Fates,
    /// Lines from emitting surfaces; `None` if there are none.
    pub from_emitters: Option<Fates>,
    /// Lines from where those from emitting surfaces have met a side that reflects, or else those from fronts: light after its first
    /// reflection. `None` if they met none.
    pub reflected: Option<Fates>,
}

/// What uniform lines through the convex hull cross.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Global {
    /// Lines that cross something.
    pub met: u64,
    /// Of these, the share that crosses an odd number of triangles: zero if all surfaces are closed.
    pub odd: f64,
    /// Of the stretches between neighboring crossings, the share with a front at one end and a back at the other: zero if the
    /// winding of closed surfaces is consistent.
    pub mixed: f64,
    /// Of the crossings, the share that coincides with the next one, on a parallel triangle with other corners.
    pub coincident: f64,
}

/// What diffuse lines from surfaces meet first, as shares that add up to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fates {
    /// A front.
    pub front: f64,
    /// A back that reflects.
    pub back: f64,
    /// The back of a one-sided surface, which absorbs.
    pub absorbed: f64,
    /// Nothing: they leave the scene.
    pub escaped: f64,
}

/// Traces all lines.
pub(super) fn trace(scene: &Scene, accel: &Accel, sources: &[Source]) -> Lines {
    let from = |side: Side, kind| {
        let sides: Vec<_> = scene.triangle_ids().map(|id| (id, side, scene.area(id))).collect();
        local(scene, accel, &starts(&sides, kind), kind)
    };
    let (from_fronts, mut arrived) = from(Side::Front, 1);
    let (from_backs, _) = from(Side::Back, 2);
    let emitters: Vec<_> = sources.iter().filter_map(emitting_side).collect();
    let from_emitters = (!emitters.is_empty()).then(|| {
        let (fates, lit) = local(scene, accel, &starts(&emitters, 3), 3);
        arrived = lit;
        fates
    });
    let reflected = (!arrived.is_empty()).then(|| local(scene, accel, &arrived, 4).0);
    Lines {
        lines_of_each_kind: LINES,
        global: global(scene, accel),
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

fn global(scene: &Scene, accel: &Accel) -> Global {
    let (domain, streams) = (Domain::hull(scene.vertices()), Streams::new(0, Purpose::PROBE));
    let contact = CONTACT * scene.bounding_sphere().radius;
    let (mut met, mut odd, mut stretches, mut mixed, mut crossings, mut coincident) = (0, 0, 0, 0, 0, 0);
    let mut tracer = accel.tracer();
    for first in (0..LINES).step_by(BLOCK as usize) {
        let block = first..LINES.min(first + BLOCK);
        let lines: Vec<Line> = block.map(|i| domain.line(streams.line(i).point())).collect();
        tracer.all_hits_each(&lines, |found| {
            for range in found.lines() {
                let hits = &found.hits()[range];
                met += u64::from(!hits.is_empty());
                odd += u64::from(hits.len() % 2 == 1);
                crossings += hits.len() as u64;
                for pair in hits.windows(2) {
                    stretches += 1;
                    // A line that meets a front leaves by the back, and the next hit shows the side that faces it.
                    mixed += u64::from(pair[0].side == pair[1].side);
                    coincident += u64::from(pair[1].t - pair[0].t <= contact && coincide(scene, pair));
                }
            }
        });
    }
    Global {
        met,
        odd: share(odd, met),
        mixed: share(mixed, stretches),
        coincident: share(coincident, crossings),
    }
}

/// Whether two triangles that are met in the same place lie in the same plane, and are not just twins with the same corners.
fn coincide(scene: &Scene, hits: &[Hit]) -> bool {
    let corners = |hit: &Hit| {
        let mut corners = scene.triangle(hit.triangle).vertices;
        corners.sort_unstable();
        corners
    };
    let [a, b] = [&hits[0], &hits[1]];
    let sine = scene.normal(a.triangle).cross(scene.normal(b.triangle)).length();
    sine < 1e-3 && corners(a) != corners(b)
}

/// Where a diffuse line starts: a point on a side.
#[derive(Clone, Copy)]
struct Start {
    triangle: TriangleId,
    side: Side,
    point: Barycentric,
}

/// Random points on sides, in proportion to their weights. `kind` numbers the kinds of lines.
fn starts(sides: &[(TriangleId, Side, f64)], kind: u64) -> Vec<Start> {
    let weights: Vec<f64> = sides.iter().map(|side| side.2).collect();
    let allocation = Allocation::new(&weights, LINES, 0.5);
    // Other numbers than those of the directions.
    let streams = Streams::new(kind + 10, Purpose::PROBE);
    let owners = allocation.owners(0).zip(0..LINES);
    owners
        .map(|(owner, i)| {
            let (triangle, side, _) = sides[owner];
            Start { triangle, side, point: point_on_triangle(streams.line(i).point()) }
        })
        .collect()
}

/// Traces a diffuse line from each start; returns what they met, and where they met a side that reflects.
fn local(scene: &Scene, accel: &Accel, starts: &[Start], kind: u64) -> (Fates, Vec<Start>) {
    let streams = Streams::new(kind, Purpose::PROBE);
    let [mut front, mut back, mut absorbed, mut escaped] = [0; 4];
    let mut arrived = Vec::with_capacity(starts.len());
    let mut tracer = accel.tracer();
    let mut numbers = 0..;
    for block in starts.chunks(BLOCK as usize) {
        let rays = block.iter().zip(&mut numbers).map(|(start, i)| {
            let normal = match start.side {
                Side::Front => scene.normal(start.triangle),
                Side::Back => -scene.normal(start.triangle),
            };
            let origin = start.point.point(scene.corners(start.triangle));
            let line = Line { origin, direction: cosine_direction(normal, streams.line(i).point()) };
            Ray::leaving(line, start.triangle)
        });
        let rays: Vec<Ray> = rays.collect();
        // Hits come in any order, but the lines that start at them shall be the same every time.
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
