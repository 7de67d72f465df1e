//! The error of results against a reference.

use serde::Serialize;
use sir_geom::Rgb;
use sir_view::{Table, compare, luminance};

use crate::error::StudyError;
use crate::experiment::runs::Done;
use crate::experiment::subject::{DIRECT, TABLE};

/// Numbers for luminance and each band.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Bands {
    /// Rec. 709 luminance.
    pub(crate) luminance: f64,
    /// Red.
    pub(crate) red: f64,
    /// Green.
    pub(crate) green: f64,
    /// Blue.
    pub(crate) blue: f64,
}

/// Error of a result against the reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Accuracy {
    /// Root mean square of the difference of the radiosities, weighted by area, relative to the mean of the reference.
    pub(crate) relative_rms: Bands,
    /// Mean of the difference of the radiosities, weighted by area, relative to the mean of the reference.
    pub(crate) relative_bias: Bands,
}

/// Run with many lines, with which results are compared.
pub(crate) struct Reference {
    pub(crate) table: Table,
    /// Power of the light that is reflected after the first reflection, per band: the power in radiosity minus that
    /// after the first shot \[W\].
    pub(crate) reflected: Rgb,
    pub(crate) seconds: f64,
}

impl Reference {
    /// Reads the tables of a run.
    pub(crate) fn read(run: &Done) -> Result<Self, StudyError> {
        let table = run.table(TABLE)?;
        let reflected = power(&table) - power(&run.table(DIRECT)?);
        Ok(Self { table, reflected, seconds: run.report.time.seconds })
    }

    /// Returns the error of a table against the reference.
    pub(crate) fn accuracy(&self, table: &Table) -> Result<Accuracy, StudyError> {
        let c = compare(&self.table, table)?;
        let [red, green, blue] = c.bands;
        let of = |f: fn(&sir_view::BandComparison) -> f64| Bands {
            luminance: f(&c.luminance),
            red: f(&red),
            green: f(&green),
            blue: f(&blue),
        };
        Ok(Accuracy { relative_rms: of(|b| b.relative_rms), relative_bias: of(|b| b.relative_bias) })
    }

    /// Returns the difference of the reflected light from that of the reference, relative to the latter.
    pub(crate) fn reflected_bias(&self, reflected: Rgb) -> Bands {
        let relative = |value: &dyn Fn(Rgb) -> f64| {
            let (ours, theirs) = (value(reflected), value(self.reflected));
            if ours == theirs { 0.0 } else { ours / theirs - 1.0 }
        };
        Bands {
            luminance: relative(&luminance),
            red: relative(&|c| c.x),
            green: relative(&|c| c.y),
            blue: relative(&|c| c.z),
        }
    }

    /// Returns the error that a table states itself, per band, on the scale of [`Accuracy::relative_rms`].
    pub(crate) fn stated(&self, table: &Table) -> [f64; 3] {
        let area: f64 = table.rows.iter().map(|row| row.area).sum();
        let squares: Rgb = table.rows.iter().map(|row| row.area * row.error * row.error).sum();
        let mean = power(&self.table) / area;
        std::array::from_fn(|k| if mean[k] > 0.0 { (squares[k] / area).sqrt() / mean[k] } else { 0.0 })
    }
}

/// Returns the power that leaves all surfaces \[W\].
pub(crate) fn power(table: &Table) -> Rgb {
    table.rows.iter().map(|row| row.area * row.radiosity).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use sir_view::Row;

    fn table(radiosities: &[f64]) -> Table {
        let row = |(i, &b): (usize, &f64)| Row {
            number: i as u32,
            triangle: 0,
            area: 2.0,
            center: DVec3::ZERO,
            normal: DVec3::Z,
            radiosity: Rgb::splat(b),
            irradiance: Rgb::ZERO,
            error: Rgb::splat(0.5),
            irradiance_error: Rgb::ZERO,
        };
        Table { rows: radiosities.iter().enumerate().map(row).collect(), ..Table::default() }
    }

    #[test]
    fn errors_are_relative_to_the_reference() {
        let reference = Reference { table: table(&[1.0, 3.0]), reflected: Rgb::splat(4.0), seconds: 0.0 };
        let accuracy = reference.accuracy(&table(&[2.0, 2.0])).unwrap();
        assert!((accuracy.relative_rms.luminance - 0.5).abs() < 1e-12);
        assert_eq!((accuracy.relative_rms.green, accuracy.relative_bias.blue), (0.5, 0.0));
        assert_eq!(reference.stated(&reference.table), [0.25; 3]);
        assert_eq!(reference.reflected_bias(Rgb::splat(3.0)).red, -0.25);
        assert_eq!(power(&reference.table), Rgb::splat(8.0));
    }
}
