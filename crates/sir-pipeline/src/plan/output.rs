//! Files that a run writes.

use std::ops::Range;
use std::path::PathBuf;

use sir_geom::Camera;
use sir_view::Exposure;

/// A file to write.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its path inside the run directory.
    pub path: PathBuf,
    /// What it holds.
    pub content: Content,
}

/// What an output file holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// A picture.
    Image(Image),
    /// The lit mesh, as binary glTF.
    Gltf,
    /// Radiosity, irradiance and error of every patch, as CSV or NPY.
    Table,
}

/// A picture of the solution.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width in pixels. Default 800.
    pub width: u32,
    /// Height in pixels. Default: as the shape of the camera asks for, else three
    /// quarters of the width.
    pub height: Option<u32>,
    /// Samples per pixel along each edge: 4 means 4 × 4 samples. Default 4.
    pub samples: u32,
    /// How bright a PNG picture is made. Default `Auto`.
    pub exposure: Exposure,
    /// Whether noise is taken out of a PNG picture. Default `true`.
    pub denoise: bool,
    /// From where it is taken.
    pub camera: CameraChoice,
}

/// The point of view of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum CameraChoice {
    /// The first camera of the scene, or, if it has none, one from which all of the scene is seen.
    #[default]
    Default,
    /// A camera of the scene by its number, from 0.
    Number {
        /// The number.
        number: usize,
        /// Where the pipeline says so.
        span: Range<usize>,
    },
    /// A camera of the scene by its name.
    Name {
        /// The name.
        name: String,
        /// Where the pipeline says so.
        span: Range<usize>,
    },
    /// A camera that the pipeline describes.
    Own(Camera),
}
