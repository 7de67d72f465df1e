//! Searches in ranges find the hits of the whole line that lie in the range. The scenes are degenerate: triangles on a
//! coarse lattice, most of which touch, intersect or lie on others.

use glam::DVec3;
use proptest::prelude::*;
use sir_types::{Barycentric, Line, TriangleId};

use crate::accel::Accel;
use crate::hit::Hit;
use crate::options::Options;
use crate::ray::{Ray, TRange};
use crate::tests::{bits, tracers};

/// A mesh, contact priorities, and which triangles are half transparent.
#[derive(Clone, Debug)]
struct Mesh {
    positions: Vec<DVec3>,
    indices: Vec<[u32; 3]>,
    priorities: Vec<u32>,
    is_transparent: Vec<bool>,
}

fn lattice_point() -> impl Strategy<Value = DVec3> {
    [-2i8..=2, -2i8..=2, -1i8..=1].prop_map(|p| DVec3::from_array(p.map(f64::from)))
}

fn any_point() -> impl Strategy<Value = DVec3> {
    prop_oneof![lattice_point(), [-3.0..3.0, -3.0..3.0, -3.0..3.0].prop_map(DVec3::from_array)]
}

fn mesh() -> impl Strategy<Value = Mesh> {
    prop::collection::vec(lattice_point(), 3..24).prop_flat_map(|positions| {
        let count = positions.len() as u32;
        let triangle = ([0..count, 0..count, 0..count], 0u32..4, any::<bool>());
        prop::collection::vec(triangle, 0..60).prop_map(move |triangles| Mesh {
            positions: positions.clone(),
            indices: triangles.iter().map(|t| t.0).collect(),
            priorities: triangles.iter().map(|t| t.1).collect(),
            is_transparent: triangles.iter().map(|t| t.2).collect(),
        })
    })
}

impl Mesh {
    fn arrange(&self) -> Accel {
        let half = |_: TriangleId, _: Barycentric| 0.5;
        let priorities = self.priorities.clone();
        let options = Options::default()
            .contact_priorities(move |ids| ids.iter().map(|id| priorities[id.index()]).collect())
            .opacity(self.is_transparent.clone(), half);
        Accel::build(&self.positions, &self.indices, options).unwrap()
    }
}

/// An end of a range: anywhere, at infinity, or exactly at a hit.
#[derive(Clone, Debug)]
enum End {
    At(f64),
    OfHit(prop::sample::Index),
}

fn end() -> impl Strategy<Value = End> {
    prop_oneof![
        (-6.0..12.0f64).prop_map(End::At),
        prop::sample::select(vec![f64::NEG_INFINITY, 0.0, f64::INFINITY, f64::NAN]).prop_map(End::At),
        any::<prop::sample::Index>().prop_map(End::OfHit),
    ]
}

impl End {
    fn of(&self, hits: &[Hit]) -> f64 {
        match self {
            Self::At(t) => *t,
            Self::OfHit(index) if !hits.is_empty() => index.get(hits).t,
            Self::OfHit(_) => 0.0,
        }
    }
}

/// Larger than the distance within which surfaces are in contact in these scenes.
const NEAR: f64 = 1e-5;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn a_range_filters_the_hits_of_a_line(
        mesh in mesh(),
        lines in prop::collection::vec((any_point(), any_point(), end(), end(), -4.0..4.0f64), 1..40),
    ) {
        let accel = mesh.arrange();
        for mut tracer in tracers(&accel) {
            for (from, to, start, end, ahead) in &lines {
                let Some(direction) = (to - from).try_normalize() else { continue };
                let line = Line { origin: from + *ahead * direction, direction };
                let all = tracer.all_hits(&line).to_vec();
                let range = TRange { start: start.of(&all), end: end.of(&all) };
                let expected: Vec<Hit> = all.iter().copied().filter(|hit| range.contains(hit.t)).collect();
                let found: Vec<_> = tracer.all_hits_within(&line, range).iter().map(|&hit| bits(hit)).collect();
                prop_assert_eq!(found, expected.iter().map(|&hit| bits(hit)).collect::<Vec<_>>());
                let ray = Ray::new(line).within(range);
                prop_assert_eq!(tracer.occluded(&ray), !expected.is_empty());
                check_first(&accel, tracer.closest(&ray), &expected)?;
                // Rays that leave the surface of each hit.
                for hit in &all {
                    let origin = line.at(hit.t);
                    let ray = Ray::leaving(Line { origin, direction }, hit.triangle);
                    let (first, length) = (tracer.closest(&ray), range.start.abs());
                    prop_assert_eq!(tracer.occluded(&ray), first.is_some());
                    let before = tracer.closest(&ray.within(0.0..length));
                    prop_assert_eq!(tracer.occluded(&ray.within(0.0..length)), before.is_some());
                    // Of surfaces in contact with the one that the ray leaves, distances decide nothing.
                    let is_in_contact = |other: &Hit| accel.are_in_contact(other.triangle, hit.triangle);
                    // Hits in contact may lie on both sides of the end.
                    if first.is_none_or(|first| (first.t - length).abs() > NEAR && !is_in_contact(&first)) {
                        prop_assert_eq!(before, first.filter(|first| first.t < length));
                    }
                    let on_line = tracer.all_hits(&ray.line).to_vec();
                    if length > NEAR && !on_line.iter().any(|hit| hit.t >= length && is_in_contact(hit)) {
                        let expected: Vec<Hit> = on_line
                            .into_iter()
                            .filter(|other| other.t >= length && other.triangle != hit.triangle)
                            .collect();
                        let after = tracer.closest(&ray.within(length..));
                        prop_assert_eq!(tracer.occluded(&ray.within(length..)), after.is_some());
                        check_first(&accel, after, &expected)?;
                    }
                }
            }
        }
    }
}

/// Checks the first hit against those expected. If others are close to it or in contact with it, the contact order chooses
/// one of them: a line in the plane of such surfaces meets them at quite different distances. The search for the closest hit
/// applies the order only to hits in the range.
fn check_first(accel: &Accel, found: Option<Hit>, expected: &[Hit]) -> Result<(), TestCaseError> {
    let nearest = expected.iter().min_by(|a, b| a.t.total_cmp(&b.t));
    let may_be_first = |hit: &&Hit| {
        nearest.is_some_and(|nearest| {
            hit.t <= nearest.t + NEAR || accel.are_in_contact(hit.triangle, nearest.triangle)
        })
    };
    let candidates: Vec<_> = expected.iter().filter(may_be_first).map(|&hit| Some(bits(hit))).collect();
    let found = found.map(bits);
    prop_assert!(candidates.contains(&found) || candidates.is_empty() && found.is_none(), "{:?}", found);
    Ok(())
}
