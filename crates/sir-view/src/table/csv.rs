//! Tables as comma-separated values.

use std::io::{self, Read, Write};
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim, Writer};

use crate::error::ViewError;
use crate::table::row::{COLUMNS, Row, bad_value, checked, row};

pub(super) fn write(rows: &[Row], out: &mut impl Write) -> io::Result<()> {
    let mut csv = Writer::from_writer(out);
    csv.write_record(COLUMNS)?;
    for row in rows {
        csv.write_field(row.patch.to_string())?;
        csv.write_field(row.triangle.to_string())?;
        for x in row.numbers() {
            // The `Debug` form is the shortest that reads back to the same number, with an exponent if that is shorter.
            csv.write_field(format!("{x:?}"))?;
        }
        csv.write_record(None::<&[u8]>)?;
    }
    csv.flush()
}

pub(super) fn read(path: &Path, file: impl Read) -> Result<Vec<Row>, ViewError> {
    let failed = |error: csv::Error| ViewError::reading(path)(error.into());
    let mut csv = ReaderBuilder::new().flexible(true).trim(Trim::All).from_reader(file);
    let names = csv.headers().map_err(failed)?;
    let mut places = [0; COLUMNS.len()];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        *place = names.iter().position(|name| name == column).ok_or_else(|| ViewError::NotATable {
            path: path.to_owned(),
            why: format!("its first line does not name the column {column}; expected {}", COLUMNS.join(",")),
        })?;
    }
    let mut rows = Vec::new();
    let mut fields = StringRecord::new();
    while csv.read_record(&mut fields).map_err(failed)? {
        // A blank line.
        if fields.iter().all(str::is_empty) {
            continue;
        }
        let mut values = [0.0; COLUMNS.len()];
        for (column, &place) in places.iter().enumerate() {
            let value = match fields.get(place) {
                None => Err(format!("the row has only {} values", fields.len())),
                Some(field) => match field.parse() {
                    Ok(value) => checked(column, value),
                    Err(_) => Err(format!("\"{field}\" is not a number")),
                },
            };
            values[column] = value.map_err(|why| bad_value(path, rows.len() + 1, column, why))?;
        }
        rows.push(row(&values));
    }
    Ok(rows)
}
