//! Lights of a pipeline, converted for a scene.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use sir_geom::{Beam, Light, Material, MaterialId, Rgb, SceneBuilder, Sky, shapes};
use sir_photometry::OpeningLight;

/// Light to be added to a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneLight {
    /// Light without a surface.
    Light(Light),
    /// Black parallelogram that emits on the side from which its edges, in their order, run counterclockwise.
    Panel {
        /// One of its corners \[m\].
        corner: DVec3,
        /// Vectors from the corner to the two adjacent ones \[m\].
        edges: [DVec3; 2],
        /// Emitted exitance per band \[W/m²\].
        exitance: Rgb,
    },
    /// Luminous openings of equal luminaires: black faces that emit outward.
    Openings {
        /// Name of the faces.
        name: String,
        /// Light of one of them.
        light: Arc<OpeningLight>,
        /// The luminaires.
        placed: Vec<PlacedLuminaire>,
    },
    /// Sky: the light from outside of the scene.
    Sky(Sky),
}

/// A luminaire in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedLuminaire {
    /// Position \[m\].
    pub position: DVec3,
    /// Axes of the luminaire, which is aimed at −z and has its length along x.
    pub frame: DMat3,
    /// Intensity per band \[W/sr\] for a candela of its distribution.
    pub factor: Rgb,
}

/// What emits in a scene after a light has been added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Added {
    /// A light with this index.
    Light(usize),
    /// A material.
    Material(MaterialId),
    /// The sky.
    Sky,
}

impl SceneLight {
    /// Adds the light to a scene, and returns what has been added. A sky replaces an existing one.
    pub(crate) fn add_to(&self, builder: &mut SceneBuilder) -> Vec<Added> {
        match self {
            Self::Light(light) => {
                let index = builder.light_count();
                builder.add_light(light.clone());
                vec![Added::Light(index)]
            }
            Self::Sky(sky) => {
                builder.set_sky(sky.clone());
                vec![Added::Sky]
            }
            Self::Panel { corner, edges: [a, b], exitance } => {
                let black = Material::diffuse("panel", Rgb::ZERO).emitting(*exitance);
                let black = builder.add_material(black);
                builder.begin_group("panel");
                shapes::quad(builder, [*corner, corner + a, corner + a + b, corner + b], black);
                vec![Added::Material(black)]
            }
            Self::Openings { name, light, placed } => {
                builder.begin_group(name);
                // Luminaires with the same light share the materials of their faces.
                let mut last: Option<(PlacedLuminaire, Vec<MaterialId>)> = None;
                let mut added = Vec::new();
                for &luminaire in placed {
                    let PlacedLuminaire { position, frame, factor } = luminaire;
                    let materials = match last.take() {
                        Some((of, materials)) if (of.frame, of.factor) == (frame, factor) => materials,
                        _ => materials(builder, name, light, factor, frame),
                    };
                    added.extend(materials.iter().map(|&material| Added::Material(material)));
                    for (face, &material) in light.faces().iter().zip(&materials) {
                        let corners = face.corners.iter().map(|corner| position + frame * *corner);
                        let vertices: Vec<_> = corners.map(|corner| builder.add_vertex(corner)).collect();
                        builder.add_polygon(&vertices, material);
                    }
                    last = Some((luminaire, materials));
                }
                added
            }
        }
    }
}

/// Adds the materials of the faces of an opening.
fn materials(
    builder: &mut SceneBuilder,
    name: &str,
    light: &Arc<OpeningLight>,
    factor: Rgb,
    frame: DMat3,
) -> Vec<MaterialId> {
    let material = |face| {
        let exitance = factor * light.exitance(face);
        let beam = Beam::new(Arc::clone(light), frame, face);
        Material { beam, ..Material::diffuse(name, Rgb::ZERO).emitting(exitance) }
    };
    (0..light.faces().len()).map(|face| builder.add_material(material(face))).collect()
}
