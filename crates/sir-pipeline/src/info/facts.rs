//! What is in a scene, as numbers.

use serde::Serialize;

use crate::info::lines::Lines;
use crate::info::shape::{Dominant, Extent, Twins};

/// What is in a scene file.
#[derive(Clone, Debug, Serialize)]
pub struct Info {
    /// Version of the JSON text.
    pub version: u32,
    /// Name and version of the program.
    pub program: &'static str,
    /// The file.
    pub scene: String,
    /// What the reader changed or left out.
    pub warnings: Vec<String>,
    /// Triangles that have an area.
    pub triangles: usize,
    /// Triangles without an area, or with coordinates that are not finite.
    pub dropped_triangles: u64,
    /// Different positions.
    pub vertices: usize,
    /// Polygons that the triangles are parts of.
    pub polygons: usize,
    /// Images that materials use.
    pub textures: Textures,
    /// Area of all triangles, one side each \[m²\].
    pub area: f64,
    /// Share of the area that the largest triangle has.
    pub largest_triangle: f64,
    /// Where the scene is \[m\].
    pub extent: Extent,
    /// Distance of its center from the origin \[m\].
    pub distance_from_origin: f64,
    /// Upwards: +y in glTF, guessed in OBJ.
    pub up: [f64; 3],
    /// Materials that a triangle has, the largest area first.
    pub materials: Vec<MaterialInfo>,
    /// Named parts, in file order.
    pub groups: Vec<Group>,
    /// Light sources by kind.
    pub sources: Vec<Lights>,
    /// Names of the cameras, in file order.
    pub cameras: Vec<String>,
    /// Triangles with the same corners.
    pub twins: Twins,
    /// What dwarfs the rest.
    pub dominant: Option<Dominant>,
    /// What random lines have found.
    pub lines: Lines,
    /// What is strange.
    pub findings: Vec<String>,
    /// What to set in a pipeline.
    pub settings: Vec<Setting>,
}

/// Images, and what has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Textures {
    /// Those that could be read and are not of a single color.
    pub images: usize,
    /// Texels of all together.
    pub texels: usize,
    /// Triangles that differ from their material or from place to place, because of a texture or colors at their corners.
    pub triangles: usize,
}

/// A material.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialInfo {
    /// Its name.
    pub name: String,
    /// Triangles that have it.
    pub triangles: usize,
    /// Their area \[m²\].
    pub area: f64,
    /// Reflectance per band.
    pub reflectance: [f64; 3],
    /// Emitted exitance per band \[W/m²\].
    pub exitance: [f64; 3],
    /// Emitted power per band, by both sides if both emit \[W\].
    pub power: [f64; 3],
    /// Whether both sides reflect.
    pub two_sided: bool,
}

/// A named part of the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// Its name.
    pub name: String,
    /// Its triangles.
    pub triangles: usize,
    /// Their area \[m²\].
    pub area: f64,
}

/// All light sources of a kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lights {
    /// How many of which kind.
    pub what: String,
    /// Their power per band \[W\].
    pub power: [f64; 3],
}

/// Something to write into a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Setting {
    /// The stage, as it is written in the pipeline.
    pub set: String,
    /// The reason.
    pub why: String,
}
