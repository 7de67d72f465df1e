//! Results are bit-identical for any number of ranks, threads and restarts.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod balance;
mod jobs;
mod measuring;
mod observers;
mod ranks;
mod refusals;
mod resume;
mod same_bits;
mod saving;
mod view_factors;
