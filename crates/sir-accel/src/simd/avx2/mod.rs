//! AVX2 and FMA backend: 8 numbers in single precision, or 4 in double precision, at a time.

mod backend;
pub(crate) mod double;
pub(crate) mod integer;
pub(crate) mod single;
pub(crate) mod token;
