//! Tests of all backends that the processor supports.

#[path = "../../tests/common/mod.rs"]
mod common;

mod backends;
mod depth;
mod ranges;

use sir_types::{Side, TriangleId};

use crate::accel::Accel;
use crate::hit::Hit;
use crate::simd::dispatch::Backend;
use crate::simd::portable::Portable;
use crate::tracer::Tracer;

/// Returns a hit in a form that compares bit for bit.
fn bits(hit: Hit) -> (TriangleId, bool, [u64; 3]) {
    (hit.triangle, hit.side == Side::Front, [hit.t, hit.point.v, hit.point.w].map(f64::to_bits))
}

/// Returns tracers with all backends that the processor supports; the last one is portable.
fn tracers(accel: &Accel) -> Vec<Tracer<'_>> {
    let backends: Vec<Backend> = Backend::available().collect();
    assert_eq!(backends.last(), Some(&Backend::Portable(Portable)));
    backends.into_iter().map(|backend| Tracer::new(accel, backend)).collect()
}
