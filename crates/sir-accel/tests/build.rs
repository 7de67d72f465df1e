//! Input that is accepted, and input that is rejected.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail like tests")]

use glam::DVec3;
use sir_accel::{Accel, AccelError, Barycentric, Line, Options, Ray, TriangleId};

const SQUARE: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
const HALVES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

fn refused(positions: &[DVec3], indices: &[[u32; 3]], options: Options<'_>) -> AccelError {
    Accel::build(positions, indices, options).unwrap_err()
}

#[test]
fn bad_input_is_refused() {
    let error = refused(&SQUARE, &[[0, 1, 2], [0, 4, 3]], Options::default());
    assert_eq!(error, AccelError::OutOfRange { triangle: 1, index: 4, count: 4 });
    assert_eq!(
        error.to_string(),
        "triangle 1 has the corner 4, but there are only 4 positions; corners are numbered from 0"
    );
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut positions = SQUARE;
        positions[3].y = bad;
        let error = refused(&positions, &HALVES, Options::default());
        assert_eq!(error, AccelError::NotFinite { position: 3 });
    }
    for size in [1e-160, 1e160, 1e300] {
        let error = refused(&SQUARE.map(|p| size * p), &HALVES, Options::default());
        assert!(matches!(error, AccelError::Extent { .. }), "{error}");
    }
    let twice = [HALVES[0], HALVES[0]];
    let error = refused(&SQUARE, &twice, Options::default().contact_priorities(|_| vec![1]));
    assert_eq!(error, AccelError::WrongLength { list: "contact priorities", found: 1, triangles: 2 });
    let opaque = |_: TriangleId, _: Barycentric| 1.0;
    let error = refused(&SQUARE, &HALVES, Options::default().opacity(vec![true; 3], opaque));
    assert_eq!(error, AccelError::WrongLength { list: "transparent triangles", found: 3, triangles: 2 });
}

#[test]
fn any_size_and_place_will_do() {
    for (size, place) in [(1e-120, 0.0), (1e120, 0.0), (1.0, 1e6), (1e-3, -1e3)] {
        let positions = SQUARE.map(|p| DVec3::splat(place) + size * p);
        let accel = Accel::build(&positions, &HALVES, Options::default()).unwrap();
        let origin = DVec3::splat(place) + size * DVec3::new(0.75, 0.25, 3.0);
        let hit = accel.tracer().closest(&Line { origin, direction: DVec3::NEG_Z }.into()).unwrap();
        assert_eq!(hit.triangle, TriangleId(0));
        assert!((hit.t - 3.0 * size).abs() < 1e-6 * size, "{hit:?}");
    }
}

#[test]
fn unused_positions_are_ignored() {
    let mut positions = SQUARE.to_vec();
    positions.extend([DVec3::NAN, DVec3::splat(1e300)]);
    let accel = Accel::build(&positions, &HALVES, Options::default()).unwrap();
    let reference = Accel::build(&SQUARE, &HALVES, Options::default()).unwrap();
    let line = Line { origin: DVec3::new(0.3, 0.6, 1.0), direction: DVec3::NEG_Z };
    assert_eq!(accel.tracer().all_hits(&line), reference.tracer().all_hits(&line));
}

#[test]
fn nothing_is_hit_where_nothing_has_an_area() {
    let line = Line { origin: DVec3::new(0.0, 0.0, 1.0), direction: DVec3::NEG_Z };
    let degenerate = [[0, 0, 0], [0, 1, 1], [1, 3, 1]];
    for (positions, indices) in
        [(&SQUARE[..], &degenerate[..]), (&SQUARE[..1], &degenerate[..1]), (&SQUARE[..], &[]), (&[], &[])]
    {
        let accel = Accel::build(positions, indices, Options::default()).unwrap();
        let mut tracer = accel.tracer();
        assert_eq!(tracer.closest(&line.into()), None);
        assert!(!tracer.occluded(&line.into()));
        assert!(tracer.all_hits(&line).is_empty());
    }
    // Degenerate triangles keep their numbers.
    let indices = [degenerate[1], HALVES[0], degenerate[0], HALVES[1]];
    let accel = Accel::build(&SQUARE, &indices, Options::default()).unwrap();
    let line = Line { origin: DVec3::new(0.25, 0.75, 1.0), direction: DVec3::NEG_Z };
    assert_eq!(accel.tracer().closest(&line.into()).map(|hit| hit.triangle.0), Some(3));
}

/// Lines with NaN, infinite or huge coordinates, and empty ranges.
#[test]
fn impossible_lines_and_rays_meet_nothing() {
    let accel = Accel::build(&SQUARE, &HALVES, Options::default()).unwrap();
    let mut tracer = accel.tracer();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        for line in [
            Line { origin: DVec3::new(0.5, bad, 1.0), direction: DVec3::NEG_Z },
            Line { origin: DVec3::new(0.5, 0.4, 1.0), direction: DVec3::new(0.0, 0.0, bad) },
        ] {
            assert_eq!(tracer.closest(&line.into()), None, "{line:?}");
            assert!(tracer.all_hits(&line).is_empty());
        }
    }
    let line = Line { origin: DVec3::new(0.5, 0.4, 1.0), direction: DVec3::NEG_Z };
    for range in [2.0..3.0, 2.0..0.0, f64::NAN..9.0, 0.0..f64::NAN, 0.0..0.9] {
        assert!(!tracer.occluded(&Ray::new(line).within(range.clone())), "{range:?}");
    }
    // The start of a range is included, its end is not.
    let hit = tracer.closest(&line.into()).unwrap();
    assert!(tracer.occluded(&Ray::new(line).within(hit.t..1.1)));
    assert!(!tracer.occluded(&Ray::new(line).within(0.5..hit.t)));
    // A ray that leaves a triangle that does not exist hits what is ahead of it.
    assert!(tracer.occluded(&Ray::leaving(line, TriangleId(7))));
}

/// Of two copies of a triangle, the one with the higher priority shows its front; if they are equal, the later one.
#[test]
fn priorities_order_surfaces_in_contact() {
    let indices = [HALVES[0], HALVES[0], HALVES[0]];
    let down = Line { origin: DVec3::new(0.7, 0.2, 1.0), direction: DVec3::NEG_Z };
    let up = Line { direction: DVec3::Z, ..down };
    let numbers = |options: Options<'_>, line: &Line| -> Vec<u32> {
        let accel = Accel::build(&SQUARE, &indices, options).unwrap();
        let mut tracer = accel.tracer();
        let all: Vec<u32> = tracer.all_hits(line).iter().map(|hit| hit.triangle.0).collect();
        if line.direction == DVec3::NEG_Z {
            assert_eq!(tracer.closest(&(*line).into()).map(|hit| hit.triangle.0), all.first().copied());
        }
        all
    };
    let given = |list: [u32; 3]| {
        Options::default().contact_priorities(move |ids| ids.iter().map(|id| list[id.index()]).collect())
    };
    assert_eq!(numbers(Options::default(), &down), [2, 1, 0]);
    assert_eq!(numbers(Options::default(), &up), [0, 1, 2]);
    assert_eq!(numbers(given([5, 9, 7]), &down), [1, 2, 0]);
    assert_eq!(numbers(given([5, 9, 7]), &up), [0, 2, 1]);
    assert_eq!(numbers(given([4, 4, 0]), &down), [1, 0, 2]);
}

/// The opacity of opaque triangles is not evaluated.
#[test]
fn only_transparent_triangles_ask_for_their_opacity() {
    let open = |triangle: TriangleId, _: Barycentric| {
        assert_eq!(triangle, TriangleId(1));
        0.0
    };
    let options = Options::default().opacity(vec![false, true], open);
    let accel = Accel::build(&SQUARE, &HALVES, options).unwrap();
    assert!(accel.has_transparency());
    let mut tracer = accel.tracer();
    let through = |x, y| Line { origin: DVec3::new(x, y, 1.0), direction: DVec3::NEG_Z };
    assert!(tracer.occluded(&through(0.7, 0.2).into()));
    assert!(!tracer.occluded(&through(0.2, 0.7).into()));
    assert_eq!(tracer.all_hits(&through(0.2, 0.7)), []);
    let mut crossings = 0;
    tracer.all_crossings_each(&[through(0.2, 0.7)], |found| crossings += found.hits().len());
    assert_eq!(crossings, 1);
    let none = Options::default().opacity(vec![false; 2], |_: TriangleId, _: Barycentric| 0.0);
    assert!(!Accel::build(&SQUARE, &HALVES, none).unwrap().has_transparency());
}
