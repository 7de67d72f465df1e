//! What is told about view factors.

use std::collections::BTreeMap;

use serde::Serialize;
use sir_radiosity::{Closed, ClosureError, Receiver, ViewFactors};

use crate::fingerprint::PROGRAM;
use crate::viewfactors::options::{By, SidesOption, ViewFactorsArgs};

/// Version of the JSON file.
const VERSION: u32 = 1;

/// View factors with all that belongs to them. Rows and columns are in the order of the groups.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Report {
    version: u32,
    program: &'static str,
    pub(crate) scene: String,
    pub(crate) by: By,
    pub(crate) sides: SidesOption,
    pub(crate) seed: u64,
    /// Lines of all groups together.
    pub(crate) lines: u64,
    /// What the reader of the scene changed or left out.
    warnings: Vec<String>,
    pub(crate) groups: Vec<Group>,
    /// `F_ij` as counted.
    pub(crate) counted: Matrix,
    /// Of each group, how many lines arrived at each group.
    pub(crate) counts: Vec<Vec<u64>>,
    /// How well both estimates of the same exchange area agree, for all pairs of which something was counted.
    pub(crate) reciprocity: Vec<Pair>,
    /// As adjusted, if that was asked for.
    pub(crate) closed: Option<Matrix>,
}

/// A group of surfaces.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Group {
    /// Its name; of equal names the second one is followed by `(2)`.
    pub(crate) name: String,
    /// Area of its active sides.
    pub(crate) area: f64,
    pub(crate) lines: u64,
}

/// Factors and their standard errors.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Matrix {
    pub(crate) factors: Vec<Vec<f64>>,
    pub(crate) errors: Vec<Vec<f64>>,
    pub(crate) blocked: Vec<f64>,
    pub(crate) blocked_errors: Vec<f64>,
    pub(crate) escaped: Vec<f64>,
    pub(crate) escaped_errors: Vec<f64>,
    pub(crate) row_sums: Vec<f64>,
}

/// Reciprocity of two groups.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Pair {
    pub(crate) from: String,
    pub(crate) to: String,
    /// `A_i F_ij − A_j F_ji`.
    residual: f64,
    error: f64,
    pub(crate) z: f64,
}

impl Report {
    pub(crate) fn new(
        args: &ViewFactorsArgs,
        factors: &ViewFactors,
        warnings: Vec<String>,
    ) -> Result<Self, ClosureError> {
        let closed = if args.closure { Some(factors.closed()?) } else { None };
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
            scene: args.scene.display().to_string(),
            by: args.by,
            sides: args.sides,
            seed: args.seed,
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
    pub(crate) fn to_json(&self) -> String {
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
