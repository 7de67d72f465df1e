//! π from counted crossings of a plate by uniform lines: `cargo run --release -p sir-lines --example buffon`.
#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

use glam::DVec3;
use sir_geom::BoundingSphere;
use sir_lines::{Domain, Stage, Streams};

fn main() {
    let domain = Domain::Sphere(BoundingSphere { centre: DVec3::ZERO, radius: 1.0 });
    let streams = Streams::new(1, Stage::GLOBAL);
    for lines in [10_000, 100_000, 1_000_000, 10_000_000] {
        // A unit square in the plane z = 0.
        let crossings = (0..lines)
            .map(|i| domain.sample(&mut streams.line(i)))
            .map(|line| line.at(-line.origin.z / line.direction.z))
            .filter(|p| p.x.abs() < 0.5 && p.y.abs() < 0.5)
            .count();
        // The forecast N · 2A/S, with A = 1 and S = 4π, solved for π.
        let pi = lines as f64 * 2.0 / (4.0 * crossings as f64);
        let sigma = pi / (crossings as f64).sqrt();
        println!("{lines:>9} lines: π ≈ {pi:.5} ± {sigma:.5}");
    }
}
