//! A fuzzer of the readers of pipeline, scene and photometric files.
//!
//!     cargo run --release -p sir-pipeline --example fuzz -- glb --minutes 60 --seed 1
//!
//! Case `n` of a seed is the same on every machine and in every run. Findings are a panic, a case that takes too much
//! time or memory, an error that names no file, and an error that is too long or contains control characters. The files
//! of findings are kept, and the exit code is then 1. If an allocation fails or the stack overflows, the program ends
//! at once: the files of that case are in the folder `case`.

#![allow(clippy::print_stdout, reason = "a program's output")]

mod mutate;
mod seeds;

use std::error::Error;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{ExitCode, exit};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::{Duration, Instant};

use clap::Parser;
use mutate::{Dice, case};
use peak_alloc::PeakAlloc;
use seeds::Target;
use sir_geom::{Built, LoadOptions, load};
use sir_lines::Domain;
use sir_mesh::{PatchSize, Subdivision};
use sir_photometry::Photometry;
use sir_pipeline::plan::Pipeline;
use sir_radiosity::{FirstShot, Model, ShotSettings, run_stage};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Memory limit of a case: a constant, and a number for each byte of its files \[bytes\].
const MEMORY_LIMIT: (usize, usize) = (32 << 20, 300);

/// Time limit of a case \[s\].
const TIME_LIMIT: u64 = 20;

/// Maximum number of characters of an error about a scene. Errors about pipelines are not limited, because they have
/// several lines for each of many problems.
const MAX_ERROR_LENGTH: usize = 1000;

/// Maximum number of triangles of a scene that is also lit.
const MAX_LIT_TRIANGLES: usize = 2000;

#[derive(Parser)]
struct Args {
    /// Kind of files to read.
    target: Target,
    /// Duration in minutes.
    #[arg(long, default_value_t = 1.0)]
    minutes: f64,
    /// The seed of all cases.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The number of the first case.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// Folder of the current case and of the findings.
    #[arg(long, default_value = "target/fuzz")]
    folder: PathBuf,
}

fn main() -> ExitCode {
    match fuzz(&Args::parse()) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Tries cases until the time is up, and returns the number of findings.
fn fuzz(args: &Args) -> Result<u64, Box<dyn Error>> {
    let Args { target, seed, .. } = *args;
    let current = args.folder.join("case");
    fs::create_dir_all(&current)?;
    let current = fs::canonicalize(current)?;
    let (start, now) = (Instant::now(), Arc::new(AtomicU64::new(0)));
    watch(start, Arc::clone(&now));
    std::panic::set_hook(Box::new(|_| {}));
    // The seed must be valid: changes to a file that is refused anyway would test little.
    if let Err(why) | Ok(Some(why)) = try_case(target, &current, &target.seed())? {
        return Err(format!("the seed is not accepted: {why}").into());
    }
    let (mut n, mut findings, mut accepted, mut reported) = (args.first, 0, 0u64, 0);
    while start.elapsed().as_secs_f64() < 60.0 * args.minutes {
        let files = case(target, &mut Dice::new(seed, n));
        now.store(start.elapsed().as_secs() + 1, Relaxed);
        let outcome = try_case(target, &current, &files)?;
        now.store(0, Relaxed);
        match outcome {
            Ok(refused) => accepted += u64::from(refused.is_none()),
            Err(what) => {
                findings += 1;
                let kept = args.folder.join(format!("{target:?}-{seed}-{n}").to_lowercase());
                fs::create_dir_all(&kept)?;
                for (name, bytes) in &files {
                    fs::write(kept.join(name), bytes)?;
                }
                println!("case {n}: {what}; kept in {}", kept.display());
            }
        }
        n += 1;
        let minutes = start.elapsed().as_secs() / 60;
        if minutes > reported {
            reported = minutes;
            eprintln!("{minutes} min: {} cases, {accepted} accepted, {findings} findings", n - args.first);
        }
    }
    println!("{target:?}, seed {seed}: {} cases, {accepted} accepted, {findings} findings", n - args.first);
    Ok(findings)
}

/// Ends the program if a case takes too long. `now` is the second in which the case began, plus 1, or 0 between cases.
fn watch(start: Instant, now: Arc<AtomicU64>) {
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let began = now.load(Relaxed);
            if began > 0 && start.elapsed().as_secs() > began + TIME_LIMIT {
                println!("a case takes more than {TIME_LIMIT} s; it is kept in the folder `case`");
                exit(1);
            }
        }
    });
}

/// Writes and reads the files of a case.
///
/// Returns `Ok(None)` if the files are accepted, `Ok(Some(reason))` if they are refused, and `Err(finding)` if the
/// reader misbehaves.
fn try_case(
    target: Target,
    folder: &Path,
    files: &[(&str, Vec<u8>)],
) -> Result<Result<Option<String>, String>, std::io::Error> {
    for (name, bytes) in files {
        // Some file systems take milliseconds to overwrite a file in place; removing it first is faster.
        let path = folder.join(name);
        if path.exists() {
            fs::remove_file(&path)?;
        }
        fs::write(path, bytes)?;
    }
    Ok(attempt(target, folder, files.iter().map(|(_, bytes)| bytes.len()).sum()))
}

fn attempt(target: Target, folder: &Path, bytes: usize) -> Result<Option<String>, String> {
    let path = folder.join(target.file());
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let outcome = catch_unwind(AssertUnwindSafe(|| match target {
        Target::Pipeline => Pipeline::read(&path).map(drop).map_err(|error| error.chain()),
        Target::Ies | Target::Ldt => Photometry::read(&path).map(sample).map_err(|error| chain(&error)),
        _ => load(&path, &LoadOptions::default()).map(Some).map_err(|error| chain(&error)).map(light),
    }));
    let memory = MEMORY.peak_usage().saturating_sub(before);
    let limit = MEMORY_LIMIT.0 + MEMORY_LIMIT.1 * bytes;
    let outcome = outcome.map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        format!("panic: {}", text.or(panic.downcast_ref::<&str>().copied()).unwrap_or("?"))
    })?;
    if memory > limit {
        return Err(format!("{memory} bytes for files of {bytes}"));
    }
    let Err(text) = outcome else { return Ok(None) };
    let control = |c: char| c.is_control() && !(target == Target::Pipeline && c == '\n');
    if text.contains(control) {
        return Err(format!("control characters in {text:?}"));
    }
    if target != Target::Pipeline && text.chars().count() > MAX_ERROR_LENGTH + 3 * folder.as_os_str().len() {
        return Err(format!("an error of {} characters", text.chars().count()));
    }
    if text.contains(&*folder.to_string_lossy()) {
        Ok(Some(text))
    } else {
        Err(format!("no file is named: {text}"))
    }
}

/// Samples directions, and looks up their intensities.
///
/// # Panics
///
/// If a result is not valid, which is a finding.
fn sample(file: Photometry) {
    let light = &file.distribution;
    assert!(light.flux().is_finite() && light.flux() > 0.0, "flux {}", light.flux());
    for point in [[0.0, 0.0], [0.2, 0.7], [0.5, 0.5], [1.0 - f64::EPSILON, 1.0 - f64::EPSILON]] {
        let direction = light.sample(point);
        assert!((direction.length() - 1.0).abs() < 1e-9, "direction {direction}");
        let intensity = light.intensity(direction);
        assert!((0.0..=light.largest() * (1.0 + 1e-9)).contains(&intensity), "intensity {intensity}");
    }
}

/// Makes patches and the convex hull of a small scene, and traces some lines.
fn light(built: Option<Built>) {
    let Some(scene) =
        built.map(|built| built.scene).filter(|scene| scene.triangles().len() <= MAX_LIT_TRIANGLES)
    else {
        return;
    };
    let Ok(model) = Model::new(scene, Subdivision::Triangles(PatchSize::Count(50))) else { return };
    drop(Domain::hull(model.scene.vertices()));
    // An error, such as too much power, is no finding.
    let _ = run_stage::<FirstShot<'_>>(ShotSettings::new(&model, 200, 1), ());
}

fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text = format!("{text}: {cause}");
        source = cause.source();
    }
    text
}
