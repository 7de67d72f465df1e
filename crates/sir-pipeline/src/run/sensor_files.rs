//! Files of sensors: a table, and a false-color image.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use sir_radiosity::Measurement;
use sir_view::{Map, ViewError, write_atomically, write_map};

use crate::error::Error;
use crate::plan::Sensors;
use crate::prepare::layout::{Cells, Layout};
use crate::report::result::OutputReport;
use crate::report::sensors::SensorsReport;
use crate::report::uncertain::Uncertain;
use crate::units::Units;

/// Columns of the table.
const COLUMNS: [&str; 15] =
    ["x", "y", "z", "dx", "dy", "dz", "E_r", "E_g", "E_b", "E", "E_direct", "se_r", "se_g", "se_b", "se"];

/// What a stage `Sensors` has measured.
pub(crate) struct SensorValues<'a> {
    pub(crate) sensors: &'a Sensors,
    pub(crate) layout: &'a Layout,
    pub(crate) measured: &'a [Measurement],
    /// Unified glare ratings, if they were asked for; `None` where nothing glares.
    pub(crate) ratings: Option<&'a [Option<Uncertain>]>,
}

/// Writes the files of a stage `Sensors` into a directory.
pub(crate) fn write(
    values: &SensorValues<'_>,
    summary: &SensorsReport,
    units: Units,
    directory: &Path,
) -> Result<Vec<OutputReport>, Error> {
    let SensorValues { sensors, layout, measured, .. } = *values;
    let table = place(directory, &sensors.table())?;
    let outdoor = summary.daylight.map(|daylight| daylight.outdoor);
    write_atomically(&table, |file| write_table(file, values, outdoor))?;
    let mut written = vec![output(directory, &sensors.table(), "sensors")?];
    if let (Some(map), Some(cells)) = (sensors.map(), &layout.cells) {
        write_map(&place(directory, &map)?, &map_of(cells, measured, summary, units))?;
        written.push(output(directory, &map, "map")?);
    }
    Ok(written)
}

/// Returns the path of an output, whose folder is made.
pub(super) fn place(directory: &Path, name: &Path) -> Result<PathBuf, Error> {
    let path = directory.join(name);
    if let Some(parent) = path.parent() {
        fs::create_dir_all(parent).map_err(Error::directory(parent))?;
    }
    Ok(path)
}

/// Returns the report of an output that has been written.
pub(super) fn output(directory: &Path, name: &Path, kind: &str) -> Result<OutputReport, Error> {
    let path = directory.join(name);
    let bytes = fs::metadata(&path).map_err(|source| ViewError::Io { what: "read", path, source })?.len();
    Ok(OutputReport {
        path: name.to_string_lossy().into_owned(),
        kind: kind.into(),
        bytes: Some(bytes),
        camera: None,
    })
}

/// Writes the table. Daylight factors refer to the irradiance `outdoor` \[W/m²\].
fn write_table(out: &mut impl Write, values: &SensorValues<'_>, outdoor: Option<f64>) -> io::Result<()> {
    let SensorValues { layout, measured, ratings, .. } = *values;
    let mut table = csv::Writer::from_writer(out);
    let of_glare: &[&str] = if ratings.is_some() { &["UGR", "se_UGR"] } else { &[] };
    table.write_record(COLUMNS.iter().chain(outdoor.map(|_| &"DF")).chain(of_glare))?;
    for (i, (sensor, m)) in layout.sensors.iter().zip(measured).enumerate() {
        let places = [sensor.position(), sensor.direction()].map(|v| v.to_array());
        let light = m.irradiance.to_array().into_iter().chain([m.luminance(), sir_geom::luminance(m.direct)]);
        let errors = m.error().to_array().into_iter().chain([m.luminance_error()]);
        let daylight = outdoor.map(|outdoor| 100.0 * m.luminance() / outdoor);
        let numbers = places.into_iter().flatten().chain(light).chain(errors).chain(daylight);
        // Where nothing glares, the fields are empty.
        let glare = ratings.into_iter().flat_map(|all| match all.get(i).copied().flatten() {
            Some(Uncertain { value, error }) => [value, error].map(|x| format!("{x:?}")),
            None => [String::new(), String::new()],
        });
        table.write_record(numbers.map(|x| format!("{x:?}")).chain(glare))?;
    }
    table.flush()
}

fn map_of(cells: &Cells, measured: &[Measurement], report: &SensorsReport, units: Units) -> Map {
    let mut values = vec![None; cells.columns * cells.rows];
    for (&cell, measurement) in cells.of.iter().zip(measured) {
        let value = measurement.luminance();
        values[cell] = Some(report.daylight.map_or(value, |daylight| 100.0 * value / daylight.outdoor));
    }
    let (quantity, subtitle, unit) = match report.daylight {
        Some(daylight) => ("daylight factor".into(), daylight.in_short(), "%"),
        None => (report.quantity(units), report.in_short(units), units.irradiance()),
    };
    Map {
        title: format!("{}: {quantity}", report.name),
        subtitle,
        unit: unit.into(),
        columns: cells.columns,
        size: cells.size.to_array(),
        values,
    }
}
