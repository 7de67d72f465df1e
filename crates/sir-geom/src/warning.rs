//! What was changed or left out on the way to a scene.

use std::fmt;

use crate::material::MAX_REFLECTANCE;
use crate::scene::Scene;

/// Something that was changed or left out while a scene was read.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// Triangles without an area, or with coordinates that are not finite, were left out.
    DroppedTriangles {
        /// How many.
        count: u64,
    },
    /// Polygons whose outlines cross themselves, or have more than 4,096 corners and are not convex, were cut into fans.
    CrossedPolygons {
        /// How many.
        count: u64,
    },
    /// A material reflected as much light as it gets, or more: its reflectance was set to [`MAX_REFLECTANCE`].
    ClampedReflectance {
        /// Name of the material.
        material: String,
        /// The largest band of the reflectance that the file asks for.
        asked: f64,
    },
    /// A part of the file has no meaning here, or is missing, and was passed over.
    Ignored {
        /// What it was, and what happens instead.
        what: String,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DroppedTriangles { count } => {
                write!(f, "{count} triangles without an area or with infinite coordinates were left out")
            }
            Self::CrossedPolygons { count } => {
                write!(
                    f,
                    "{count} polygons cross themselves, or have too many corners for another way, and were cut from their first corner"
                )
            }
            Self::ClampedReflectance { material, asked } => write!(
                f,
                "material {} reflects {} of the light it gets; {MAX_REFLECTANCE} is used, \
                 because a surface must absorb some",
                quoted(material),
                if *asked < 1e6 { format!("{asked:.4}") } else { format!("{asked:.1e}") }
            ),
            Self::Ignored { what } => f.write_str(what),
        }
    }
}

/// The start of a name from a file in quotes, with escapes for what would play tricks on a terminal.
pub(crate) fn quoted(name: &str) -> String {
    format!("{:?}", name.chars().take(80).collect::<String>())
}

/// A new scene and what was changed to make it one.
#[derive(Clone, Debug)]
pub struct Built {
    /// The scene.
    pub scene: Scene,
    /// What was changed or left out.
    pub warnings: Vec<Warning>,
}
