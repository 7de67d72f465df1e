//! The contents of a scene, as numbers and names.

use serde::Serialize;

use crate::info::lines::Lines;
use crate::info::shape::{Dominant, Extent, Twins};

/// Contents of a scene file.
#[derive(Clone, Debug, Serialize)]
pub struct Info {
    /// Version of the JSON layout.
    pub version: u32,
    /// Name and version of the program.
    pub program: &'static str,
    /// Path of the file.
    pub scene: String,
    /// Warnings of the reader: what it changed or left out.
    pub warnings: Vec<String>,
    /// Number of triangles that have an area.
    pub triangles: usize,
    /// Number of triangles without an area, or with non-finite coordinates.
    pub dropped_triangles: u64,
    /// Number of distinct positions.
    pub vertices: usize,
    /// Number of polygons that the triangles belong to.
    pub polygons: usize,
    /// Images that materials use, and their triangles.
    pub textures: Textures,
    /// Area of all triangles, one side each \[m²\].
    pub area: f64,
    /// Area of the largest triangle as a share of `area`.
    pub largest_triangle: f64,
    /// Bounding box of the scene \[m\].
    pub extent: Extent,
    /// Distance of the box's center from the origin \[m\].
    pub distance_from_origin: f64,
    /// Up direction: +y in glTF, and what the scene shows in OBJ.
    pub up: [f64; 3],
    /// Reason for the up direction.
    pub up_from: String,
    /// What speaks against the up direction, if anything.
    pub doubt_of_up: Option<String>,
    /// Materials that triangles have, largest area first.
    pub materials: Vec<MaterialInfo>,
    /// Named parts, in file order.
    pub groups: Vec<Group>,
    /// Light sources by kind.
    pub sources: Vec<Lights>,
    /// Names of the cameras, in file order.
    pub cameras: Vec<String>,
    /// Triangles with the same corners.
    pub twins: Twins,
    /// Part that dwarfs the rest of the scene, if there is one.
    pub dominant: Option<Dominant>,
    /// Statistics of random lines.
    pub lines: Lines,
    /// Notes about likely mistakes.
    pub findings: Vec<String>,
    /// Suggested pipeline settings.
    pub settings: Vec<Setting>,
}

/// Images, and the triangles that they affect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Textures {
    /// Number of images that could be read and have more than one color.
    pub images: usize,
    /// Number of texels of all images together.
    pub texels: usize,
    /// Number of triangles whose appearance differs from their material's or varies over the triangle, because of a
    /// texture or vertex colors.
    pub triangles: usize,
}

/// A material.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialInfo {
    /// Name of the material.
    pub name: String,
    /// Number of triangles that have it.
    pub triangles: usize,
    /// Area of these triangles \[m²\].
    pub area: f64,
    /// Reflectance per band.
    pub reflectance: [f64; 3],
    /// Emitted exitance per band \[W/m²\].
    pub exitance: [f64; 3],
    /// Emitted power per band, by both sides if both emit \[W\].
    pub power: [f64; 3],
    /// True if both sides reflect.
    pub two_sided: bool,
}

/// A named part of the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// Name of the part.
    pub name: String,
    /// Number of its triangles.
    pub triangles: usize,
    /// Area of these triangles \[m²\].
    pub area: f64,
}

/// All light sources of a kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lights {
    /// Number and kind of the sources.
    pub what: String,
    /// Power of the sources per band \[W\].
    pub power: [f64; 3],
}

/// Suggested stage or field of a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Setting {
    /// Text in a pipeline file.
    pub set: String,
    /// Reason for the suggestion.
    pub why: String,
    /// What is doubtful about it, and what to write instead.
    pub doubt: Option<String>,
    /// True if every pipeline has it, so that it needs no mention.
    #[serde(skip)]
    pub is_usual: bool,
}
