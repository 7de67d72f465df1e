//! The report and its text.

use serde::Serialize;

use crate::check::{Check, LIMIT, Verdict};
use crate::effort::Effort;

/// Outcome of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// ID of the case.
    pub case: String,
    /// Title of the case.
    pub title: String,
    /// Reason why the case was not run; `None` if it was run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skipped: Option<String>,
    /// Comparisons with exact answers.
    pub checks: Vec<Check>,
}

/// Outcomes of all selected cases.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Required precision of the answers.
    pub effort: Effort,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Cases, in the order of the reference.
    pub cases: Vec<Outcome>,
}

impl Report {
    /// Returns the comparisons of all answers.
    pub fn checks(&self) -> impl Iterator<Item = &Check> {
        self.cases.iter().flat_map(|case| &case.checks)
    }

    /// Returns the number of answers with this verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.checks().filter(|check| check.verdict == verdict).count()
    }

    /// Returns true if all answers are correct and precise enough.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.checks().all(|check| check.verdict == Verdict::Passed)
    }
}

/// Returns the rows of a table: answers without a group, and the worst answer of each group.
fn rows(checks: &[Check]) -> Vec<(String, &Check)> {
    let mut rows: Vec<(String, &Check)> = Vec::new();
    let mut shown: Vec<&str> = Vec::new();
    for check in checks {
        let Some(group) = &check.group else {
            rows.push((check.quantity.clone(), check));
            continue;
        };
        if shown.contains(&group.as_str()) {
            continue;
        }
        shown.push(group);
        let of_group = || checks.iter().filter(|other| other.group.as_ref() == Some(group));
        let worst = of_group().max_by(|a, b| {
            let failed = |check: &Check| check.verdict != Verdict::Passed;
            failed(a).cmp(&failed(b)).then(a.z.abs().total_cmp(&b.z.abs()))
        });
        if let Some(worst) = worst {
            rows.push((format!("{group}: {}, worst of {}", worst.quantity, of_group().count()), worst));
        }
    }
    rows
}

impl Outcome {
    /// Returns a word: `skipped`, `ok`, or the first verdict that is not a pass.
    #[must_use]
    pub fn word(&self) -> &'static str {
        if self.skipped.is_some() {
            return "skipped";
        }
        let failed = |check: &&Check| check.verdict != Verdict::Passed;
        self.checks.iter().find(failed).map_or("ok", |check| check.verdict.word())
    }
}

impl Report {
    /// Returns a sentence with the number of answers per verdict, and the cases that were not run.
    #[must_use]
    pub fn summary(&self) -> String {
        let skipped: Vec<&str> =
            self.cases.iter().filter(|c| c.skipped.is_some()).map(|c| c.case.as_str()).collect();
        let (passed, all) = (self.count(Verdict::Passed), self.checks().count());
        let mut text = format!(
            "{passed} of {all} answers in {} cases are exact to within noise",
            self.cases.len() - skipped.len()
        );
        for (verdict, what) in [(Verdict::Wrong, "are wrong"), (Verdict::TooNoisy, "are too noisy to tell")] {
            match self.count(verdict) {
                0 => {}
                count => text += &format!("; {count} {what}"),
            }
        }
        if !skipped.is_empty() {
            text += &format!("; not run: {}", skipped.join(", "));
        }
        text + "."
    }

    /// Returns the report in Markdown. Columns are aligned, so that it is also readable as plain text.
    #[must_use]
    pub fn markdown(&self) -> String {
        let (option, precision) = match self.effort {
            Effort::Quick => (" --quick", "0.5"),
            Effort::Full => ("", "0.1"),
        };
        let mut text = format!(
            "# Exact answers and ours\n\n`sir validate{option} --seed {}`. *ours* is the mean of independent runs, \
             *σ* its standard error (at most {precision} % of the exact answer), *z* the difference as a standard \
             normal deviate; an answer passes if its size is at most {LIMIT}.\n\n{}\n",
            self.seed,
            self.summary()
        );
        for case in &self.cases {
            text += &format!("\n## {}: {}\n\n", case.case, case.title);
            text += &match &case.skipped {
                Some(why) => format!("Not run: {why}.\n"),
                None => table(&case.checks),
            };
        }
        text
    }

    /// Returns all numbers as JSON.
    #[must_use]
    pub fn json(&self) -> String {
        // Plain structs always serialize; numbers that are not finite become `null`.
        serde_json::to_string_pretty(self).map(|json| json + "\n").unwrap_or_default()
    }
}

fn table(checks: &[Check]) -> String {
    let published = checks.iter().any(|check| check.published.is_some());
    let mut grid = vec![["quantity", "exact", "ours", "σ", "z", "runs", ""].map(str::to_owned).to_vec()];
    if published {
        grid[0].insert(6, "published".into());
    }
    for (name, check) in rows(checks) {
        let mut row = vec![
            name.replace('|', "\\|"),
            number(check.exact),
            number(check.ours),
            percent(check.sigma, check.exact),
            if check.z == 0.0 { "0".into() } else { format!("{:+.2}", check.z).replace('-', "−") },
            check.runs.to_string(),
            check.verdict.word().into(),
        ];
        if published {
            row.insert(6, check.published.map_or(String::new(), |value| value.to_string()));
        }
        grid.push(row);
    }
    aligned(&grid)
}

/// Formats a number with six digits, which is more than noise leaves significant.
fn number(x: f64) -> String {
    let before = if x == 0.0 { 1 } else { libm::log10(x.abs()).floor() as i32 + 1 };
    let text = format!("{:.*}", (6 - before).clamp(0, 9) as usize, x);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn percent(sigma: f64, exact: f64) -> String {
    match sigma / exact.abs() {
        _ if sigma == 0.0 => "0".into(),
        share if share < 1e-5 => "< 0.001 %".into(),
        share => format!("{:.3} %", 100.0 * share),
    }
}

/// Formats a Markdown table, whose first and last columns are words.
fn aligned(grid: &[Vec<String>]) -> String {
    let columns = grid.first().map_or(0, Vec::len);
    let width = |column: usize| grid.iter().map(|row| row[column].chars().count()).max().unwrap_or(0).max(3);
    let is_word = |column: usize| column == 0 || column + 1 == columns;
    let mut text = String::new();
    for (number, row) in grid.iter().enumerate() {
        for (column, cell) in row.iter().enumerate() {
            let pad = " ".repeat(width(column) - cell.chars().count());
            text += &if is_word(column) { format!("| {cell}{pad} ") } else { format!("| {pad}{cell} ") };
        }
        text += "|\n";
        if number == 0 {
            for column in 0..columns {
                let rule = "-".repeat(width(column) - 1);
                text += &if is_word(column) { format!("| {rule}- ") } else { format!("| {rule}: ") };
            }
            text += "|\n";
        }
    }
    text
}
