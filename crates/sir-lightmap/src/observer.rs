//! Progress of the work, and its end on request.

/// Step of making a lightmap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Meshes are unfolded into charts. Counts triangles.
    Unwrapping,
    /// Charts are placed on pages. The total is not known.
    Packing,
    /// Texels get their light. Counts sides of patches.
    Filling,
    /// Texels at the edges of charts are fitted to each other.
    Seams,
}

/// Observer of the work.
pub trait Observer: Sync {
    /// Receives the amount of work done and in total, if it is known. Returns false to stop.
    fn progress(&self, step: Step, done: u64, total: Option<u64>) -> bool;
}
