//! Triangles of mesh primitives.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use ::gltf::json::accessor::{ComponentType, Type};
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use glam::{DAffine3, DVec3};

use super::super::MAX_ELEMENTS;
use super::{LoadError, Reader};
use crate::VertexId;

/// Vertices of one instance of a mesh by their position accessor, which primitives often share.
pub(super) type Shared = HashMap<usize, Vec<VertexId>>;

impl Reader<'_> {
    /// Adds a primitive in world space. `shared` has the vertices that other primitives of this mesh instance
    /// brought; `what` names the primitive.
    pub(super) fn primitive(
        &mut self,
        primitive: &Primitive,
        to_world: &DAffine3,
        shared: &mut Shared,
        what: &str,
    ) -> Result<(), LoadError> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(self.invalid(format!("{what}: unknown mode")));
        };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            self.notes.count("mesh primitives of points or lines were skipped", 1);
            return Ok(());
        }
        if primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
            self.notes.count("mesh primitives have morph targets, and are read in their basic shape", 1);
        }
        if primitive.attributes.keys().any(|k| matches!(k, Checked::Valid(Semantic::Colors(_)))) {
            self.notes.count("mesh primitives have vertex colours, which were ignored", 1);
        }
        let Some(vertices) = self.vertices_of(primitive, to_world, shared, what)? else {
            self.notes.count("mesh primitives without positions were skipped", 1);
            return Ok(());
        };
        let corners = self.corners(primitive, vertices.len(), what)?;
        let triangles = Triangles { mode, corners: corners.len() };
        self.triangles += triangles.count();
        self.check_size("triangles", self.triangles)?;
        let material = self.material(primitive.material)?;
        // A mirror image turns fronts into backs unless the order of the corners is turned, too.
        let mirrored = to_world.matrix3.determinant() < 0.0;
        for i in 0..triangles.count() {
            let mut triangle = triangles.get(i).map(|c| vertices[corners[c]]);
            if mirrored {
                triangle.swap(1, 2);
            }
            self.builder.add_polygon(&triangle, material);
        }
        Ok(())
    }

    /// The vertices of a primitive, which are added to `shared` if they are not there yet.
    fn vertices_of<'s>(
        &mut self,
        primitive: &Primitive,
        to_world: &DAffine3,
        shared: &'s mut Shared,
        what: &str,
    ) -> Result<Option<&'s [VertexId]>, LoadError> {
        use ComponentType::{F32, I8, I16, U8, U16};
        let Some(&accessor) = primitive.attributes.get(&Checked::Valid(Semantic::Positions)) else {
            return Ok(None);
        };
        let vacant = match shared.entry(accessor.value()) {
            Entry::Occupied(known) => return Ok(Some(known.into_mut())),
            Entry::Vacant(vacant) => vacant,
        };
        // Whole numbers are those of KHR_mesh_quantization.
        let positions = self.elements::<3>(accessor, Type::Vec3, &[F32, I8, U8, I16, U16], what)?;
        self.vertices += positions.len();
        self.check_size("vertices", self.vertices)?;
        let add = |p| self.builder.add_vertex(to_world.transform_point3(DVec3::from_array(p)));
        Ok(Some(vacant.insert(positions.into_iter().map(add).collect())))
    }

    /// Numbers of the vertices of a primitive in the order of its corners.
    fn corners(&self, primitive: &Primitive, vertices: usize, what: &str) -> Result<Vec<usize>, LoadError> {
        use ComponentType::{U8, U16, U32};
        let Some(accessor) = primitive.indices else {
            return Ok((0..vertices).collect());
        };
        let indices = self.elements::<1>(accessor, Type::Scalar, &[U8, U16, U32], what)?;
        let corners: Vec<usize> = indices.into_iter().map(|[i]| i as usize).collect();
        match corners.iter().find(|&&i| i >= vertices) {
            Some(i) => Err(self.invalid(format!("{what}: index {i} is beyond its {vertices} vertices"))),
            None => Ok(corners),
        }
    }

    pub(super) fn check_size(&self, what: &'static str, count: usize) -> Result<(), LoadError> {
        if count > MAX_ELEMENTS {
            return Err(LoadError::TooLarge { path: self.path.to_owned(), what, limit: MAX_ELEMENTS });
        }
        Ok(())
    }
}

/// The triangles of a list of corners.
struct Triangles {
    mode: Mode,
    corners: usize,
}

impl Triangles {
    fn count(&self) -> usize {
        match self.mode {
            Mode::Triangles => self.corners / 3,
            _ => self.corners.saturating_sub(2),
        }
    }

    /// Corners of triangle `i`, counter-clockwise seen from its front (glTF 2.0 specification, section 3.7.2.1).
    fn get(&self, i: usize) -> [usize; 3] {
        match self.mode {
            Mode::TriangleStrip => [i, i + 1 + i % 2, i + 2 - i % 2],
            Mode::TriangleFan => [i + 1, i + 2, 0],
            _ => [3 * i, 3 * i + 1, 3 * i + 2],
        }
    }
}
