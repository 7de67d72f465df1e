//! Surfaces: what is cut into cells, or joined to patches, whatever its triangles.

mod adjacency;
mod bent;
mod beside;
mod flat;
mod overlap;

pub(crate) use adjacency::Adjacency;
pub(crate) use bent::join;
pub(crate) use beside::Surfaces;
pub(crate) use flat::FlatSurface;
