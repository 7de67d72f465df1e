//! Numbers of patches and their sides.

use sir_geom::typed_index;

typed_index!(
    /// A patch of a [`PatchMesh`](crate::PatchMesh).
    PatchId
);
typed_index!(
    /// One active side of a patch: the thing that holds power.
    SideId
);
