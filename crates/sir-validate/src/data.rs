//! Files of exact answers. Their conventions are in `data/README.md`; unused fields are ignored.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::error::ValidateError;

/// File names, in the order of [`Reference::parse`].
pub const FILES: [&str; 4] = ["view-factors.json", "radiosity-exact.json", "cie171.json", "luminaires.json"];

/// All cases with exact answers.
#[derive(Clone, Debug)]
pub struct Reference {
    pub(crate) cases: Vec<Case>,
}

/// One case.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Case {
    pub(crate) id: String,
    pub(crate) title: String,
    #[serde(default)]
    pub(crate) geometry: Geometry,
    /// Given quantities; their layout depends on the case.
    #[serde(default)]
    inputs: Value,
    /// Answers; their layout depends on the case.
    #[serde(default)]
    values: Value,
    #[serde(default)]
    pub(crate) points: Vec<Point>,
    /// Averages of faces; CIE 5.8 only.
    #[serde(default)]
    pub(crate) face_averages: Vec<FaceAverage>,
    /// Values at points by reflectance, written `rho=0.5`; CIE 5.8 only.
    #[serde(default)]
    pub(crate) point_values: BTreeMap<String, Vec<Point>>,
}

/// Surfaces and sources of a case.
#[derive(Clone, Debug, Default, Deserialize)]
pub(crate) struct Geometry {
    #[serde(default)]
    pub(crate) surfaces: Vec<Surface>,
    /// Rooms by name; RE-01 only.
    #[serde(default)]
    pub(crate) enclosures: BTreeMap<String, Vec<Surface>>,
    pub(crate) source: Option<PointSource>,
    pub(crate) opening: Option<Surface>,
    #[serde(default)]
    pub(crate) openings: Vec<Surface>,
}

/// A surface with a name.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Surface {
    pub(crate) name: String,
    #[serde(default)]
    pub(crate) role: String,
    #[serde(flatten)]
    pub(crate) shape: Shape,
}

/// Shape of a surface; lengths in meters.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(crate) enum Shape {
    /// Polygon, with corners counterclockwise seen from the active side.
    Polygon { vertices: Vec<[f64; 3]> },
    /// Disc, active on the side to which the normal points.
    Disc {
        #[serde(rename = "centre")]
        center: [f64; 3],
        normal: [f64; 3],
        radius: f64,
    },
    /// The same with a hole.
    Annulus {
        #[serde(rename = "centre")]
        center: [f64; 3],
        normal: [f64; 3],
        inner_radius: f64,
        outer_radius: f64,
    },
    /// Whole sphere.
    Sphere {
        #[serde(rename = "centre")]
        center: [f64; 3],
        radius: f64,
        active_side: ActiveSide,
    },
    /// Part of a sphere between two angles from the axis.
    SphericalZone {
        #[serde(rename = "centre")]
        center: [f64; 3],
        radius: f64,
        axis: [f64; 3],
        polar_angle_deg: [f64; 2],
        active_side: ActiveSide,
    },
    /// Curved surface of a cylinder.
    Cylinder {
        #[serde(rename = "base_centre")]
        base_center: [f64; 3],
        axis: [f64; 3],
        radius: f64,
        length: f64,
        active_side: ActiveSide,
    },
}

/// Active side of a curved surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ActiveSide {
    Inside,
    Outside,
}

/// A point light.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct PointSource {
    pub(crate) position: [f64; 3],
    /// Axis of a source that is not isotropic.
    pub(crate) axis: Option<[f64; 3]>,
}

/// A point on a surface, with the light that arrives there.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Point {
    pub(crate) name: String,
    pub(crate) position: [f64; 3],
    pub(crate) normal: [f64; 3],
    #[serde(alias = "exact_total")]
    pub(crate) exact: f64,
    pub(crate) cie_published: Option<f64>,
}

/// Mean illuminance \[lx\] of a face in CIE 5.8.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(crate) struct FaceAverage {
    pub(crate) reflectance: f64,
    pub(crate) total: f64,
    pub(crate) indirect: f64,
    pub(crate) cie_published_indirect: Option<f64>,
}

impl Reference {
    /// Returns the answers that are built into the program.
    ///
    /// # Errors
    ///
    /// Only if the program was built with invalid files.
    pub fn built_in() -> Result<Self, ValidateError> {
        Self::parse([
            include_str!("../data/view-factors.json"),
            include_str!("../data/radiosity-exact.json"),
            include_str!("../data/cie171.json"),
            include_str!("../data/luminaires.json"),
        ])
    }

    /// Reads the texts of the four [`FILES`].
    ///
    /// # Errors
    ///
    /// If one of them is not a file of exact answers.
    pub fn parse(texts: [&str; 4]) -> Result<Self, ValidateError> {
        #[derive(Deserialize)]
        struct File {
            cases: Vec<Case>,
        }
        let mut cases = Vec::new();
        for (name, text) in FILES.into_iter().zip(texts) {
            let file: File =
                serde_json::from_str(text).map_err(|source| ValidateError::File { name, source })?;
            cases.extend(file.cases);
        }
        Ok(Self { cases })
    }

    /// Returns the IDs of all cases.
    pub fn ids(&self) -> impl Iterator<Item = &str> {
        self.cases.iter().map(|case| case.id.as_str())
    }
}

impl Case {
    /// Reads the given quantities.
    pub(crate) fn inputs<T: DeserializeOwned>(&self) -> Result<T, ValidateError> {
        self.read("inputs", &self.inputs)
    }

    /// Reads the answers.
    pub(crate) fn values<T: DeserializeOwned>(&self) -> Result<T, ValidateError> {
        self.read("values", &self.values)
    }

    fn read<T: DeserializeOwned>(&self, what: &'static str, value: &Value) -> Result<T, ValidateError> {
        T::deserialize(value).map_err(|source| ValidateError::Layout { case: self.id.clone(), what, source })
    }

    /// Returns a part that a case of its kind must have, or an error if it is missing.
    pub(crate) fn need<'a, T>(
        &self,
        what: &'static str,
        found: Option<&'a T>,
    ) -> Result<&'a T, ValidateError> {
        found.ok_or_else(|| ValidateError::Missing { case: self.id.clone(), what })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_files_are_read() {
        let reference = Reference::built_in().unwrap();
        assert_eq!(reference.ids().count(), 14 + 9 + 10 + 6);
        let points: usize = reference.cases.iter().map(|case| case.points.len()).sum();
        assert_eq!(points, 10 + 14 + 14 + 14 + 11 + 14 + 14);
    }

    #[test]
    fn a_broken_file_is_named() {
        let error = Reference::parse([r#"{"cases": []}"#, r#"{"cases": [{"id": 1}]}"#, "", ""]).unwrap_err();
        assert!(error.to_string().contains("radiosity-exact.json"), "{error}");
    }
}
