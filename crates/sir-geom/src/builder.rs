//! Scene builder: the one place where geometry is checked.

use std::collections::HashMap;

use glam::{DAffine3, DVec3, Vec2, Vec4};

use crate::appearance::{Appearance, Corners};
use crate::camera::{Camera, Projection};
use crate::color::Rgb;
use crate::error::SceneError;
use crate::index::{FaceId, GroupId, MaterialId, VertexId};
use crate::light::{Light, LightKind};
use crate::material::{MAX_REFLECTANCE, Material};
use crate::polygon;
use crate::scene::{MeshInstance, Scene, Triangle};
use crate::sky::Sky;
use crate::split::{Corner, split};
use crate::texture::{ColorMap, Texture, TextureId};
use crate::warning::{Built, Warning};
use sir_types::{BoundingBox, BoundingSphere};

/// Builder of a [`Scene`]: collects vertices, materials, polygons, lights and cameras, and checks them.
#[derive(Clone, Debug, Default)]
pub struct SceneBuilder {
    vertices: Vec<DVec3>,
    materials: Vec<Material>,
    cameras: Vec<Camera>,
    lights: Vec<Light>,
    sky: Option<Sky>,
    triangles: Vec<Triangle>,
    faces: u32,
    /// Group numbers by name, from 1; group 0 has no name.
    groups: HashMap<String, GroupId>,
    group: u32,
    /// First corners of polygons without a valid triangulation, such as those that cross themselves.
    crossed: Vec<VertexId>,
    appearance: Appearance,
    warnings: Vec<Warning>,
    instances: Vec<MeshInstance>,
    /// Number of triangles of `instances`, once all were added.
    loaded: u32,
}

impl SceneBuilder {
    /// Creates an empty builder.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a vertex. Vertices at equal positions are merged when the scene is built.
    pub fn add_vertex(&mut self, position: DVec3) -> VertexId {
        self.vertices.push(position);
        VertexId::new(self.vertices.len() - 1)
    }

    /// Adds a material.
    pub fn add_material(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId::new(self.materials.len() - 1)
    }

    /// Adds a texture for the maps of materials.
    pub fn add_texture(&mut self, texture: Texture) -> TextureId {
        self.appearance.textures.push(texture);
        TextureId::new(self.appearance.textures.len() - 1)
    }

    /// Adds a camera.
    pub fn add_camera(&mut self, camera: Camera) {
        self.cameras.push(camera);
    }

    /// Adds a light without a surface.
    pub fn add_light(&mut self, light: Light) {
        self.lights.push(light);
    }

    /// Returns the number of lights so far, which is the index of the next one in [`Scene::lights`].
    #[must_use]
    pub fn light_count(&self) -> usize {
        self.lights.len()
    }

    /// Sets the sky, which is seen by lines that leave the scene.
    pub fn set_sky(&mut self, sky: Sky) {
        self.sky = Some(sky);
    }

    /// Adds a warning, such as one of a file reader, to those of the built scene.
    pub fn warn(&mut self, warning: Warning) {
        self.warnings.push(warning);
    }

    /// Starts a group: faces added from now on belong to the group with this name. Equal names mean the same group. An
    /// empty name means no group, as before the first call.
    pub fn begin_group(&mut self, name: &str) -> GroupId {
        let next = GroupId::new(self.groups.len() + 1);
        let group =
            if name.is_empty() { GroupId(0) } else { *self.groups.entry(name.to_owned()).or_insert(next) };
        self.group = group.0;
        group
    }

    /// Starts an instance of a mesh of a glTF file: the triangles added from now on, until the next call of this function or
    /// of [`end_meshes`](Self::end_meshes), belong to it. `indices` are those of its node, among the instances of the node,
    /// and of its mesh.
    #[cfg(feature = "gltf")]
    pub(crate) fn begin_mesh(&mut self, [node, instance, mesh]: [u32; 3], to_world: DAffine3) {
        let first = self.triangles.len() as u32;
        self.instances.push(MeshInstance { first, node, instance, mesh, to_world });
    }

    /// Ends the last instance of a mesh.
    #[cfg(any(feature = "gltf", feature = "obj"))]
    pub(crate) fn end_meshes(&mut self) {
        self.loaded = if self.instances.is_empty() { 0 } else { self.triangles.len() as u32 };
    }

    /// Adds a polygon whose corners run counterclockwise seen from its front; with fewer than three corners it adds no
    /// triangle. A convex quadrilateral is cut into the triangles `(0, 1, 2), (0, 2, 3)`, and a convex polygon of more
    /// corners is cut in halves until triangles are left. Other polygons are cut into the same number of triangles. A
    /// polygon that crosses itself, or winds in many turns and has more than 4,096 corners, is cut into the fan
    /// `(0, 1, 2), (0, 2, 3), …` with a warning.
    pub fn add_polygon(&mut self, corners: &[VertexId], material: MaterialId) -> FaceId {
        // `build` reports vertices that were not added.
        let places: Option<Vec<DVec3>> =
            corners.iter().map(|v| self.vertices.get(v.index()).copied()).collect();
        let cut = polygon::cut(&places.unwrap_or_else(|| vec![DVec3::ZERO; corners.len()]));
        self.crossed.extend(corners.first().filter(|_| !cut.is_valid));
        let triangles: Vec<_> = cut.triangles.iter().map(|t| t.map(|i| corners[i])).collect();
        self.add_face(&triangles, material)
    }

    /// Adds the triangles of one face, with corners counterclockwise seen from their fronts.
    pub fn add_face(&mut self, triangles: &[[VertexId; 3]], material: MaterialId) -> FaceId {
        let face = FaceId(self.faces);
        self.faces += 1;
        for &vertices in triangles {
            let source = self.triangles.len() as u32;
            let group = GroupId(self.group);
            let corners = Corners::PLAIN;
            self.triangles.push(Triangle { vertices, material, face, group, source, corners });
        }
        face
    }

    /// Sets the corner values of the triangle that was added last: as many sets of texture coordinates as the maps of
    /// its material use ([`Material::coordinate_sets`]), and a tint, whose color and opacity multiply those of the
    /// material. Coordinates that are not finite are ignored, and the triangle has the mean color of its texture.
    pub fn set_corners(&mut self, coordinates: &[[Vec2; 3]], tint: Option<[Vec4; 3]>) {
        if let Some(triangle) = self.triangles.last_mut() {
            triangle.corners = self.appearance.add(coordinates, tint);
        }
    }

    /// Sets the corner values of all triangles of the polygon that was added last and has these `corners`, as
    /// [`set_corners`](Self::set_corners) does. Each set of coordinates has one entry per corner, and the tint one
    /// color per corner.
    pub fn set_polygon_corners(
        &mut self,
        corners: &[VertexId],
        coordinates: &[&[Vec2]],
        tint: Option<&[Vec4]>,
    ) {
        // A map keeps the time for polygons with many corners from growing quadratically.
        let numbers: HashMap<VertexId, usize> =
            corners.iter().enumerate().rev().map(|(i, &vertex)| (vertex, i)).collect();
        let last = self.faces.checked_sub(1);
        let triangles = self.triangles.iter_mut().rev().take_while(|t| Some(t.face.0) == last);
        for triangle in triangles {
            let [Some(a), Some(b), Some(c)] = triangle.vertices.map(|v| numbers.get(&v).copied()) else {
                continue;
            };
            let sets: Vec<[Vec2; 3]> = coordinates.iter().map(|set| [a, b, c].map(|i| set[i])).collect();
            let tint = tint.map(|tint| [a, b, c].map(|i| tint[i]));
            triangle.corners = self.appearance.add(&sets, tint);
        }
    }

    /// Multiplies all lengths of what was added so far by a factor, which is finite and above zero: positions of
    /// vertices, cameras and lights, and heights of parallel projections.
    pub fn scale(&mut self, factor: f64) {
        self.vertices.iter_mut().for_each(|vertex| *vertex *= factor);
        for instance in &mut self.instances {
            instance.to_world = DAffine3::from_scale(DVec3::splat(factor)) * instance.to_world;
        }
        for camera in &mut self.cameras {
            camera.eye *= factor;
            if let Projection::Orthographic { height } = &mut camera.projection {
                *height *= factor;
            }
        }
        for light in &mut self.lights {
            if let LightKind::Point { position, .. } = &mut light.kind {
                *position *= factor;
            }
        }
    }

    /// Splits the triangles added so far at the faces of a box, so that each triangle lies inside the box, faces
    /// included, or outside. The parts keep the face and the source number of the triangle, and their corner values are
    /// interpolated. A triangle that does not intersect the box stays whole.
    pub fn split_at(&mut self, bounds: &BoundingBox) {
        for triangle in std::mem::take(&mut self.triangles) {
            // `build` reports vertices that were not added.
            let parts = match triangle.vertices.map(|v| self.vertices.get(v.index()).copied()) {
                [Some(a), Some(b), Some(c)] => split([a, b, c], bounds),
                _ => None,
            };
            let Some(parts) = parts else {
                self.triangles.push(triangle);
                continue;
            };
            for part in parts {
                let vertex = |corner: &Corner| match corner.own {
                    Some(i) => triangle.vertices[i],
                    None => self.add_vertex(corner.place),
                };
                let vertices: Vec<VertexId> = part.iter().map(vertex).collect();
                for i in 2..part.len() {
                    let [a, b, c] = [0, i - 1, i];
                    let corners = self.appearance.part(triangle.corners, [a, b, c].map(|i| part[i].point));
                    let vertices = [a, b, c].map(|i| vertices[i]);
                    self.triangles.push(Triangle { vertices, corners, ..triangle });
                }
            }
        }
    }

    /// Checks the input, merges vertices at equal positions, drops triangles without an area, clamps reflectances, and
    /// returns the scene.
    ///
    /// # Errors
    ///
    /// If no triangle is left, an index is out of range, a count exceeds 32 bits, or a material or light has an invalid
    /// number.
    pub fn build(mut self) -> Result<Built, SceneError> {
        self.check_sizes()?;
        self.check_indices()?;
        self.check_materials()?;
        self.check_lights()?;
        if let Some(first) = self.crossed.first() {
            let (count, place) =
                (self.crossed.len() as u64, self.vertices.get(first.index()).copied().unwrap_or_default());
            self.warnings.push(Warning::CrossedPolygons { count, place });
        }
        self.drop_degenerate_triangles();
        if self.triangles.is_empty() {
            let dropped = self.warnings.iter().map(|w| match w {
                Warning::DroppedTriangles { count } => *count,
                _ => 0,
            });
            return Err(SceneError::Empty { dropped: dropped.sum() });
        }
        self.weld();
        let (Some(bounding_box), Some(bounding_sphere)) =
            (BoundingBox::of(self.vertices.iter().copied()), BoundingSphere::of(&self.vertices))
        else {
            return Err(SceneError::Empty { dropped: 0 });
        };
        let mut groups: Vec<_> = self.groups.into_iter().map(|(name, group)| (group, name)).collect();
        groups.sort_unstable();
        let named = groups.into_iter().map(|(_, name)| name);
        let scene = Scene {
            groups: std::iter::once(String::new()).chain(named).collect(),
            instances: self.instances.into(),
            loaded: self.loaded,
            vertices: self.vertices.into(),
            triangles: self.triangles.into(),
            materials: self.materials,
            cameras: self.cameras,
            lights: self.lights,
            sky: self.sky,
            appearance: self.appearance.into(),
            dimming: Vec::new(),
            bounding_box,
            bounding_sphere,
        };
        Ok(Built { scene, warnings: self.warnings })
    }

    fn check_sizes(&self) -> Result<(), SceneError> {
        for (what, count) in [
            ("vertices", self.vertices.len()),
            ("triangles", self.triangles.len()),
            ("materials", self.materials.len()),
        ] {
            if u32::try_from(count).is_err() {
                return Err(SceneError::TooLarge { what });
            }
        }
        Ok(())
    }

    fn check_indices(&self) -> Result<(), SceneError> {
        for t in &self.triangles {
            let check = |what, index: u32, count: usize| {
                if (index as usize) < count {
                    Ok(())
                } else {
                    Err(SceneError::OutOfRange { face: t.face.0, what, index, count })
                }
            };
            for v in t.vertices {
                check("vertex", v.0, self.vertices.len())?;
            }
            check("material", t.material.0, self.materials.len())?;
        }
        Ok(())
    }

    fn check_materials(&mut self) -> Result<(), SceneError> {
        for m in &mut self.materials {
            let factor = |map: &Option<ColorMap>| map.map_or(Rgb::ZERO, |map| map.factor);
            for (what, value) in [
                ("reflectance", m.reflectance),
                ("exitance", m.exitance),
                ("reflectance", factor(&m.reflectance_map)),
                ("exitance", factor(&m.exitance_map)),
                ("opacity", Rgb::splat(m.opacity.factor)),
            ] {
                if !value.is_finite() || value.min_element() < 0.0 {
                    return Err(SceneError::BadMaterial { name: m.name.clone(), what, value });
                }
            }
            let asked = m.reflectance.max_element();
            if asked > MAX_REFLECTANCE {
                self.warnings.push(Warning::ClampedReflectance { material: m.name.clone(), asked });
                m.reflectance = m.reflectance.min(Rgb::splat(MAX_REFLECTANCE));
            }
        }
        Ok(())
    }

    fn check_lights(&self) -> Result<(), SceneError> {
        for (number, light) in self.lights.iter().enumerate() {
            if let Err((what, rule)) = light.kind.check() {
                return Err(SceneError::BadLight { number, name: light.name.clone(), what, rule });
            }
        }
        Ok(())
    }

    /// Drops triangles whose corners are collinear or coincide to the precision of the coordinates.
    fn drop_degenerate_triangles(&mut self) {
        let before = self.triangles.len();
        let vertices = &self.vertices;
        self.triangles.retain(|t| {
            let [a, b, c] = t.vertices.map(|v| vertices[v.index()]);
            let (ab, bc, ca) = (b - a, c - b, a - c);
            let longest = ab.length_squared().max(bc.length_squared()).max(ca.length_squared());
            let doubled_area = ab.cross(ca).length();
            // Also false for NaN and infinite coordinates.
            doubled_area.is_finite() && doubled_area > polygon::MIN_RELATIVE_AREA * longest
        });
        let count = (before - self.triangles.len()) as u64;
        if count > 0 {
            self.warnings.push(Warning::DroppedTriangles { count });
        }
    }

    /// Merges vertices at equal positions, in the order of their first use, and removes unused ones.
    fn weld(&mut self) {
        let mut by_position: HashMap<[u64; 3], VertexId> =
            HashMap::with_capacity(self.vertices.len().min(3 * self.triangles.len()));
        let mut welded: Vec<DVec3> = Vec::new();
        for t in &mut self.triangles {
            for v in &mut t.vertices {
                // Adding zero turns −0 into +0, so that equal numbers have equal bits.
                let p = self.vertices[v.index()] + DVec3::ZERO;
                *v = *by_position.entry(p.to_array().map(f64::to_bits)).or_insert_with(|| {
                    welded.push(p);
                    VertexId::new(welded.len() - 1)
                });
            }
        }
        self.vertices = welded;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::{LightKind, Spread};

    fn corner_triangle(builder: &mut SceneBuilder, scale: f64, material: MaterialId) {
        let v = [DVec3::ZERO, DVec3::X * scale, DVec3::Y * scale].map(|p| builder.add_vertex(p));
        builder.add_polygon(&v, material);
    }

    #[test]
    fn equal_positions_are_welded_and_degenerate_triangles_counted() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        corner_triangle(&mut b, 0.0, m);
        corner_triangle(&mut b, 1.0, m);
        corner_triangle(&mut b, 2.0, m);
        corner_triangle(&mut b, f64::NAN, m);
        let built = b.build().unwrap();
        assert_eq!(built.scene.vertices().len(), 5);
        assert_eq!(built.scene.triangles().iter().map(|t| t.source).collect::<Vec<_>>(), [1, 2]);
        assert_eq!(built.warnings, [Warning::DroppedTriangles { count: 2 }]);
    }

    #[test]
    fn parts_of_equal_names_are_one() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        for name in [None, Some("b"), Some("a"), Some("b"), Some("")] {
            name.map(|name| b.begin_group(name));
            corner_triangle(&mut b, 1.0, m);
        }
        let scene = b.build().unwrap().scene;
        let names: Vec<&str> = scene.triangles().iter().map(|t| &*scene.groups()[t.group.index()]).collect();
        assert_eq!(names, ["", "b", "a", "b", ""]);
        assert_eq!(scene.groups(), ["", "b", "a"]);
    }

    #[test]
    fn a_scale_changes_lengths_and_nothing_else() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("lamp", Rgb::ZERO).emitting(Rgb::ONE));
        corner_triangle(&mut b, 4.0, m);
        let eye = DVec3::new(0.0, 2.0, 8.0);
        let mut camera = Camera::looking_at(eye, DVec3::ZERO, DVec3::Y, 1.0).unwrap();
        b.add_camera(camera.clone());
        camera.projection = Projection::Orthographic { height: 6.0 };
        b.add_camera(camera.clone());
        let kind = |position| LightKind::Point { position, intensity: Rgb::ONE, spread: Spread::Isotropic };
        b.add_light(Light { name: String::new(), kind: kind(eye) });
        b.scale(0.25);
        corner_triangle(&mut b, 9.0, m);
        let scene = b.build().unwrap().scene;
        assert_eq!(scene.bounding_box().max, DVec3::new(9.0, 9.0, 0.0));
        assert_eq!(scene.area(sir_types::TriangleId(0)), 0.5);
        assert_eq!(scene.lights()[0].kind, kind(0.25 * eye));
        assert_eq!(scene.materials()[0].exitance, Rgb::ONE);
        let [perspective, parallel] = [&scene.cameras()[0], &scene.cameras()[1]];
        assert_eq!((perspective.eye, perspective.forward), (0.25 * eye, camera.forward));
        assert_eq!(perspective.projection, Projection::Perspective { vertical_fov: 1.0 });
        assert_eq!(parallel.projection, Projection::Orthographic { height: 1.5 });
    }

    #[test]
    fn full_reflectance_is_clamped_with_a_warning() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("white", Rgb::new(1.0, 0.5, 2.0)));
        corner_triangle(&mut b, 1.0, m);
        let built = b.build().unwrap();
        assert_eq!(built.scene.materials()[0].reflectance, Rgb::new(MAX_REFLECTANCE, 0.5, MAX_REFLECTANCE));
        assert_eq!(built.warnings.len(), 1);
    }

    #[test]
    fn impossible_input_is_refused() {
        let mut b = SceneBuilder::new();
        assert_eq!(b.clone().build().unwrap_err(), SceneError::Empty { dropped: 0 });
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        b.add_polygon(&[VertexId(0), VertexId(1), VertexId(7)], m);
        assert!(matches!(b.build().unwrap_err(), SceneError::OutOfRange { what: "vertex", .. }));
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::new(f64::NAN, 0.0, 0.0)));
        corner_triangle(&mut b, 1.0, m);
        assert!(matches!(b.build().unwrap_err(), SceneError::BadMaterial { .. }));
    }

    #[test]
    fn impossible_lights_are_refused() {
        let (z, one) = (DVec3::Z, Rgb::ONE);
        let distant = |direction, irradiance| LightKind::Distant { direction, irradiance };
        let point = |position, spread| LightKind::Point { position, intensity: one, spread };
        let spot = |inner, outer| point(z, Spread::Spot { axis: z, inner, outer });
        for (kind, bad) in [
            (distant(z, one), None),
            (distant(z * 1.001, one), Some("direction")),
            (distant(z, -one), Some("irradiance")),
            (point(DVec3::NAN, Spread::Isotropic), Some("position")),
            (point(z, Spread::Lambertian { axis: DVec3::ZERO }), Some("axis")),
            (spot(0.9, 0.5), None),
            (spot(0.5, 0.5), Some("cone")),
            (spot(1.1, 0.5), Some("cone")),
            (
                LightKind::Point { position: z, intensity: Rgb::INFINITY, spread: Spread::Isotropic },
                Some("intensity"),
            ),
        ] {
            let mut b = SceneBuilder::new();
            let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
            corner_triangle(&mut b, 1.0, m);
            b.add_light(Light { name: "lamp".into(), kind: kind.clone() });
            match (b.build(), bad) {
                (Ok(built), None) => assert_eq!(built.scene.lights()[0].kind, kind),
                (Err(SceneError::BadLight { what, .. }), Some(bad)) => assert_eq!(what, bad),
                (outcome, _) => panic!("{kind:?}: {outcome:?}"),
            }
        }
    }
}
