//! Tables as comma-separated values.

use std::io::{self, BufRead, Write};
use std::path::Path;

use crate::error::ViewError;
use crate::table::row::{COLUMNS, Row, bad_value, checked, row};

pub(super) fn write(rows: &[Row], out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "{}", COLUMNS.join(","))?;
    for row in rows {
        write!(out, "{},{}", row.patch, row.triangle)?;
        for x in row.numbers() {
            // The debug form is the shortest that reads back to the same number, with an exponent if that is short.
            write!(out, ",{x:?}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

pub(super) fn read(path: &Path, file: impl BufRead) -> Result<Vec<Row>, ViewError> {
    let mut lines = file.lines();
    let header = match lines.next() {
        Some(line) => line.map_err(ViewError::reading(path))?,
        None => String::new(),
    };
    let names: Vec<&str> = header.trim_start_matches('\u{feff}').split(',').map(str::trim).collect();
    let mut places = [0; COLUMNS.len()];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        *place = names.iter().position(|&name| name == column).ok_or_else(|| ViewError::NotATable {
            path: path.to_owned(),
            why: format!("its first line does not name the column {column}; expected {}", COLUMNS.join(",")),
        })?;
    }
    let mut rows = Vec::new();
    for (number, line) in (1..).zip(lines) {
        let line = line.map_err(ViewError::reading(path))?;
        if line.trim().is_empty() {
            continue;
        }
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let mut values = [0.0; COLUMNS.len()];
        for (column, &place) in places.iter().enumerate() {
            let value = match fields.get(place) {
                None => Err(format!("the row has only {} values", fields.len())),
                Some(field) => match field.parse() {
                    Ok(value) => checked(column, value),
                    Err(_) => Err(format!("\"{field}\" is not a number")),
                },
            };
            values[column] = value.map_err(|why| bad_value(path, number, column, why))?;
        }
        rows.push(row(&values));
    }
    Ok(rows)
}
