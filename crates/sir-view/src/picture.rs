//! Pictures: the radiance that a camera sees.

use crate::error::ViewError;

/// A picture of linear radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Radiance `L` \[W/(m² sr)\] in linear Rec. 709 bands, row by row from the top left.
    pub radiance: Vec<[f32; 3]>,
    /// The same for the screen: a mean over the rays of a pixel in which rays much brighter than is typical of the
    /// scene have less weight. It differs from `radiance` only in pixels that partly show a lamp. Without the weights,
    /// a pixel a tenth of which is lamp would be as white as the lamp, and the edge would be jagged.
    pub shown: Vec<[f32; 3]>,
    /// Share of the rays of each pixel that met a surface; the others saw the sky.
    pub surface: Vec<f32>,
}

/// Size and sampling of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureSettings {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Rays per pixel in each direction: a pixel is the mean of a stratified sample of `grid²` rays, one in each cell
    /// of a square grid.
    pub grid: u32,
    /// Number of threads; the picture does not depend on it.
    pub threads: usize,
}

impl PictureSettings {
    /// Largest width and height that every file format can hold.
    const MAX: u32 = 65_535;

    pub(crate) fn check(&self) -> Result<(), ViewError> {
        let fits = |x: u32| (1..=Self::MAX).contains(&x);
        if fits(self.width) && fits(self.height) {
            Ok(())
        } else {
            Err(ViewError::PictureSize { width: self.width, height: self.height })
        }
    }
}
