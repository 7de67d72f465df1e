//! Tables as NumPy arrays.
//!
//! The `.npy` format, version 1.0 (NumPy Enhancement Proposal 1), consists of the magic bytes, the version, the length
//! of the header in two bytes, the header, and the rows, packed and little-endian. The header is a Python dictionary as
//! text that names the columns, padded with spaces so that the rows begin at a multiple of 64 bytes.

use std::io::{self, Read, Write};
use std::path::Path;

use crate::error::ViewError;
use crate::table::row::{COLUMNS, Row, WHOLE_COLUMNS, bad_value, checked, row};

pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

/// Size of a row in bytes.
const ROW_BYTES: usize = 4 * WHOLE_COLUMNS + 8 * (COLUMNS.len() - WHOLE_COLUMNS);

/// Returns the part of the header that describes the columns.
fn description() -> String {
    let columns: Vec<String> = COLUMNS
        .iter()
        .enumerate()
        .map(|(i, name)| format!("('{name}', '{}')", if i < WHOLE_COLUMNS { "<u4" } else { "<f8" }))
        .collect();
    format!("'descr': [{}]", columns.join(", "))
}

pub(super) fn write(rows: &[Row], out: &mut impl Write) -> io::Result<()> {
    let mut header = format!("{{{}, 'fortran_order': False, 'shape': ({},), }}", description(), rows.len());
    let fixed = MAGIC.len() + 4;
    let padded = (fixed + header.len() + 1).next_multiple_of(64) - fixed;
    header.extend(std::iter::repeat_n(' ', padded - 1 - header.len()));
    header.push('\n');
    out.write_all(MAGIC)?;
    out.write_all(&[1, 0])?;
    out.write_all(&(header.len() as u16).to_le_bytes())?;
    out.write_all(header.as_bytes())?;
    for row in rows {
        out.write_all(&row.patch.to_le_bytes())?;
        out.write_all(&row.triangle.to_le_bytes())?;
        for x in row.numbers() {
            out.write_all(&x.to_le_bytes())?;
        }
    }
    Ok(())
}

pub(super) fn read(path: &Path, mut file: impl Read) -> Result<Vec<Row>, ViewError> {
    let not_a_table = |why: &str| ViewError::NotATable { path: path.to_owned(), why: why.to_owned() };
    let mut start = [0; 10];
    file.read_exact(&mut start).map_err(ViewError::reading(path))?;
    if start[6..8] != [1, 0] {
        return Err(not_a_table("its NumPy format is not version 1.0"));
    }
    let mut header = vec![0; usize::from(u16::from_le_bytes([start[8], start[9]]))];
    file.read_exact(&mut header).map_err(ViewError::reading(path))?;
    let header = String::from_utf8_lossy(&header).into_owned();
    if !header.contains(&description()) {
        return Err(not_a_table(&format!(
            "its columns are not those that this program writes; expected {}",
            description()
        )));
    }
    let count = header
        .split_once("'shape': (")
        .and_then(|(_, rest)| rest.split_once(','))
        .and_then(|(count, _)| count.trim().parse::<usize>().ok())
        .ok_or_else(|| not_a_table("its header does not state the number of rows"))?;
    let mut rows = Vec::new();
    let mut bytes = [0; ROW_BYTES];
    for number in 1..=count {
        if file.read_exact(&mut bytes).is_err() {
            return Err(not_a_table(&format!("it ends before row {number} of {count} (truncated file)")));
        }
        let mut values = [0.0; COLUMNS.len()];
        let (whole, numbers) = bytes.split_at(4 * WHOLE_COLUMNS);
        let whole = whole.chunks_exact(4).map(|b| f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])));
        let numbers = numbers
            .chunks_exact(8)
            .map(|b| f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]));
        for (column, value) in whole.chain(numbers).enumerate() {
            values[column] = checked(column, value).map_err(|why| bad_value(path, number, column, why))?;
        }
        rows.push(row(&values));
    }
    Ok(rows)
}
