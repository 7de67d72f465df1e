//! Table files.

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

use crate::atomic_file::write_atomically;
use crate::error::ViewError;
use crate::table::row::Table;
use crate::table::{csv, npy};

impl Table {
    /// Writes comma-separated values: a line with the names of the columns, then a line per row. Numbers have the
    /// shortest form without loss.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<(), ViewError> {
        write_atomically(path, |file| csv::write(self, file))
    }

    /// Writes a NumPy file: a structured array with the same columns, `<u4` for whole numbers, `<U` for names and `<f8` for
    /// the others. `numpy.load(path)['B_r']` is a column.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_npy(&self, path: &Path) -> Result<(), ViewError> {
        write_atomically(path, |file| npy::write(self, file))
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
        if start == npy::MAGIC { npy::read(path, file) } else { csv::read(path, file) }
    }
}
