//! Errors of building a scene.

use thiserror::Error;

use crate::color::Rgb;
use crate::warning::quoted;

/// Reason why a scene cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SceneError {
    /// No triangle has both an area and finite coordinates.
    #[error("{}; add meshes of triangles to the scene", empty_reason(*dropped))]
    Empty {
        /// Number of degenerate triangles that were dropped.
        dropped: u64,
    },
    /// More vertices, triangles or materials than 32-bit numbers can count.
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
        /// The index that is out of range.
        index: u32,
        /// Number of vertices or materials that were added.
        count: usize,
    },
    /// A material has a negative, infinite or undefined color.
    #[error("material {} has the {what} ({:?}, {:?}, {:?}), which must be finite and not negative", quoted(name), value.x, value.y, value.z)]
    BadMaterial {
        /// Name of the material.
        name: String,
        /// `reflectance`, `exitance` or `opacity`.
        what: &'static str,
        /// The invalid value.
        value: Rgb,
    },
    /// A light has a negative, infinite or undefined number, or a vector that is not of unit length.
    #[error("light {number} (\"{name}\") has a bad {what}: {rule}")]
    BadLight {
        /// Index of the light, from 0, in the order in which lights were added.
        number: usize,
        /// Name of the light.
        name: String,
        /// `position`, `direction`, `axis`, `cone`, `intensity` or `irradiance`.
        what: &'static str,
        /// The rule that it violates.
        rule: &'static str,
    },
}

fn empty_reason(dropped: u64) -> String {
    match dropped {
        0 => "it has no triangles".to_owned(),
        n => format!("none of its {n} triangles has both an area and finite coordinates"),
    }
}
