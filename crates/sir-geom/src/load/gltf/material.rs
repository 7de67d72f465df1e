//! Materials and their textures.

use std::f64::consts::PI;

use ::gltf::json::Index;
use ::gltf::json::material::Material as Source;
use ::gltf::json::texture::Info;

use super::super::{DEFAULT_REFLECTANCE, texture};
use super::{LoadError, Reader, container, lookup};
use crate::{Material, MaterialId, Rgb, Sides};

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
        let mean = match self.textures.get(&image) {
            Some(&mean) => mean,
            None => {
                let mean = self.image(image).and_then(|bytes| texture::mean_colour(&bytes));
                let mean = mean
                    .inspect_err(|e| self.notes.name(texture::UNREADABLE, format!("image {image} ({e})")));
                *self.textures.entry(image).or_insert(mean.ok())
            }
        };
        Ok(mean.unwrap_or(Rgb::ONE))
    }

    /// The encoded bytes of an image.
    fn image(&self, index: usize) -> Result<Vec<u8>, String> {
        let image = self.root.images.get(index).ok_or("it does not exist in a known format")?;
        match (&image.uri, image.buffer_view) {
            (Some(uri), _) => {
                container::fetch(self.path, uri, || format!("image {index}")).map_err(|e| match e {
                    LoadError::Read { path, source } => format!("{}: {source}", path.display()),
                    LoadError::Reference { why, .. } => why,
                    other => other.to_string(),
                })
            }
            (None, Some(view)) => match self.view(view, "an image") {
                Ok((bytes, _)) => Ok(bytes.to_vec()),
                Err(LoadError::Gltf { what, .. }) => Err(what),
                Err(other) => Err(other.to_string()),
            },
            (None, None) => Err("it has no data".to_owned()),
        }
    }
}
