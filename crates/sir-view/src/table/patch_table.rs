//! The table of a solution: creation, writing and reading.

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

use sir_geom::{Rgb, Scene, Side};
use sir_mesh::PatchMesh;

use crate::atomic_file::write_atomically;
use crate::error::ViewError;
use crate::table::row::Row;
use crate::table::{csv, npy};

/// Table with one row per active side of every patch, in the order of side numbers.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Table {
    /// The rows.
    pub rows: Vec<Row>,
}

impl Table {
    /// Creates the table of a solution: the irradiance `E` \[W/m²\] of every [`SideId`](sir_mesh::SideId), and its
    /// standard error.
    ///
    /// A two-sided patch has two rows with opposite normals. A patch in several triangles has its center and mean normal, and
    /// the number of the first one.
    ///
    /// # Panics
    ///
    /// If there is not exactly one irradiance and one error for every side.
    #[must_use]
    pub fn new(scene: &Scene, mesh: &PatchMesh, irradiance: &[Rgb], error: &[Rgb]) -> Self {
        assert_eq!(irradiance.len(), mesh.side_count(), "one irradiance for every side of the mesh");
        assert_eq!(error.len(), mesh.side_count(), "one error for every side of the mesh");
        let mut rows: Vec<Row> = Vec::with_capacity(mesh.side_count());
        mesh.for_each_side(|t, patch, side, id| {
            let (e, se) = (irradiance[id.index()], error[id.index()]);
            let reflectance = mesh.reflectance(scene, t, patch);
            let (center, normal) = mesh.center_and_normal(scene, t, patch);
            let triangle = mesh.pieces(t, patch).next().map_or(t, |piece| piece.triangle);
            rows.push(Row {
                patch: patch.0,
                triangle: scene.triangle(triangle).source,
                area: mesh.patch_area(t, patch),
                center,
                normal: if side == Side::Front { normal } else { -normal }.normalize_or_zero(),
                radiosity: mesh.exitance(scene, t, patch, side) + reflectance * e,
                irradiance: e,
                error: reflectance * se,
            });
        });
        Self { rows }
    }

    /// Writes comma-separated values: a line with the names of the columns, then a line per row. Numbers have the
    /// shortest form without loss.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<(), ViewError> {
        write_atomically(path, |file| csv::write(&self.rows, file))
    }

    /// Writes a NumPy file: a structured array with the same columns, `<u4` for the first two and `<f8` for the
    /// others. `numpy.load(path)['B_r']` is a column.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_npy(&self, path: &Path) -> Result<(), ViewError> {
        write_atomically(path, |file| npy::write(&self.rows, file))
    }

    /// Reads a file written by [`Table::write_csv`] or [`Table::write_npy`]; its first bytes tell which. A CSV file may
    /// have its columns in another order, and additional columns.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, a column is missing, or a value is not a number; the message names the row and
    /// the column.
    pub fn read(path: &Path) -> Result<Self, ViewError> {
        let mut file = File::open(path).map_err(ViewError::reading(path))?;
        let mut start = Vec::new();
        (&mut file)
            .take(npy::MAGIC.len() as u64)
            .read_to_end(&mut start)
            .map_err(ViewError::reading(path))?;
        file.rewind().map_err(ViewError::reading(path))?;
        let file = BufReader::new(file);
        let rows = if start == npy::MAGIC { npy::read(path, file) } else { csv::read(path, file) };
        Ok(Self { rows: rows? })
    }
}
