//! Wavefront OBJ with material libraries (MTL).
//!
//! `Kd` times `map_Kd` and the vertex colors is the reflectance. `Ke` times `map_Ke` is the radiance that the front
//! emits: files do not define sides, so both sides reflect and only the front emits. `d`, or else `1 − Tr`, times
//! `map_d` is the opacity.
//!
//! Faces, groups and materials are connected by names, which are bytes in any encoding: programs of several countries
//! and decades write them. They become text only to be shown.

mod colors;
mod file_name;
mod geometry;
mod map;
mod material;
mod mtl;
mod text;

use std::collections::HashMap;
use std::path::Path;

use glam::{Vec2, Vec4};

use crate::builder::SceneBuilder;
use crate::color::Rgb;
use crate::index::{MaterialId, VertexId};
use crate::load::error::LoadError;
use crate::load::files;
use crate::load::notes::{Notes, quoted};
use crate::load::obj::geometry::{Corner, Obj};
use crate::load::obj::material::{Converter, Known};
use crate::load::obj::mtl::Libraries;
use crate::load::obj::text::shown;
use crate::load::options::{DEFAULT_REFLECTANCE, LoadOptions};
use crate::load::texture::{Images, Placement};
use crate::material::{MAX_REFLECTANCE, Material, Sides};
use crate::text::utf8_text;

/// Warning about normals that contradict the order of corners, which decides where light goes.
const REVERSED: &str = "emitting faces have normals (`vn`) that point to their backs, but only fronts emit, where \
                        corners run counterclockwise; turn the faces around if their light is on the wrong side";

/// Reads an OBJ file into a builder.
pub(super) fn read(
    path: &Path,
    options: LoadOptions,
    builder: &mut SceneBuilder,
    notes: &mut Notes,
) -> Result<(), LoadError> {
    let obj = Obj::parse(path, &utf8_text(files::read_scene(path)?), notes)?;
    let used = obj.used_materials();
    let mut libraries = Libraries::new(used.iter().map(|(_, name)| *name));
    for names in &obj.libraries {
        libraries.add(path, names, notes)?;
    }
    let mut converter = Converter {
        is_colored: !obj.colors.is_empty(),
        options,
        builder,
        notes,
        textures: HashMap::new(),
        images: Images::default(),
    };
    let found = libraries.finish();
    let mut known: HashMap<&[u8], Known> =
        found.iter().map(|source| (&source.name[..], converter.add(source))).collect();
    let mut materials = HashMap::new();
    for (i, name) in used {
        match known.remove(name) {
            Some(material) => {
                materials.insert(i, material);
            }
            None => notes.name("materials are in no library, and are made gray", shown(name)),
        }
    }
    add_faces(&obj, &materials, options, builder, notes);
    Ok(())
}

fn add_faces(
    obj: &Obj,
    materials: &HashMap<usize, Known>,
    options: LoadOptions,
    builder: &mut SceneBuilder,
    notes: &mut Notes,
) {
    let vertices: Vec<VertexId> = obj.positions.iter().map(|&p| builder.add_vertex(p)).collect();
    let groups = obj.group_names();
    let mut group = None;
    let mut default = None;
    for face in &obj.faces {
        let corners = obj.corners(face);
        if group.replace(face.group) != Some(face.group) {
            builder.begin_group(&groups[face.group]);
        }
        let known = face.material.and_then(|i| materials.get(&i));
        let material = known.map(|known| known.id).unwrap_or_else(|| {
            *default.get_or_insert_with(|| add_default(!obj.colors.is_empty(), options, builder))
        });
        let own: Vec<VertexId> = corners.iter().map(|c| vertices[c.vertex as usize]).collect();
        builder.add_polygon(&own, material);
        let placements = known.map_or(&[][..], |known| &known.placements);
        if !set_face_corners(&own, corners, obj, placements, builder) {
            notes.count("faces lack coordinates for a texture and have its mean color", 1);
        }
        match known {
            None if obj.colors.is_empty() => {
                notes.count("faces have no known material, and are made gray", 1);
            }
            Some(known) if known.emits && obj.has_reversed_normals(corners) => {
                let name = |name: &str| quoted(&files::shortened(name, 50));
                let group = Some(&groups[face.group]).filter(|group| !group.is_empty());
                let place = group.map_or_else(String::new, |group| format!(" in {}", name(group)));
                notes.count_in(REVERSED, format!("{}{place}", name(&known.name)));
            }
            _ => {}
        }
    }
}

/// Adds the material of faces without one.
fn add_default(is_colored: bool, options: LoadOptions, builder: &mut SceneBuilder) -> MaterialId {
    let reflectance = if is_colored { MAX_REFLECTANCE } else { DEFAULT_REFLECTANCE };
    let plain = Material::diffuse("", Rgb::splat(reflectance)).with_sides(Sides::Both);
    builder.add_material(options.sides.apply(plain))
}

/// Sets the coordinates and colors of the face that was added last. Returns false if coordinates are missing.
fn set_face_corners(
    vertices: &[VertexId],
    corners: &[Corner],
    obj: &Obj,
    placements: &[Placement],
    builder: &mut SceneBuilder,
) -> bool {
    let places = || -> Option<Vec<Vec2>> { corners.iter().map(|&corner| obj.place(corner)).collect() };
    let places = if placements.is_empty() { Some(Vec::new()) } else { places() };
    let sets: Vec<Vec<Vec2>> = match &places {
        Some(places) => placements.iter().map(|p| places.iter().map(|&at| p.apply(at)).collect()).collect(),
        None => Vec::new(),
    };
    let tint = || -> Vec<Vec4> { corners.iter().map(|c| obj.colors.linear(c.vertex as usize)).collect() };
    let tint = (!obj.colors.is_empty()).then(tint);
    let tint = tint.filter(|tint| tint.iter().any(|&corner| corner != Vec4::ONE));
    if !sets.is_empty() || tint.is_some() {
        let sets: Vec<&[Vec2]> = sets.iter().map(|set| &set[..]).collect();
        builder.set_polygon_corners(vertices, &sets, tint.as_deref());
    }
    places.is_some()
}
