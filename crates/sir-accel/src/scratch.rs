//! Scratch memory of tracers.

use std::sync::Mutex;

use crate::search::all_hits::AllHitsScratch;
use crate::search::first_hit::FirstHitScratch;

/// Scratch memory of a tracer.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) first_hit: FirstHitScratch,
    pub(crate) all_hits: AllHitsScratch,
}

/// Scratch memory that no tracer uses. A thread that makes a tracer for each of its tasks gets the same memory again.
#[derive(Debug, Default)]
pub(crate) struct ScratchPool(Mutex<Vec<Scratch>>);

impl ScratchPool {
    /// Returns memory that a tracer has put back, or new memory.
    pub(crate) fn take(&self) -> Scratch {
        self.0.lock().ok().and_then(|mut pool| pool.pop()).unwrap_or_default()
    }

    /// Puts the memory of a tracer back.
    pub(crate) fn put(&self, scratch: Scratch) {
        if let Ok(mut pool) = self.0.lock() {
            pool.push(scratch);
        }
    }
}

/// A copy starts without memory.
impl Clone for ScratchPool {
    fn clone(&self) -> Self {
        Self::default()
    }
}
