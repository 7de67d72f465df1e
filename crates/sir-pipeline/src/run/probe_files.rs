//! Files of probes: a table, and the spherical harmonics as JSON.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use sir_radiosity::ProbeMeasurement;
use sir_view::write_atomically;

use crate::error::Error;
use crate::plan::Sensors;
use crate::prepare::prepared::Prepared;
use crate::prepare::probe_grid::ProbeGrid;
use crate::report::probes::{ProbesFile, error_over_directions};
use crate::report::result::OutputReport;
use crate::run::sensor_files::{output, place};
use crate::units::Units;

/// Columns of the table: the mean irradiance over all directions with its direct part and its errors, the root mean
/// square of the errors over all directions, and irradiances along the axes.
const COLUMNS: [&str; 23] = [
    "x", "y", "z", "valid", "backs", "E_r", "E_g", "E_b", "E", "E_direct", "se_r", "se_g", "se_b", "se",
    "rms_r", "rms_g", "rms_b", "E+x", "E-x", "E+y", "E-y", "E+z", "E-z",
];

/// Writes the files of probes into a directory. `measured` are the measurements of the valid probes, in order.
pub(crate) fn write(
    sensors: &Sensors,
    grid: &ProbeGrid,
    measured: &[ProbeMeasurement],
    prepared: &Prepared,
    units: Units,
    directory: &Path,
) -> Result<Vec<OutputReport>, Error> {
    let table = place(directory, &sensors.table())?;
    write_atomically(&table, |file| write_table(file, grid, measured))?;
    let mut written = vec![output(directory, &sensors.table(), "probes")?];
    if let Some(name) = sensors.harmonics() {
        let content = ProbesFile::new(&sensors.name, grid, measured, units, prepared.up);
        write_atomically(&place(directory, &name)?, |file| {
            let mut out = BufWriter::new(file);
            serde_json::to_writer(&mut out, &content).map_err(io::Error::from)?;
            out.flush()
        })?;
        written.push(output(directory, &name, "harmonics")?);
    }
    Ok(written)
}

fn write_table(out: &mut impl Write, grid: &ProbeGrid, measured: &[ProbeMeasurement]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(COLUMNS)?;
    let mut measured = measured.iter();
    for probe in 0..grid.len() {
        let is_valid = grid.is_valid(probe);
        let number = |x: f64| format!("{x:?}");
        let mut row: Vec<String> = grid.position(probe).to_array().map(number).into();
        row.push(is_valid.to_string());
        row.push(grid.backs[probe].map_or(String::new(), number));
        let light = if is_valid { measured.next() } else { None };
        if let Some(m) = light {
            let mean = m.mean();
            let light = mean.irradiance.to_array().into_iter();
            let light = light.chain([mean.luminance(), sir_geom::luminance(mean.direct)]);
            let errors = mean.error().to_array().into_iter().chain([mean.luminance_error()]);
            let numbers = light.chain(errors).chain(error_over_directions(m).to_array());
            let axes = m.axes().into_iter().map(sir_geom::luminance);
            row.extend(numbers.chain(axes).map(number));
        }
        // Invalid probes have no light.
        row.resize(COLUMNS.len(), String::new());
        table.write_record(row)?;
    }
    table.flush()
}
