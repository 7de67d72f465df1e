//! Formats numbers, sizes, times and names for people.

use glam::DVec3;

/// Returns the names in backticks as an enumeration, such as "`a`, `b` and `c`" with `and` as conjunction.
#[must_use]
pub fn list<S: AsRef<str>>(names: &[S], and: &str) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{}`", name.as_ref())).collect();
    match quoted.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} {and} {last}", most.join(", ")),
    }
}

/// Formats a whole number with its digits in groups of three, as RON accepts it: `1_234_567`.
#[must_use]
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push('_');
        }
        out.push(c);
    }
    out
}

/// Formats a size \[bytes\] with a binary unit of suitable magnitude.
#[must_use]
pub fn bytes(n: usize) -> String {
    let (mut x, mut unit) = (n as f64, "B");
    for next in ["kiB", "MiB", "GiB", "TiB"] {
        if x < 1024.0 {
            break;
        }
        (x, unit) = (x / 1024.0, next);
    }
    if unit == "B" { format!("{n} B") } else { format!("{x:.1} {unit}") }
}

/// Formats a time \[s\] with a unit of suitable magnitude.
#[must_use]
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}

/// Formats a length, an area or a power with four digits, as a pipeline can read it.
#[must_use]
pub fn length(x: f64) -> String {
    // Turns −0 into +0.
    let x = x + 0.0;
    let digits = if x == 0.0 { 0.0 } else { 3.0 - x.abs().log10().floor() };
    match digits {
        // Very large and very small numbers have an exponent.
        d if !(-4.0..=8.0).contains(&d) => format!("{x:.3e}"),
        d if d > 0.0 => {
            let text = format!("{x:.*}", d as usize);
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        _ => format!("{x:.0}"),
    }
}

/// Formats a share as a percentage.
#[must_use]
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".into(),
        p if p < 0.05 => "<0.1 %".into(),
        p => format!("{p:.1} %"),
    }
}

/// Formats the edge lengths of a box \[m\].
#[must_use]
pub fn dimensions(size: DVec3) -> String {
    format!("{} × {} × {} m", length(size.x), length(size.y), length(size.z))
}

/// Returns a number rounded up to two digits.
pub(crate) fn rounded_up(x: f64) -> u64 {
    let unit = 10u64.pow((x.max(10.0).log10().floor() as u32).saturating_sub(1));
    (x / unit as f64).ceil() as u64 * unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_names_are_readable() {
        assert_eq!(grouped(1_234_567), "1_234_567");
        assert_eq!(list(&["a", "b", "c"], "or"), "`a`, `b` or `c`");
    }

    #[test]
    fn sizes_and_times_are_readable() {
        assert_eq!([0, 1023, 1024, 5 << 20].map(bytes), ["0 B", "1023 B", "1.0 kiB", "5.0 MiB"]);
        assert_eq!(
            [0.26, 119.0, 600.0, 7200.0, 172_800.0].map(duration),
            ["0.3 s", "119.0 s", "10.0 min", "2.0 h", "2.0 days"]
        );
    }
}
