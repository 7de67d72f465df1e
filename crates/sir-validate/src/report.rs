//! The report, and its text.

use serde::Serialize;

use crate::check::{Check, LIMIT, Verdict};
use crate::effort::Effort;

/// What became of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Its name.
    pub case: String,
    /// What it is about.
    pub title: String,
    /// Why it was not run, if it was not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skipped: Option<String>,
    /// The answers.
    pub checks: Vec<Check>,
}

/// The outcome of all cases that were asked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// How precise answers had to be.
    pub effort: Effort,
    /// Seed of the random numbers.
    pub seed: u64,
    /// The cases in the order of the reference.
    pub cases: Vec<Outcome>,
}

impl Report {
    /// All answers.
    pub fn checks(&self) -> impl Iterator<Item = &Check> {
        self.cases.iter().flat_map(|case| &case.checks)
    }

    /// Number of answers with this verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.checks().filter(|check| check.verdict == verdict).count()
    }

    /// Whether all answers are right and precise enough.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.checks().all(|check| check.verdict == Verdict::Passed)
    }
}

/// The rows of a table: answers that stand alone, and of each group the one that is farthest off.
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
        let alike = || checks.iter().filter(|other| other.group.as_ref() == Some(group));
        let worst = alike().max_by(|a, b| {
            let failed = |check: &Check| check.verdict != Verdict::Passed;
            failed(a).cmp(&failed(b)).then(a.z.abs().total_cmp(&b.z.abs()))
        });
        if let Some(worst) = worst {
            rows.push((format!("{group}: {}, worst of {}", worst.quantity, alike().count()), worst));
        }
    }
    rows
}

impl Outcome {
    /// Whether it was run, and what came out.
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
    /// How many answers passed, and how many cases were not run, in a sentence.
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

    /// The report for people, in Markdown; columns are aligned, so that it can be read as it is.
    #[must_use]
    pub fn markdown(&self) -> String {
        let (option, precision) = match self.effort {
            Effort::Quick => (" --quick", "0.5"),
            Effort::Full => ("", "0.1"),
        };
        let mut text = format!(
            "# Exact answers and ours\n\n`sir validate{option} --seed {}`. *ours* is the mean of independent runs, *σ* its standard error (at most {precision} % \
             of the exact answer), *z* the difference as a normal variable of deviation 1 would show it; at most {LIMIT} passes.\n\n{}\n",
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

    /// All numbers, for programs.
    #[must_use]
    pub fn json(&self) -> String {
        // A tree of plain structs; numbers that are not finite become `null`.
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

/// Six digits, which is more than any noise leaves.
fn number(x: f64) -> String {
    let before = if x == 0.0 { 1 } else { x.abs().log10().floor() as i32 + 1 };
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

/// A Markdown table; the first and the last column are words.
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
