//! The measurements as tables for terminals and in Markdown.

use crate::scaling::series::stages;
use crate::scaling::statistics::{Overhead, Part};
use crate::scaling::study::{MARK, Row, Study};

/// Group of columns about the same part of the run.
struct Group {
    name: &'static str,
    columns: Vec<Column>,
}

/// Column of a table.
struct Column {
    name: &'static str,
    cells: Vec<String>,
}

/// Returns a table of fixed width for terminals, with notes below it.
#[must_use]
pub fn text(study: &Study) -> String {
    let blocks: Vec<Vec<String>> = groups(study).iter().map(block).collect();
    let mut text = String::new();
    for i in 0..study.rows.len() + 2 {
        let line: Vec<&str> = blocks.iter().map(|block| block[i].as_str()).collect();
        text += &format!("{}\n", line.join("  ").trim_end());
    }
    for note in std::iter::once(String::new()).chain(study.notes()) {
        text += &format!("{note}\n");
    }
    if let Some(meaning) = study.mark() {
        text += &format!("{MARK} {meaning}\n");
    }
    text
}

/// Returns the lines of a group, all of the same width: its name, the names of its columns, and the rows.
fn block(group: &Group) -> Vec<String> {
    let columns: Vec<Vec<String>> = group.columns.iter().map(padded).collect();
    let rows = columns.first().map_or(0, Vec::len);
    let row = |i: usize| columns.iter().map(|cells| cells[i].as_str()).collect::<Vec<_>>().join("  ");
    let lines: Vec<String> = (0..rows).map(row).collect();
    let title = if group.name.is_empty() { String::new() } else { format!("{} ─", group.name) };
    let width = lines.iter().chain([&title]).map(|line| length(line)).max().unwrap_or(0);
    let fill = if group.name.is_empty() { " " } else { "─" };
    let title = format!("{title}{}", fill.repeat(width - length(&title)));
    std::iter::once(title).chain(lines.iter().map(|line| format!("{line:>width$}"))).collect()
}

/// Returns the name and the cells of a column, padded to the same width.
fn padded(column: &Column) -> Vec<String> {
    let texts = || std::iter::once(column.name).chain(column.cells.iter().map(String::as_str));
    let width = texts().map(length).max().unwrap_or(0);
    texts().map(|text| format!("{text:>width$}")).collect()
}

/// Returns the table of [`text`] with its notes in Markdown.
#[must_use]
pub fn markdown(study: &Study) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let groups = groups(study);
    let columns = || groups.iter().flat_map(|group| group.columns.iter().map(|column| (group.name, column)));
    let mut text =
        line(columns().map(|(group, c)| format!("{group} {}", c.name).trim().to_owned()).collect());
    text += &format!("|{}\n", "---:|".repeat(columns().count()));
    for i in 0..study.rows.len() {
        text += &line(columns().map(|(_, c)| c.cells[i].trim().replace(MARK, "\\*")).collect());
    }
    for note in study.notes() {
        text += &format!("\n{note}\n");
    }
    if let Some(meaning) = study.mark() {
        text += &format!("\n\\{MARK} {meaning}\n");
    }
    text
}

fn groups(study: &Study) -> Vec<Group> {
    let column =
        |name, cell: &dyn Fn(&Row) -> String| Column { name, cells: study.rows.iter().map(cell).collect() };
    // If some numbers have a mark, the others leave its place blank.
    let blank = if study.mark().is_some() { " " } else { "" };
    let mut groups = vec![Group {
        name: "",
        columns: vec![
            column("workers", &|row| format!("{}{}", row.p, if row.more_than_cores { MARK } else { blank })),
            column("ranks", &|row| row.workers.ranks.to_string()),
            column("threads", &|row| row.workers.threads.to_string()),
        ],
    }];
    for stage in stages(study) {
        let cell =
            |number: &dyn Fn(Part) -> String, row: &Row| (stage.part)(row).map_or_else(|| "-".into(), number);
        groups.push(Group {
            name: stage.name,
            columns: vec![
                column("T [s]", &|row| cell(&|part| seconds(part.seconds.median), row)),
                column("S", &|row| cell(&|part| format!("{:.2}", part.speed_up), row)),
                column("E", &|row| cell(&|part| format!("{:.2}", part.efficiency), row)),
            ],
        });
    }
    let overhead = |name, overhead: &dyn Fn(&Row) -> Overhead| Group {
        name,
        columns: vec![
            column("[s]", &|row| seconds(overhead(row).seconds.median)),
            column("%", &|row| format!("{:.1}", 100.0 * overhead(row).share)),
        ],
    };
    groups.push(overhead("sequential", &|row| row.sequential));
    groups.push(overhead("communication", &|row| row.communication));
    groups
}

/// Formats a time with four digits, but no finer than a tenth of a millisecond.
pub(crate) fn seconds(seconds: f64) -> String {
    let decimals = match seconds {
        s if s < 1.0 => 4,
        s if s < 10.0 => 3,
        s if s < 100.0 => 2,
        s if s < 1000.0 => 1,
        _ => 0,
    };
    format!("{seconds:.decimals$}")
}

fn length(text: &str) -> usize {
    text.chars().count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_four_digits() {
        let times = [0.0, 0.012_34, 1.0, 12.345, 123.45, 12_345.6].map(seconds);
        assert_eq!(times, ["0.0000", "0.0123", "1.000", "12.35", "123.5", "12346"]);
    }

    #[test]
    fn blocks_are_as_wide_as_what_they_are_about() {
        let column = Column { name: "[s]", cells: vec!["1".into(), "12.5".into()] };
        let block = block(&Group { name: "waiting", columns: vec![column] });
        assert_eq!(block, ["waiting ─", "      [s]", "        1", "     12.5"]);
    }
}
