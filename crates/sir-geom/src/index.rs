//! Typed indices of what a scene consists of.

use sir_types::typed_index;

typed_index!(
    /// A vertex of a [`Scene`](crate::Scene).
    VertexId
);
typed_index!(
    /// A material of a [`Scene`](crate::Scene).
    MaterialId
);
typed_index!(
    /// A named part of a [`Scene`](crate::Scene); number 0 has no name.
    GroupId
);
typed_index!(
    /// A polygon or a piece of curved surface as its author drew it: the triangles it was cut into share this number.
    FaceId
);
