//! The report of view factors: the content of `viewfactors.json`.

use std::collections::BTreeMap;

use serde::Serialize;
use sir_geom::SidesPolicy;
use sir_radiosity::{Closed, ClosureError, Receiver, ViewFactors};

use crate::fingerprint::PROGRAM;
use crate::view_factors::options::{By, ViewFactorsOptions};

/// Version of the JSON file.
const VERSION: u32 = 1;

/// View factors with their errors, counts and settings. Rows and columns are in the order of the groups.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Version of this layout.
    pub version: u32,
    /// Name and version of the program.
    pub program: &'static str,
    /// The scene file.
    pub scene: String,
    /// Criterion by which surfaces were grouped.
    pub by: By,
    /// Sides that sent and received: `as-authored`, `both` or `front`.
    pub sides: &'static str,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of lines of all groups together.
    pub lines: u64,
    /// Warnings of the reader of the scene: what it changed or left out.
    pub warnings: Vec<String>,
    /// The groups.
    pub groups: Vec<Group>,
    /// Factors `F_ij` as counted.
    pub counted: Matrix,
    /// `counts[i][j]`: number of lines from group `i` that arrived at group `j`.
    pub counts: Vec<Vec<u64>>,
    /// Agreement of both estimates of the same exchange area, for all pairs with a count above 0.
    pub reciprocity: Vec<Pair>,
    /// Factors after closure, if it was requested.
    pub closed: Option<Matrix>,
}

/// Group of surfaces.
#[derive(Clone, Debug, Serialize)]
pub struct Group {
    /// Name of the group. The second of equal names is followed by `(2)`.
    pub name: String,
    /// Area of the active sides.
    pub area: f64,
    /// Number of lines from this group.
    pub lines: u64,
}

/// Factors and their standard errors.
#[derive(Clone, Debug, Serialize)]
pub struct Matrix {
    /// `factors[i][j]`: share of the flux leaving group `i` that arrives at group `j`.
    pub factors: Vec<Vec<f64>>,
    /// Standard errors of `factors`.
    pub errors: Vec<Vec<f64>>,
    /// Share of each row that backs of one-sided surfaces absorb.
    pub blocked: Vec<f64>,
    /// Standard errors of `blocked`.
    pub blocked_errors: Vec<f64>,
    /// Share of each row that leaves the scene.
    pub escaped: Vec<f64>,
    /// Standard errors of `escaped`.
    pub escaped_errors: Vec<f64>,
    /// Sum of each row, `blocked` and `escaped` included: 1.
    pub row_sums: Vec<f64>,
}

/// Test of the reciprocity of two groups.
#[derive(Clone, Debug, Serialize)]
pub struct Pair {
    /// Name of group `i`.
    pub from: String,
    /// Name of group `j`.
    pub to: String,
    /// `A_i F_ij − A_j F_ji`.
    pub residual: f64,
    /// Standard error of `residual`.
    pub error: f64,
    /// `residual` in standard errors.
    pub z: f64,
}

impl Report {
    pub(super) fn new(
        options: &ViewFactorsOptions,
        factors: &ViewFactors,
        warnings: Vec<String>,
    ) -> Result<Self, ClosureError> {
        let closed = if options.closure { Some(factors.closed()?) } else { None };
        let n = factors.len();
        let names = labels(factors.names());
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        let count = |i, j| factors.count(i, Receiver::Group(j));
        let reciprocity = pairs.filter(|&(i, j)| count(i, j) + count(j, i) > 0).map(|(i, j)| {
            let residual = factors.reciprocity(i, j);
            let (from, to) = (names[i].clone(), names[j].clone());
            Pair { from, to, residual: residual.value, error: residual.error, z: residual.z() }
        });
        Ok(Self {
            version: VERSION,
            program: PROGRAM,
            scene: options.scene.display().to_string(),
            by: options.by,
            sides: name_of(options.sides),
            seed: options.settings.seed,
            lines: factors.total_lines(),
            warnings,
            counted: Matrix::of(n, |i, receiver| {
                let share = factors.share(i, receiver);
                (share.value, share.error)
            }),
            counts: (0..n).map(|i| (0..n).map(|j| count(i, j)).collect()).collect(),
            reciprocity: reciprocity.collect(),
            closed: closed.map(|closed: Closed| Matrix::of(n, |i, receiver| closed.share(i, receiver))),
            groups: names
                .into_iter()
                .zip(factors.lines())
                .enumerate()
                .map(|(i, (name, &lines))| Group { name, area: factors.area(i), lines })
                .collect(),
        })
    }

    /// Returns the report as JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Serializing cannot fail: the report is a tree of plain structs and finite numbers.
        serde_json::to_string_pretty(self).map(|json| json + "\n").unwrap_or_default()
    }
}

impl Matrix {
    fn of(n: usize, share: impl Fn(usize, Receiver) -> (f64, f64)) -> Self {
        let rows: Vec<Vec<(f64, f64)>> =
            (0..n).map(|i| (0..n).map(|j| share(i, Receiver::Group(j))).collect()).collect();
        let column = |receiver| -> (Vec<f64>, Vec<f64>) { (0..n).map(|i| share(i, receiver)).unzip() };
        let (blocked, blocked_errors) = column(Receiver::Blocked);
        let (escaped, escaped_errors) = column(Receiver::Escaped);
        let row_sums = (0..n).map(|i| rows[i].iter().map(|s| s.0).sum::<f64>() + blocked[i] + escaped[i]);
        Self {
            row_sums: row_sums.collect(),
            factors: rows.iter().map(|row| row.iter().map(|s| s.0).collect()).collect(),
            errors: rows.iter().map(|row| row.iter().map(|s| s.1).collect()).collect(),
            blocked,
            blocked_errors,
            escaped,
            escaped_errors,
        }
    }
}

/// Returns the name of a policy in the report.
fn name_of(sides: SidesPolicy) -> &'static str {
    match sides {
        SidesPolicy::AsAuthored => "as-authored",
        SidesPolicy::Both => "both",
        SidesPolicy::Front => "front",
    }
}

/// Returns unique names of the groups.
fn labels(names: &[String]) -> Vec<String> {
    let mut seen: BTreeMap<&str, u32> = BTreeMap::new();
    names
        .iter()
        .map(|name| {
            let name = if name.is_empty() { "(unnamed)" } else { name };
            let times = seen.entry(name).or_default();
            *times += 1;
            if *times == 1 { name.to_owned() } else { format!("{name} ({times})") }
        })
        .collect()
}
