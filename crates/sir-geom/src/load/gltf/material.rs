//! Materials and their textures.

use std::f64::consts::PI;
use std::path::PathBuf;

use ::gltf::json::Index;
use ::gltf::json::material::Material as Source;
use ::gltf::json::texture::Info;

use super::super::files::{self, Reference};
use super::super::{DEFAULT_REFLECTANCE, texture};
use super::{LoadError, Reader, lookup};
use crate::{Material, MaterialId, Rgb, Sides};

/// Where the encoded bytes of an image lie. Images may share them, and large ones take time to decode.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Pixels {
    /// In a buffer view.
    View(usize),
    /// In a file.
    File(PathBuf),
    /// In the URI of this image, or nowhere.
    Own(usize),
}

impl Reader<'_> {
    /// The material at an index of the file, added when it is first used; `None` is the default material.
    pub(super) fn material(&mut self, index: Option<Index<Source>>) -> Result<MaterialId, LoadError> {
        let key = index.map(|i| i.value());
        if key.is_none() {
            self.notes.count("mesh primitives have no material, and are made grey", 1);
        }
        if let Some(&id) = self.materials.get(&key) {
            return Ok(id);
        }
        let material = match index {
            Some(index) => {
                self.convert(lookup(self.path, self.root, index, "a mesh primitive: material")?)?
            }
            None => Material::diffuse("", Rgb::splat(DEFAULT_REFLECTANCE)),
        };
        let id = self.builder.add_material(self.options.sides.apply(material));
        self.materials.insert(key, id);
        Ok(id)
    }

    /// Base colour to reflectance, emitted radiance `L` to exitance `π L` (the emitted light of glTF is a
    /// radiance in cd/m²; specification, section 3.9.3).
    fn convert(&mut self, source: &Source) -> Result<Material, LoadError> {
        let pbr = &source.pbr_metallic_roughness;
        let [r, g, b, _] = pbr.base_color_factor.0.map(f64::from);
        let reflectance = Rgb::new(r, g, b) * self.mean(pbr.base_color_texture.as_ref())?;
        let mut radiance = Rgb::from_array(source.emissive_factor.0.map(f64::from));
        if radiance != Rgb::ZERO {
            radiance *= self.mean(source.emissive_texture.as_ref())?;
        }
        if let Some(strength) = source.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref()) {
            radiance *= f64::from(strength.emissive_strength.0);
        }
        let name = source.name.as_deref().unwrap_or_default();
        let mut material = Material::diffuse(name, reflectance).emitting(PI * radiance);
        if source.double_sided {
            material.sides = Sides::Both;
            material.back_emits = true;
        }
        Ok(material)
    }

    /// Mean colour of a texture; one where there is none or it cannot be read.
    fn mean(&mut self, info: Option<&Info>) -> Result<Rgb, LoadError> {
        let Some(info) = info else {
            return Ok(Rgb::ONE);
        };
        let image = lookup(self.path, self.root, info.index, "a material: texture")?.source.value();
        let pixels = self.pixels(image);
        let mean = match self.textures.get(&pixels) {
            Some(&mean) => mean,
            None => {
                let mean = self
                    .image(image, &pixels)
                    .and_then(|bytes| texture::decode(&bytes).map(|t| t.mean_colour()));
                let mean = mean
                    .inspect_err(|e| self.notes.name(texture::UNREADABLE, format!("image {image} ({e})")));
                *self.textures.entry(pixels).or_insert(mean.ok())
            }
        };
        Ok(mean.unwrap_or(Rgb::ONE))
    }

    fn pixels(&self, index: usize) -> Pixels {
        let image = self.root.images.get(index);
        match image.map(|image| (&image.uri, image.buffer_view)) {
            Some((Some(uri), _)) if !uri.starts_with("data:") => match files::resolve(self.path, uri) {
                Ok(Reference::File(path)) => Pixels::File(path),
                _ => Pixels::Own(index),
            },
            Some((None, Some(view))) => Pixels::View(view.value()),
            _ => Pixels::Own(index),
        }
    }

    /// The encoded bytes of an image.
    fn image(&self, index: usize, pixels: &Pixels) -> Result<Vec<u8>, String> {
        let image = self.root.images.get(index).ok_or("it does not exist in a known format")?;
        match (pixels, &image.uri, image.buffer_view) {
            (Pixels::File(path), ..) => {
                files::read(path).map_err(|source| format!("{}: {source}", path.display()))
            }
            (_, Some(uri), _) => match files::resolve(self.path, uri)? {
                Reference::Data(bytes) => Ok(bytes),
                Reference::File(_) => Err("it has no data".to_owned()),
            },
            (_, None, Some(view)) => match self.view(view, "an image") {
                Ok((bytes, _)) => Ok(bytes.to_vec()),
                Err(LoadError::Gltf { what, .. }) => Err(what),
                Err(other) => Err(other.to_string()),
            },
            (_, None, None) => Err("it has no data".to_owned()),
        }
    }
}
