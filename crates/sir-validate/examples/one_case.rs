//! Validates one case: `cargo run --release -p sir-validate --example one_case -- RE-08`.
#![allow(clippy::print_stdout, reason = "an example shows its result")]

use std::num::NonZeroUsize;

use sir_validate::{Effort, Reference, Settings, Watcher, validate};

/// Prints each case as it begins.
struct Names;

impl Watcher for Names {
    fn begin(&mut self, case: &str, title: &str) {
        println!("{case}: {title}");
    }

    fn progress(&mut self, _done: u64, _total: u64) {}

    fn should_stop(&self) -> bool {
        false
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let case = std::env::args().nth(1).unwrap_or_else(|| "RE-08".into());
    let threads = std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let settings = Settings { effort: Effort::Quick, seed: 1, threads, cases: vec![case] };
    let report = validate(&Reference::built_in()?, &settings, &mut Names)?;
    println!(
        "{}",
        if report.passed() { "agrees with the exact answer" } else { "differs from the exact answer" }
    );
    Ok(())
}
