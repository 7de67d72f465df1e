//! Material libraries.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use crate::builder::SceneBuilder;
use crate::color::Rgb;
use crate::index::MaterialId;
use crate::load::error::LoadError;
use crate::load::files;
use crate::load::notes::{Notes, quoted};
use crate::load::obj::clean::{self, line_at};
use crate::load::obj::map;
use crate::load::options::{DEFAULT_REFLECTANCE, LoadOptions};
use crate::load::texture;
use crate::load::texture::{Image, Images, Layer, Placement};
use crate::material::{MAX_REFLECTANCE, Material, Opacity, Sides};
use crate::texture::Texture;

/// Materials of all libraries of an OBJ file that its faces use.
#[derive(Debug)]
pub(super) struct Library<'a> {
    /// Names of the materials to read.
    wanted: &'a BTreeSet<String>,
    /// True if vertices have colors.
    is_colored: bool,
    options: LoadOptions,
    builder: &'a mut SceneBuilder,
    materials: Vec<Known>,
    /// Indices in `materials`; of equal names, the last counts.
    pub(super) by_name: BTreeMap<String, usize>,
    /// Images read so far, by path and by whether their brightness became their alpha.
    textures: HashMap<(PathBuf, bool), Option<Image>>,
    images: Images,
    /// Library files that were tried.
    read: HashSet<PathBuf>,
}

/// Data about a material that its faces need.
#[derive(Debug)]
pub(super) struct Known {
    pub(super) id: MaterialId,
    /// Transforms of the coordinate sets of its textures.
    pub(super) placements: Vec<Placement>,
}

impl<'a> Library<'a> {
    /// Creates a library that reads the materials with these names.
    pub(super) fn new(
        wanted: &'a BTreeSet<String>,
        is_colored: bool,
        options: LoadOptions,
        builder: &'a mut SceneBuilder,
    ) -> Self {
        Self {
            wanted,
            is_colored,
            options,
            builder,
            materials: Vec::new(),
            by_name: BTreeMap::new(),
            textures: HashMap::new(),
            images: Images::default(),
            read: HashSet::new(),
        }
    }

    /// Returns the materials, in the order of the indices in `by_name`.
    pub(super) fn finish(self) -> Vec<Known> {
        self.materials
    }

    /// Reads the libraries of an `mtllib` statement of the file `obj`: one file whose name may contain blanks, or else
    /// several files.
    pub(super) fn add(&mut self, obj: &Path, names: &str, notes: &mut Notes) -> Result<(), LoadError> {
        let whole = plain_name(names);
        if files::beside(obj, &whole).is_some_and(|path| path.is_file()) {
            return self.add_file(obj, &whole, notes);
        }
        // In a list of names, a backslash precedes a blank inside a name.
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
        let clean::Mtl { text, ignored } =
            clean::mtl(&String::from_utf8_lossy(bytes)).map_err(|(line, what)| syntax(line, what))?;
        for keyword in ignored {
            notes.name("material properties do not apply to diffuse surfaces and were ignored", keyword);
        }
        let mut rest = text.as_bytes();
        let (materials, _) = tobj::load_mtl_buf(&mut rest).map_err(|e| {
            let (line, statement) = line_at(&text, text.len() - rest.len());
            syntax(line, format!("{e} in \"{statement}\""))
        })?;
        for source in materials.into_iter().filter(|m| self.wanted.contains(&m.name)) {
            self.by_name.insert(source.name.clone(), self.materials.len());
            let mut placements = Vec::new();
            let material = self.convert(&source, path, &mut placements, notes);
            let id = self.builder.add_material(self.options.sides.apply(material));
            self.materials.push(Known { id, placements });
        }
        Ok(())
    }

    fn convert(
        &mut self,
        source: &tobj::Material,
        mtl: &Path,
        sets: &mut Vec<Placement>,
        notes: &mut Notes,
    ) -> Material {
        let base = self.layer(mtl, source.diffuse_texture.as_ref(), false, sets, notes);
        let reflectance = match source.diffuse {
            Some(factor) => Rgb::from_array(factor),
            None if base.is_some() => Rgb::ONE,
            None if self.is_colored => Rgb::splat(MAX_REFLECTANCE),
            None => {
                notes.name("materials have no diffuse color, and are made gray", &source.name);
                Rgb::splat(DEFAULT_REFLECTANCE)
            }
        };
        let radiance = source.emissive.map_or(Rgb::ZERO, Rgb::from_array);
        let map = source.unknown_param.get("map_Ke").filter(|_| radiance != Rgb::ZERO);
        let emissive = self.layer(mtl, map, false, sets, notes);
        let mask = self.layer(mtl, source.dissolve_texture.as_ref(), true, sets, notes);
        let mut material = Material::diffuse(&source.name, Rgb::ZERO).with_sides(Sides::Both);
        (material.reflectance, material.reflectance_map) = texture::color(reflectance, base.as_ref());
        (material.exitance, material.exitance_map) = texture::color(PI * radiance, emissive.as_ref());
        material.opacity = self.opacity(source, mask.as_ref(), notes);
        material
    }

    /// Returns the opacity: the number `d`, or `1 − Tr` if only `Tr` is given, times the mask.
    fn opacity(&self, source: &tobj::Material, mask: Option<&Layer>, notes: &mut Notes) -> Opacity {
        let transparency = source.unknown_param.get("Tr").and_then(|tr| tr.parse::<f64>().ok());
        let factor = match (source.dissolve, transparency) {
            (Some(d), _) => d,
            // Exporters that write this mean an opacity of one: nobody makes a fully transparent surface.
            (None, Some(1.0)) => {
                notes.name("materials have Tr 1 and no d, and were made opaque", quoted(&source.name));
                1.0
            }
            (None, Some(tr)) => 1.0 - tr,
            (None, None) => 1.0,
        };
        texture::opacity(factor.clamp(0.0, 1.0), mask, None)
    }

    /// Returns the texture of a `map_…` statement of a library. If it `is_mask`, its alpha is that of a mask.
    fn layer(
        &mut self,
        mtl: &Path,
        statement: Option<&String>,
        is_mask: bool,
        sets: &mut Vec<Placement>,
        notes: &mut Notes,
    ) -> Option<Layer> {
        let map::Map { name, placement, wrap, ignored } = map::parse(statement?);
        for option in ignored {
            notes.name("texture options were ignored", option);
        }
        let name = plain_name(name);
        let Some(path) = files::beside(mtl, &name) else {
            notes.name("textures are not in the folder of the scene, and were not read", &name);
            return None;
        };
        let colors = (path.clone(), false);
        let image = match self.textures.get(&colors).copied() {
            Some(None) => None,
            Some(Some(image)) if !is_mask || image.has_alpha() => Some(image),
            _ => self.image(path, &name, is_mask, notes),
        };
        Some(Layer::new(image?, wrap, placement, sets))
    }

    /// Returns an image, which is read on first use. A mask without alpha gets its brightness as alpha.
    fn image(&mut self, path: PathBuf, name: &str, is_mask: bool, notes: &mut Notes) -> Option<Image> {
        if let Some(&image) = self.textures.get(&(path.clone(), is_mask)) {
            return image;
        }
        let bytes = files::read(&path).map_err(|e| e.to_string());
        let (image, from_brightness) = match bytes.and_then(|bytes| self.images.decode(&bytes)) {
            Ok(texture) => {
                let from_brightness = is_mask && texture.texels().iter().all(|texel| texel[3] == 255);
                let texture = if from_brightness { brightness_as_alpha(&texture) } else { Some(texture) };
                (texture.map(|t| self.images.add(t, name, self.builder, notes)), from_brightness)
            }
            Err(e) => {
                notes.name(texture::UNREADABLE, format!("{name} ({e})"));
                (None, false)
            }
        };
        self.textures.insert((path, from_brightness), image);
        image
    }
}

/// Returns a mask from the brightness of an image without alpha. Color values are used as stored, without sRGB
/// decoding.
fn brightness_as_alpha(texture: &Texture) -> Option<Texture> {
    let [width, height] = texture.size();
    let mask = |&[r, g, b, _]: &[u8; 4]| {
        // Luminance weights (ITU-R BT.709), scaled such that gray keeps its value.
        let sum = 2126 * u32::from(r) + 7152 * u32::from(g) + 722 * u32::from(b);
        [255, 255, 255, ((sum + 5000) / 10_000) as u8]
    };
    Texture::new(width, height, texture.texels().iter().map(mask).collect())
}

/// Returns a file name without quotes, with forward slashes.
fn plain_name(name: &str) -> String {
    name.trim_matches('"').replace('\\', "/")
}
