//! Texts of photometric files.

use glam::DVec3;
use serde::Deserialize;

use crate::luminaire::file_kind::FileKind;
use crate::luminaire::lamp::{Angles, Lamp};

/// Luminous opening in a file; lengths in meters.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(crate) enum Opening {
    /// Disc, perpendicular to the aim.
    Disc { diameter: f64 },
    /// Rectangle, perpendicular to the aim; `length` is along x.
    Rectangle { length: f64, width: f64 },
    /// Box; `height` is along the aim.
    Box { length: f64, width: f64, height: f64 },
}

/// Intensity \[cd\] that is written as 0.
const DUST: f64 = 1e-9;

impl FileKind {
    /// Returns the name in tables.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::IesC => "IES C",
            Self::IesB => "IES B",
            Self::IesA => "IES A",
            Self::Eulumdat => "EULUMDAT",
        }
    }

    /// Returns the text of the file of a lamp.
    pub(crate) fn text(self, lamp: &Lamp, opening: Option<Opening>) -> String {
        let mut angles = lamp.angles(self);
        match self {
            Self::Eulumdat => {
                // The plane at 360° is that at 0.
                angles.horizontal.retain(|&c| c < 360.0);
                self.eulumdat(lamp, &angles, opening)
            }
            _ => self.ies(lamp, &angles, opening),
        }
    }

    /// Returns the direction of a pair of angles \[°\] in the frame of the luminaire: aimed at −z, with its length along x.
    fn direction(self, horizontal: f64, vertical: f64) -> DVec3 {
        let ((sin_h, cos_h), (sin_v, cos_v)) =
            (libm::sincos(horizontal.to_radians()), libm::sincos(vertical.to_radians()));
        match self {
            Self::IesC => DVec3::new(sin_v * cos_h, sin_v * sin_h, -cos_v),
            Self::Eulumdat => DVec3::new(sin_v * sin_h, -sin_v * cos_h, -cos_v),
            Self::IesB => DVec3::new(cos_h * sin_v, -sin_h, -cos_h * cos_v),
            Self::IesA => DVec3::new(cos_v * cos_h, -cos_v * sin_h, sin_v),
        }
    }

    /// Returns the intensities of all pairs of angles, plane by plane.
    fn table(self, lamp: &Lamp, angles: &Angles) -> impl Iterator<Item = String> {
        let planes = angles.horizontal.iter();
        planes
            .flat_map(move |&h| angles.vertical.iter().map(move |&v| self.direction(h, v)))
            .map(|direction| lamp.intensity(direction))
            // Rounded sines and cosines leave dust, which has hundreds of digits.
            .map(|intensity| if intensity < DUST { "0".into() } else { intensity.to_string() })
    }

    fn ies(self, lamp: &Lamp, angles: &Angles, opening: Option<Opening>) -> String {
        let kind = match self {
            Self::IesB => 2,
            Self::IesA => 3,
            _ => 1,
        };
        let Angles { horizontal, vertical } = angles;
        let sizes = match opening {
            None => "0 0 0".to_owned(),
            // Width and length; negative numbers are round.
            Some(Opening::Disc { diameter }) => format!("-{diameter} -{diameter} 0"),
            Some(Opening::Rectangle { length, width }) => format!("{width} {length} 0"),
            Some(Opening::Box { length, width, height }) => format!("{width} {length} {height}"),
        };
        let counts = format!("1 -1 1 {} {} {kind} 2 {sizes}", vertical.len(), horizontal.len());
        let mut lines = ["IESNA:LM-63-2002", "[LUMINAIRE] formula", "TILT=NONE", &counts, "1 1 0"]
            .map(str::to_owned)
            .to_vec();
        lines.extend(vertical.iter().chain(horizontal).map(f64::to_string));
        lines.extend(self.table(lamp, angles));
        lines.join("\n")
    }

    fn eulumdat(self, lamp: &Lamp, angles: &Angles, opening: Option<Opening>) -> String {
        let Angles { horizontal, vertical } = angles;
        let symmetry = if horizontal.len() == 1 { "1" } else { "0" };
        // Length, width and heights in millimeters; a disc has no width.
        let [length, width, height] = match opening {
            None => [0.0; 3],
            Some(Opening::Disc { diameter }) => [diameter, 0.0, 0.0],
            Some(Opening::Rectangle { length, width }) => [length, width, 0.0],
            Some(Opening::Box { length, width, height }) => [length, width, height],
        }
        .map(|meters| (1000.0 * meters).to_string());
        let (planes, gammas) = (horizontal.len().to_string(), vertical.len().to_string());
        let head =
            ["formula", "1", symmetry, &planes, "0", &gammas, "0", "", "formula", "", "formula.ldt", ""];
        let housing = ["0"; 3];
        let area = [&*length, &width, &height, &height, &height, &height];
        // Intensities are per 1,000 lm of the only lamp.
        let factors = ["100", "100", "1", "0", "1", "1", "LED", "1000", "4000", "80", "0"];
        let ratios = ["0"; 10];
        let all = head.into_iter().chain(housing).chain(area).chain(factors).chain(ratios);
        let mut lines: Vec<String> = all.map(str::to_owned).collect();
        lines.extend(horizontal.iter().chain(vertical).map(f64::to_string));
        lines.extend(self.table(lamp, angles));
        lines.join("\r\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_photometry::Photometry;

    /// All files of a lamp have its intensity at the angles that they share, and no warnings but for what types A and B
    /// leave out.
    #[test]
    fn files_are_read_as_they_are_meant() {
        let lamp = Lamp::Product { peak: 1000.0, step_deg: 5.0 };
        let opening = Some(Opening::Box { length: 0.4, width: 0.2, height: 0.1 });
        let size = |opening| match opening {
            sir_photometry::Opening::Solid { length, width, height, .. } => [length, width, height],
            other => unreachable!("{other:?}"),
        };
        for file in [FileKind::IesC, FileKind::IesB, FileKind::IesA, FileKind::Eulumdat] {
            let read = Photometry::parse(file.text(&lamp, opening).as_bytes()).unwrap();
            assert_eq!(size(read.opening), [0.4, 0.2, 0.1], "{file:?}");
            assert!(read.warnings.is_empty(), "{file:?}: {:?}", read.warnings);
            for degrees in [15f64, 45.0, 80.0] {
                let direction = DVec3::new(degrees.to_radians().sin(), 0.0, -degrees.to_radians().cos());
                let exact = lamp.intensity(direction);
                let found = read.distribution.intensity(direction);
                assert!((found / exact - 1.0).abs() < 1e-12, "{file:?} at {degrees}°: {found}");
            }
        }
    }
}
