//! Searches the tree for what many lines cross.
//!
//! A line visits few nodes, but has to wait for the memory of each. So many lines are searched at the same time, each a step
//! at a time, and memory is prefetched as soon as it is known that it will be needed.

pub(crate) mod all_hits;
mod candidates;
pub(crate) mod first_hit;
mod pairs;
pub(crate) mod queue;
