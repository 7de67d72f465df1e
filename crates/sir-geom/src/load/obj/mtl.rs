//! Material libraries (MTL): statements of the materials that faces use.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use crate::color::Rgb;
use crate::load::error::LoadError;
use crate::load::files::{self, shortened};
use crate::load::notes::Notes;
use crate::load::obj::file_name;
use crate::load::obj::text::{number, shown, split_word, start_of, statements, words};
use crate::text::utf8_text;

/// Keywords about gloss, refraction and ambient light, which are ignored without a warning, since most libraries have
/// them.
const SILENTLY_IGNORED: [&[u8]; 8] = [b"illum", b"ka", b"ks", b"ni", b"ns", b"tf", b"map_ka", b"sharpness"];

/// Statements of a material that affect diffuse surfaces.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Statements {
    /// `Kd`.
    pub(super) diffuse: Option<Rgb>,
    /// `Ke`.
    pub(super) emissive: Option<Rgb>,
    /// `d`.
    pub(super) opacity: Option<f64>,
    /// `Tr`.
    pub(super) transparency: Option<f64>,
    /// Options and file name of `map_Kd`.
    pub(super) diffuse_map: Option<Vec<u8>>,
    /// Options and file name of `map_Ke`.
    pub(super) emissive_map: Option<Vec<u8>>,
    /// Options and file name of `map_d`.
    pub(super) mask: Option<Vec<u8>>,
}

/// Material of a library.
#[derive(Debug)]
pub(super) struct Source {
    /// Name as in the library.
    pub(super) name: Vec<u8>,
    /// Library, in whose folder textures are.
    pub(super) library: Rc<Path>,
    pub(super) statements: Statements,
}

/// Reader of the libraries of an OBJ file.
#[derive(Debug)]
pub(super) struct Libraries<'a> {
    /// Names of the materials to read.
    wanted: HashSet<&'a [u8]>,
    /// Materials in the order of their first definition; of equal names, the last definition counts.
    materials: Vec<Source>,
    indices: HashMap<Vec<u8>, usize>,
    /// Library files that were tried.
    read: HashSet<PathBuf>,
}

impl<'a> Libraries<'a> {
    /// Creates a reader of the materials with these names.
    pub(super) fn new(wanted: impl IntoIterator<Item = &'a [u8]>) -> Self {
        Self {
            wanted: wanted.into_iter().collect(),
            materials: Vec::new(),
            indices: HashMap::new(),
            read: HashSet::new(),
        }
    }

    /// Returns the materials that were found.
    pub(super) fn finish(self) -> Vec<Source> {
        self.materials
    }

    /// Reads the libraries of an `mtllib` statement of the file `obj`: one file whose name may contain blanks, or else
    /// several files.
    pub(super) fn add(&mut self, obj: &Path, names: &[u8], notes: &mut Notes) -> Result<(), LoadError> {
        if file_name::find(obj, names).is_some_and(|path| path.is_file()) {
            return self.add_file(obj, names, notes);
        }
        // In a list of names, a backslash precedes a blank inside a name.
        let (mut name, mut words) = (Vec::new(), words(names).peekable());
        while let Some(word) = words.next() {
            name.extend(word);
            if words.peek().is_some() && name.pop_if(|last| *last == b'\\').is_some() {
                name.push(b' ');
            } else {
                self.add_file(obj, &std::mem::take(&mut name), notes)?;
            }
        }
        Ok(())
    }

    /// Reads one library, unless it was read before.
    fn add_file(&mut self, obj: &Path, name: &[u8], notes: &mut Notes) -> Result<(), LoadError> {
        let shown = || shown(file_name::unquoted(name));
        let Some(path) = file_name::find(obj, name) else {
            notes.name("material libraries are not in the folder of the scene, and were not read", shown());
            return Ok(());
        };
        if !self.read.insert(path.clone()) {
            return Ok(());
        }
        match files::read(&path) {
            Ok(bytes) => self.parse(path.into(), &utf8_text(bytes), notes)?,
            Err(_) => notes.name("material libraries cannot be read", shown()),
        }
        Ok(())
    }

    /// Reads the statements of a library about materials that are wanted.
    fn parse(&mut self, path: Rc<Path>, text: &[u8], notes: &mut Notes) -> Result<(), LoadError> {
        let mut current = None;
        for (line, statement) in statements(text) {
            let (keyword, rest) = split_word(&statement);
            if keyword.eq_ignore_ascii_case(b"newmtl") {
                current = self.wanted.contains(rest).then(|| self.define(rest, &path));
            } else if let Some(i) = current {
                let Source { name, statements, .. } = &mut self.materials[i];
                statements.add(name, &statement, notes).map_err(|what| {
                    let what = format!("{} {what}", start_of(&statement));
                    LoadError::Syntax { path: path.to_path_buf(), line, what }
                })?;
            }
        }
        Ok(())
    }

    /// Returns the index of a new material, which replaces one of the same name.
    fn define(&mut self, name: &[u8], library: &Rc<Path>) -> usize {
        let new =
            Source { name: name.to_owned(), library: library.clone(), statements: Statements::default() };
        let i = *self.indices.entry(name.to_owned()).or_insert(self.materials.len());
        match self.materials.get_mut(i) {
            Some(old) => *old = new,
            None => self.materials.push(new),
        }
        i
    }
}

impl Statements {
    /// Adds a statement about the material `name`. The error completes a sentence that begins with the statement.
    fn add(&mut self, name: &[u8], statement: &[u8], notes: &mut Notes) -> Result<(), &'static str> {
        let (keyword, rest) = split_word(statement);
        let has_words = !rest.is_empty();
        match &*keyword.to_ascii_lowercase() {
            b"kd" | b"ke" if matches!(split_word(rest).0, b"spectral" | b"xyz") => {
                let what = "materials have spectral or CIE XYZ colors, which are not read";
                notes.name(what, shown(name));
            }
            b"kd" => self.diffuse = Some(color(rest)?),
            b"ke" => self.emissive = Some(color(rest)?),
            b"d" if has_words => self.opacity = Some(last_number(rest)?),
            b"tr" if has_words => self.transparency = Some(last_number(rest)?),
            b"map_kd" if has_words => self.diffuse_map = Some(rest.to_owned()),
            b"map_ke" if has_words => self.emissive_map = Some(rest.to_owned()),
            b"map_d" if has_words => self.mask = Some(rest.to_owned()),
            b"" | b"d" | b"tr" | b"map_kd" | b"map_ke" | b"map_d" => {}
            other if SILENTLY_IGNORED.contains(&other) => {}
            _ => notes.name(
                "material properties do not apply to diffuse surfaces and were ignored",
                shortened(&shown(keyword), 40),
            ),
        }
        Ok(())
    }
}

/// Parses a color. One number stands for three (the MTL specification allows this for all colors).
fn color(rest: &[u8]) -> Result<Rgb, &'static str> {
    let numbers: Option<Vec<f64>> = words(rest).take(3).map(number).collect();
    let color = match numbers.as_deref() {
        Some(&[x]) => Rgb::splat(x),
        Some(&[r, g, b]) => Rgb::new(r, g, b),
        _ => return Err("must have one or three numbers, with a point before decimals"),
    };
    let is_valid = color.is_finite() && color.min_element() >= 0.0;
    if is_valid { Ok(color) } else { Err("must have finite numbers that are not negative") }
}

/// Parses the last word, since there may be an option `-halo` before the number.
fn last_number(rest: &[u8]) -> Result<f64, &'static str> {
    let last = words(rest).last().and_then(number).filter(|x| x.is_finite());
    last.ok_or("must have a finite number, with a point before decimals")
}
