//! Vertices, faces and names of an OBJ file.

use std::collections::HashMap;
use std::num::IntErrorKind;
use std::ops::Range;
use std::path::Path;

use glam::{DVec3, Vec2};

use crate::load::error::LoadError;
use crate::load::files::shortened;
use crate::load::notes::Notes;
use crate::load::obj::colors::Colors;
use crate::load::obj::text::{lower_case, number, shown, split_word, start_of, statements, words};
use crate::polygon;

/// Index of missing texture coordinates or a missing normal.
const NONE: u32 = u32::MAX;

/// Contents of an OBJ file that a scene needs.
#[derive(Debug, Default)]
pub(super) struct Obj {
    /// Positions of the vertices; each corner has the index of one.
    pub(super) positions: Vec<DVec3>,
    pub(super) colors: Colors,
    places: Vec<Vec2>,
    normals: Vec<DVec3>,
    corners: Vec<Corner>,
    pub(super) faces: Vec<Face>,
    /// Names of materials, as bytes, in the order of their first `usemtl`.
    materials: Names,
    /// Names of objects and groups.
    groups: Names,
    /// Arguments of the `mtllib` statements.
    pub(super) libraries: Vec<Vec<u8>>,
}

/// Indices of the values of a corner of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) vertex: u32,
    place: u32,
    normal: u32,
}

/// Face of an OBJ file.
#[derive(Debug)]
pub(super) struct Face {
    /// Indices of its corners.
    corners: Range<usize>,
    /// Index of the name of its material; `None` before the first `usemtl`.
    pub(super) material: Option<usize>,
    /// Index of the name of its group.
    pub(super) group: usize,
}

/// Distinct names in the order of their first use.
#[derive(Debug, Default)]
struct Names {
    indices: HashMap<Vec<u8>, usize>,
}

impl Names {
    fn add(&mut self, name: &[u8]) -> usize {
        let next = self.indices.len();
        *self.indices.entry(name.to_vec()).or_insert(next)
    }

    fn list(&self) -> Vec<&[u8]> {
        let mut list = vec![&[][..]; self.indices.len()];
        self.indices.iter().for_each(|(name, &i)| list[i] = name);
        list
    }
}

impl Obj {
    /// Parses the text of the file `path`.
    pub(super) fn parse(path: &Path, text: &[u8], notes: &mut Notes) -> Result<Self, LoadError> {
        let keyword_of = |statement: &[u8]| lower_case(split_word(statement).0).into_owned();
        let all = statements(text).filter(|(_, statement)| keyword_of(statement) == b"v").count();
        let mut obj = Self { positions: Vec::with_capacity(all), ..Self::default() };
        let (mut material, mut group) = (None, obj.groups.add(b""));
        let (mut points_and_lines, mut free_forms, mut calls) = (0, 0, 0);
        for (line, statement) in statements(text) {
            let (keyword, rest) = split_word(&statement);
            match &*lower_case(keyword) {
                b"v" => obj.add_vertex(rest).ok_or_else(|| not_numbers(path, line, &statement))?,
                b"vt" => obj.places.push(vector(rest).truncate().as_vec2()),
                b"vn" => obj.normals.push(vector(rest)),
                b"f" | b"fo" if words(rest).nth(2).is_some() => {
                    let start = obj.corners.len();
                    for word in words(rest) {
                        let corner = obj.corner(word, all, path, line)?;
                        obj.corners.push(corner);
                    }
                    obj.faces.push(Face { corners: start..obj.corners.len(), material, group });
                }
                b"f" | b"fo" | b"l" | b"p" => points_and_lines += 1,
                b"surf" | b"curv" | b"bzp" | b"bsp" | b"cdp" | b"cdc" => free_forms += 1,
                b"usemtl" => material = Some(obj.materials.add(rest)),
                // The last object or group before a face counts.
                b"o" | b"g" => group = obj.groups.add(rest),
                b"mtllib" => obj.libraries.push(rest.to_owned()),
                b"call" => calls += 1,
                _ => {}
            }
        }
        notes.count("points and lines were skipped", points_and_lines);
        notes.count("free-form curves and surfaces were skipped", free_forms);
        notes.count("statements `call`, which include other files, were skipped", calls);
        obj.colors.decide_range(notes);
        Ok(obj)
    }

    /// Returns the corners of a face.
    pub(super) fn corners(&self, face: &Face) -> &[Corner] {
        &self.corners[face.corners.clone()]
    }

    /// Returns the names of the materials that faces have, with their indices.
    pub(super) fn used_materials(&self) -> Vec<(usize, &[u8])> {
        let mut used: Vec<usize> = self.faces.iter().filter_map(|face| face.material).collect();
        used.sort_unstable();
        used.dedup();
        let names = self.materials.list();
        used.into_iter().map(|i| (i, names[i])).collect()
    }

    /// Returns the names of objects and groups; the first one is empty.
    pub(super) fn group_names(&self) -> Vec<String> {
        self.groups.list().into_iter().map(shown).collect()
    }

    /// Returns the texture coordinates of a corner; `None` if it has none, or they do not exist.
    pub(super) fn place(&self, corner: Corner) -> Option<Vec2> {
        self.places.get(corner.place as usize).copied()
    }

    /// Returns true if all corners of a face have normals (`vn`) and these point to its back.
    pub(super) fn has_reversed_normals(&self, corners: &[Corner]) -> bool {
        let normal = |corner: &Corner| self.normals.get(corner.normal as usize).copied();
        let stated: Option<DVec3> = corners.iter().map(normal).sum();
        let places: Vec<DVec3> =
            corners.iter().map(|corner| self.positions[corner.vertex as usize]).collect();
        stated.is_some_and(|stated| stated.dot(polygon::normal(&places)) < 0.0)
    }

    /// Adds the vertex of a `v` statement: three coordinates, and a color if three more follow.
    fn add_vertex(&mut self, rest: &[u8]) -> Option<()> {
        let mut numbers = words(rest).map(number);
        let mut coordinate = || numbers.next().flatten();
        let position = DVec3::new(coordinate()?, coordinate()?, coordinate()?);
        if let (Some(r), Some(g), Some(b)) = (numbers.next(), numbers.next(), numbers.next()) {
            self.colors.add(self.positions.len(), [r, g, b].map(|x| x.unwrap_or(f64::NAN) as f32));
        }
        self.positions.push(position);
        Some(())
    }

    /// Returns the corner `position/texture/normal` of a face in this line. Numbers count from 1 or, if negative, back
    /// from the last one before the line; `all` is the number of vertices in the file.
    fn corner(&self, word: &[u8], all: usize, path: &Path, line: usize) -> Result<Corner, LoadError> {
        let mut parts = word.split(|&byte| byte == b'/').map(|part| str::from_utf8(part).unwrap_or_default());
        let index = |n: i64, count: usize| {
            let index = if n < 0 { n.checked_add_unsigned(count as u64)? } else { n - 1 };
            u32::try_from(index).ok()
        };
        let position = parts.next().unwrap_or_default();
        let before = self.positions.len();
        let vertex = match position.parse::<i64>() {
            Ok(n) => index(n, before).filter(|&i| (i as usize) < all),
            Err(e) if matches!(e.kind(), IntErrorKind::PosOverflow | IntErrorKind::NegOverflow) => None,
            Err(_) => {
                let what =
                    format!("the corner {} of a face does not begin with a vertex number", start_of(word));
                return Err(LoadError::Syntax { path: path.to_owned(), line, what });
            }
        };
        let vertex = vertex.ok_or_else(|| LoadError::NoSuchVertex {
            path: path.to_owned(),
            line,
            index: shortened(position, 40),
            count: if position.starts_with('-') { before } else { all },
        })?;
        let mut other = |count| parts.next()?.parse().ok().and_then(|n| index(n, count));
        let place = other(self.places.len()).unwrap_or(NONE);
        Ok(Corner { vertex, place, normal: other(self.normals.len()).unwrap_or(NONE) })
    }
}

fn not_numbers(path: &Path, line: usize, statement: &[u8]) -> LoadError {
    let what = format!("{} must have three numbers, with a point before decimals", start_of(statement));
    LoadError::Syntax { path: path.to_owned(), line, what }
}

/// Returns the first three numbers of a statement; missing ones are zero, and invalid ones undefined.
fn vector(rest: &[u8]) -> DVec3 {
    let mut numbers = words(rest).map(|word| number(word).unwrap_or(f64::NAN));
    let mut next = || numbers.next().unwrap_or(0.0);
    DVec3::new(next(), next(), next())
}
