//! Benchmark of line tracing, compared with Embree 4 or 3 if it is installed (Debian: `libembree4-4` or `libembree3-3`), or
//! with the library that the environment variable `EMBREE_LIBRARY` names: the same triangles and rays, on one thread, in
//! interleaved rounds.
//!
//! ```text
//! cargo bench --bench lines                        # all available scenes
//! cargo bench --bench lines -- soda --rounds 3     # one scene
//! cargo bench --bench lines -- patches growth experiment
//! ```

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark that fails, fails like a test")]

mod embree;
mod scenes;

use std::time::Instant;

use sir::accel::{Accel, Ray};
use sir::geom::Scene;
use sir::lines::{Domain, Purpose, Streams, cosine_direction, point_on_triangle};
use sir::mesh::{PatchSize, Subdivision};
use sir::radiosity::{
    AnyOrder, BatchSettings, Batches, FirstShot, Model, OneWorker, Segments, ShotSettings, Stage,
    StageTotals, run_stage,
};

use embree::{Embree, Peer, Quality, RayHit};

/// Number of patches per scene, about as in the experiment of the paper.
const PATCHES: u64 = 600_000;

/// Command-line options.
struct Options {
    names: Vec<String>,
    rounds: usize,
    lines: u64,
}

impl Options {
    fn parse() -> Self {
        let mut options = Self { names: Vec::new(), rounds: 7, lines: 1_000_000 };
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            let mut number = || arguments.next().and_then(|n| n.parse().ok()).expect("option needs a number");
            match argument.as_str() {
                // Cargo passes this option to every benchmark.
                "--bench" => {}
                "--rounds" => options.rounds = number() as usize,
                "--lines" => options.lines = number(),
                _ => options.names.push(argument),
            }
        }
        options
    }

    fn wants(&self, name: &str) -> bool {
        self.names.is_empty() || self.names.iter().any(|n| n == name)
    }
}

fn main() {
    let options = Options::parse();
    let embree = Embree::load();
    if let Err(reason) = &embree {
        println!("no comparison with Embree, because it cannot be loaded ({reason});");
        println!("install a package such as Debian's libembree4-4, or name the library in EMBREE_LIBRARY\n");
    }
    let embree = embree.ok();
    if let Some(embree) = &embree {
        println!("Compared with Embree {}.", embree.version());
    }
    println!("One thread, {} lines, median of {} interleaved rounds.", options.lines, options.rounds);
    println!(
        "{:<16} {:<34} {:>10} {:>10} {:>7}  agreement",
        "scene", "M per second", "ours", "Embree", "ratio"
    );
    for (name, load) in scenes::ALL {
        if options.wants(name)
            && let Some(scene) = load()
        {
            rates(name, scene, embree.as_ref(), &options);
        }
    }
    if options.wants("patches") {
        patches(&options);
    }
    if options.wants("growth") {
        growth(embree.as_ref(), &options);
    }
    if options.wants("experiment") {
        experiment(embree.as_ref(), &options);
    }
}

/// Returns the duration of a call, in seconds.
fn seconds(call: impl FnOnce()) -> f64 {
    let start = Instant::now();
    call();
    start.elapsed().as_secs_f64()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Runs all calls in interleaved rounds, and returns the median duration of each, in seconds.
fn by_turns(rounds: usize, calls: &mut [&mut dyn FnMut()]) -> Vec<f64> {
    let mut times = vec![Vec::new(); calls.len()];
    for _ in 0..rounds {
        for (call, times) in calls.iter_mut().zip(&mut times) {
            times.push(seconds(call));
        }
    }
    times.into_iter().map(median).collect()
}

/// Prints a row: the rates of SIR and Embree, and their ratio.
fn row(scene: &str, what: &str, counts: (f64, f64), times: &[f64], agreement: &str) {
    let ours = counts.0 / times[0] / 1e6;
    print!("{scene:<16} {what:<34} {ours:>10.2}");
    match times.get(1) {
        Some(peer) => {
            let peer = counts.1 / peer / 1e6;
            println!(" {peer:>10.2} {:>7.2}  {agreement}", ours / peer);
        }
        None => println!(),
    }
}

/// Measures the three rates of a scene.
fn rates(name: &str, scene: Scene, embree: Option<&Embree>, options: &Options) {
    let model = Model::new(scene, Subdivision::Triangles(PatchSize::Count(PATCHES))).unwrap();
    let scene = &model.scene;
    println!("{name:<16} {} triangles, {} patches", scene.triangles().len(), model.mesh.patch_count());
    let closest = embree.map(|e| e.scene(scene, Quality::High, false));
    let all = embree.map(|e| e.scene(scene, Quality::Medium, true));
    let cosine = cosine_rays(scene, options.lines);
    compare_closest(name, "(a) cosine rays", &model.accel, &cosine, closest.as_ref(), options.rounds);
    let shot = FirstShot::begin(ShotSettings::new(&model, options.lines, 1), (), &OneWorker).unwrap();
    let rays: Vec<Ray> = (0..options.lines).map(|i| shot.ray(i)).collect();
    compare_closest(name, "(b) first-shot rays", &model.accel, &rays, closest.as_ref(), options.rounds);
    compare_all(name, &model, options.lines, all.as_ref(), options.rounds);
}

/// Returns cosine-weighted rays from random points of all surfaces, to either side.
fn cosine_rays(scene: &Scene, rays: u64) -> Vec<Ray> {
    let mut areas: Vec<f64> = scene.triangle_ids().map(|t| scene.area(t)).collect();
    for i in 1..areas.len() {
        areas[i] += areas[i - 1];
    }
    let streams = Streams::new(1, Purpose::PROBE);
    (0..rays)
        .map(|i| {
            let mut stream = streams.line(i);
            let area = stream.unit() * areas[areas.len() - 1];
            let k = areas.partition_point(|&a| a <= area);
            let triangle = scene.triangle_ids().nth(k).unwrap();
            let normal = if stream.unit() < 0.5 { scene.normal(triangle) } else { -scene.normal(triangle) };
            let origin = point_on_triangle(stream.point()).point(scene.corners(triangle));
            let direction = cosine_direction(normal, stream.point());
            Ray::leaving(sir::geom::Line { origin, direction }, triangle)
        })
        .collect()
}

fn compare_closest(
    name: &str,
    what: &str,
    accel: &Accel,
    rays: &[Ray],
    peer: Option<&Peer<'_>>,
    rounds: usize,
) {
    let mut ours = vec![None; rays.len()];
    let trace = |found: &mut [Option<u32>]| {
        accel.tracer().closest_each(rays, |i, hit| found[i] = hit.map(|h| h.triangle.0));
    };
    trace(&mut ours);
    let mut sum = 0u64;
    let mut we =
        || accel.tracer().closest_each(rays, |_, hit| sum += hit.map_or(0, |h| u64::from(h.triangle.0)));
    let Some(peer) = peer else {
        let times = by_turns(rounds, &mut [&mut we]);
        return row(name, what, (rays.len() as f64, 0.0), &times, "");
    };
    let far = rays.iter().map(|r| r.line.origin.length()).fold(0.0, f64::max);
    let theirs: Vec<RayHit> = rays.iter().map(|r| RayHit::new(&r.line, (far * 1e-5) as f32)).collect();
    let mut i = 0;
    let mut same = 0;
    peer.closest(&theirs, |triangle| {
        same += usize::from(triangle == ours[i]);
        i += 1;
    });
    let (mut sum1, mut sum2) = (0u64, 0u64);
    let mut they = || peer.closest(&theirs, |triangle| sum1 += u64::from(triangle.unwrap_or(0)));
    let mut has_streams = false;
    let mut streams = || {
        has_streams = peer.closest_streams(&theirs, |triangle| sum2 += u64::from(triangle.unwrap_or(0)));
    };
    let times = by_turns(rounds, &mut [&mut we, &mut they, &mut streams]);
    let n = rays.len() as f64;
    let agreement = format!("{:.3} % of the triangles", 100.0 * same as f64 / n);
    row(name, what, (n, n), &times[..2], &agreement);
    // Embree traces coherent rays faster as streams. These rays have the order in which a pipeline generates them.
    if has_streams {
        row(name, &format!("{what}, its streams"), (n, n), &[times[0], times[2]], "");
    }
}

fn compare_all(name: &str, model: &Model, lines: u64, peer: Option<&Peer<'_>>, rounds: usize) {
    let sphere = model.scene.bounding_sphere();
    let domain = Domain::Sphere(sphere);
    let streams = Streams::new(1, Purpose::GLOBAL);
    let lines: Vec<_> = (0..lines).map(|i| domain.line(streams.line(i).point())).collect();
    let (mut hits, mut odd) = (0, 0);
    model.accel.tracer().all_hits_each(&lines, |found| {
        hits += found.hits().len();
        odd += found.lines().filter(|line| line.len() % 2 == 1).count();
    });
    let mut sides = 0;
    let mut we = || {
        let mut segments = Segments::default();
        model.accel.tracer().all_hits_each(&lines, |found| {
            segments.find(&model.mesh, found);
            sides += segments.count();
        });
    };
    let what = "(c) hits of global lines, in order";
    let Some(peer) = peer else {
        let times = by_turns(rounds, &mut [&mut we]);
        return row(name, what, (hits as f64, 0.0), &times, "");
    };
    let theirs: Vec<RayHit> = lines.iter().map(|line| RayHit::new(line, 0.0)).collect();
    let mut they_hit = 0;
    peer.all_hits(&theirs, |found| they_hit += found.len());
    let mut sum = 0;
    let mut they = || {
        peer.all_hits(&theirs, |found| {
            sum += found
                .iter()
                .map(|f| f.triangle as usize + usize::from(f.front) + f.point[0].to_bits() as usize)
                .sum::<usize>();
        });
    };
    let times = by_turns(rounds, &mut [&mut we, &mut they]);
    let n = lines.len() as f64;
    let agreement = format!(
        "{:.4} and {:.4} hits per line; {:.1} and {:.1} M lines/s; {odd} odd",
        hits as f64 / n,
        f64::from(they_hit as u32) / n,
        n / times[0] / 1e6,
        n / times[1] / 1e6
    );
    row(name, what, (hits as f64, f64::from(they_hit as u32)), &times, &agreement);
}

/// Measures the cost of a line if the same triangles are cut into ten times as many patches: hits and patches alone,
/// and with the exchange of power.
fn patches(options: &Options) {
    println!("\nTen times the patches: M lines per second, and factor by which the time per line increases");
    println!(
        "{:<16} {:>10} {:>9} {:>9} {:>6} {:>9} {:>9} {:>6}",
        "scene", "patches", "find", "find 10×", "", "exchange", "exch. 10×", ""
    );
    for (name, load) in scenes::ALL {
        let Some(scene) = load() else { continue };
        let few = scene.triangles().len() as u64;
        let models = [few, 10 * few]
            .map(|n| Model::new(scene.clone(), Subdivision::Triangles(PatchSize::Count(n))).unwrap());
        let domain = Domain::Sphere(scene.bounding_sphere());
        let streams = Streams::new(1, Purpose::GLOBAL);
        let lines: Vec<_> = (0..options.lines).map(|i| domain.line(streams.line(i).point())).collect();
        let mut sides = 0;
        let mut find = |model: &Model| {
            let mut segments = Segments::default();
            model.accel.tracer().all_hits_each(&lines, |found| {
                segments.find(&model.mesh, found);
                sides += segments.count();
            });
        };
        let mut stages = models.each_ref().map(|model| {
            let shot = run_stage::<FirstShot<'_>>(ShotSettings::new(model, 100_000, 1), ()).unwrap();
            let settings = BatchSettings::new(model, domain.clone(), options.lines, 1);
            Batches::begin(settings, shot, &OneWorker).unwrap()
        });
        let [one, ten] = &mut stages;
        let exchange = |stage: &Batches<'_>| {
            stage.trace(0, &mut AnyOrder, 0..options.lines, &mut StageTotals::default());
        };
        let mut find_few = || find(&models[0]);
        let few_times = by_turns(options.rounds, &mut [&mut find_few, &mut || exchange(one)]);
        let mut find_many = || find(&models[1]);
        let many_times = by_turns(options.rounds, &mut [&mut find_many, &mut || exchange(ten)]);
        let rate = |time: f64| options.lines as f64 / time / 1e6;
        println!(
            "{name:<16} {few:>10} {:>9.2} {:>9.2} × {:.2} {:>9.2} {:>9.2} × {:.2}",
            rate(few_times[0]),
            rate(many_times[0]),
            many_times[0] / few_times[0],
            rate(few_times[1]),
            rate(many_times[1]),
            many_times[1] / few_times[1]
        );
    }
}

/// Repeats the experiment of the paper on one thread: the complete run after loading, compared with the time that
/// Embree needs to trace the same lines. There are 1.3 global lines per line of the first shot.
fn experiment(embree: Option<&Embree>, options: &Options) {
    println!("\nExperiment of the paper, seconds: the complete run, and the tracing alone by Embree");
    println!(
        "{:<16} {:>10} {:>10} {:>7} {:>10} {:>10} {:>7} {:>6}",
        "scene", "first shot", "Embree", "ratio", "multipath", "Embree", "ratio", "all"
    );
    for (name, patches) in [("museum-stairs", 614_778), ("airplane-cabin", 438_518)] {
        let Some(scene) = scenes::ALL.iter().find(|s| s.0 == name).and_then(|s| s.1()) else { continue };
        let model = Model::new(scene, Subdivision::Triangles(PatchSize::Count(patches))).unwrap();
        let (local, global) = (options.lines, options.lines * 13 / 10);
        let domain = Domain::hull(model.scene.vertices());
        let shoot = || run_stage::<FirstShot<'_>>(ShotSettings::new(&model, local, 1), ()).unwrap();
        let shot = shoot();
        let transport = || {
            let settings = BatchSettings::new(&model, domain.clone(), global, 1);
            drop(run_stage::<Batches<'_>>(settings, shot.clone()).unwrap());
        };
        let (mut sum, mut hits) = (0, 0);
        let peers = embree.map(|e| {
            let settings = ShotSettings::new(&model, local, 1);
            let stage = FirstShot::begin(settings, (), &OneWorker).unwrap();
            let streams = Streams::new(1, Purpose::GLOBAL);
            let rays: Vec<_> = (0..local).map(|i| RayHit::new(&stage.ray(i).line, 1e-5)).collect();
            let lines = (0..global).map(|i| RayHit::new(&domain.line(streams.line(i).point()), 0.0));
            let lines: Vec<_> = lines.collect();
            let [closest, all] = [(Quality::High, false), (Quality::Medium, true)]
                .map(|(quality, all)| e.scene(&model.scene, quality, all));
            (rays, lines, closest, all)
        });
        let times = match &peers {
            None => by_turns(options.rounds, &mut [&mut || drop(shoot()), &mut || transport()]),
            Some((rays, lines, closest, all)) => by_turns(
                options.rounds,
                &mut [
                    &mut || drop(shoot()),
                    &mut || transport(),
                    &mut || closest.closest(rays, |triangle| sum += triangle.unwrap_or(0)),
                    &mut || all.all_hits(lines, |found| hits += found.len()),
                ],
            ),
        };
        print!("{name:<16}");
        for i in 0..2 {
            let peer = times.get(i + 2).copied().unwrap_or(f64::NAN);
            print!(" {:>10.2} {peer:>10.2} {:>7.2}", times[i], peer / times[i]);
        }
        let all = |i: usize| {
            times.get(i).copied().unwrap_or(f64::NAN) + times.get(i + 1).copied().unwrap_or(f64::NAN)
        };
        println!(" {:>6.2}", all(2) / all(0));
    }
}

/// Measures how the cost of a line and of the build grows with the number of triangles.
fn growth(embree: Option<&Embree>, options: &Options) {
    println!("\nGrowth with the number of triangles (balls in a room), M per second; seconds to build");
    println!(
        "{:>10} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "triangles", "closest", "Embree", "all hits", "Embree", "build"
    );
    for level in 1..=6 {
        let scene = scenes::balls(level);
        let mut accel = None;
        let build = seconds(|| accel = Some(sir::radiosity::build_accel(&scene).unwrap()));
        let accel = accel.unwrap();
        let rays = cosine_rays(&scene, options.lines / 4);
        let domain = Domain::Sphere(scene.bounding_sphere());
        let streams = Streams::new(1, Purpose::GLOBAL);
        let lines: Vec<_> = (0..options.lines / 4).map(|i| domain.line(streams.line(i).point())).collect();
        let n = rays.len() as f64;
        let mut sum = 0;
        let mut sum2 = 0;
        let times = by_turns(
            options.rounds,
            &mut [
                &mut || accel.tracer().closest_each(&rays, |_, hit| sum += usize::from(hit.is_some())),
                &mut || accel.tracer().all_hits_each(&lines, |found| sum2 += found.hits().len()),
            ],
        );
        let peers = embree.map(|e| {
            let closest = e.scene(&scene, Quality::High, false);
            let all = e.scene(&scene, Quality::Medium, true);
            let rays: Vec<RayHit> = rays.iter().map(|r| RayHit::new(&r.line, 1e-5)).collect();
            let lines: Vec<RayHit> = lines.iter().map(|l| RayHit::new(l, 0.0)).collect();
            by_turns(
                options.rounds,
                &mut [&mut || closest.closest(&rays, |hit| sum += usize::from(hit.is_some())), &mut || {
                    all.all_hits(&lines, |hits| sum2 += hits.len())
                }],
            )
        });
        let rate = |times: &[f64], i: usize| format!("{:.2}", n / times[i] / 1e6);
        let peer = |i| peers.as_ref().map_or_else(|| "-".to_owned(), |times| rate(times, i));
        println!(
            "{:>10} {:>9} {:>9} {:>9} {:>9} {:>9.2}",
            scene.triangles().len(),
            rate(&times, 0),
            peer(0),
            rate(&times, 1),
            peer(1),
            build
        );
    }
}
