//! View factors as text for terminals.

use std::path::PathBuf;

use sir_pipeline::format::grouped;
use sir_pipeline::view_factors::{Matrix, Report};

/// Maximum number of groups for which the table is printed.
const MAX_GROUPS: usize = 12;

/// Maximum length of a name in a table, in characters.
const MAX_NAME: usize = 24;

/// Returns the table, or a list of the groups if there are many, with its accuracy.
pub(super) fn text(report: &Report, paths: &[PathBuf]) -> String {
    let mut out = if report.groups.len() > MAX_GROUPS {
        format!("{}\n{} groups; --out DIR writes the table\n", list(report), report.groups.len())
    } else {
        let mut out = String::from("View factors from the group of the row to the group of the column\n\n");
        out += &table(report, &report.counted);
        if let Some(closed) = &report.closed {
            out += "\nAdjusted to reciprocity and sums of 1\n\n";
            out += &table(report, closed);
        }
        out
    };
    out += &format!(
        "\n{} lines, seed {}; `<` is an upper bound with 95 % confidence where no line arrived; ± is the largest standard error of a row\n",
        grouped(report.lines),
        report.seed
    );
    out += &reciprocity(report);
    paths.iter().for_each(|path| out += &format!("{}\n", path.display()));
    out
}

/// Returns the number of decimals that show at least one digit of an error.
fn digits(error: f64) -> usize {
    (2..9).find(|&digits| error >= 10f64.powi(-digits)).map_or(9, |digits| digits as usize)
}

fn row_error(report: &Report, matrix: &Matrix, i: usize) -> f64 {
    let errors = &matrix.errors[i][..report.groups.len()];
    errors.iter().copied().fold(matrix.blocked_errors[i].max(matrix.escaped_errors[i]), f64::max)
}

fn names(report: &Report) -> Vec<String> {
    let cut = |name: String| match name.char_indices().nth(MAX_NAME) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name,
    };
    // Control characters could manipulate a terminal.
    let plain = |name: &str| name.chars().map(|c| if c.is_control() { '�' } else { c }).collect::<String>();
    report.groups.iter().map(|group| cut(plain(&group.name))).collect()
}

fn table(report: &Report, matrix: &Matrix) -> String {
    let names = names(report);
    let wide = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let mut out = format!("   {:<wide$} {:>10}", "", "area");
    (1..=names.len()).for_each(|number| out += &format!(" {number:>9}"));
    out += &format!(" {:>9} {:>9} {:>9}\n", "blocked", "escaped", "±");
    for (i, (name, group)) in names.iter().zip(&report.groups).enumerate() {
        let error = row_error(report, matrix, i);
        let digits = digits(error);
        out += &format!("{:>2} {name:<wide$} {:>10.4}", i + 1, group.area);
        let shares =
            matrix.factors[i].iter().zip(&report.counts[i]).map(|(&factor, &count)| (factor, count > 0));
        let rest = [matrix.blocked[i], matrix.escaped[i]].map(|share| (share, share > 0.0));
        for (share, counted) in shares.chain(rest) {
            // An adjusted factor may be positive without a count, if lines were counted in the other direction.
            out += &match counted || share > 0.0 {
                true => format!(" {share:>9.digits$}"),
                false => format!(" {:>9}", format!("<{:.0e}", 3.0 / group.lines as f64)),
            };
        }
        out += &format!(" {error:>9.digits$}\n");
    }
    out
}

/// Returns a list with a line for each group.
fn list(report: &Report) -> String {
    let names = names(report);
    let wide = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let mut out = format!(
        "{:<wide$} {:>12} {:>14} {:>9} {:>9} {:>9} {:>9}\n",
        "", "area", "lines", "itself", "blocked", "escaped", "±"
    );
    let matrix = report.closed.as_ref().unwrap_or(&report.counted);
    for (i, (name, group)) in names.iter().zip(&report.groups).enumerate() {
        let error = row_error(report, matrix, i);
        let digits = digits(error);
        let shares = [matrix.factors[i][i], matrix.blocked[i], matrix.escaped[i], error];
        out += &format!("{name:<wide$} {:>12.4} {:>14}", group.area, grouped(group.lines));
        shares.iter().for_each(|share| out += &format!(" {share:>9.digits$}"));
        out.push('\n');
    }
    out
}

/// Returns a line that says how well both estimates of each exchange area agree.
fn reciprocity(report: &Report) -> String {
    let pairs = &report.reciprocity;
    let Some(worst) = pairs.iter().max_by(|a, b| a.z.abs().total_cmp(&b.z.abs())) else {
        return String::new();
    };
    let squares: f64 = pairs.iter().map(|pair| pair.z * pair.z).sum();
    format!(
        "reciprocity of {} pairs: RMS of z {:.2}, largest {:+.1} (\"{}\" and \"{}\")\n",
        pairs.len(),
        (squares / pairs.len() as f64).sqrt(),
        worst.z,
        worst.from,
        worst.to
    )
}
