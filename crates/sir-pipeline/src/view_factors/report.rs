//! What is told about view factors.

use std::collections::BTreeMap;

use serde::Serialize;
use sir_geom::SidesPolicy;
use sir_radiosity::{Closed, ClosureError, Receiver, ViewFactors};

use crate::fingerprint::PROGRAM;
use crate::view_factors::options::{By, ViewFactorsOptions};

/// Version of the JSON file.
const VERSION: u32 = 1;

/// View factors with all that belongs to them. Rows and columns are in the order of the groups.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Version of this layout.
    pub version: u32,
    /// Name and version of the program.
    pub program: &'static str,
    /// The scene file.
    pub scene: String,
    /// What makes a group.
    pub by: By,
    /// Which sides took part: `as-authored`, `both` or `front`.
    pub sides: &'static str,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Lines of all groups together.
    pub lines: u64,
    /// What the reader of the scene changed or left out.
    pub warnings: Vec<String>,
    /// The groups.
    pub groups: Vec<Group>,
    /// `F_ij` as counted.
    pub counted: Matrix,
    /// Of each group, how many lines arrived at each group.
    pub counts: Vec<Vec<u64>>,
    /// How well both estimates of the same exchange area agree, for all pairs of which something was counted.
    pub reciprocity: Vec<Pair>,
    /// As adjusted, if that was asked for.
    pub closed: Option<Matrix>,
}

/// A group of surfaces.
#[derive(Clone, Debug, Serialize)]
pub struct Group {
    /// Its name; of equal names the second one is followed by `(2)`.
    pub name: String,
    /// Area of its active sides.
    pub area: f64,
    /// Lines from this group.
    pub lines: u64,
}

/// Factors and their standard errors.
#[derive(Clone, Debug, Serialize)]
pub struct Matrix {
    /// `factors[i][j]`: share of what leaves group `i` that arrives at group `j`.
    pub factors: Vec<Vec<f64>>,
    /// Standard errors of `factors`.
    pub errors: Vec<Vec<f64>>,
    /// Shares that backs of one-sided surfaces absorb.
    pub blocked: Vec<f64>,
    /// Their standard errors.
    pub blocked_errors: Vec<f64>,
    /// Shares that leave the scene.
    pub escaped: Vec<f64>,
    /// Their standard errors.
    pub escaped_errors: Vec<f64>,
    /// Sum of each row: 1.
    pub row_sums: Vec<f64>,
}

/// Reciprocity of two groups.
#[derive(Clone, Debug, Serialize)]
pub struct Pair {
    /// One of the groups.
    pub from: String,
    /// The other one.
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

    /// For programs.
    #[must_use]
    pub fn to_json(&self) -> String {
        // A tree of plain structs and finite numbers.
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

/// The name of a policy in the report.
fn name_of(sides: SidesPolicy) -> &'static str {
    match sides {
        SidesPolicy::AsAuthored => "as-authored",
        SidesPolicy::Both => "both",
        SidesPolicy::Front => "front",
    }
}

/// Names that tell groups apart.
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
