//! Measures the share of wasted lines of each domain, and the time per line and per crossing, for some scenes:
//! `cargo run --release -p sir-radiosity --example domains scenes/*/*.gl*`.
//!
//! In each domain, one thread traces the number of lines that gives the same expected number of crossings, in 100,000
//! patches. The domains take turns. The fastest of seven tries counts, which is least disturbed by other load.
#![allow(clippy::print_stdout, reason = "an example prints its results")]

use std::path::Path;
use std::time::Instant;

use sir_geom::{LoadOptions, load};
use sir_lines::{ConvexHull, Domain};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{
    AnyOrder, BatchSettings, Batches, Counts, FirstShot, Model, OneWorker, ShotSettings, Stage, StageTotals,
    run_stage,
};

const CROSSINGS: f64 = 2e6;
const TRIES: usize = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("For the sphere, the box and the hull:\n");
    println!(
        "| scene | triangles | facets, time of the hull | empty lines | ns per line | ns per crossing |"
    );
    println!("|---|--:|--:|--:|--:|--:|");
    for path in std::env::args().skip(1) {
        measure(Path::new(&path))?;
    }
    Ok(())
}

fn measure(path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let scene = load(path, &LoadOptions::default())?.scene;
    let start = Instant::now();
    let facets = ConvexHull::of(scene.vertices()).map_or(0, |hull| hull.facets().len());
    let hull_time = start.elapsed().as_secs_f64();
    let model = Model::new(scene, Subdivision::Triangles(PatchSize::Count(100_000)))?;
    let scene = &model.scene;
    let shot = run_stage::<FirstShot<'_>>(ShotSettings::new(&model, 100_000, 1), ())?;

    let domains = [
        Domain::Sphere(scene.bounding_sphere()),
        Domain::Box(scene.bounding_box()),
        Domain::hull(scene.vertices()),
    ];
    let mut times = [f64::INFINITY; 3];
    let mut counts = [Counts::default(); 3];
    for _ in 0..TRIES {
        for (k, domain) in domains.iter().enumerate() {
            let lines = (CROSSINGS / domain.forecast(1).crossings(scene.total_area())) as u64;
            let settings = BatchSettings::new(&model, domain.clone(), lines, 1);
            let transport = Batches::begin(settings, shot.clone(), &OneWorker)?;
            let (start, mut totals) = (Instant::now(), StageTotals::default());
            transport.trace(0, &mut AnyOrder, 0..lines, &mut totals);
            times[k] = f64::min(times[k], start.elapsed().as_secs_f64());
            counts[k] = totals.counts;
        }
    }
    let each = |value: &dyn Fn(f64, &Counts) -> f64, digits: usize| {
        let values = times.iter().zip(&counts).map(|(&time, counts)| value(time, counts));
        values.map(|value| format!("{value:.digits$}")).collect::<Vec<_>>().join(", ")
    };
    println!(
        "| {} | {} | {facets}, {:.1} ms | {} % | {} | {} |",
        path.file_stem().unwrap_or_default().to_string_lossy(),
        scene.triangles().len(),
        1e3 * hull_time,
        each(&|_, counts| 100.0 * counts.empty as f64 / counts.lines as f64, 1),
        each(&|time, counts| 1e9 * time / counts.lines as f64, 0),
        each(&|time, counts| 1e9 * time / counts.crossings as f64, 0),
    );
    Ok(())
}
