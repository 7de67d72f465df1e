//! Comparison of two solutions of the same patches, or of the same parts of a scene.

use sir_geom::{Rgb, luminance};

use crate::error::ViewError;
use crate::table::row::{Columns, Table};

/// Difference of the radiosities in one band, or in luminance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandComparison {
    /// Area-weighted mean of the radiosity of the first table \[W/m²\].
    pub mean: f64,
    /// Root of the area-weighted mean square of the difference, relative to `mean`.
    pub relative_rms: f64,
    /// Area-weighted mean of second minus first, relative to `mean`.
    pub relative_bias: f64,
}

/// A row with a large difference between two tables.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstRow {
    /// Index of the row in both tables, from 0.
    pub row: usize,
    /// Number of the patch, triangle or face, or name of the material or group.
    pub part: String,
    /// Number of the triangle in the scene's file; of a patch or face, that of its first one.
    pub triangle: u32,
    /// Luminance of the radiosity in the first and in the second table \[W/m²\].
    pub luminance: [f64; 2],
    /// Second minus first over the standard error of this difference, in the band where it is largest; `None` if there
    /// is no band in which both tables state an error.
    pub z: Option<f64>,
}

/// Result of [`compare`].
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// What a row is: `patch`, `triangle`, `face`, `material` or `group`.
    pub of: &'static str,
    /// Number of rows compared.
    pub rows: usize,
    /// Differences in red, green and blue.
    pub bands: [BandComparison; 3],
    /// Difference in Rec. 709 luminance.
    pub luminance: BandComparison,
    /// Largest `|z|` of all rows and bands; `None` if no row states its error in both tables.
    pub largest_z: Option<f64>,
    /// Rows that contribute most to the difference in luminance (area times square of the difference), worst first.
    pub worst: Vec<WorstRow>,
}

/// Largest number of worst rows listed.
const MAX_WORST_ROWS: usize = 10;

/// Largest relative difference of the areas of the same patch in two tables.
const AREA_TOLERANCE: f64 = 1e-6;

/// Compares the radiosities of two tables of the same patches or parts. Differences are relative to the area-weighted mean
/// radiosity of the first table (zero if both are black, infinite if only the first is).
///
/// # Errors
///
/// If the tables differ in the kind or number of rows, or in the patch (or part) or area of a row.
pub fn compare(a: &Table, b: &Table) -> Result<Comparison, ViewError> {
    check_match(a, b)?;
    let band = |value: &dyn Fn(Rgb) -> f64| {
        let (mut area, mut sum, mut difference, mut square) = (0.0, 0.0, 0.0, 0.0);
        for (x, y) in a.rows.iter().zip(&b.rows) {
            let d = value(y.radiosity) - value(x.radiosity);
            area += x.area;
            sum += x.area * value(x.radiosity);
            difference += x.area * d;
            square += x.area * d * d;
        }
        let relative = |d: f64| if d == 0.0 { 0.0 } else { d / (sum / area) };
        BandComparison {
            mean: if area > 0.0 { sum / area } else { 0.0 },
            relative_rms: relative((square / area).sqrt()),
            relative_bias: relative(difference / area),
        }
    };
    let z_scores: Vec<Option<f64>> = (0..a.rows.len()).map(|i| z_score(a, b, i)).collect();
    let luminances = |i: usize| [luminance(a.rows[i].radiosity), luminance(b.rows[i].radiosity)];
    let weight = |i: usize| {
        let [x, y] = luminances(i);
        a.rows[i].area * (y - x) * (y - x)
    };
    let mut order: Vec<usize> = (0..a.rows.len()).filter(|&i| weight(i) > 0.0).collect();
    order.sort_by(|&i, &j| weight(j).total_cmp(&weight(i)).then(i.cmp(&j)));
    order.truncate(MAX_WORST_ROWS);
    Ok(Comparison {
        of: Columns::of(a.per).key(),
        rows: a.rows.len(),
        bands: [band(&|c| c.x), band(&|c| c.y), band(&|c| c.z)],
        luminance: band(&luminance),
        largest_z: z_scores.iter().flatten().map(|z| z.abs()).max_by(f64::total_cmp),
        worst: order
            .into_iter()
            .map(|row| WorstRow {
                row,
                part: part(a, row),
                triangle: a.rows[row].triangle,
                luminance: luminances(row),
                z: z_scores[row],
            })
            .collect(),
    })
}

/// Returns the number or name of a row.
fn part(table: &Table, row: usize) -> String {
    table.names.get(row).cloned().unwrap_or_else(|| table.rows[row].number.to_string())
}

fn check_match(a: &Table, b: &Table) -> Result<(), ViewError> {
    let mismatch = |why| Err(ViewError::Mismatch { why });
    let [kind, other] = [a, b].map(|table| Columns::of(table.per).key());
    if kind != other {
        return mismatch(format!("a row of the first is a {kind}, of the second a {other}"));
    }
    if a.rows.len() != b.rows.len() {
        return mismatch(format!("the first has {} rows, the second {}", a.rows.len(), b.rows.len()));
    }
    for (i, (x, y)) in a.rows.iter().zip(&b.rows).enumerate() {
        let (number, [this, that]) = (i + 1, [a, b].map(|table| part(table, i)));
        if this != that {
            return mismatch(format!("row {number} is {kind} {this} in the first, {that} in the second"));
        }
        if (x.area - y.area).abs() > AREA_TOLERANCE * x.area {
            return mismatch(format!(
                "{kind} {this} (row {number}) has the area {} in the first, {} in the second",
                x.area, y.area
            ));
        }
    }
    Ok(())
}

/// Returns the largest difference of a row in standard errors, over the bands in which both tables state an error.
fn z_score(a: &Table, b: &Table, row: usize) -> Option<f64> {
    let (x, y) = (&a.rows[row], &b.rows[row]);
    (0..3)
        .filter(|&i| x.error[i] > 0.0 && y.error[i] > 0.0)
        .map(|i| (y.radiosity[i] - x.radiosity[i]) / x.error[i].hypot(y.error[i]))
        .max_by(|p, q| p.abs().total_cmp(&q.abs()))
}
