//! The scene: triangles, materials, lights, a sky and cameras.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use crate::appearance::{Appearance, Corners};
use sir_types::Side;

use crate::camera::Camera;
use crate::color::Rgb;
use crate::index::{FaceId, GroupId, MaterialId, VertexId};
use crate::light::Light;
use crate::material::{Material, Sides};
use crate::sky::Sky;
use sir_types::{BoundingBox, BoundingSphere, TriangleId};

/// A triangle of a [`Scene`]. Its area is never zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle {
    /// Corners, counterclockwise seen from the front.
    pub vertices: [VertexId; 3],
    /// Material of both sides.
    pub material: MaterialId,
    /// Polygon that this triangle is a part of.
    pub face: FaceId,
    /// Group that it belongs to.
    pub group: GroupId,
    /// Index, from 0, among all triangles of the file in file order, including those that were dropped.
    pub source: u32,
    /// Location of its corner values.
    pub(crate) corners: Corners,
}

/// Consecutive triangles that come from one instance of a mesh of a glTF file.
///
/// Triangles are numbered by [`Triangle::source`]. Those of an instance are in the order of the primitives of its mesh and
/// of their triangles. If its transform is a reflection, the last two corners of each triangle are exchanged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshInstance {
    /// Number of its first triangle. It has all triangles up to the first one of the next instance.
    pub first: u32,
    /// Index of its node.
    pub node: u32,
    /// Index among the instances of the node (`EXT_mesh_gpu_instancing`), 0 without them.
    pub instance: u32,
    /// Index of its mesh.
    pub mesh: u32,
    /// Transform from the space of the mesh to that of the scene \[m\].
    pub to_world: DAffine3,
}

/// Triangles, materials, lights and cameras in world space.
///
/// Copies share the geometry. Built by a [`SceneBuilder`](crate::SceneBuilder), which guarantees: at least one triangle, finite coordinates,
/// indices in range, areas above zero, reflectances in `[0, MAX_REFLECTANCE]`, finite non-negative exitances, lights
/// with finite numbers and vectors of unit length.
#[derive(Clone, Debug)]
pub struct Scene {
    pub(crate) vertices: Arc<Vec<DVec3>>,
    pub(crate) triangles: Arc<Vec<Triangle>>,
    pub(crate) materials: Vec<Material>,
    pub(crate) cameras: Vec<Camera>,
    pub(crate) lights: Vec<Light>,
    pub(crate) sky: Option<Sky>,
    pub(crate) groups: Vec<String>,
    pub(crate) instances: Arc<Vec<MeshInstance>>,
    pub(crate) loaded: u32,
    pub(crate) appearance: Arc<Appearance>,
    /// Factors of the exitance of each material since the scene was built; empty if all are one.
    pub(crate) dimming: Vec<Rgb>,
    pub(crate) bounding_box: BoundingBox,
    pub(crate) bounding_sphere: BoundingSphere,
}

impl Scene {
    /// Returns the positions, indexed by [`VertexId`]. No two are equal.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Returns the triangles, indexed by [`TriangleId`], in file order.
    #[must_use]
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Returns the materials, indexed by [`MaterialId`].
    #[must_use]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// Returns the names of the groups, indexed by [`GroupId`]. The first one is empty and stands for triangles in no
    /// group.
    #[must_use]
    pub fn groups(&self) -> &[String] {
        &self.groups
    }

    /// Returns the instances of meshes of the glTF file from which the scene was read, in the order of their triangles. Empty
    /// for other scenes.
    #[must_use]
    pub fn mesh_instances(&self) -> &[MeshInstance] {
        &self.instances
    }

    /// Returns the instance of a mesh of a glTF file from which a triangle comes, by its index; `None` for triangles that
    /// do not come from a glTF file.
    #[must_use]
    pub fn mesh_instance_of(&self, id: TriangleId) -> Option<usize> {
        let source = self.triangle(id).source;
        let next = self.instances.partition_point(|instance| instance.first <= source);
        next.checked_sub(1).filter(|_| source < self.loaded)
    }

    /// Returns the cameras in file order.
    #[must_use]
    pub fn cameras(&self) -> &[Camera] {
        &self.cameras
    }

    /// Returns the lights without a surface, in file order.
    #[must_use]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// Returns the sky, which is seen by lines that leave the scene; without a sky, they see darkness.
    #[must_use]
    pub fn sky(&self) -> Option<&Sky> {
        self.sky.as_ref()
    }

    /// Returns the indices of all triangles in order.
    pub fn triangle_ids(&self) -> impl ExactSizeIterator<Item = TriangleId> + use<> {
        (0..self.triangles.len() as u32).map(TriangleId)
    }

    /// Returns the triangle with this index.
    #[inline]
    #[must_use]
    pub fn triangle(&self, id: TriangleId) -> &Triangle {
        &self.triangles[id.index()]
    }

    /// Returns the three corners of a triangle.
    #[inline]
    #[must_use]
    pub fn corners(&self, id: TriangleId) -> [DVec3; 3] {
        self.triangle(id).vertices.map(|v| self.vertices[v.index()])
    }

    /// Returns the material of a triangle.
    #[inline]
    #[must_use]
    pub fn material(&self, id: TriangleId) -> &Material {
        &self.materials[self.triangle(id).material.index()]
    }

    /// Returns the area of a triangle.
    #[must_use]
    pub fn area(&self, id: TriangleId) -> f64 {
        0.5 * self.scaled_normal(id).length()
    }

    /// Returns the unit normal on the front of a triangle.
    #[must_use]
    pub fn normal(&self, id: TriangleId) -> DVec3 {
        self.scaled_normal(id).normalize()
    }

    /// Returns a normal on the front of a triangle whose length is twice the area.
    fn scaled_normal(&self, id: TriangleId) -> DVec3 {
        let [a, b, c] = self.corners(id);
        (b - a).cross(c - a)
    }

    /// Returns true if the given side of a triangle reflects or emits; otherwise it only absorbs.
    #[inline]
    #[must_use]
    pub fn is_active(&self, id: TriangleId, side: Side) -> bool {
        side == Side::Front || self.material(id).sides == Sides::Both
    }

    /// Returns the emitted exitance `M` \[W/m²\] of a side of a triangle; with a texture, its mean over the image.
    #[must_use]
    pub fn exitance(&self, id: TriangleId, side: Side) -> Rgb {
        let material = self.material(id);
        match side {
            Side::Front => material.exitance,
            Side::Back if material.sides == Sides::Both && material.back_emits => material.exitance,
            Side::Back => Rgb::ZERO,
        }
    }

    /// Returns the radiance that a side of a triangle emits in a direction of unit length, away from it, relative to that of a
    /// diffuse surface with the same exitance: 1 unless its light is directional.
    #[must_use]
    pub fn relative_radiance(&self, id: TriangleId, direction: DVec3) -> f64 {
        self.material(id).beam.as_ref().map_or(1.0, |beam| beam.relative_radiance(direction))
    }

    /// Returns true if a side of a triangle emits.
    #[must_use]
    pub fn emits(&self, id: TriangleId) -> bool {
        [Side::Front, Side::Back].iter().any(|&side| self.exitance(id, side) != Rgb::ZERO)
    }

    /// Returns the sum of the areas of all triangles (one side each).
    #[must_use]
    pub fn total_area(&self) -> f64 {
        self.triangle_ids().map(|t| self.area(t)).sum()
    }

    /// Returns the smallest axis-aligned box around the triangles.
    #[must_use]
    pub fn bounding_box(&self) -> BoundingBox {
        self.bounding_box
    }

    /// Returns a sphere that strictly encloses the triangles.
    #[must_use]
    pub fn bounding_sphere(&self) -> BoundingSphere {
        self.bounding_sphere
    }
}
