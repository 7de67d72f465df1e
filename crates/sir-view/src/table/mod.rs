//! The per-patch table: the solution in numbers.

mod compare;
mod csv;
mod npy;

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

use glam::DVec3;
use sir_geom::{Rgb, Scene, Side};
use sir_mesh::{PatchId, PatchMesh};

use crate::atomic_file::write_atomically;
use crate::error::ViewError;

pub use compare::{BandComparison, Comparison, WorstRow, compare};

/// One active side of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Number of the patch.
    pub patch: u32,
    /// Number of its triangle in the scene's file, from 0.
    pub triangle: u32,
    /// Area \[m²\], gaps included.
    pub area: f64,
    /// Centre of area \[m\].
    pub centre: DVec3,
    /// Unit normal on this side.
    pub normal: DVec3,
    /// Radiosity `B` \[W/m²\] of what is not gap; with a texture, its mean.
    pub radiosity: Rgb,
    /// Irradiance `E` \[W/m²\].
    pub irradiance: Rgb,
    /// Standard error of the radiosity \[W/m²\]; zero where it is not known.
    pub error: Rgb,
}

/// Names of the columns, in the order of a file.
pub const COLUMNS: [&str; 18] = [
    "patch", "triangle", "area", "cx", "cy", "cz", "nx", "ny", "nz", "B_r", "B_g", "B_b", "E_r", "E_g",
    "E_b", "se_r", "se_g", "se_b",
];

/// How many of the [`COLUMNS`], the first ones, hold whole numbers.
const WHOLE_COLUMNS: usize = 2;

impl Row {
    /// The columns after the whole numbers.
    fn numbers(&self) -> [f64; COLUMNS.len() - WHOLE_COLUMNS] {
        let mut out = [self.area; COLUMNS.len() - WHOLE_COLUMNS];
        let vectors = [self.centre, self.normal, self.radiosity, self.irradiance, self.error];
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
            centre: vector(1),
            normal: vector(4),
            radiosity: vector(7),
            irradiance: vector(10),
            error: vector(13),
        }
    }
}

/// One row for every active side of every patch, in the order of their numbers.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Table {
    /// The rows.
    pub rows: Vec<Row>,
}

impl Table {
    /// The table of a solution: the irradiance `E` \[W/m²\] of every [`SideId`](sir_mesh::SideId), and its
    /// standard error.
    ///
    /// A two-sided patch has two rows, with opposite normals. A face that is one patch has the centre and the mean
    /// normal of all its triangles, and the number of the first one.
    ///
    /// # Panics
    ///
    /// If there is not one irradiance and one error for every side.
    #[must_use]
    pub fn new(scene: &Scene, mesh: &PatchMesh, irradiance: &[Rgb], error: &[Rgb]) -> Self {
        assert_eq!(irradiance.len(), mesh.side_count(), "one irradiance for every side of the mesh");
        assert_eq!(error.len(), mesh.side_count(), "one error for every side of the mesh");
        let mut rows: Vec<Row> = Vec::with_capacity(mesh.side_count());
        mesh.for_each_side(|t, patch, side, id| {
            let (e, se) = (irradiance[id.index()], error[id.index()]);
            let reflectance = mesh.reflectance(scene, t, patch);
            rows.push(Row {
                patch: patch.0,
                triangle: scene.triangle(t).source,
                area: mesh.patch_area(t),
                centre: DVec3::ZERO,
                normal: DVec3::ZERO,
                radiosity: mesh.exitance(scene, t, patch, side) + reflectance * e,
                irradiance: e,
                error: reflectance * se,
            });
        });
        // Centres and normals are means over all triangles of a patch, which are several if faces are patches.
        for t in scene.triangle_ids() {
            let (corners, normal) = (scene.corners(t), scene.normal(t));
            let patches = mesh.patches_of(t);
            let part = scene.area(t) / patches.len() as f64;
            for patch in patches.map(PatchId) {
                let c = mesh.patch_corners(t, patch).map(|b| b.point(corners));
                for (side, outward) in [(Side::Front, normal), (Side::Back, -normal)] {
                    if let Some(id) = mesh.side_of(t, patch, side) {
                        let row = &mut rows[id.index()];
                        row.centre += part / row.area * (c[0] + c[1] + c[2]) / 3.0;
                        row.normal += part / row.area * outward;
                    }
                }
            }
        }
        for row in &mut rows {
            row.normal = row.normal.normalize_or_zero();
        }
        Self { rows }
    }

    /// Writes comma-separated values: a line with the names of the columns, then a line for each row. Numbers are
    /// as short as they can be without loss.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<(), ViewError> {
        write_atomically(path, |file| csv::write(self, file))
    }

    /// Writes a NumPy file: a structured array with the same columns, `<u4` for the first two and `<f8` for the
    /// others. `numpy.load(path)['B_r']` is a column.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_npy(&self, path: &Path) -> Result<(), ViewError> {
        write_atomically(path, |file| npy::write(self, file))
    }

    /// Reads a file that one of the above has written; its first bytes tell which. A CSV file may have its columns
    /// in another order, and further ones.
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

/// A value as a row of a table may hold it; otherwise why it may not.
fn checked(column: usize, value: f64) -> Result<f64, String> {
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

/// What to say of a value that may not stand in a row and column of a table file.
fn bad_value(path: &Path, row: usize, column: usize, why: String) -> ViewError {
    ViewError::BadValue { path: path.to_owned(), row, column: COLUMNS[column].to_owned(), why }
}

/// A row from values in the order of the columns, all of them checked.
fn row(values: &[f64; COLUMNS.len()]) -> Row {
    let mut numbers = [0.0; COLUMNS.len() - WHOLE_COLUMNS];
    numbers.copy_from_slice(&values[WHOLE_COLUMNS..]);
    Row::from_numbers(values[0] as u32, values[1] as u32, numbers)
}
