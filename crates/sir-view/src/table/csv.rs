//! Tables as comma-separated values.

use std::io::{self, Read, Write};
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim, Writer};

use crate::error::ViewError;
use crate::table::row::{Columns, Table, bad_value};

pub(super) fn write(table: &Table, out: &mut impl Write) -> io::Result<()> {
    let columns = Columns::of(table.per);
    let mut csv = Writer::from_writer(out);
    csv.write_record(columns.names())?;
    for (i, row) in table.rows.iter().enumerate() {
        if columns.has_names() {
            csv.write_field(&table.names[i])?;
        }
        for x in columns.whole_of(row) {
            csv.write_field(x.to_string())?;
        }
        for x in columns.numbers_of(row) {
            // The `Debug` form is the shortest that reads back to the same number, with an exponent if that is shorter.
            csv.write_field(format!("{x:?}"))?;
        }
        csv.write_record(None::<&[u8]>)?;
    }
    csv.flush()
}

pub(super) fn read(path: &Path, file: impl Read) -> Result<Table, ViewError> {
    let failed = |error: csv::Error| ViewError::reading(path)(error.into());
    let mut csv = ReaderBuilder::new().flexible(true).trim(Trim::All).from_reader(file);
    let header = csv.headers().map_err(failed)?;
    let place_of = |column: &str| header.iter().position(|name| name == column);
    let known = Columns::ALL.into_iter().find(|columns| place_of(columns.key()).is_some());
    let columns = known.unwrap_or(Columns::of(None));
    let names = columns.names();
    let places: Result<Vec<usize>, _> = names
        .iter()
        .map(|column| {
            place_of(column).ok_or_else(|| ViewError::NotATable {
                path: path.to_owned(),
                why: format!(
                    "its first line does not name the column {column}; expected {}",
                    names.join(",")
                ),
            })
        })
        .collect();
    let places = places?;
    let mut table = Table { per: columns.per(), ..Table::default() };
    let (mut fields, mut values) = (StringRecord::new(), Vec::new());
    while csv.read_record(&mut fields).map_err(failed)? {
        // A blank line.
        if fields.iter().all(str::is_empty) {
            continue;
        }
        values.clear();
        for (column, &place) in names.iter().zip(&places) {
            let field = fields.get(place).ok_or_else(|| format!("the row has only {} values", fields.len()));
            let value = match field {
                Ok(field) if columns.has_names() && *column == columns.key() => {
                    table.names.push(field.to_owned());
                    continue;
                }
                Ok(field) => match field.parse() {
                    Ok(value) => columns.checked(column, value),
                    Err(_) => Err(format!("\"{field}\" is not a number")),
                },
                Err(why) => Err(why),
            };
            values.push(value.map_err(|why| bad_value(path, table.rows.len() + 1, column, why))?);
        }
        table.rows.push(columns.row(table.rows.len(), &values));
    }
    Ok(table)
}
