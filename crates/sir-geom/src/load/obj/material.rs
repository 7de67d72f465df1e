//! Materials of a scene from statements of material libraries.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use crate::builder::SceneBuilder;
use crate::color::Rgb;
use crate::index::MaterialId;
use crate::load::files;
use crate::load::notes::{Notes, quoted};
use crate::load::obj::file_name;
use crate::load::obj::map;
use crate::load::obj::mtl::{Source, Statements};
use crate::load::obj::text::shown;
use crate::load::options::{DEFAULT_REFLECTANCE, LoadOptions};
use crate::load::texture;
use crate::load::texture::{Image, Images, Layer, Placement};
use crate::material::{MAX_REFLECTANCE, Material, Opacity, Sides};
use crate::texture::Texture;

/// Data about a material that its faces need.
#[derive(Debug)]
pub(super) struct Known {
    pub(super) id: MaterialId,
    /// Name, in readable form.
    pub(super) name: String,
    pub(super) emits: bool,
    /// Transforms of the coordinate sets of its textures.
    pub(super) placements: Vec<Placement>,
}

/// Converter of materials, which reads their textures.
#[derive(Debug)]
pub(super) struct Converter<'a> {
    /// True if vertices have colors.
    pub(super) is_colored: bool,
    pub(super) options: LoadOptions,
    pub(super) builder: &'a mut SceneBuilder,
    pub(super) notes: &'a mut Notes,
    /// Images read so far, by path and by whether their brightness became their alpha.
    pub(super) textures: HashMap<(PathBuf, bool), Option<Image>>,
    pub(super) images: Images,
}

impl Converter<'_> {
    /// Adds a material to the scene.
    pub(super) fn add(&mut self, source: &Source) -> Known {
        let Source { library, statements, .. } = source;
        let name = shown(&source.name);
        let mut placements = Vec::new();
        let material = self.convert(&name, statements, library, &mut placements);
        let emits = material.exitance != Rgb::ZERO;
        let id = self.builder.add_material(self.options.sides.apply(material));
        Known { id, name, emits, placements }
    }

    fn convert(
        &mut self,
        name: &str,
        source: &Statements,
        mtl: &Path,
        sets: &mut Vec<Placement>,
    ) -> Material {
        let base = self.layer(mtl, source.diffuse_map.as_deref(), false, sets);
        let reflectance = match source.diffuse {
            Some(factor) => factor,
            None if base.is_some() => Rgb::ONE,
            None if self.is_colored => Rgb::splat(MAX_REFLECTANCE),
            None => {
                self.notes.name("materials have no diffuse color, and are made gray", name);
                Rgb::splat(DEFAULT_REFLECTANCE)
            }
        };
        let radiance = source.emissive.unwrap_or(Rgb::ZERO);
        let map = source.emissive_map.as_deref().filter(|_| radiance != Rgb::ZERO);
        let emissive = self.layer(mtl, map, false, sets);
        let mask = self.layer(mtl, source.mask.as_deref(), true, sets);
        let mut material = Material::diffuse(name, Rgb::ZERO).with_sides(Sides::Both);
        (material.reflectance, material.reflectance_map) = texture::color(reflectance, base.as_ref());
        (material.exitance, material.exitance_map) = texture::color(PI * radiance, emissive.as_ref());
        material.opacity = self.opacity(name, source, mask.as_ref());
        material
    }

    /// Returns the opacity: the number `d`, or `1 − Tr` if only `Tr` is given, times the mask.
    fn opacity(&mut self, name: &str, source: &Statements, mask: Option<&Layer>) -> Opacity {
        let factor = match (source.opacity, source.transparency) {
            (Some(d), _) => d,
            // Exporters that write this mean an opacity of one: nobody makes a fully transparent surface.
            (None, Some(1.0)) => {
                self.notes.name("materials have Tr 1 and no d, and were made opaque", quoted(name));
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
        statement: Option<&[u8]>,
        is_mask: bool,
        sets: &mut Vec<Placement>,
    ) -> Option<Layer> {
        let map::Map { name, placement, wrap, ignored } = map::parse(statement?);
        for option in ignored {
            self.notes.name("texture options were ignored", option);
        }
        let shown = shown(file_name::unquoted(name));
        let Some(path) = file_name::find(mtl, name) else {
            self.notes.name("textures are not in the folder of the scene, and were not read", shown);
            return None;
        };
        let colors = (path.clone(), false);
        let image = match self.textures.get(&colors).copied() {
            Some(None) => None,
            Some(Some(image)) if !is_mask || image.has_alpha() => Some(image),
            _ => self.image(path, &shown, is_mask),
        };
        Some(Layer::new(image?, wrap, placement, sets))
    }

    /// Returns an image, which is read on first use. A mask without alpha gets its brightness as alpha.
    fn image(&mut self, path: PathBuf, name: &str, is_mask: bool) -> Option<Image> {
        if let Some(&image) = self.textures.get(&(path.clone(), is_mask)) {
            return image;
        }
        let bytes = files::read(&path).map_err(|e| e.to_string());
        let (image, from_brightness) = match bytes.and_then(|bytes| self.images.decode(&bytes)) {
            Ok(texture) => {
                let from_brightness = is_mask && texture.texels().iter().all(|texel| texel[3] == 255);
                let texture = if from_brightness { brightness_as_alpha(&texture) } else { Some(texture) };
                (texture.map(|t| self.images.add(t, name, self.builder, self.notes)), from_brightness)
            }
            Err(e) => {
                self.notes.name(texture::UNREADABLE, format!("{name} ({e})"));
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
