//! Luminaires of a case: a lamp, its files, its place, and the exact answers.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use serde::Deserialize;
use sir_geom::{Beam, Light, LightKind, Material, Rgb, SceneBuilder, Spread, Tabulated};
use sir_photometry::{OpeningLight, Photometry};

use crate::data::{Case, Point, Surface};
use crate::error::ValidateError;
use crate::luminaire::file::Opening;
use crate::luminaire::file_kind::FileKind;
use crate::luminaire::lamp::Lamp;

/// A luminaire among black surfaces.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Setup {
    pub(crate) name: String,
    pub(crate) lamp: Lamp,
    /// Formats of the file. All give the same answers.
    pub(crate) files: Vec<FileKind>,
    #[serde(default)]
    pub(crate) opening: Option<Opening>,
    pub(crate) position: [f64; 3],
    /// Directions of length and width, and opposite to the aim.
    #[serde(default = "upright")]
    pub(crate) axes: [[f64; 3]; 3],
    #[serde(default)]
    pub(crate) surfaces: Vec<Surface>,
    /// True for low-discrepancy points. Their noise is so small that only exact shapes and tables may have them.
    #[serde(default)]
    pub(crate) sobol: bool,
    /// Exact flux \[lm\] that surfaces receive, by their names.
    #[serde(default)]
    pub(crate) fluxes: BTreeMap<String, f64>,
    #[serde(default)]
    pub(crate) points: Vec<Point>,
    /// Number of rays per point. Few of those over the hemisphere meet a small opening, and enough must do so in quick runs,
    /// too, for the spread of the runs to show it.
    pub(crate) rays: Option<u64>,
}

fn upright() -> [[f64; 3]; 3] {
    DMat3::IDENTITY.to_cols_array_2d()
}

impl Setup {
    /// Adds the luminaire to a scene, as it is described by one of its files.
    pub(crate) fn add(
        &self,
        case: &Case,
        file: FileKind,
        builder: &mut SceneBuilder,
    ) -> Result<(), ValidateError> {
        let Photometry { distribution, opening, .. } =
            Photometry::parse(file.text(&self.lamp, self.opening).as_bytes())?;
        let (position, frame) = (DVec3::from_array(self.position), DMat3::from_cols_array_2d(&self.axes));
        if self.opening.is_none() {
            let intensity = Rgb::splat(distribution.largest());
            let spread = Spread::Tabulated(Tabulated::new(distribution, frame));
            let kind = LightKind::Point { position, intensity, spread };
            builder.add_light(Light { name: String::new(), kind });
            return Ok(());
        }
        let light = OpeningLight::new(distribution, &opening).map(Arc::new);
        let light = case.need("luminous opening", light.as_ref())?;
        for (number, face) in light.faces().iter().enumerate() {
            let beam = Beam::new(Arc::clone(light), frame, number);
            let black = Material::diffuse("opening", Rgb::ZERO).emitting(Rgb::splat(light.exitance(number)));
            let material = builder.add_material(Material { beam, ..black });
            let corners = face.corners.iter().map(|&corner| position + frame * corner);
            let corners: Vec<_> = corners.map(|corner| builder.add_vertex(corner)).collect();
            builder.add_polygon(&corners, material);
        }
        Ok(())
    }
}
