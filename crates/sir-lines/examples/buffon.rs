//! Estimates π from the number of uniform lines that cross a square, with a random generator, with the streams of this
//! crate, and with a low-discrepancy sequence: `cargo run --release -p sir-lines --example buffon`.
#![allow(clippy::print_stdout, reason = "an example prints its results")]

use std::f64::consts::PI;

use glam::DVec3;
use rand::{SeedableRng, rngs::SmallRng};
use sir_lines::{Domain, Purpose, Streams, random_point};
use sir_types::{BoundingSphere, Line};

/// Returns true if a line crosses the unit square in the plane z = 0.
fn crosses(line: &Line) -> bool {
    let point = line.at(-line.origin.z / line.direction.z);
    point.x.abs() < 0.5 && point.y.abs() < 0.5
}

/// Returns a coordinate of the point with this number of a Halton sequence (1960): the digits of the number, mirrored
/// at the radix point.
fn radical_inverse(base: u64, mut number: u64) -> f64 {
    let (mut digits, mut scale) = (0, 1.0);
    while number > 0 {
        digits = digits * base + number % base;
        number /= base;
        scale /= base as f64;
    }
    digits as f64 * scale
}

fn main() {
    let domain = Domain::Sphere(BoundingSphere { center: DVec3::ZERO, radius: 1.0 });
    let streams = Streams::new(1, Purpose::GLOBAL);
    println!("    lines       generator         streams          Halton");
    for lines in [10_000, 100_000, 1_000_000, 10_000_000] {
        let mut generator = SmallRng::seed_from_u64(1);
        // The forecast N · 2A/S, with A = 1 and S = 4π, solved for π.
        let pi = |count: usize| lines as f64 * 2.0 / (4.0 * count as f64);
        let found = [
            (0..lines).filter(|_| crosses(&domain.line(random_point(&mut generator)))).count(),
            (0..lines).filter(|&i| crosses(&domain.line(streams.line(i).point()))).count(),
            (1..=lines)
                .filter(|&i| crosses(&domain.line([2, 3, 5, 7, 11, 13].map(|base| radical_inverse(base, i)))))
                .count(),
        ];
        let columns = found.map(|count| format!("{:.5} ({:+.5})", pi(count), pi(count) - PI));
        println!("{lines:>9} {}", columns.join(" "));
    }
}
