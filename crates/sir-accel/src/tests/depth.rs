//! Trees stay shallow, whatever the triangles are. Their construction would take minutes otherwise.

use glam::DVec3;
use sir_types::Line;

use crate::accel::Accel;
use crate::options::Options;

const COUNT: u32 = 50_000;

/// Largest number of entries on the stack of a search: for a balanced tree about 15 per level.
const MAX_STACK: usize = 1_000;

#[track_caller]
fn assert_shallow(positions: &[DVec3], triangles: &[[u32; 3]]) -> Accel {
    let accel = Accel::build(positions, triangles, Options::default()).unwrap();
    let Accel { tree, .. } = &accel;
    assert!(tree.stack_size < MAX_STACK, "{}", tree.stack_size);
    accel
}

fn circle() -> Vec<DVec3> {
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(COUNT);
    (0..COUNT).map(|i| DVec3::new(angle(i).cos(), angle(i).sin(), 0.0)).collect()
}

#[test]
fn triangles_in_one_place() {
    let accel = assert_shallow(&[DVec3::ZERO, DVec3::X, DVec3::Y], &vec![[0, 1, 2]; COUNT as usize]);
    let line = Line { origin: DVec3::new(0.2, 0.3, 1.0), direction: DVec3::NEG_Z };
    assert!(accel.tracer().occluded(&line.into()));
}

#[test]
fn a_fan_of_many_triangles() {
    let fan: Vec<_> = (2..COUNT).map(|i| [0, i - 1, i]).collect();
    let accel = assert_shallow(&circle(), &fan);
    let line = Line { origin: DVec3::new(0.2, 0.3, 1.0), direction: DVec3::NEG_Z };
    assert_eq!(accel.tracer().all_hits(&line).len(), 1);
}

#[test]
fn many_triangles_around_a_point() {
    let mut positions = circle();
    positions.push(DVec3::Z);
    assert_shallow(&positions, &(0..COUNT).map(|i| [COUNT, i, (i + 1) % COUNT]).collect::<Vec<_>>());
}

/// Each triangle is a little larger than the one before, as in a stack of decals.
#[test]
fn triangles_that_grow() {
    let corners = [DVec3::X, DVec3::Y, DVec3::NEG_ONE];
    let positions: Vec<_> =
        (0..5_000).flat_map(|i| corners.map(|p| p * (1.0 + 1e-5 * f64::from(i)))).collect();
    assert_shallow(&positions, &(0..5_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect::<Vec<_>>());
}

/// A tracer takes over the memory of one that was dropped.
#[test]
fn memory_is_used_again() {
    let accel = assert_shallow(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]]);
    let line = Line { origin: DVec3::new(0.2, 0.3, 1.0), direction: DVec3::NEG_Z };
    let hits = |accel: &Accel| accel.tracer().all_hits(&line).as_ptr();
    assert_eq!(hits(&accel), hits(&accel));
}
