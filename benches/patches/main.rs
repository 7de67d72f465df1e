//! Benchmark of patches: the error of the irradiance on patches of surfaces and of triangles, with the same number of
//! patches and of lines, against a reference with more of both.
//!
//! ```text
//! cargo bench --bench patches -- scene.obj 4000 1000000                          # scene, patches, lines
//! cargo bench --bench patches -- scene.obj 4000 1000000 --finer 16 --lines 64    # the reference, in multiples
//! cargo bench --bench patches -- scene.obj 4000 1000000 --triangles 12000        # more patches of triangles
//! ```
//!
//! The reference has 16 times as many patches, of surfaces, and 64 times as many lines, in two runs, whose difference shows
//! its own noise; that is subtracted. The error of a patch is the difference of its irradiance from the mean of the
//! reference over the finer patches whose centers lie in it. The last column is the root mean square over the finer patches
//! instead: it includes what a constant patch hides.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark that fails, fails like a test")]

use std::path::Path;
use std::time::Instant;

use sir::geom::{Barycentric, LoadOptions, Scene, Side, TriangleId, load, luminance};
use sir::mesh::{PatchSize, SideId, Subdivision};
use sir::parallel::{Solved, Solver};

fn main() {
    let given: Vec<String> = std::env::args().skip(1).filter(|arg| arg != "--bench").collect();
    let option = |name: &str, default: u64| {
        let place = given.iter().position(|arg| arg == name);
        place.map_or(default, |place| given[place + 1].parse().unwrap())
    };
    let [scene, patches, lines, ..] = &given[..] else {
        println!("give a scene, a number of patches and a number of lines");
        return;
    };
    let (patches, lines): (u64, u64) = (patches.parse().unwrap(), lines.parse().unwrap());
    let scene = load(Path::new(scene), &LoadOptions::default()).unwrap().scene;
    let (finer, more) = (option("--finer", 16), option("--lines", 64));
    let fine = Subdivision::Surfaces(PatchSize::Count(finer * patches));
    let reference = [1001, 1002].map(|seed| solve(&scene, fine, more * lines, seed));
    let triangles = PatchSize::Count(option("--triangles", patches));
    println!(
        "| patches of | number | time | RMS error | noise of the reference | median relative error | RMS over finer patches |"
    );
    for (name, rule) in [
        ("triangles", Subdivision::Triangles(triangles)),
        ("surfaces", Subdivision::Surfaces(PatchSize::Count(patches))),
    ] {
        let start = Instant::now();
        let solved = solve(&scene, rule, lines, 1);
        let seconds = start.elapsed().as_secs_f64();
        let Errors { rms, noise, median, within } = errors(&solved, &reference);
        println!(
            "| {name} | {} | {seconds:.1} s | {:.2} % | {:.2} % | {:.2} % | {:.2} % |",
            solved.model.mesh.patch_count(),
            100.0 * rms,
            100.0 * noise,
            100.0 * median,
            100.0 * within
        );
    }
}

/// Computes the light with a third of the lines in the first shot.
fn solve(scene: &Scene, subdivision: Subdivision, lines: u64, seed: u64) -> Solved {
    let solver = Solver::new(scene.clone()).subdivision(subdivision).seed(seed);
    solver.first_shot(lines / 3).second_shot(lines / 6).multipath(lines / 2).solve().unwrap()
}

/// Errors over the mean irradiance, and over the irradiance of the patch.
struct Errors {
    rms: f64,
    noise: f64,
    median: f64,
    within: f64,
}

/// Sums of the reference over the finer patches in a patch.
#[derive(Clone, Copy, Default)]
struct Sums {
    area: f64,
    irradiance: f64,
    /// Difference of the two runs.
    difference: f64,
}

fn errors(solved: &Solved, reference: &[Solved; 2]) -> Errors {
    let (mesh, fine) = (&solved.model.mesh, &reference[0].model);
    let mut sums = vec![Sums::default(); mesh.side_count()];
    let mut within = 0.0;
    fine.mesh.for_each_side(|triangle, patch, side, id| {
        let [one, other] = [0, 1].map(|run| luminance(reference[run].solution.irradiance[id.index()]));
        for piece in fine.mesh.pieces(triangle, patch) {
            let area = fine.scene.area(piece.triangle) * piece.share();
            let n = piece.corners().len() as f64;
            let sum = |of: fn(&Barycentric) -> f64| piece.corners().iter().map(of).sum::<f64>() / n;
            let center = Barycentric { v: sum(|p| p.v), w: sum(|p| p.w) };
            let Some(coarse) = mesh.side_at(piece.triangle, center, side) else { continue };
            let off = luminance(solved.solution.irradiance[coarse.index()]) - 0.5 * (one + other);
            within += area * (off * off - 0.25 * (one - other) * (one - other));
            let sums = &mut sums[coarse.index()];
            sums.area += area;
            sums.irradiance += area * 0.5 * (one + other);
            sums.difference += area * (one - other);
        }
    });
    let (mut area, mut total, mut square, mut noise) = (0.0, 0.0, 0.0, 0.0);
    let mut relative: Vec<(f64, f64)> = Vec::new();
    mesh.for_each_side(|_: TriangleId, _, _: Side, id: SideId| {
        let of = sums[id.index()];
        // A patch smaller than the finer ones has no reference.
        if of.area == 0.0 {
            return;
        }
        let exact = of.irradiance / of.area;
        let off = luminance(solved.solution.irradiance[id.index()]) - exact;
        area += of.area;
        total += of.irradiance;
        square += of.area * off * off;
        // The mean of two runs has a quarter of the variance of their difference.
        noise += of.area * 0.25 * (of.difference / of.area).powi(2);
        if exact > 0.0 {
            relative.push((off.abs() / exact, of.area));
        }
    });
    relative.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * relative.iter().map(|patch| patch.1).sum::<f64>();
    let mut sum = 0.0;
    let median = relative.iter().find(|patch| {
        sum += patch.1;
        sum >= half
    });
    let mean = total / area;
    Errors {
        rms: ((square - noise).max(0.0) / area).sqrt() / mean,
        noise: (noise / area).sqrt() / mean,
        median: median.map_or(0.0, |patch| patch.0),
        within: (within.max(0.0) / area).sqrt() / mean,
    }
}
