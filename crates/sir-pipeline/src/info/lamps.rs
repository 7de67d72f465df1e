//! Where the light of lamps ends: on which side of what, and how far away.

use std::collections::BTreeMap;

use glam::DVec3;
use sir_accel::{Accel, Ray};
use sir_geom::{Scene, TriangleId};
use sir_lines::{Allocation, Purpose, Streams};
use sir_radiosity::{Emitter, Source};

/// Number of the kind of lines, which differs from those of `lines`.
const KIND: u64 = 21;

/// Largest distance between a lamp and a parallel surface that covers it, in edges of a square of the area of the
/// emitting triangle.
const COVER: f64 = 0.02;

/// First hits of lines from lamps: emitting surfaces and point lights.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LampLight {
    /// Share of the light that ends on a parallel surface right before the lamp.
    pub covered: f64,
    /// Pair of a lamp and its cover that has the largest part of this light.
    pub cover: Option<Cover>,
    /// Share of the light that ends on the back of a one-sided surface elsewhere, which absorbs it.
    pub absorbed: f64,
    /// Share of the light that hits nothing.
    pub escaped: f64,
    /// Median distance to the first hit that is not on a cover \[m\]; `None` if there is none.
    pub reach: Option<f64>,
    /// Mean position of the lamps, weighted by power \[m\].
    pub center: DVec3,
}

/// A lamp, and the surface that covers it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cover {
    /// Description of the lamp.
    pub lamp: String,
    /// Description of the cover.
    pub by: String,
    /// Distance between the two \[m\].
    pub distance: f64,
}

/// Traces a number of lines from all lamps. Returns `None` if there are none. The random numbers are the same every
/// time.
pub(crate) fn lamp_light(scene: &Scene, accel: &Accel, sources: &[Source], lines: u64) -> Option<LampLight> {
    let is_lamp =
        |source: &&Source| matches!(source.emitter, Emitter::Surface { .. } | Emitter::Point { .. });
    let lamps: Vec<&Source> = sources.iter().filter(is_lamp).collect();
    if lamps.is_empty() {
        return None;
    }
    let weights: Vec<f64> = lamps.iter().map(|lamp| lamp.power.element_sum()).collect();
    let owners: Vec<usize> = Allocation::new(&weights, lines, 0.5).owners(0).take(lines as usize).collect();
    let streams = Streams::new(KIND, Purpose::PROBE);
    let rays: Vec<Ray> = owners
        .iter()
        .zip(0..)
        .map(|(&owner, i)| lamps[owner].emitter.ray(scene, &mut streams.line(i)))
        .collect();
    let center = rays.iter().map(|ray| ray.line.origin).sum::<DVec3>() / rays.len().max(1) as f64;
    let mut hits = vec![None; rays.len()];
    accel.tracer().closest_each(&rays, |i, hit| hits[i] = hit);
    let (mut covers, mut absorbed, mut escaped, mut distances) = (BTreeMap::new(), 0, 0, Vec::new());
    for ((&owner, ray), hit) in owners.iter().zip(&rays).zip(hits) {
        let Some(hit) = hit else {
            escaped += 1;
            continue;
        };
        match gap(scene, accel, lamps[owner], hit.triangle, hit.t, ray.line.direction) {
            Some((lamp, gap)) => {
                let pair = (scene.triangle(lamp).material.0, scene.triangle(hit.triangle).material.0);
                let (count, widest) = covers.entry(pair).or_insert((0u64, (gap, lamp, hit.triangle)));
                *count += 1;
                if gap > widest.0 {
                    *widest = (gap, lamp, hit.triangle);
                }
            }
            None => {
                absorbed += u64::from(!scene.is_active(hit.triangle, hit.side));
                distances.push(hit.t);
            }
        }
    }
    let share = |count: u64| count as f64 / rays.len().max(1) as f64;
    let covered = covers.values().map(|(count, _)| count).sum();
    let cover = covers.into_values().max_by_key(|(count, _)| *count).map(|(_, (distance, lamp, by))| Cover {
        lamp: describe(scene, lamp),
        by: describe(scene, by),
        distance,
    });
    let middle = distances.len() / 2;
    let reach = (!distances.is_empty()).then(|| *distances.select_nth_unstable_by(middle, f64::total_cmp).1);
    Some(LampLight {
        covered: share(covered),
        cover,
        absorbed: share(absorbed),
        escaped: share(escaped),
        reach,
        center,
    })
}

/// Returns the triangle of a lamp and its distance from the surface that a line hits, if that surface covers the lamp.
fn gap(
    scene: &Scene,
    accel: &Accel,
    lamp: &Source,
    hit: TriangleId,
    t: f64,
    direction: DVec3,
) -> Option<(TriangleId, f64)> {
    let Emitter::Surface { triangle, normal, .. } = lamp.emitter else { return None };
    let gap = (t * direction.dot(normal)).abs();
    let is_near = gap <= COVER * scene.area(triangle).sqrt();
    // Light passes through the gaps of a cover that is not opaque.
    let is_cover = !scene.is_transparent(hit) && scene.normal(hit).dot(normal).abs() > 0.999;
    // What emits itself is part of the lamp, unless it is a copy.
    let is_other = !scene.emits(hit) || accel.are_in_contact(triangle, hit);
    (is_near && is_cover && is_other).then_some((triangle, gap))
}

/// Returns the part and the material of a triangle, in words.
pub(crate) fn describe(scene: &Scene, id: TriangleId) -> String {
    let triangle = scene.triangle(id);
    let name = |names: &str| names.chars().take(60).collect::<String>();
    let part = scene.groups().get(triangle.group.index()).map_or("", String::as_str);
    let material = &scene.material(id).name;
    match (part, material.as_str()) {
        ("", "") => format!("triangle {}", triangle.source),
        ("", material) => format!("the material {:?}", name(material)),
        (part, "") => format!("the part {:?}", name(part)),
        (part, material) => format!("the part {:?} (material {:?})", name(part), name(material)),
    }
}
