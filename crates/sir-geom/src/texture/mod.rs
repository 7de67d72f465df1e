//! Textures: images that vary the colors of surfaces.

mod halved;
mod image;
mod sums;

#[cfg(feature = "obj")]
pub(crate) use image::srgb_to_linear_at;
pub use image::{ColorMap, Texture, TextureId, TextureMap, Wrap};
pub use sums::{TextureMean, TextureSums};
