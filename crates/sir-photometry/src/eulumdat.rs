//! Reader of EULUMDAT (Stockmar 1990).

use crate::distribution::{Coordinates, IntensityDistribution};
use crate::error::PhotometryError;
use crate::opening::{Opening, Outline};
use crate::photometry::Photometry;
use crate::planes::{Planes, ascending, near, snapped, warn_of_range, without_negative};
use crate::text::{Comma, Reader, color_temperature, shortened, shortened_to};

/// Maximum number of characters of the name of a luminaire.
const MAX_NAME: usize = 200;

/// Number of lines with direct ratios, which are ignored.
const DIRECT_RATIOS: usize = 10;

/// Flux \[lm\] to which intensities refer if the file states no flux of its lamps.
const REFERENCE_FLUX: f64 = 1000.0;

/// Maximum number of other sets of lamps that a warning names.
const MAX_NAMED: usize = 5;

/// Returns true if a decoded text has the type and symmetry indicators of EULUMDAT in lines 2 and 3, and a number of planes in
/// line 4.
pub(crate) fn is_eulumdat(text: &str) -> bool {
    let mut reader = Reader::new(text, Comma::Decimal);
    let mut lines = std::iter::from_fn(|| reader.line());
    let mut indicators =
        lines.by_ref().skip(1).take(3).map(|(line, _)| line.replace(',', ".").parse::<f64>().unwrap_or(-1.0));
    let mut next = || indicators.next().unwrap_or(-1.0);
    (0.0..=3.0).contains(&next()) && (0.0..=4.0).contains(&next()) && next() >= 1.0
}

/// Reads a decoded file. `lamp_set` is the index of the set of lamps.
///
/// # Errors
///
/// If the file is incomplete, or a value is invalid.
pub(crate) fn read(text: &str, lamp_set: usize) -> Result<Photometry, PhotometryError> {
    let mut warnings = Vec::new();
    let mut reader = Reader::new(text, Comma::Decimal);
    let header = Header::read(&mut reader)?;
    let lamps = Lamps::read(&mut reader, header.sets, lamp_set, &mut warnings)?;
    for _ in 0..DIRECT_RATIOS {
        line(&mut reader, "the direct ratios")?;
    }
    let planes = reader.numbers(header.planes, "the angle C")?;
    let gammas = reader.numbers(header.gammas, "the angle γ")?;
    let planes = regular_if_broken(planes, header.plane_step, "C", &mut warnings);
    let gammas = regular_if_broken(gammas, header.gamma_step, "γ", &mut warnings);

    let angles = measured_planes(header.symmetry, &planes)?;
    let values = intensities(&mut reader, angles.len(), gammas.len(), &mut warnings)?;
    let mut planes = Planes { angles, values };
    without_negative(&mut planes.values, &mut warnings);
    let flux = if lamps.flux > 0.0 {
        lamps.flux
    } else {
        warnings.push(format!("The flux of the lamps is not stated; {REFERENCE_FLUX} lm are assumed."));
        REFERENCE_FLUX
    };
    let factor = header.conversion(&mut warnings) * flux / 1000.0;
    planes.values.iter_mut().for_each(|value| *value *= factor);

    ascending("angles γ", &gammas)?;
    let gammas: Vec<f64> = gammas.into_iter().map(snapped).collect();
    warn_of_range(&gammas, &mut warnings);
    extend(header.symmetry, &mut planes)?;
    let distribution =
        IntensityDistribution::new(Coordinates::CAcross, &planes.angles, &gammas, &planes.values)
            .map_err(|problem| PhotometryError::Table { problem })?;
    if header.tilt != 0.0 {
        warnings.push(format!(
            "The luminaire was measured at a tilt of {}°; its intensities refer to that position.",
            header.tilt
        ));
    }
    let opening = header.opening(&mut warnings);
    let absolute = lamps.count < 0.0;
    Ok(Photometry {
        format: "EULUMDAT".to_owned(),
        name: header.name,
        distribution,
        lamp_flux: (lamps.flux > 0.0 && !absolute).then_some(lamps.flux),
        stated_flux: match lamps.flux {
            flux if flux <= 0.0 => None,
            // The flux of absolute photometry is that of the luminaire.
            flux if absolute => Some(flux),
            flux => (header.output_ratio > 0.0).then_some(flux * header.output_ratio / 100.0),
        },
        watts: (lamps.watts > 0.0).then_some(lamps.watts),
        color_temperature: lamps.color_temperature,
        opening,
        tilt: None,
        warnings,
    })
}

/// Lines 1 to 26.
struct Header {
    name: String,
    /// Symmetry indicator `Isym`.
    symmetry: u8,
    /// Number of planes around the full circle, `Mc`, and the step between them \[°\].
    planes: usize,
    plane_step: f64,
    /// Number of angles in a plane, `Ng`, and the step between them \[°\].
    gammas: usize,
    gamma_step: f64,
    /// Length and width of the luminaire \[mm\].
    luminaire: [f64; 2],
    /// Length and width of the luminous area, and its heights in the planes C0, C90, C180 and C270 \[mm\].
    area: [f64; 2],
    heights: [f64; 4],
    /// Light output ratio \[%\].
    output_ratio: f64,
    conversion: f64,
    /// Tilt during the measurement \[°\].
    tilt: f64,
    /// Number of sets of lamps.
    sets: usize,
}

impl Header {
    fn read(reader: &mut Reader<'_>) -> Result<Self, PhotometryError> {
        let company = line(reader, "the company")?;
        line(reader, "the type indicator")?;
        let indicator = |x: f64| (0.0..=4.0).contains(&x) && x.fract() == 0.0;
        let symmetry =
            field(reader, "the symmetry indicator", "a whole number from 0 to 4", indicator)? as u8;
        let count = |x: f64| (1.0..=1e9).contains(&x) && x.fract() == 0.0;
        let planes = field(reader, "the number of planes", "a whole number from 1", count)? as usize;
        let plane_step = optional(reader, "the step between planes")?;
        let gammas =
            field(reader, "the number of angles in a plane", "a whole number from 1", count)? as usize;
        let gamma_step = optional(reader, "the step between angles in a plane")?;
        line(reader, "the number of the report")?;
        let luminaire = line(reader, "the name of the luminaire")?;
        let number = line(reader, "the number of the luminaire")?;
        let luminaire = if luminaire.is_empty() { number } else { luminaire };
        let name =
            company.split_whitespace().chain(luminaire.split_whitespace()).collect::<Vec<_>>().join(" ");
        line(reader, "the file name")?;
        line(reader, "the date")?;
        let mut sizes = [0.0; 9];
        for size in &mut sizes {
            *size = optional(reader, "a dimension")?.abs();
        }
        let [length, width, _, area_length, area_width, heights @ ..] = sizes;
        optional(reader, "the downward flux fraction")?;
        let output_ratio = optional(reader, "the light output ratio")?;
        let conversion = optional(reader, "the conversion factor")?;
        let tilt = optional(reader, "the tilt of the measurement")?;
        let whole = |x: f64| (0.0..=1e9).contains(&x) && x.fract() == 0.0;
        let sets = field_or(reader, "the number of lamp sets", "a whole number", whole, Some(0.0))? as usize;
        Ok(Self {
            name: shortened_to(&name, MAX_NAME),
            symmetry,
            planes,
            plane_step,
            gammas,
            gamma_step,
            luminaire: [length, width],
            area: [area_length, area_width],
            heights,
            output_ratio,
            conversion,
            tilt,
            sets,
        })
    }

    /// Returns the factor of intensities.
    fn conversion(&self, warnings: &mut Vec<String>) -> f64 {
        if self.conversion > 0.0 {
            return self.conversion;
        }
        warnings.push(format!("The conversion factor {} is read as 1.", self.conversion));
        1.0
    }

    fn opening(&self, warnings: &mut Vec<String>) -> Opening {
        let meters = |millimeters: f64| millimeters / 1000.0;
        let [length, width] = self.area.map(meters);
        let height = meters(self.heights.iter().sum::<f64>() / 4.0);
        if self.heights.iter().any(|&other| other != self.heights[0]) {
            warnings.push(format!(
                "The luminous heights {:?} mm differ; their mean {} mm is used.",
                self.heights,
                1000.0 * height
            ));
        }
        // A circle has a diameter, and no width.
        let (outline, length, width) = match (length > 0.0, width > 0.0) {
            (false, false) if height == 0.0 => {
                if self.luminaire.iter().any(|&size| size > 0.0) {
                    warnings.push(
                        "The file states no luminous area; the luminaire is read as a point.".to_owned(),
                    );
                }
                return Opening::Point;
            }
            (true, false) => (Outline::Ellipse, length, length),
            (false, true) => (Outline::Ellipse, width, width),
            _ => (Outline::Rectangle, length, width),
        };
        if height > 0.0 {
            Opening::Solid { outline, length, width, height }
        } else {
            Opening::Flat { outline, length, width }
        }
    }
}

/// A set of lamps.
#[derive(Default)]
struct Lamps {
    /// Number of lamps; negative for absolute photometry.
    count: f64,
    kind: String,
    /// Flux of all lamps together \[lm\].
    flux: f64,
    color_temperature: Option<f64>,
    watts: f64,
}

impl Lamps {
    /// Reads all sets, and returns one of them.
    fn read(
        reader: &mut Reader<'_>,
        count: usize,
        wanted: usize,
        warnings: &mut Vec<String>,
    ) -> Result<Self, PhotometryError> {
        let (mut chosen, mut others) = (None, Vec::new());
        for index in 0..count {
            let mut lamps = Self { count: optional(reader, "the number of lamps")?, ..Self::default() };
            lamps.kind = shortened(line(reader, "the type of lamps")?);
            lamps.flux = optional(reader, "the flux of the lamps")?;
            lamps.color_temperature = color_temperature(line(reader, "the color temperature")?);
            line(reader, "the color rendering")?;
            lamps.watts = optional(reader, "the electric power")?;
            if index == wanted {
                chosen = Some(lamps);
            } else if others.len() < MAX_NAMED {
                others.push(format!("{} × {}, {} lm", lamps.count.abs(), lamps.kind, lamps.flux));
            }
        }
        if count > 1 {
            let rest = if count - 1 > others.len() { "; …" } else { "" };
            warnings.push(format!(
                "The set of lamps {} of {count} is used; others are: {}{rest}.",
                wanted + 1,
                others.join("; ")
            ));
        }
        match chosen {
            Some(lamps) => Ok(lamps),
            None if count == 0 && wanted == 0 => Ok(Self::default()),
            None => Err(PhotometryError::LampSet { count, wanted: wanted + 1 }),
        }
    }
}

/// Returns the next line.
fn line<'a>(reader: &mut Reader<'a>, what: &str) -> Result<&'a str, PhotometryError> {
    let place = reader.place();
    let next = reader.line().map(|(line, _)| line);
    next.ok_or_else(|| PhotometryError::End { line: place.line, what: what.to_owned() })
}

/// Returns the number of the next line; 0 if the line is blank.
fn optional(reader: &mut Reader<'_>, what: &str) -> Result<f64, PhotometryError> {
    field_or(reader, what, "a number", |_| true, Some(0.0))
}

/// Returns the number of the next line, which must fulfill a condition that `expected` describes.
fn field(
    reader: &mut Reader<'_>,
    what: &str,
    expected: &'static str,
    condition: impl Fn(f64) -> bool,
) -> Result<f64, PhotometryError> {
    field_or(reader, what, expected, condition, None)
}

/// Does the same; a blank line has the value `blank`.
fn field_or(
    reader: &mut Reader<'_>,
    what: &str,
    expected: &'static str,
    condition: impl Fn(f64) -> bool,
    blank: Option<f64>,
) -> Result<f64, PhotometryError> {
    let place = reader.place();
    let text = line(reader, what)?;
    let value = if text.is_empty() { blank } else { reader.value(text) };
    value.filter(|&value| condition(value)).ok_or_else(|| PhotometryError::Value {
        line: place.line,
        column: place.column,
        what: what.to_owned(),
        found: shortened(text),
        expected,
    })
}

/// Returns angles, or multiples of a step if they do not ascend.
fn regular_if_broken(angles: Vec<f64>, step: f64, name: &str, warnings: &mut Vec<String>) -> Vec<f64> {
    if step <= 0.0 || ascending("", &angles).is_ok() {
        return angles;
    }
    warnings.push(format!("The angles {name} do not ascend; multiples of {step}° are used."));
    (0..angles.len()).map(|i| i as f64 * step).collect()
}

/// Returns the angles of the planes whose intensities are in the file.
fn measured_planes(symmetry: u8, all: &[f64]) -> Result<Vec<f64>, PhotometryError> {
    let count = all.len();
    let (start, planes) = match symmetry {
        0 => (0, count),
        1 => return Ok(vec![0.0]),
        2 => (0, count / 2 + 1),
        // From C270 through C0 to C90.
        3 => (3 * count / 4, count / 2 + 1),
        _ => (0, count / 4 + 1),
    };
    let angles: Vec<f64> =
        (start..start + planes).map(|i| all[i % count] + 360.0 * (i / count) as f64).collect();
    ascending("angles C", &angles)?;
    Ok(angles)
}

/// Reads the intensities. A few missing ones at the end are zero, with a warning: some programs leave them out.
fn intensities(
    reader: &mut Reader<'_>,
    planes: usize,
    gammas: usize,
    warnings: &mut Vec<String>,
) -> Result<Vec<f64>, PhotometryError> {
    let mut values = Vec::new();
    for plane in 1..=planes {
        for gamma in 1..=gammas {
            if plane == planes && gamma > 1 && reader.is_at_end() {
                warnings.push(format!(
                    "The last {} intensities are missing, and read as zero.",
                    gammas + 1 - gamma
                ));
                values.resize(planes * gammas, 0.0);
                return Ok(values);
            }
            values.push(
                reader
                    .number(|| format!("the intensity {gamma} of {gammas} in plane {plane} of {planes}"))?,
            );
        }
    }
    let left = reader.words_left();
    if left > 0 {
        warnings.push(format!("{left} numbers after the intensities are ignored."));
    }
    Ok(values)
}

/// Extends planes to a full turn by their symmetry.
fn extend(symmetry: u8, planes: &mut Planes) -> Result<(), PhotometryError> {
    let [first, last] = planes.range();
    let (expected, from, to, folds) = match symmetry {
        0 => {
            if planes.angles.len() > 1 && !near(last - first, 360.0) {
                planes.close();
            }
            return Ok(());
        }
        1 => return Ok(()),
        2 => ("0 to 180° for the symmetry indicator 2", 0.0, 180.0, 1),
        3 => ("270 to 450° for the symmetry indicator 3", 270.0, 450.0, 1),
        _ => ("0 to 90° for the symmetry indicator 4", 0.0, 90.0, 2),
    };
    if !near(first, from) || !near(last, to) {
        return Err(PhotometryError::Angles { what: "angles C", first, last, expected });
    }
    let count = planes.angles.len();
    (planes.angles[0], planes.angles[count - 1]) = (from, to);
    for _ in 0..folds {
        planes.mirror_at_last();
    }
    Ok(())
}
