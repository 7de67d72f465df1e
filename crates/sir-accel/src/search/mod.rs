//! Searches of the tree for the triangles that many lines cross.
//!
//! A line visits few nodes, but each visit may wait for memory. So many lines are searched at the same time, each by
//! one step at a time, and memory is prefetched as soon as it is known to be needed.

pub(crate) mod all_hits;
mod candidates;
pub(crate) mod first_hit;
mod pairs;
pub(crate) mod queue;
