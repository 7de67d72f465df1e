//! Wavefront OBJ with material libraries (MTL).
//!
//! `Kd` times `map_Kd` and the vertex colors is the reflectance. `Ke` times `map_Ke` is the radiance that the front
//! emits: files do not define sides, so both sides reflect and only the front emits. `d`, or else `1 − Tr`, times
//! `map_d` is the opacity.
//!
//! The crate `tobj` reads vertices, faces and colors from text that `clean` has simplified. A draft of a custom parser
//! in place of both was longer: about 600 lines of code instead of 565, without tests and comments. So `tobj` stays.

mod clean;
mod corners;
mod map;
mod mtl;

use std::path::Path;

use glam::{DVec3, Vec2, Vec4};

use crate::builder::SceneBuilder;
use crate::color::Rgb;
use crate::index::VertexId;
use crate::load::error::LoadError;
use crate::load::files;
use crate::load::notes::Notes;
use crate::load::obj::clean::line_at;
use crate::load::obj::corners::Corners;
use crate::load::options::{DEFAULT_REFLECTANCE, LoadOptions};
use crate::load::texture::Placement;
use crate::material::{MAX_REFLECTANCE, Material, Sides};

/// Statement that makes `tobj` request the materials, which have all been read by then.
const ALL_LIBRARIES: &str = "mtllib *\n";

/// Name that `tobj` gives to faces outside any object.
const NO_OBJECT: &str = "unnamed_object";

/// Reads an OBJ file into a builder.
pub(super) fn read(
    path: &Path,
    options: LoadOptions,
    builder: &mut SceneBuilder,
    notes: &mut Notes,
) -> Result<(), LoadError> {
    let obj = clean::obj(&String::from_utf8_lossy(&files::read_scene(path)?));
    notes.count("points and lines were skipped", obj.points_and_lines);
    let mut library = mtl::Library::new(&obj.used_materials, obj.corners.has_colors(), options, builder);
    for names in &obj.libraries {
        library.add(path, names, notes)?;
    }
    for name in obj.used_materials.iter().filter(|name| !library.by_name.contains_key(*name)) {
        notes.name("materials are in no library, and are made gray", name);
    }
    let models = parse(path, &obj.text, &library)?;
    let materials = library.finish();
    add(&models, &obj.corners, &materials, options, builder, notes);
    Ok(())
}

/// Parses simplified OBJ text with `tobj` into meshes, one for each run of faces of the same material and object, in
/// file order.
fn parse(path: &Path, text: &str, library: &mtl::Library<'_>) -> Result<Vec<tobj::Model>, LoadError> {
    let text = format!("{ALL_LIBRARIES}{text}");
    let mut rest = text.as_bytes();
    let as_they_are = tobj::LoadOptions { ignore_points: true, ignore_lines: true, ..Default::default() };
    let numbers = library.by_name.iter().map(|(name, &i)| (name.clone(), i));
    let result = tobj::load_obj_buf(&mut rest, &as_they_are, |_| Ok((Vec::new(), numbers.clone().collect())));
    let text = &text[ALL_LIBRARIES.len()..];
    match result {
        Ok((models, _)) => Ok(models),
        Err(tobj::LoadError::FaceVertexOutOfBounds) => Err(no_such_vertex(path, text)),
        Err(e) => {
            let (line, statement) = line_at(text, text.len().saturating_sub(rest.len()));
            let what = format!("{e} in \"{statement}\"");
            Err(LoadError::Syntax { path: path.to_owned(), line, what })
        }
    }
}

/// Returns the error for the first face corner whose vertex does not exist: in the whole file or, if the index counts
/// back, before the line.
fn no_such_vertex(path: &Path, text: &str) -> LoadError {
    let all = text.lines().filter(|line| line.starts_with("v ")).count();
    let mut before = 0;
    for (i, line) in text.lines().enumerate() {
        before += usize::from(line.starts_with("v "));
        let mut corners = line.strip_prefix("f ").unwrap_or_default().split_whitespace();
        let count = |corner: &str| if corner.starts_with('-') { before } else { all };
        let known = |c: &&str| c.parse::<isize>().is_ok_and(|n| n != 0 && n.unsigned_abs() <= count(c));
        if let Some(index) = corners.find(|corner| !known(corner)) {
            return LoadError::NoSuchVertex {
                path: path.to_owned(),
                line: i + 1,
                index: files::shortened(index, 40),
                count: count(index),
            };
        }
    }
    LoadError::Syntax { path: path.to_owned(), line: 1, what: "a face refers to a missing vertex".to_owned() }
}

fn add(
    models: &[tobj::Model],
    corners: &Corners,
    materials: &[mtl::Known],
    options: LoadOptions,
    builder: &mut SceneBuilder,
    notes: &mut Notes,
) {
    let mut default = None;
    let mut first = 0;
    for tobj::Model { mesh, name } in models.iter().filter(|model| !model.mesh.indices.is_empty()) {
        builder.begin_group(if name == NO_OBJECT { "" } else { name });
        let known = mesh.material_id.map(|i| &materials[i]);
        let material = known.map(|known| known.id).unwrap_or_else(|| {
            let reflectance = if corners.has_colors() { MAX_REFLECTANCE } else { DEFAULT_REFLECTANCE };
            let plain = Material::diffuse("", Rgb::splat(reflectance)).with_sides(Sides::Both);
            *default.get_or_insert_with(|| builder.add_material(options.sides.apply(plain)))
        });
        let placements = known.map_or(&[][..], |known| &known.placements);
        let vertices: Vec<VertexId> =
            mesh.positions.chunks_exact(3).map(|p| builder.add_vertex(DVec3::from_slice(p))).collect();
        let all: Vec<VertexId> = mesh.indices.iter().map(|&i| vertices[i as usize]).collect();
        // An absent list of arities means triangles only.
        let triangles = vec![3; if mesh.face_arities.is_empty() { all.len() / 3 } else { 0 }];
        let mut rest = &all[..];
        for &arity in mesh.face_arities.iter().chain(&triangles) {
            let (face, behind) = rest.split_at(arity as usize);
            builder.add_polygon(face, material);
            if !set_face_corners(face, first, corners, placements, builder) {
                notes.count("faces lack coordinates for a texture and have its mean color", 1);
            }
            first += face.len();
            rest = behind;
        }
        if mesh.material_id.is_none() && !corners.has_colors() {
            notes.count(
                "faces have no known material, and are made gray",
                mesh.face_arities.len() + triangles.len(),
            );
        }
    }
}

/// Sets the coordinates and colors of the face that was added last, whose first corner has the number `first`. Returns
/// false if coordinates are missing.
fn set_face_corners(
    face: &[VertexId],
    first: usize,
    corners: &Corners,
    placements: &[Placement],
    builder: &mut SceneBuilder,
) -> bool {
    let numbers = || first..first + face.len();
    let places = || -> Option<Vec<Vec2>> { numbers().map(|i| corners.place(i)).collect() };
    let places = if placements.is_empty() { Some(Vec::new()) } else { places() };
    let sets: Vec<Vec<Vec2>> = match &places {
        Some(places) => placements.iter().map(|p| places.iter().map(|&at| p.apply(at)).collect()).collect(),
        None => Vec::new(),
    };
    let tint: Option<Vec<Vec4>> = corners.has_colors().then(|| numbers().map(|i| corners.color(i)).collect());
    let tint = tint.filter(|tint| tint.iter().any(|&corner| corner != Vec4::ONE));
    if !sets.is_empty() || tint.is_some() {
        let sets: Vec<&[Vec2]> = sets.iter().map(|set| &set[..]).collect();
        builder.set_polygon_corners(face, &sets, tint.as_deref());
    }
    places.is_some()
}
