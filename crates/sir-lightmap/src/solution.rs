//! The solution of which a lightmap is made.

use std::path::Path;

use glam::DVec3;
use sir_geom::{Rgb, Scene};
use sir_mesh::PatchMesh;

/// The solution of which a lightmap is made.
#[derive(Clone, Copy)]
pub struct Solution<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its patches.
    pub mesh: &'a PatchMesh,
    /// Irradiance of each side of a patch \[W/m²\].
    pub irradiance: &'a [Rgb],
    /// Standard error of the irradiance of each side \[W/m²\].
    pub errors: &'a [Rgb],
    /// True if `irradiance` was denoised, for the manifest.
    pub is_denoised: bool,
    /// Direct irradiance of each side \[W/m²\], if direct and reflected light are wanted apart.
    pub direct: Option<&'a [Rgb]>,
    /// File from which the scene was read.
    pub source: &'a Path,
    /// Length of a unit of the file \[m\].
    pub scale: f64,
    /// Direction of the scene that is up.
    pub up: DVec3,
}
