//! Counts the surfaces along lines through a room with a ball, and the corners of the mesh that a lamp lights:
//! `cargo run --release -p sir-accel --example crossings`.
//!
//! The only input is positions and indices.
#![allow(clippy::print_stdout, reason = "an example prints its results")]

use std::f64::consts::PI;

use glam::DVec3;
use sir_accel::{Accel, AccelError, Line, Options, Ray};

/// A closed mesh.
#[derive(Default)]
struct Mesh {
    positions: Vec<DVec3>,
    indices: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds a closed surface: the image of a grid of unit vectors on the sphere.
    fn add(&mut self, steps: u32, image: impl Fn(DVec3) -> DVec3) {
        let first = self.positions.len() as u32;
        let columns = 2 * steps;
        for row in 0..=steps {
            for column in 0..columns {
                let (down, around) =
                    (PI * f64::from(row) / f64::from(steps), PI * f64::from(column) / f64::from(steps));
                // The poles are exact, so that their corners coincide.
                let radius = if row % steps == 0 { 0.0 } else { down.sin() };
                self.positions.push(image(DVec3::new(
                    radius * around.cos(),
                    down.cos(),
                    radius * around.sin(),
                )));
            }
        }
        for row in 0..steps {
            for column in 0..columns {
                let at = |row: u32, column: u32| first + row * columns + column % columns;
                let [a, b] = [at(row, column), at(row, column + 1)];
                let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
                // Some triangles at the poles have no area; they are never hit.
                self.indices.extend([[a, b, d], [a, d, c]]);
            }
        }
    }
}

fn main() -> Result<(), AccelError> {
    let mut mesh = Mesh::default();
    let room = |p: DVec3| DVec3::new(4.0, 3.0, 5.0) * (p / p.abs().max_element());
    mesh.add(64, room);
    mesh.add(64, |p| DVec3::new(0.0, -1.0, 1.0) + 1.5 * p);
    let accel = Accel::build(&mesh.positions, &mesh.indices, Options::default())?;
    let mut tracer = accel.tracer();

    // Lines through pairs of corners, where a floating-point test would lose hits or find them twice.
    let count = mesh.positions.len();
    let lines: Vec<Line> = (0..1_000_000usize)
        .filter_map(|i| {
            let [a, b] = [i * 7919 % count, i * 104_729 % count].map(|k| mesh.positions[k]);
            Some(Line { origin: a, direction: (b - a).try_normalize()? })
        })
        .collect();
    let start = std::time::Instant::now();
    let (mut hits, mut odd) = (0, 0);
    tracer.all_hits_each(&lines, |found| {
        for line in found.lines() {
            hits += line.len();
            odd += line.len() % 2;
        }
    });
    let rate = 1e-6 * lines.len() as f64 / start.elapsed().as_secs_f64();
    println!("{} triangles, {} lines, {rate:.2} M/s", mesh.indices.len(), lines.len());
    println!("{hits} hits, {odd} lines with an odd number of them");

    let lamp = DVec3::new(0.0, 2.0, 1.0);
    let shadow_rays: Vec<Ray> = mesh
        .positions
        .iter()
        .map(|&p| {
            Ray::new(Line { origin: lamp, direction: (p - lamp).normalize() })
                .within(0.0..0.999 * p.distance(lamp))
        })
        .collect();
    let mut seen = 0;
    tracer.occluded_each(&shadow_rays, |_, is_occluded| seen += usize::from(!is_occluded));
    println!("the lamp lights {seen} of {count} corners");
    Ok(())
}
