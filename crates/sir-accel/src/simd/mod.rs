//! SIMD backends: one trait, thin implementations, and the choice between them at run time.
//!
//! The searches of this crate are written once, for any [`SimdBackend`](backend::SimdBackend), and compiled for each
//! backend. All backends find the same hits, bit for bit: boxes and triangles are only culled in single precision, with
//! a margin for rounding, and triangles are intersected with the basic operations of double precision, which are
//! rounded identically everywhere.
//!
//! A backend is a *token*: a zero-sized value that exists only if the processor has the instructions, because its only
//! constructor queries the processor. Vectors are made from a token, so they exist only then, too. All operations take
//! a token or a vector, which makes them safe to call.

#[cfg(target_arch = "x86_64")]
pub(crate) mod avx2;
#[cfg(target_arch = "x86_64")]
pub(crate) mod avx512;
pub(crate) mod backend;
pub(crate) mod dispatch;
mod insertion;
pub(crate) mod portable;
pub(crate) mod prefetch;
#[cfg(target_arch = "x86_64")]
mod x86;
