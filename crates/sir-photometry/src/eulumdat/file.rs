//! A whole file: header, sets of lamps, and the table of intensities with its factors.

use crate::distribution::{Coordinates, IntensityDistribution};
use crate::error::PhotometryError;
use crate::eulumdat::fields::line;
use crate::eulumdat::header::Header;
use crate::eulumdat::lamps::Lamps;
use crate::eulumdat::table::{extend, intensities, measured_count, measured_planes, regular_if_broken};
use crate::photometry::Photometry;
use crate::planes::{Planes, ascending, snapped, warn_of_range, without_negative};
use crate::text::{Comma, Reader};

/// Number of lines with direct ratios, which are ignored.
const DIRECT_RATIOS: usize = 10;

/// Line of the number of sets of lamps.
const SETS_LINE: usize = 26;

/// Flux \[lm\] to which intensities refer if the file states no flux of its lamps.
const REFERENCE_FLUX: f64 = 1000.0;

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
    let header = Header::read(&mut reader, &mut warnings)?;
    let lamps = Lamps::read(&mut reader, header.sets, lamp_set, &mut warnings)?;
    for _ in 0..DIRECT_RATIOS {
        line(&mut reader, "the direct ratios")?;
    }
    let line_of_planes = reader.line_of_next();
    let planes = reader.numbers(header.planes, "the angle C")?;
    let line_of_gammas = reader.line_of_next();
    let gammas = reader.numbers(header.gammas, "the angle γ")?;
    check_sets(&header, &planes, &gammas, &reader)?;
    let planes = regular_if_broken(planes, header.plane_step, "C", &mut warnings);
    let gammas = regular_if_broken(gammas, header.gamma_step, "γ", &mut warnings);

    let of_planes = PhotometryError::from_line(line_of_planes);
    let angles = measured_planes(header.symmetry, &planes).map_err(&of_planes)?;
    let line_of_values = reader.line_of_next();
    let values = intensities(&mut reader, angles.len(), gammas.len(), &mut warnings)?;
    let mut planes = Planes { angles, values };
    without_negative(&mut planes.values, &mut warnings);
    let flux = if lamps.flux > 0.0 {
        lamps.flux
    } else {
        let why = match lamps.flux {
            flux if flux < 0.0 => format!("{flux} lm is negative"),
            _ => "is not stated".to_owned(),
        };
        warnings.push(format!("The flux of the lamps {why}; {REFERENCE_FLUX} lm are assumed."));
        REFERENCE_FLUX
    };
    let factor = header.conversion(&mut warnings) * flux / 1000.0;
    planes.values.iter_mut().for_each(|value| *value *= factor);

    ascending("angles γ", &gammas).map_err(PhotometryError::from_line(line_of_gammas))?;
    let gammas: Vec<f64> = gammas.into_iter().map(snapped).collect();
    warn_of_range(&gammas, &mut warnings);
    extend(header.symmetry, &mut planes).map_err(of_planes)?;
    let distribution =
        IntensityDistribution::new(Coordinates::CAcross, &planes.angles, &gammas, &planes.values)
            .map_err(|problem| PhotometryError::Table { problem })
            .map_err(PhotometryError::from_line(line_of_values))?;
    if header.tilt != 0.0 {
        warnings.push(format!(
            "The luminaire was measured at a tilt of {}°; its intensities refer to that position.",
            header.tilt
        ));
    }
    let opening = header.opening(&mut warnings);
    let absolute = lamps.count < 0.0;
    if header.output_ratio <= 0.0 && !absolute {
        let ratio = header.output_ratio;
        warnings.push(format!("The light output ratio {ratio} % is ignored; it should be above 0."));
    }
    if lamps.watts < 0.0 {
        warnings.push(format!("The electric power {} W is negative, and ignored.", lamps.watts));
    }
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

/// Checks that the number of sets of lamps is right. If it is not, all that follows is read from wrong lines: angles do not
/// ascend, and there are too many intensities or too few.
///
/// # Errors
///
/// If both are the case.
fn check_sets(
    header: &Header,
    planes: &[f64],
    gammas: &[f64],
    reader: &Reader<'_>,
) -> Result<(), PhotometryError> {
    let is_ascending = ascending("", planes).is_ok() && ascending("", gammas).is_ok();
    if is_ascending || reader.words_left() == measured_count(header.symmetry, planes.len()) * gammas.len() {
        return Ok(());
    }
    Err(PhotometryError::Value {
        line: SETS_LINE,
        column: 1,
        what: "the number of lamp sets".to_owned(),
        found: header.sets.to_string(),
        expected: "that of the sets in the file; the angles after them do not ascend, and the intensities are too many or \
                   too few",
    })
}
