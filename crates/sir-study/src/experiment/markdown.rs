//! Formats of tables and numbers in Markdown.

/// Markdown table. The first column is left-aligned.
pub(crate) struct Grid {
    text: String,
}

impl Grid {
    /// Starts a table with these columns, right-aligned for numbers.
    pub(crate) fn new(columns: &[&str]) -> Self {
        Self::aligned(columns, "--:")
    }

    /// Starts a table with these columns, left-aligned for words.
    pub(crate) fn of_words(columns: &[&str]) -> Self {
        Self::aligned(columns, "---")
    }

    fn aligned(columns: &[&str], rule: &'static str) -> Self {
        let rules = std::iter::once("---").chain(columns.iter().skip(1).map(|_| rule));
        let mut grid = Self { text: String::new() };
        grid.row(columns.iter().map(|&c| c.to_owned()));
        grid.row(rules.map(str::to_owned));
        grid
    }

    /// Adds a row.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        let cells: Vec<String> = cells.into_iter().map(|cell| cell.replace('|', "\\|")).collect();
        self.text += &format!("| {} |\n", cells.join(" | "));
    }

    /// Returns the table, followed by an empty line.
    pub(crate) fn end(self) -> String {
        self.text + "\n"
    }
}

/// Formats a share in percent, with about three digits.
pub(crate) fn percent(share: f64) -> String {
    let value = 100.0 * share;
    let decimals = match value.abs() {
        v if v >= 10.0 => 1,
        v if v >= 1.0 => 2,
        v if v >= 0.1 || v == 0.0 => 3,
        _ => 4,
    };
    format!("{value:.decimals$} %")
}

/// Formats a share in percent with its sign.
pub(crate) fn signed_percent(share: f64) -> String {
    if share >= 0.0 { format!("+{}", percent(share)) } else { percent(share).replace('-', "−") }
}

/// Formats a share in whole percent.
pub(crate) fn whole_percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// Formats a number of lines or patches, grouped by thousands.
pub(crate) fn count(n: u64) -> String {
    sir_pipeline::format::grouped(n).replace('_', ",")
}

/// Formats an amount of memory in megabytes.
pub(crate) fn megabytes(bytes: Option<u64>) -> String {
    bytes.map_or("-".into(), |bytes| format!("{:.0} MB", bytes as f64 / 1e6))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_precise_as_they_are_worth() {
        assert_eq!(
            [0.1234, 0.012_34, 0.001_234, 0.000_012, 0.0].map(percent),
            ["12.3 %", "1.23 %", "0.123 %", "0.0012 %", "0.000 %"]
        );
        assert_eq!([0.02, -0.02].map(signed_percent), ["+2.00 %", "−2.00 %"]);
        assert_eq!(count(614_778), "614,778");
    }

    #[test]
    fn tables_have_as_many_rules_as_columns() {
        let mut grid = Grid::new(&["a", "b"]);
        grid.row(["1".into(), "|".into()]);
        assert_eq!(grid.end(), "| a | b |\n| --- | --: |\n| 1 | \\| |\n\n");
    }
}
