//! Rows of a table, and their valid values.

use std::path::Path;

use glam::DVec3;
use sir_geom::Rgb;

use crate::error::ViewError;

/// One active side of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Number of the patch.
    pub patch: u32,
    /// Number of its triangle in the scene's file, from 0.
    pub triangle: u32,
    /// Area \[m²\], including gaps.
    pub area: f64,
    /// Center of area \[m\].
    pub center: DVec3,
    /// Unit normal on this side.
    pub normal: DVec3,
    /// Radiosity `B` \[W/m²\] of the part that is not gap; with a texture, its mean.
    pub radiosity: Rgb,
    /// Irradiance `E` \[W/m²\].
    pub irradiance: Rgb,
    /// Standard error of the radiosity \[W/m²\]; zero where it is not known.
    pub error: Rgb,
}

/// Names of the columns, in file order.
pub const COLUMNS: [&str; 18] = [
    "patch", "triangle", "area", "cx", "cy", "cz", "nx", "ny", "nz", "B_r", "B_g", "B_b", "E_r", "E_g",
    "E_b", "se_r", "se_g", "se_b",
];

/// Number of leading [`COLUMNS`] that hold integers.
pub(super) const WHOLE_COLUMNS: usize = 2;

impl Row {
    /// Returns the columns after the integers.
    pub(super) fn numbers(&self) -> [f64; COLUMNS.len() - WHOLE_COLUMNS] {
        let mut out = [self.area; COLUMNS.len() - WHOLE_COLUMNS];
        let vectors = [self.center, self.normal, self.radiosity, self.irradiance, self.error];
        for (slot, x) in out[1..].iter_mut().zip(vectors.iter().flat_map(|v| v.to_array())) {
            *slot = x;
        }
        out
    }

    fn from_numbers(patch: u32, triangle: u32, x: [f64; COLUMNS.len() - WHOLE_COLUMNS]) -> Self {
        let vector = |i: usize| DVec3::new(x[i], x[i + 1], x[i + 2]);
        Self {
            patch,
            triangle,
            area: x[0],
            center: vector(1),
            normal: vector(4),
            radiosity: vector(7),
            irradiance: vector(10),
            error: vector(13),
        }
    }
}

/// Returns the value if it is valid in this column, otherwise the reason why not.
pub(super) fn checked(column: usize, value: f64) -> Result<f64, String> {
    if !value.is_finite() {
        Err(format!("{value} is not a finite number"))
    } else if column < WHOLE_COLUMNS && (value.fract() != 0.0 || !(0.0..4_294_967_296.0).contains(&value)) {
        Err(format!("{value} is not a whole number below 2³²"))
    } else if COLUMNS[column] == "area" && value <= 0.0 {
        Err(format!("an area must be positive, but this is {value}"))
    } else {
        Ok(value)
    }
}

/// Creates the error for an invalid value in a row and column of a table file.
pub(super) fn bad_value(path: &Path, row: usize, column: usize, why: String) -> ViewError {
    ViewError::BadValue { path: path.to_owned(), row, column: COLUMNS[column].to_owned(), why }
}

/// Creates a row from checked values in the order of the columns.
pub(super) fn row(values: &[f64; COLUMNS.len()]) -> Row {
    let mut numbers = [0.0; COLUMNS.len() - WHOLE_COLUMNS];
    numbers.copy_from_slice(&values[WHOLE_COLUMNS..]);
    Row::from_numbers(values[0] as u32, values[1] as u32, numbers)
}
