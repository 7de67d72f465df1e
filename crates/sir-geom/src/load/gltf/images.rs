//! Encoded images.

use crate::load::error::LoadError;
use crate::load::files;
use crate::load::gltf::data::Data;
use crate::load::gltf::known::Pixels;
use crate::load::gltf::uri::{self, Reference};

impl Data<'_> {
    /// Returns the location of the encoded bytes of an image.
    pub(super) fn pixels(&self, index: usize) -> Pixels {
        let image = self.root.images.get(index);
        match image.map(|image| (&image.uri, image.buffer_view)) {
            Some((Some(uri), _)) if !uri::is_data(uri) => match uri::resolve(self.path, uri) {
                Ok(Reference::File(path)) => Pixels::File(path),
                _ => Pixels::Own(index),
            },
            Some((None, Some(view))) => Pixels::View(view.value()),
            _ => Pixels::Own(index),
        }
    }

    /// Returns the encoded bytes of the image with this index, which are at `pixels`.
    pub(super) fn image(&self, index: usize, pixels: &Pixels) -> Result<Vec<u8>, String> {
        let image = self.root.images.get(index).ok_or("it does not exist")?;
        match (pixels, &image.uri, image.buffer_view) {
            (Pixels::File(path), ..) => {
                files::read(path).map_err(|source| format!("{}: {source}", path.display()))
            }
            (_, Some(uri), _) => match uri::resolve(self.path, uri)? {
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
