//! Positions and triangles of mesh primitives.

use ::gltf::json::Index;
use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::mesh::{Mode, Primitive};
use ::gltf::json::validation::Checked;

use crate::load::error::LoadError;
use crate::load::gltf::data::Data;

impl Data<'_> {
    /// Returns true if a primitive has triangles, not points or lines. `what` names it in error messages, here and below.
    pub(super) fn has_triangles(&self, primitive: &Primitive, what: &str) -> Result<bool, LoadError> {
        match primitive.mode {
            Checked::Valid(mode) => {
                Ok(matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan))
            }
            Checked::Invalid => Err(self.invalid(format!("{what}: unknown mode"))),
        }
    }

    /// Returns positions in the space of their mesh.
    pub(super) fn positions(
        &self,
        accessor: Index<Accessor>,
        what: &str,
    ) -> Result<Vec<[f64; 3]>, LoadError> {
        use ComponentType::{F32, I8, I16, U8, U16};
        // `KHR_mesh_quantization` adds integers.
        self.elements::<3>(accessor, Type::Vec3, &[F32, I8, U8, I16, U16], what)
    }

    /// Returns the triangles of a primitive with this number of vertices: vertex numbers, counterclockwise seen from the
    /// front (glTF 2.0 specification, section 3.7.2.1).
    pub(super) fn triangles(
        &self,
        primitive: &Primitive,
        vertices: usize,
        what: &str,
    ) -> Result<Vec<[u32; 3]>, LoadError> {
        let corners = self.corners(primitive, vertices, what)?;
        let triangle = |corners: [usize; 3], at: &[u32]| corners.map(|i| at[i]);
        Ok(match primitive.mode {
            Checked::Valid(Mode::TriangleStrip) => {
                let of = |(i, at): (usize, &[u32])| triangle([0, 1 + i % 2, 2 - i % 2], at);
                corners.windows(3).enumerate().map(of).collect()
            }
            Checked::Valid(Mode::TriangleFan) => {
                let first = |at: &[u32]| [at[0], at[1], corners[0]];
                corners.get(1..).unwrap_or_default().windows(2).map(first).collect()
            }
            _ => corners.chunks_exact(3).map(|at| triangle([0, 1, 2], at)).collect(),
        })
    }

    /// Returns the vertex numbers of a primitive in the order of its corners.
    fn corners(&self, primitive: &Primitive, vertices: usize, what: &str) -> Result<Vec<u32>, LoadError> {
        use ComponentType::{U8, U16, U32};
        let Some(accessor) = primitive.indices else {
            return Ok((0..vertices as u32).collect());
        };
        let indices = self.elements::<1>(accessor, Type::Scalar, &[U8, U16, U32], what)?;
        let corners: Vec<u32> = indices.into_iter().map(|[i]| i as u32).collect();
        match corners.iter().find(|&&i| i as usize >= vertices) {
            Some(i) => Err(self.invalid(format!("{what}: index {i} is beyond its {vertices} vertices"))),
            None => Ok(corners),
        }
    }
}
