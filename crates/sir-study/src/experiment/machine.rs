//! Date, machine and command line of the experiment.

use std::fs;

use serde::Serialize;

/// Machine on which the experiment was made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Machine {
    /// Model of the processor, if known.
    pub(crate) cpu: Option<String>,
    /// Number of cores that this process may use.
    pub(crate) cores: usize,
    /// Memory \[bytes\], if known.
    pub(crate) memory: Option<u64>,
    /// Operating system and processor architecture.
    pub(crate) system: String,
}

impl Machine {
    /// Describes this machine.
    #[must_use]
    pub(crate) fn this() -> Self {
        let read = |path| fs::read_to_string(path).unwrap_or_default();
        let memory = field(&read("/proc/meminfo"), "MemTotal");
        let release = read("/proc/sys/kernel/osrelease");
        let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
        Self {
            cpu: field(&read("/proc/cpuinfo"), "model name"),
            cores: sir_parallel::cores().get(),
            memory: memory.and_then(|m| m.strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)),
            system: format!("{os} {} ({arch})", release.trim()).replace("  ", " "),
        }
    }
}

/// Returns the first value of a name in a text of lines `name : value`.
fn field(text: &str, name: &str) -> Option<String> {
    let pairs = text.lines().filter_map(|line| line.split_once(':'));
    pairs
        .map(|(key, value)| (key.trim(), value.trim()))
        .find(|(key, _)| *key == name)
        .map(|(_, v)| v.to_owned())
}

/// Returns today's date in UTC, such as `2026-11-24`.
#[must_use]
pub(crate) fn today() -> String {
    jiff::tz::TimeZone::UTC.to_datetime(jiff::Timestamp::now()).date().to_string()
}

/// Returns the command line of this process, quoted where a shell needs it.
#[must_use]
pub(crate) fn command_line() -> String {
    let words = std::env::args().skip(1).map(|word| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:+".contains(c);
        if !word.is_empty() && word.chars().all(plain) {
            word
        } else {
            format!("'{}'", word.replace('\'', r"'\''"))
        }
    });
    std::iter::once("sir".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_by_their_whole_name() {
        let text = "model\t\t: 1\nmodel name\t: A 244\nmodel name\t: B\n";
        assert_eq!(field(text, "model name").as_deref(), Some("A 244"));
        assert_eq!(field(text, "name"), None);
    }
}
