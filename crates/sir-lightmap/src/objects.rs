//! Meshes and their instances: where the triangles of a scene are in a document.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec2, DVec3};
use serde_json::Value;
use sir_geom::{Scene, Sides, TriangleId};

use crate::document::Document;
use crate::error::LightmapError;
use crate::json::list;

/// Distance from a corner, in barycentric coordinates, within which a point is that corner.
const CORNER: f64 = 1e-9;

/// All meshes with triangles in the scene, and their instances.
#[derive(Default)]
pub(crate) struct Objects {
    pub(crate) meshes: Vec<Mesh>,
    pub(crate) instances: Vec<Instance>,
    /// Place of each triangle of the scene.
    pub(crate) places: Vec<Place>,
}

/// A mesh of the document.
pub(crate) struct Mesh {
    /// Index in the document.
    pub(crate) index: usize,
    /// Name, or an empty string.
    pub(crate) name: String,
    pub(crate) primitives: Vec<Primitive>,
}

/// A primitive of a mesh. Without triangles if it has points or lines.
#[derive(Default)]
pub(crate) struct Primitive {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// True if both sides have light and are shown.
    pub(crate) is_two_sided: bool,
}

/// A mesh at a place in the scene.
pub(crate) struct Instance {
    /// Index in `Objects::meshes`.
    pub(crate) mesh: usize,
    /// Index of the node in the document.
    pub(crate) node: usize,
    /// Index among the instances of the node.
    pub(crate) of_node: u32,
    pub(crate) to_world: DAffine3,
    /// Surface area of the mesh there \[m²\].
    pub(crate) area: f64,
}

/// Place of a triangle of the scene in the document.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) instance: u32,
    /// Number of the triangle in its mesh, counted over all primitives.
    pub(crate) triangle: u32,
}

impl Mesh {
    /// Returns the primitive of a triangle, and the number of the triangle in it.
    pub(crate) fn locate(&self, triangle: u32) -> Option<(usize, usize)> {
        let mut number = triangle as usize;
        for (i, primitive) in self.primitives.iter().enumerate() {
            if number < primitive.triangles.len() {
                return Some((i, number));
            }
            number -= primitive.triangles.len();
        }
        None
    }

    /// Returns the surface area under a transform.
    pub(crate) fn area(&self, to_world: &DAffine3) -> f64 {
        let of = |primitive: &Primitive| {
            let place =
                |v: u32| to_world.transform_point3(DVec3::from_array(primitive.positions[v as usize]));
            let areas = primitive.triangles.iter().map(|t| {
                let [a, b, c] = t.map(place);
                0.5 * (b - a).cross(c - a).length()
            });
            areas.filter(|area| area.is_finite()).sum::<f64>()
        };
        self.primitives.iter().map(of).sum()
    }
}

impl Objects {
    /// Collects the meshes from which the triangles of a scene come. Triangles without one have no place yet.
    pub(crate) fn of_file(document: &Document, scene: &Scene) -> Result<Self, LightmapError> {
        let nowhere = Place { instance: u32::MAX, triangle: 0 };
        let mut objects = Self { places: vec![nowhere; scene.triangles().len()], ..Self::default() };
        let Some(file) = document.file() else { return Ok(objects) };
        let mut known: BTreeMap<u32, usize> = BTreeMap::new();
        let mut numbers: BTreeMap<usize, u32> = BTreeMap::new();
        for (number, t) in scene.triangle_ids().enumerate() {
            let Some(i) = scene.mesh_instance_of(t) else { continue };
            let source = scene.mesh_instances()[i];
            let mesh = match known.get(&source.mesh) {
                Some(&mesh) => mesh,
                None => {
                    let index = source.mesh as usize;
                    let json = &document.json["meshes"][index];
                    let mut primitives = Vec::new();
                    for i in 0..list(json, "primitives").len() {
                        let read = file.primitive(index, i)?;
                        primitives.push(read.map_or_else(Primitive::default, |read| Primitive {
                            positions: read.positions,
                            triangles: read.triangles,
                            is_two_sided: false,
                        }));
                    }
                    objects.meshes.push(Mesh { index, name: name(json), primitives });
                    known.insert(source.mesh, objects.meshes.len() - 1);
                    objects.meshes.len() - 1
                }
            };
            let instance = *numbers.entry(i).or_insert_with(|| {
                let area = objects.meshes[mesh].area(&source.to_world);
                objects.instances.push(Instance {
                    mesh,
                    node: source.node as usize,
                    of_node: source.instance,
                    to_world: source.to_world,
                    area,
                });
                objects.instances.len() as u32 - 1
            });
            objects.places[number] = Place { instance, triangle: scene.triangle(t).source - source.first };
        }
        objects.find_sides(document, scene);
        Ok(objects)
    }

    /// Marks the primitives of which both sides have light and are shown.
    fn find_sides(&mut self, document: &Document, scene: &Scene) {
        for t in scene.triangle_ids() {
            let Some((mesh, primitive, _)) = self.locate(t) else { continue };
            let json = &document.json["meshes"][self.meshes[mesh].index]["primitives"][primitive];
            if scene.material(t).sides == Sides::Both && is_double_sided(document, json) {
                self.meshes[mesh].primitives[primitive].is_two_sided = true;
            }
        }
    }

    /// Returns the mesh, the primitive, and the number in the primitive of a triangle of the scene.
    pub(crate) fn locate(&self, t: TriangleId) -> Option<(usize, usize, usize)> {
        let Place { instance, triangle } = self.places[t.index()];
        let mesh = self.instances.get(instance as usize)?.mesh;
        let (primitive, number) = self.meshes[mesh].locate(triangle)?;
        Some((mesh, primitive, number))
    }

    /// Returns the corners of a triangle of the scene as barycentric coordinates `(v, w)` in its triangle of the document,
    /// of which it may be a part.
    pub(crate) fn corners_in_source(&self, scene: &Scene, t: TriangleId) -> Option<[DVec2; 3]> {
        let (mesh, primitive, number) = self.locate(t)?;
        let instance = &self.instances[self.places[t.index()].instance as usize];
        let of = &self.meshes[mesh].primitives[primitive];
        let [a, b, c] = of.triangles[number]
            .map(|v| instance.to_world.transform_point3(DVec3::from_array(of.positions[v as usize])));
        let normal = (b - a).cross(c - a);
        let scale = 1.0 / normal.length_squared();
        Some(scene.corners(t).map(|p| {
            let v = (p - a).cross(c - a).dot(normal) * scale;
            let w = (b - a).cross(p - a).dot(normal) * scale;
            let corners = [DVec2::ZERO, DVec2::X, DVec2::Y];
            let point = DVec2::new(v, w);
            corners.into_iter().find(|corner| corner.distance(point) < CORNER).unwrap_or(point)
        }))
    }
}

/// Returns true if the material of a primitive says that both of its sides are shown.
fn is_double_sided(document: &Document, primitive: &Value) -> bool {
    let material = primitive["material"].as_u64().map(|i| &document.json["materials"][i as usize]);
    material.is_some_and(|material| material["doubleSided"] == true)
}

/// Returns the name of an element, or an empty string.
fn name(element: &Value) -> String {
    element["name"].as_str().unwrap_or_default().to_owned()
}
