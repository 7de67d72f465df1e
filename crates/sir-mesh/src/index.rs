//! Numbers of patches and their sides.

use sir_geom::typed_index;

typed_index!(
    /// Number of a patch of a [`PatchMesh`](crate::PatchMesh).
    PatchId
);
typed_index!(
    /// Number of an active side of a patch, which holds and receives power.
    SideId
);
