//! Material libraries.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use super::super::notes::Notes;
use super::super::{DEFAULT_REFLECTANCE, LoadError, LoadOptions, files, texture};
use super::{clean, line_at};
use crate::{Material, Rgb, Sides};

/// The materials of all libraries of an OBJ file, as far as its faces use them.
#[derive(Debug)]
pub(super) struct Library<'a> {
    /// Names of the materials to take in.
    wanted: &'a BTreeSet<String>,
    options: LoadOptions,
    pub(super) materials: Vec<Material>,
    /// Places in `materials`; of equal names the last counts.
    pub(super) by_name: BTreeMap<String, usize>,
    textures: HashMap<PathBuf, Option<Rgb>>,
    /// The files that were tried.
    read: HashSet<PathBuf>,
}

impl<'a> Library<'a> {
    /// A library that takes in the materials of these names.
    pub(super) fn new(wanted: &'a BTreeSet<String>, options: LoadOptions) -> Self {
        Self {
            wanted,
            options,
            materials: Vec::new(),
            by_name: BTreeMap::new(),
            textures: HashMap::new(),
            read: HashSet::new(),
        }
    }

    /// Reads what a `mtllib` statement of the file `obj` names: one file whose name may have blanks, or else
    /// several.
    pub(super) fn add(&mut self, obj: &Path, names: &str, notes: &mut Notes) -> Result<(), LoadError> {
        let whole = plain_name(names);
        if files::beside(obj, &whole).is_some_and(|path| path.is_file()) {
            return self.add_file(obj, &whole, notes);
        }
        // A blank inside one of several names has a backslash before it.
        for name in names.replace("\\ ", "\0").split_whitespace().map(|name| name.replace('\0', " ")) {
            self.add_file(obj, &plain_name(&name), notes)?;
        }
        Ok(())
    }

    /// Reads one library, unless it was read before.
    fn add_file(&mut self, obj: &Path, name: &str, notes: &mut Notes) -> Result<(), LoadError> {
        let Some(path) = files::beside(obj, name) else {
            notes.name("material libraries are not in the folder of the scene, and were not read", name);
            return Ok(());
        };
        if !self.read.insert(path.clone()) {
            return Ok(());
        }
        match files::read(&path) {
            Ok(bytes) => self.parse(&path, &bytes, notes)?,
            Err(_) => notes.name("material libraries cannot be read", name),
        }
        Ok(())
    }

    fn parse(&mut self, path: &Path, bytes: &[u8], notes: &mut Notes) -> Result<(), LoadError> {
        let syntax = |line, what| LoadError::Syntax { path: path.to_owned(), line, what };
        let text = clean::mtl(&String::from_utf8_lossy(bytes)).map_err(|(line, what)| syntax(line, what))?;
        let mut rest = text.as_bytes();
        let (materials, _) = tobj::load_mtl_buf(&mut rest).map_err(|e| {
            let (line, statement) = line_at(&text, text.len() - rest.len());
            syntax(line, format!("{e} in \"{statement}\""))
        })?;
        for source in materials.into_iter().filter(|m| self.wanted.contains(&m.name)) {
            self.by_name.insert(source.name.clone(), self.materials.len());
            let material = self.convert(&source, path, notes);
            self.materials.push(self.options.sides.apply(material));
        }
        Ok(())
    }

    fn convert(&mut self, source: &tobj::Material, mtl: &Path, notes: &mut Notes) -> Material {
        let texture = source.diffuse_texture.as_ref().and_then(|map| self.texture(mtl, map, notes));
        let reflectance = match (source.diffuse, texture) {
            (Some(factor), mean) => Rgb::from_array(factor) * mean.unwrap_or(Rgb::ONE),
            (None, Some(mean)) => mean,
            (None, None) => {
                notes.name("materials have no diffuse colour, and are made grey", &source.name);
                Rgb::splat(DEFAULT_REFLECTANCE)
            }
        };
        let emissive = source.emissive.map_or(Rgb::ZERO, Rgb::from_array);
        let radiance = match source.unknown_param.get("map_Ke") {
            Some(map) if emissive != Rgb::ZERO => {
                emissive * self.texture(mtl, map, notes).unwrap_or(Rgb::ONE)
            }
            _ => emissive,
        };
        Material::diffuse(&source.name, reflectance).emitting(PI * radiance).with_sides(Sides::Both)
    }

    /// Mean colour of the texture that a `map_…` statement of a library names.
    fn texture(&mut self, mtl: &Path, map: &str, notes: &mut Notes) -> Option<Rgb> {
        let name = plain_name(without_options(map));
        let Some(path) = files::beside(mtl, &name) else {
            notes.name("textures are not in the folder of the scene, and were not read", &name);
            return None;
        };
        *self.textures.entry(path).or_insert_with_key(|path| {
            let mean = files::read(path)
                .map_err(|e| e.to_string())
                .and_then(|b| texture::decode(&b).map(|t| t.mean_colour()));
            mean.inspect_err(|e| notes.name(texture::UNREADABLE, format!("{name} ({e})"))).ok()
        })
    }
}

/// A file name without quotes, with the slashes of this system.
fn plain_name(name: &str) -> String {
    name.trim_matches('"').replace('\\', "/")
}

/// The file name behind the options of a `map_…` statement.
fn without_options(mut map: &str) -> &str {
    loop {
        let (option, mut rest) = clean::split_word(map);
        let (most, numbers) = match option {
            "-o" | "-s" | "-t" => (3, true),
            "-mm" => (2, true),
            "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-clamp" | "-colorspace" | "-imfchan"
            | "-texres" | "-type" => (1, false),
            _ => return map,
        };
        for _ in 0..most {
            let (value, behind) = clean::split_word(rest);
            if numbers && value.parse::<f64>().is_err() {
                break;
            }
            rest = behind;
        }
        map = rest;
    }
}

#[cfg(test)]
mod tests {
    use super::without_options;

    #[test]
    fn options_before_a_texture_are_passed_over() {
        for map in [
            "a b.png",
            "-s 1 1 1 a b.png",
            "-o 0.1 -s 2 -clamp on a b.png",
            "-mm 0 1 -type sphere\ta b.png",
            "-texres 512 -blendu off -bm 0.3 a b.png",
        ] {
            assert_eq!(without_options(map), "a b.png");
        }
        assert_eq!(without_options("-o"), "");
    }
}
