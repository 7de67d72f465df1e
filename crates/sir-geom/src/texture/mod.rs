//! Textures: images that say how a surface's colors vary on it.

mod halved;
mod image;
mod sums;

#[cfg(feature = "obj")]
pub(crate) use image::srgb_to_linear_at;
pub use image::{ColorMap, Texture, TextureId, TextureMap, Wrap};
pub use sums::{TextureMean, TextureSums};
