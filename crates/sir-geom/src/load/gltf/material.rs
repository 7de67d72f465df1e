//! Materials and their textures.

use std::f64::consts::PI;

use ::gltf::json::Index;
use ::gltf::json::material::{AlphaMode, Material as Source};
use ::gltf::json::texture::{Info, WrappingMode};
use ::gltf::json::validation::Checked;
use glam::DVec2;

use crate::color::Rgb;
use crate::load::error::LoadError;
use crate::load::gltf::data::lookup;
use crate::load::gltf::known::{Alpha, Coordinates, Known};
use crate::load::gltf::reader::Reader;
use crate::load::notes;
use crate::load::options::DEFAULT_REFLECTANCE;
use crate::load::texture;
use crate::load::texture::{Image, Layer, Placement};
use crate::material::{MAX_REFLECTANCE, Material, Opacity, Sides};
use crate::texture::Wrap;

/// Index that the crate `gltf` gives to the image of a texture without one.
const NO_IMAGE: usize = u32::MAX as usize;

impl Reader<'_> {
    /// Returns the material at an index of the file, which is added on first use. `None` is the default material, which
    /// is white if vertices have colors.
    pub(super) fn material(
        &mut self,
        index: Option<Index<Source>>,
        is_colored: bool,
    ) -> Result<Known, LoadError> {
        let key = (index.map(|i| i.value()), index.is_none() && is_colored);
        if key == (None, false) {
            self.notes.count("mesh primitives have no material, and are made gray", 1);
        }
        if let Some(known) = self.materials.get(&key) {
            return Ok(known.clone());
        }
        let mut sets = Vec::new();
        let (material, alpha) = match index {
            Some(index) => {
                let source = lookup(self.data.path, self.data.root, index, "a mesh primitive: material")?;
                (self.convert(source, &mut sets)?, alpha(source))
            }
            None => {
                let reflectance = if is_colored { MAX_REFLECTANCE } else { DEFAULT_REFLECTANCE };
                (Material::diffuse("", Rgb::splat(reflectance)), Alpha::Opaque)
            }
        };
        let id = self.builder.add_material(self.options.sides.apply(material));
        let known = Known { id, sets: sets.into(), alpha };
        self.materials.insert(key, known.clone());
        Ok(known)
    }

    /// Converts a material: base color to reflectance, emitted radiance `L` to exitance `π L` (the emitted light of
    /// glTF is a radiance in cd/m²; specification, section 3.9.3).
    ///
    /// The base color of a metal is its specular reflectance. Used as a diffuse reflectance, it sends the right amount
    /// of light in the wrong directions; without it, metals would be black.
    fn convert(&mut self, source: &Source, sets: &mut Vec<Coordinates>) -> Result<Material, LoadError> {
        let name = source.name.as_deref().unwrap_or_default();
        self.note_ignored(source, name);
        let ([r, g, b, a], info) = base_color(source);
        let base = self.layer(info, sets)?;
        let mut radiance = Rgb::from_array(source.emissive_factor.0.map(f64::from));
        let emissive = match radiance == Rgb::ZERO {
            true => None,
            false => self.layer(source.emissive_texture.as_ref(), sets)?,
        };
        if let Some(strength) = source.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref()) {
            radiance *= f64::from(strength.emissive_strength.0);
        }
        let mut material = Material::diffuse(name, Rgb::ZERO);
        (material.reflectance, material.reflectance_map) = texture::color(Rgb::new(r, g, b), base.as_ref());
        (material.exitance, material.exitance_map) = texture::color(PI * radiance, emissive.as_ref());
        material.opacity = match alpha(source) {
            Alpha::Opaque => Opacity::default(),
            Alpha::Mask => {
                let cutoff = source.alpha_cutoff.map_or(0.5, |cutoff| as_written(cutoff.0));
                texture::opacity(a, base.as_ref(), Some(cutoff))
            }
            Alpha::Blend => texture::opacity(a, base.as_ref(), None),
        };
        if source.double_sided {
            material.sides = Sides::Both;
            material.back_emits = true;
        }
        Ok(material)
    }

    fn note_ignored(&mut self, source: &Source, name: &str) {
        let name = notes::quoted(name);
        if source.extensions.as_ref().is_some_and(|e| e.unlit.is_some()) {
            self.notes
                .name("materials are unlit, which is not supported: they reflect their base color", &name);
        }
        if source.normal_texture.is_some()
            || source.occlusion_texture.is_some()
            || source.pbr_metallic_roughness.metallic_roughness_texture.is_some()
        {
            self.notes.name(
                "materials have normal, metallic-roughness or occlusion textures, which were ignored",
                &name,
            );
        }
        if !matches!(source.alpha_mode, Checked::Valid(_)) {
            self.notes.name("materials have an unknown alpha mode, and were made opaque", &name);
        }
    }

    /// Returns the texture on a surface; `None` if there is none or it cannot be read.
    fn layer(
        &mut self,
        info: Option<&Info>,
        sets: &mut Vec<Coordinates>,
    ) -> Result<Option<Layer>, LoadError> {
        let Some(info) = info else { return Ok(None) };
        let source = lookup(self.data.path, self.data.root, info.index, "a material: texture")?;
        let wrap = match source.sampler {
            Some(index) => {
                let sampler = lookup(self.data.path, self.data.root, index, "a texture: sampler")?;
                [sampler.wrap_s, sampler.wrap_t].map(wrap)
            }
            None => [Wrap::Repeat; 2],
        };
        let image = match source.source.value() {
            NO_IMAGE => self.without_image(info.index.value()),
            image => self.decoded(image),
        };
        Ok(image.map(|image| Layer::new(image, wrap, coordinates(info), sets)))
    }

    /// Returns an image of the file, which is read on first use.
    fn decoded(&mut self, index: usize) -> Option<Image> {
        let pixels = self.data.pixels(index);
        if let Some(&image) = self.textures.get(&pixels) {
            return image;
        }
        let name = format!("image {index}");
        let texture = self.data.image(index, &pixels).and_then(|bytes| self.images.decode(&bytes));
        let image = match texture {
            Ok(texture) => Some(self.images.add(texture, &name, self.builder, self.notes)),
            Err(e) => {
                self.notes.name(texture::UNREADABLE, format!("{name} ({e})"));
                None
            }
        };
        self.textures.insert(pixels, image);
        image
    }

    /// Notes that a texture has no image.
    fn without_image(&mut self, texture: usize) -> Option<Image> {
        let formats = self.data.document.textures.get(&texture).map(|names| names.join(" and "));
        let why = match formats.filter(|names| !names.is_empty()) {
            Some(names) => format!("it has no PNG or JPEG image, only one for {names}"),
            None => "it has no image".to_owned(),
        };
        self.notes.name(texture::UNREADABLE, format!("texture {texture} ({why})"));
        None
    }
}

/// Returns the base color with alpha, and its texture.
///
/// With `KHR_materials_pbrSpecularGlossiness` this is the diffuse color or, if that is black as for metals, the
/// specular color.
fn base_color(source: &Source) -> ([f64; 4], Option<&Info>) {
    let glossy = source.extensions.as_ref().and_then(|e| e.pbr_specular_glossiness.as_ref());
    let (factor, info) = match glossy {
        Some(glossy) if glossy.diffuse_factor.0[..3] == [0.0; 3] => {
            let [r, g, b] = glossy.specular_factor.0;
            // The alpha of this texture is the glossiness.
            let info = glossy.specular_glossiness_texture.as_ref();
            ([r, g, b, glossy.diffuse_factor.0[3]], info.filter(|_| alpha(source) == Alpha::Opaque))
        }
        Some(glossy) => (glossy.diffuse_factor.0, glossy.diffuse_texture.as_ref()),
        None => {
            let pbr = &source.pbr_metallic_roughness;
            (pbr.base_color_factor.0, pbr.base_color_texture.as_ref())
        }
    };
    (factor.map(f64::from), info)
}

fn alpha(source: &Source) -> Alpha {
    match source.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => Alpha::Mask,
        Checked::Valid(AlphaMode::Blend) => Alpha::Blend,
        _ => Alpha::Opaque,
    }
}

/// Returns the number with the fewest digits that rounds to `x` in single precision. An alpha equal to the threshold
/// must pass it: 51/255 is 0.2, which is less than the 0.2 of single precision.
fn as_written(x: f32) -> f64 {
    x.to_string().parse().unwrap_or_else(|_| f64::from(x))
}

fn wrap(mode: Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

/// Returns the texture coordinates of a texture: scaled, then rotated, then translated (`KHR_texture_transform`).
///
/// The rotation is counterclockwise in the plane of the image, whose second axis points down. The matrix in the text of
/// the extension has the opposite sign, which its authors and all readers consider a mistake (Khronos' glTF issue
/// 1563).
fn coordinates(info: &Info) -> Coordinates {
    let plain = Coordinates { set: info.tex_coord, placement: Placement::PLAIN };
    let Some(transform) = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref()) else {
        return plain;
    };
    let [x, y] = transform.scale.0.map(f64::from);
    let (sin, cos) = libm::sincos(f64::from(transform.rotation.0));
    let offset = DVec2::from_array(transform.offset.0.map(f64::from));
    let placement = Placement { x_axis: x * DVec2::new(cos, -sin), y_axis: y * DVec2::new(sin, cos), offset };
    Coordinates { set: transform.tex_coord.unwrap_or(plain.set), placement }
}
