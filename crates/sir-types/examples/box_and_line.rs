//! Tests which lines meet a box: `cargo run -p sir-types --example box_and_line`.

#![allow(clippy::print_stdout, reason = "an example prints its results")]

use glam::DVec3;
use sir_types::{BoundingBox, Line};

fn main() {
    let unit = BoundingBox { min: DVec3::ZERO, max: DVec3::ONE };
    for height in [0.5, 1.0, 1.5] {
        let line = Line { origin: DVec3::new(-3.0, 0.5, height), direction: DVec3::X };
        println!("a line along x at z = {height} meets the unit cube: {}", unit.meets(&line));
    }
}
