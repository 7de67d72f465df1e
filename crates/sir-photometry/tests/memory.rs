//! Files whose counts are huge use memory in proportion to their size.
//!
//! This is a separate program, because the memory of one file can only be measured if nothing else runs.

#![allow(clippy::unwrap_used, reason = "these are tests")]

use peak_alloc::PeakAlloc;
use sir_photometry::Photometry;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Returns the peak of memory while a file is read \[bytes\].
fn peak(text: &str) -> usize {
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    drop(Photometry::parse(text.as_bytes()));
    MEMORY.peak_usage() - before
}

#[test]
fn huge_counts_take_no_memory() {
    for text in [
        "TILT=NONE\n1 -1 1 1000000000 1000000000 1 2 0 0 0 1 1 0\n0 90\n".to_owned(),
        "TILT=INCLUDE\n1 1000000000 0 1 2 3\n".to_owned(),
        "x\n1\n0\n1000000000\n0\n1000000000\n0\n".to_owned() + &"0\n".repeat(100),
        format!("x\n1\n0\n24\n0\n19\n0\n{}1000000000\n{}", "0\n".repeat(18), "1\n".repeat(1000)),
        "1\n1\n1\n1\n".to_owned() + &"\n".repeat(50),
    ] {
        let peak = peak(&text);
        assert!(peak < 100_000, "{peak} bytes for {:?}", &text[..60.min(text.len())]);
    }
    // A valid file whose planes are mirrored twice.
    let values = "7 ".repeat(500 * 500);
    let ascending = |step: f64| (0..500).map(|i| format!("{} ", f64::from(i) * step)).collect::<String>();
    let text = format!(
        "TILT=NONE\n1 -1 1 500 500 1 2 0 0 0 1 1 0\n{}{}{values}",
        ascending(180.0 / 499.0),
        ascending(90.0 / 499.0)
    );
    let peak = peak(&text);
    assert!(peak < 150 * text.len(), "{peak} bytes for {}", text.len());
}
