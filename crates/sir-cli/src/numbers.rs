//! Parsers of option values, with range checks.

use std::num::NonZeroUsize;
use std::time::Duration;

pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
    let number = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    number.ok_or_else(|| "write a number of seconds, 0 or more".into())
}

pub(crate) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let number = text.parse().ok().filter(|&n| n <= 4096).and_then(NonZeroUsize::new);
    number.ok_or_else(|| "write a whole number from 1 to 4096".into())
}

fn number(text: &str, most: usize) -> Option<NonZeroUsize> {
    text.trim().parse().ok().filter(|&n| n <= most).and_then(NonZeroUsize::new)
}

pub(crate) fn workers(text: &str) -> Result<NonZeroUsize, String> {
    number(text, 4096).ok_or_else(|| "write whole numbers from 1 to 4096, with commas between them".into())
}

pub(crate) fn repeats(text: &str) -> Result<NonZeroUsize, String> {
    number(text, 1000).ok_or_else(|| "write a whole number from 1 to 1000".into())
}

pub(crate) fn command_words(text: &str) -> Result<String, String> {
    if text.trim().is_empty() {
        return Err("write a command, such as `mpirun` or `srun`".into());
    }
    Ok(text.into())
}

pub(crate) fn scale(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|&s| s > 0.0 && s <= 1.0);
    number.ok_or_else(|| "write a number above 0 and at most 1, such as 0.01".into())
}

pub(crate) fn reference(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|f| (1.0..=10_000.0).contains(f));
    number.ok_or_else(|| "write a number from 1 to 10000, such as 20".into())
}
