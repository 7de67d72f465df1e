//! Triangles of mesh primitives.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::rc::Rc;

use ::gltf::json::mesh::{Primitive, Semantic};
use ::gltf::json::validation::Checked;
use glam::{DAffine3, DVec3, Vec2};

use crate::index::VertexId;
use crate::load::error::LoadError;
use crate::load::gltf::corners::{Attributes, MAX_SETS, Values};
use crate::load::gltf::reader::Reader;

/// Data that the primitives of one mesh instance share, by accessor number.
#[derive(Default)]
pub(super) struct Shared {
    vertices: HashMap<usize, Rc<[VertexId]>>,
    pub(super) attributes: Attributes,
}

/// Maximum number of vertices, triangles or texture coordinates of a glTF scene. Without a limit, a small file with
/// many instances of its meshes could exhaust memory.
const MAX_ELEMENTS: usize = 1 << 26;

impl Reader<'_> {
    /// Adds a primitive in world space. `shared` has the vertices that other primitives of this mesh instance added;
    /// `what` names the primitive in error messages.
    pub(super) fn primitive(
        &mut self,
        primitive: &Primitive,
        to_world: &DAffine3,
        shared: &mut Shared,
        what: &str,
    ) -> Result<(), LoadError> {
        if !self.data.has_triangles(primitive, what)? {
            self.notes.count("mesh primitives of points or lines were skipped", 1);
            return Ok(());
        }
        if primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
            self.notes.count("mesh primitives have morph targets, which were ignored", 1);
        }
        let Some(vertices) = self.vertices_of(primitive, to_world, shared, what)? else {
            self.notes.count("mesh primitives without positions were skipped", 1);
            return Ok(());
        };
        let triangles = self.data.triangles(primitive, vertices.len(), what)?;
        self.triangles += triangles.len();
        self.check_size("triangles", self.triangles)?;
        let is_colored = primitive.attributes.contains_key(&Checked::Valid(Semantic::Colors(0)));
        let material = self.material(primitive.material, is_colored)?;
        let Values { coordinates, colors } =
            self.values(primitive, &material, vertices.len(), &mut shared.attributes, what)?;
        self.coordinates += triangles.len() * (coordinates.len() + usize::from(colors.is_some()));
        self.check_size("texture coordinates and colors", self.coordinates)?;
        // A reflection swaps fronts and backs unless the order of the corners is reversed, too.
        let mirrored = to_world.matrix3.determinant() < 0.0;
        for triangle in triangles {
            let mut triangle = triangle.map(|vertex| vertex as usize);
            if mirrored {
                triangle.swap(1, 2);
            }
            self.builder.add_polygon(&triangle.map(|v| vertices[v]), material.id);
            if !coordinates.is_empty() || colors.is_some() {
                let mut sets = [[Vec2::ZERO; 3]; MAX_SETS];
                for (set, (places, placement)) in sets.iter_mut().zip(&coordinates) {
                    *set = triangle.map(|v| placement.apply(places[v]));
                }
                let tint = colors.as_ref().map(|colors| triangle.map(|v| colors[v]));
                self.builder.set_corners(&sets[..coordinates.len().min(MAX_SETS)], tint);
            }
        }
        Ok(())
    }

    /// Returns the vertices of a primitive, which are added to `shared` on first use; `None` if it has no positions.
    fn vertices_of(
        &mut self,
        primitive: &Primitive,
        to_world: &DAffine3,
        shared: &mut Shared,
        what: &str,
    ) -> Result<Option<Rc<[VertexId]>>, LoadError> {
        let Some(&accessor) = primitive.attributes.get(&Checked::Valid(Semantic::Positions)) else {
            return Ok(None);
        };
        let vacant = match shared.vertices.entry(accessor.value()) {
            Entry::Occupied(known) => return Ok(Some(Rc::clone(known.get()))),
            Entry::Vacant(vacant) => vacant,
        };
        let positions = self.data.positions(accessor, what)?;
        self.vertices += positions.len();
        self.check_size("vertices", self.vertices)?;
        let add = |p| self.builder.add_vertex(to_world.transform_point3(DVec3::from_array(p)));
        Ok(Some(Rc::clone(vacant.insert(positions.into_iter().map(add).collect()))))
    }

    pub(super) fn check_size(&self, what: &'static str, count: usize) -> Result<(), LoadError> {
        self.check_limit(what, count, MAX_ELEMENTS)
    }

    pub(super) fn check_limit(
        &self,
        what: &'static str,
        count: usize,
        limit: usize,
    ) -> Result<(), LoadError> {
        if count > limit {
            return Err(LoadError::TooLarge { path: self.data.path.to_owned(), what, limit });
        }
        Ok(())
    }
}
