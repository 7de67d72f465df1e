//! Typed indices of the parts of a scene.

use sir_types::typed_index;

typed_index!(
    /// Index of a vertex of a [`Scene`](crate::Scene).
    VertexId
);
typed_index!(
    /// Index of a material of a [`Scene`](crate::Scene).
    MaterialId
);
typed_index!(
    /// Index of a named group of faces of a [`Scene`](crate::Scene); group 0 has no name.
    GroupId
);
typed_index!(
    /// Index of a face: a polygon or a piece of curved surface as its author drew it. All triangles that it was cut
    /// into share this index.
    FaceId
);
