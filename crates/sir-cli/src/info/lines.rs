//! What random lines tell about a scene: whether it is closed, and which sides of its surfaces face each other.
//!
//! The lines are the same every time.

use serde::Serialize;
use sir_accel::{Accel, Hit, Ray};
use sir_geom::{Line, Scene, Side, Sides, TriangleId};
use sir_lines::{Allocation, Domain, Stage, Streams, cosine_direction, point_on_triangle};
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
}

/// What uniform lines through the convex hull cross.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Global {
    /// Lines that cross something.
    pub met: u64,
    /// Of these, the share that crosses an odd number of triangles: zero if all surfaces are closed.
    pub odd: f64,
    /// Of the stretches between neighbouring crossings, the share with a front at one end and a back at the other: zero if the
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
pub(super) fn trace(scene: &Scene, sources: &[Source]) -> Lines {
    let accel = Accel::new(scene);
    let side = |side| scene.triangle_ids().map(|id| (id, side, scene.area(id))).collect::<Vec<_>>();
    let emitters: Vec<_> = sources.iter().filter_map(emitting_side).collect();
    Lines {
        lines_of_each_kind: LINES,
        global: global(scene, &accel),
        from_fronts: local(scene, &accel, &side(Side::Front), 1),
        from_backs: local(scene, &accel, &side(Side::Back), 2),
        from_emitters: (!emitters.is_empty()).then(|| local(scene, &accel, &emitters, 3)),
    }
}

fn emitting_side(source: &Source) -> Option<(TriangleId, Side, f64)> {
    match source.emitter {
        Emitter::Surface { triangle, side, .. } => Some((triangle, side, source.power.element_sum())),
        _ => None,
    }
}

fn global(scene: &Scene, accel: &Accel) -> Global {
    let (domain, streams) = (Domain::hull(scene), Streams::new(0, Stage::PROBE));
    let contact = CONTACT * scene.bounding_sphere().radius;
    let (mut met, mut odd, mut stretches, mut mixed, mut crossings, mut coincident) = (0, 0, 0, 0, 0, 0);
    let mut tracer = accel.tracer();
    for first in (0..LINES).step_by(BLOCK as usize) {
        let block = first..LINES.min(first + BLOCK);
        let lines: Vec<Line> = block.map(|i| domain.sample(&mut streams.line(i))).collect();
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

/// Traces diffuse lines from sides, in proportion to their weights. `kind` numbers the kinds of lines.
fn local(scene: &Scene, accel: &Accel, sides: &[(TriangleId, Side, f64)], kind: u64) -> Fates {
    let streams = Streams::new(kind, Stage::PROBE);
    let weights: Vec<f64> = sides.iter().map(|side| side.2).collect();
    let allocation = Allocation::new(&weights, LINES, 0.5);
    let mut owners = allocation.owners(0).zip(0..LINES);
    let [mut front, mut back, mut absorbed, mut escaped] = [0; 4];
    let mut tracer = accel.tracer();
    loop {
        let block = owners.by_ref().take(BLOCK as usize);
        let rays: Vec<Ray> = block
            .map(|(owner, i)| {
                let (triangle, side, _) = sides[owner];
                let stream = &mut streams.line(i);
                let origin = point_on_triangle(stream).point(scene.corners(triangle));
                let normal = match side {
                    Side::Front => scene.normal(triangle),
                    Side::Back => -scene.normal(triangle),
                };
                let line = Line { origin, direction: cosine_direction(normal, stream) };
                Ray { line, leaving: Some(triangle) }
            })
            .collect();
        if rays.is_empty() {
            break;
        }
        tracer.closest_each(&rays, |_, hit| match hit {
            None => escaped += 1,
            Some(hit) if hit.side == Side::Front => front += 1,
            Some(hit) if scene.material(hit.triangle).sides == Sides::Both => back += 1,
            Some(_) => absorbed += 1,
        });
    }
    let [front, back, absorbed, escaped] = [front, back, absorbed, escaped].map(|n| share(n, LINES));
    Fates { front, back, absorbed, escaped }
}

fn share(part: u64, whole: u64) -> f64 {
    part as f64 / whole.max(1) as f64
}
