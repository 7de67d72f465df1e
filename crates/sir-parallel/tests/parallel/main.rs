//! Any number of ranks and threads, and any number of restarts, give the same result to the last bit.
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
