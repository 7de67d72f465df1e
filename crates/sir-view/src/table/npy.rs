//! Tables as NumPy arrays.
//!
//! The `.npy` format, version 1.0 (NumPy Enhancement Proposal 1), consists of the magic bytes, the version, the length
//! of the header in two bytes, the header, and the rows, packed and little-endian. The header is a Python dictionary as
//! text that names the columns, padded with spaces so that the rows begin at a multiple of 64 bytes. Names are UTF-32,
//! all of the same width, padded with zeros.

use std::io::{self, Read, Write};
use std::path::Path;

use crate::error::ViewError;
use crate::table::row::{Columns, Table, bad_value};

pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

/// Returns the part of the header that describes the columns, with names of this number of characters.
fn description(columns: Columns, width: usize) -> String {
    let name = columns.has_names().then(|| format!("('{}', '<U{width}')", columns.key()));
    let whole = columns.whole().iter().map(|name| format!("('{name}', '<u4')"));
    let numbers = columns.numbers().map(|name| format!("('{name}', '<f8')"));
    let all: Vec<String> = name.into_iter().chain(whole).chain(numbers).collect();
    format!("'descr': [{}]", all.join(", "))
}

pub(super) fn write(table: &Table, out: &mut impl Write) -> io::Result<()> {
    let columns = Columns::of(table.per);
    // NumPy has no names without characters.
    let width = table.names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(1);
    let description = description(columns, width);
    let mut header = format!("{{{description}, 'fortran_order': False, 'shape': ({},), }}", table.rows.len());
    let fixed = MAGIC.len() + 4;
    let padded = (fixed + header.len() + 1).next_multiple_of(64) - fixed;
    header.extend(std::iter::repeat_n(' ', padded - 1 - header.len()));
    header.push('\n');
    out.write_all(MAGIC)?;
    out.write_all(&[1, 0])?;
    out.write_all(&(header.len() as u16).to_le_bytes())?;
    out.write_all(header.as_bytes())?;
    for (i, row) in table.rows.iter().enumerate() {
        if columns.has_names() {
            let padding = std::iter::repeat_n(0, width);
            for character in table.names[i].chars().map(u32::from).chain(padding).take(width) {
                out.write_all(&character.to_le_bytes())?;
            }
        }
        for x in columns.whole_of(row) {
            out.write_all(&x.to_le_bytes())?;
        }
        for x in columns.numbers_of(row) {
            out.write_all(&x.to_le_bytes())?;
        }
    }
    Ok(())
}

pub(super) fn read(path: &Path, mut file: impl Read) -> Result<Table, ViewError> {
    let not_a_table = |why: &str| ViewError::NotATable { path: path.to_owned(), why: why.to_owned() };
    let mut start = [0; 10];
    file.read_exact(&mut start).map_err(ViewError::reading(path))?;
    if start[6..8] != [1, 0] {
        return Err(not_a_table("its NumPy format is not version 1.0"));
    }
    let mut header = vec![0; usize::from(u16::from_le_bytes([start[8], start[9]]))];
    file.read_exact(&mut header).map_err(ViewError::reading(path))?;
    let header = String::from_utf8_lossy(&header).into_owned();
    let between = |start: &str, end: char| {
        header.split_once(start).and_then(|(_, rest)| rest.split_once(end)).map(|(text, _)| text)
    };
    let width = between("'<U", '\'').and_then(|width| width.parse::<usize>().ok()).unwrap_or(0);
    let known = Columns::ALL.into_iter().find(|&columns| header.contains(&description(columns, width)));
    let columns = known.ok_or_else(|| {
        not_a_table(&format!(
            "its columns are not those that this program writes; for patches: {}",
            description(Columns::of(None), 0)
        ))
    })?;
    let count = between("'shape': (", ',')
        .and_then(|count| count.trim().parse::<usize>().ok())
        .ok_or_else(|| not_a_table("its header does not state the number of rows"))?;
    let mut table = Table { per: columns.per(), ..Table::default() };
    let (name, whole) = (if columns.has_names() { 4 * width } else { 0 }, 4 * columns.whole().len());
    let names: Vec<&str> = columns.whole().iter().copied().chain(columns.numbers()).collect();
    let mut bytes = vec![0; name + whole + 8 * columns.numbers().count()];
    for number in 1..=count {
        if file.read_exact(&mut bytes).is_err() {
            return Err(not_a_table(&format!("it ends before row {number} of {count} (truncated file)")));
        }
        let (name, rest) = bytes.split_at(name);
        let (whole, numbers) = rest.split_at(whole);
        if columns.has_names() {
            let characters = name.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes));
            let characters = characters.take_while(|character| *character != 0);
            table.names.push(characters.filter_map(char::from_u32).collect());
        }
        let whole = whole.as_chunks().0.iter().map(|bytes| f64::from(u32::from_le_bytes(*bytes)));
        let numbers = numbers.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes));
        let values: Result<Vec<f64>, _> = names
            .iter()
            .zip(whole.chain(numbers))
            .map(|(column, value)| {
                columns.checked(column, value).map_err(|why| bad_value(path, number, column, why))
            })
            .collect();
        table.rows.push(columns.row(table.rows.len(), &values?));
    }
    Ok(table)
}
