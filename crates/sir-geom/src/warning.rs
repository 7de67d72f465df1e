//! Warnings of building a scene.

use std::fmt;

use glam::DVec3;

use crate::material::MAX_REFLECTANCE;
use crate::scene::Scene;

/// Something that was changed or left out while a scene was read.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// Triangles without an area, or with coordinates that are not finite, were left out.
    DroppedTriangles {
        /// Number of triangles.
        count: u64,
    },
    /// Polygons whose outlines cross themselves, or that have more than 4,096 corners and are far from convex, were cut into
    /// fans.
    CrossedPolygons {
        /// Number of polygons.
        count: u64,
        /// First corner of the first of them \[m\].
        place: DVec3,
    },
    /// A material reflects as much light as it receives, or more. Its reflectance was set to [`MAX_REFLECTANCE`].
    ClampedReflectance {
        /// Name of the material.
        material: String,
        /// Largest band of the reflectance in the file.
        asked: f64,
    },
    /// A part of the file is not supported or missing, and was ignored.
    Ignored {
        /// Description of the part, and the consequence.
        what: String,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DroppedTriangles { count } => {
                write!(
                    f,
                    "{count} triangles without an area or with infinite or undefined coordinates were left out"
                )
            }
            Self::CrossedPolygons { count, place } => {
                let [x, y, z] = place.to_array();
                write!(
                    f,
                    "{count} polygons cross themselves, or have more than 4,096 corners and are far from convex; they \
                     were cut into fans from their first corners, of which the first is ({x}, {y}, {z}), and may have a wrong area; \
                     split them into simple polygons"
                )
            }
            Self::ClampedReflectance { material, asked } => write!(
                f,
                "material {} reflects {} of the light it receives; {MAX_REFLECTANCE} is used, \
                 because a surface must absorb some",
                quoted(material),
                if *asked < 1e6 { format!("{asked:.4}") } else { format!("{asked:.1e}") }
            ),
            Self::Ignored { what } => f.write_str(what),
        }
    }
}

/// Returns the start of a name from a file in quotes. Control characters are escaped, because they could manipulate a
/// terminal.
pub(crate) fn quoted(name: &str) -> String {
    format!("{:?}", name.chars().take(80).collect::<String>())
}

/// A scene, and the warnings from building it.
#[derive(Clone, Debug)]
pub struct Built {
    /// The scene.
    pub scene: Scene,
    /// Everything that was changed or left out.
    pub warnings: Vec<Warning>,
}
