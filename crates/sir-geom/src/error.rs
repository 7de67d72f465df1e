//! Why a scene cannot be built.

use thiserror::Error;

use crate::color::Rgb;
use crate::warning::quoted;

/// Why a scene cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SceneError {
    /// There is nothing that light could meet.
    #[error("{}; add meshes of triangles to the scene", nothing(*dropped))]
    Empty {
        /// Degenerate triangles that were dropped.
        dropped: u64,
    },
    /// More vertices or triangles than 32-bit numbers can count.
    #[error("the scene has more than {} {what}", u32::MAX)]
    TooLarge {
        /// `vertices`, `triangles` or `materials`.
        what: &'static str,
    },
    /// A polygon names a vertex or material that was not added.
    #[error("polygon {face} refers to {what} {index}, but only {count} were added")]
    OutOfRange {
        /// Number of the polygon.
        face: u32,
        /// `vertex` or `material`.
        what: &'static str,
        /// The number that it asks for.
        index: u32,
        /// How many there are.
        count: usize,
    },
    /// A material has a negative, infinite or undefined color.
    #[error("material {} has the {what} ({:?}, {:?}, {:?}), which must be finite and not negative", quoted(name), value.x, value.y, value.z)]
    BadMaterial {
        /// Name of the material.
        name: String,
        /// `reflectance`, `exitance` or `opacity`.
        what: &'static str,
        /// The value found.
        value: Rgb,
    },
    /// A light has a negative, infinite or undefined number.
    #[error("light {number} (\"{name}\") has a bad {what}: {rule}")]
    BadLight {
        /// Its number, from 0, in the order in which lights were added.
        number: usize,
        /// Name of the light.
        name: String,
        /// `position`, `direction`, `axis`, `cone`, `intensity` or `irradiance`.
        what: &'static str,
        /// What it must be.
        rule: &'static str,
    },
}

fn nothing(dropped: u64) -> String {
    match dropped {
        0 => "it has no triangles".to_owned(),
        n => format!("none of its {n} triangles has both an area and finite coordinates"),
    }
}
