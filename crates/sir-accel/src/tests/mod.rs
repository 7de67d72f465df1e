//! Tests of all backends that the processor has.

#[path = "../../tests/common/mod.rs"]
mod common;

mod backends;
mod ranges;

use sir_types::{Side, TriangleId};

use crate::accel::Accel;
use crate::hit::Hit;
use crate::simd::dispatch::Backend;
use crate::simd::portable::Portable;
use crate::tracer::Tracer;

/// A hit, comparable bit for bit.
fn bits(hit: Hit) -> (TriangleId, bool, [u64; 3]) {
    (hit.triangle, hit.side == Side::Front, [hit.t, hit.point.v, hit.point.w].map(f64::to_bits))
}

/// Tracers with all backends that this processor has; the last one is the portable one.
fn tracers(accel: &Accel) -> Vec<Tracer<'_>> {
    let backends: Vec<Backend> = Backend::available().collect();
    assert_eq!(backends.last(), Some(&Backend::Portable(Portable)));
    backends.into_iter().map(|backend| Tracer::new(accel, backend)).collect()
}
