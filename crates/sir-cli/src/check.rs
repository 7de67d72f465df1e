//! What a pipeline will do and cost, without doing it.

use std::fmt;
use std::time::{Duration, Instant};

use sir_geom::{Rgb, Scene};
use sir_lines::LocalLines;
use sir_parallel::cores;
use sir_radiosity::{
    Batches, Books, Emitter, FirstShot, Model, Quanta, Repeats, SecondShot, SolveError, Source,
};

use crate::error::Error;
use crate::fields::grouped;
use crate::memory;
use crate::pipeline::{Action, Content, Pipeline, Repeat, Until};
use crate::prepare::{Prepared, chosen_camera, prepare};
use crate::progress::Progress;
use crate::save::{is_calm, settings};
use crate::units::Units;

/// How long the lines of a stage are tried to learn their rate.
const PROBE: Duration = Duration::from_millis(300);

/// Lines between two looks at the clock.
const BLOCK: u64 = 1 << 10;

/// Bytes per side of what pictures and lit meshes are made from: measured on two million sides, rounded up.
const DISPLAY_BYTES: usize = 200;

/// Bytes per pixel of the largest picture: a ray's colours while it is drawn and when it is done, and its file.
const PIXEL_BYTES: usize = 2 * 24 + 16;

/// What a pipeline will do and cost.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// What power is measured in.
    pub units: Units,
    /// The scene, ready to be lit.
    pub prepared: Prepared,
    /// Memory per part \[bytes\].
    pub memory: Vec<(&'static str, usize)>,
    /// Most memory in use at one time \[bytes\].
    pub peak_memory: usize,
    /// Lines and lines per second of each stage that has any: the rate of one thread in a short try on this machine now,
    /// times its processor cores.
    pub stages: Vec<StageEstimate>,
    /// How often these stages are repeated.
    pub repeat: Option<Repeated>,
}

/// What a stage will cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageEstimate {
    /// Name of the stage.
    pub name: &'static str,
    /// Its lines.
    pub lines: u64,
    /// Lines per second.
    pub rate: f64,
}

/// How often stages are repeated, see [`Repeat`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeated {
    /// Until when.
    pub until: Until,
    /// How often at most.
    pub at_most: Option<u64>,
}

/// Reads the scene of a pipeline, makes its patches and tries some lines of each stage. Writes nothing.
///
/// # Errors
///
/// As [`prepare`].
pub fn check(pipeline: &Pipeline, progress: Progress) -> Result<Estimate, Error> {
    let prepared = prepare(pipeline, progress)?;
    let (memory, peak_memory) = memory(&prepared.model, pipeline);
    // The try below takes as much as the run.
    memory::refuse_more_than_available(needed_beside_model(&memory))?;
    let repeat = pipeline.stages.iter().find_map(|stage| match &stage.action {
        Action::Repeat(repeat) => Some(repeat),
        _ => None,
    });
    let stages = probe(pipeline, &prepared)?;
    let repeat = repeat.map(|&Repeat { until, at_most, .. }| Repeated { until, at_most });
    Ok(Estimate { units: pipeline.units, prepared, memory, peak_memory, stages, repeat })
}

/// Says how much memory a run will take, and refuses what this machine does not have.
pub(crate) fn check_memory(model: &Model, pipeline: &Pipeline, progress: Progress) -> Result<(), Error> {
    let (parts, most) = memory(model, pipeline);
    progress.note(&format!("Memory: {} at most", bytes(most)));
    memory::refuse_more_than_available(needed_beside_model(&parts))
}

/// Of the parts of a run's memory, what it needs beside its scene, patches and acceleration structure.
fn needed_beside_model(memory: &[(&'static str, usize)]) -> usize {
    memory.iter().skip(3).map(|part| part.1).max().unwrap_or(0)
}

/// Memory of a run per part and at most \[bytes\].
fn memory(model: &Model, pipeline: &Pipeline) -> (Vec<(&'static str, usize)>, usize) {
    let Model { scene, mesh, accel } = model;
    let sides = mesh.side_count();
    // Power and its variance; in the first shot two records of 64 bytes in the ledger, later one, and less than 64 bytes
    // for what is unshot.
    let tracing = size_of::<Quanta>() + size_of::<[f32; 3]>() + 2 * 64;
    let solution = 2 * size_of::<Rgb>();
    let repeats = pipeline.stages.iter().any(|stage| matches!(stage.action, Action::Repeat(_)));
    let tracing = tracing + if repeats { Repeats::BYTES_PER_SIDE } else { 0 };
    let shown = pipeline.outputs().any(|o| o.content != Content::Table);
    // Pictures for measuring have one of standard errors, too.
    let measured =
        pipeline.outputs().any(|o| o.path.extension().is_some_and(|e| e.eq_ignore_ascii_case("exr")));
    // Pictures without noise have a mesh of their own; making it takes less than it has itself.
    let calm = pipeline.outputs().any(is_calm);
    let displays = usize::from(shown) + usize::from(measured) + usize::from(calm);
    let pixels = pipeline.outputs().filter_map(|o| match &o.content {
        Content::Image(image) => {
            let camera = chosen_camera(&image.camera, scene);
            let size = settings(image, camera.as_ref(), 1);
            Some(size.width as usize * size.height as usize)
        }
        _ => None,
    });
    let memory = vec![
        ("scene", size_of_val(scene.vertices()) + size_of_val(scene.triangles()) + scene.appearance_bytes()),
        // See `PatchMesh`: 28 bytes per triangle.
        ("patches", 28 * scene.triangles().len() + mesh.paint_bytes()),
        ("acceleration structure", accel.bytes()),
        ("computing the light", sides * tracing),
        (
            "pictures and lit meshes",
            sides * displays.min(1) * solution
                + sides * displays * DISPLAY_BYTES
                + pixels.max().unwrap_or(0) * PIXEL_BYTES,
        ),
    ];
    // The last two are not needed at the same time.
    let [scene, patches, accel, light, display] = [0, 1, 2, 3, 4].map(|i: usize| memory[i].1);
    (memory, scene + patches + accel + light.max(display))
}

fn probe(pipeline: &Pipeline, prepared: &Prepared) -> Result<Vec<StageEstimate>, SolveError> {
    let Prepared { model, focus, .. } = prepared;
    let (focus, seed) = (*focus, pipeline.seed);
    let mut shot = None;
    let mut estimates = Vec::new();
    for stage in pipeline.flat_stages() {
        let name = stage.action.name();
        match stage.action {
            Action::FirstShot { lines } => {
                let first_shot = FirstShot::new(model, LocalLines { count: lines, focus }, seed)?;
                let (tally, mut books) = (first_shot.tally(1), Books::default());
                let rate = rate(lines, |block| first_shot.trace(0, block, &tally, &mut books));
                shot = Some(first_shot.finish(tally, books)?);
                estimates.push(StageEstimate { name, lines, rate });
            }
            Action::SecondShot { lines } => {
                let Some(shot) = &shot else { continue };
                let second_shot = SecondShot::new(model, shot, LocalLines { count: lines, focus }, seed);
                let local = second_shot.lines();
                let (tally, mut books) = (local.tally(1), Books::default());
                let rate = rate(local.lines(), |block| local.trace(0, block, &tally, &mut books));
                estimates.push(StageEstimate { name, lines, rate });
            }
            Action::Multipath { lines, body, .. } => {
                let Some(shot) = shot.take() else { continue };
                // Both transports trace the same lines at about the same rate.
                let through = body.lines_around(&model.scene, focus);
                let transport = Batches::new(model, shot, lines, through, seed, 1);
                let mut books = Books::default();
                let rate = rate(lines, |block| transport.trace(0, block, &mut books));
                estimates.push(StageEstimate { name, lines, rate });
            }
            _ => {}
        }
    }
    Ok(estimates)
}

/// Lines per second of a short try, if all cores do the same.
fn rate(lines: u64, mut trace: impl FnMut(std::ops::Range<u64>)) -> f64 {
    let start = Instant::now();
    let mut done = 0;
    while done < lines && start.elapsed() < PROBE {
        let end = lines.min(done + BLOCK);
        trace(done..end);
        done = end;
    }
    cores().get() as f64 * done as f64 / start.elapsed().as_secs_f64().max(1e-9)
}

impl Repeated {
    /// What a repeat of so many seconds comes to: whether that is all, the seconds, and how often it is.
    fn cost(self, once: f64) -> (&'static str, f64, Option<String>) {
        let most = self.at_most.map_or(f64::INFINITY, |most| most as f64);
        let limit = self.at_most.map_or(String::new(), |most| format!(", {} times at most", grouped(most)));
        match self.until {
            Until::Times(times) => {
                let times = most.min(times as f64);
                (" in all", times * once, Some(format!("{} times", grouped(times as u64))))
            }
            Until::Seconds(budget) => {
                let seconds = budget.min(most * once).max(once);
                let how = format!("for {}{limit}", duration(budget));
                (" in all", seconds, Some(how))
            }
            Until::RelativeError(target) => {
                let how = format!("until the relative error is {} %{limit}", 100.0 * target);
                match self.at_most {
                    Some(_) => (" at most", most * once, Some(how)),
                    None => (" or more", once, Some(how)),
                }
            }
        }
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Prepared { model, sources, load_seconds, build_seconds, .. } = &self.prepared;
        let scene: &Scene = &model.scene;
        let count = |n: usize| grouped(n as u64);
        let size = scene.bounding_box().size();
        let power: Rgb = sources.iter().map(|s| s.power).sum();
        writeln!(f, "triangles  {}", count(scene.triangles().len()))?;
        writeln!(f, "patches    {}", count(model.mesh.patch_count()))?;
        writeln!(f, "sides      {}", count(model.mesh.side_count()))?;
        writeln!(f, "area       {:.6} m²", scene.total_area())?;
        writeln!(f, "extent     {:.4} × {:.4} × {:.4} m", size.x, size.y, size.z)?;
        writeln!(f, "cameras    {}", scene.cameras().len())?;
        writeln!(
            f,
            "sources    {}, {:.6} + {:.6} + {:.6} {} (red, green, blue)",
            kinds(sources),
            power.x,
            power.y,
            power.z,
            self.units.power()
        )?;
        writeln!(f, "memory     {} at most:", bytes(self.peak_memory))?;
        for (part, size) in &self.memory {
            writeln!(f, "           {:>9}  {part}", bytes(*size))?;
        }
        let once: f64 = self.stages.iter().map(|s| s.lines as f64 / s.rate).sum();
        let (bound, tracing, repeats) =
            self.repeat.map_or((" in all", once, None), |repeat| repeat.cost(once));
        writeln!(
            f,
            "time       {}{bound}, without outputs:",
            duration(load_seconds + build_seconds + tracing)
        )?;
        writeln!(f, "           {:>9}  Load", duration(*load_seconds))?;
        writeln!(f, "           {:>9}  patches and acceleration structure", duration(*build_seconds))?;
        if let Some(repeats) = repeats {
            writeln!(f, "           {:>9}  Repeat: {repeats}; each time", duration(tracing))?;
        }
        for StageEstimate { name, lines, rate } in &self.stages {
            let time = duration(*lines as f64 / rate);
            writeln!(
                f,
                "           {time:>9}  {name}: {} lines at {} lines/s",
                grouped(*lines),
                grouped(*rate as u64)
            )?;
        }
        Ok(())
    }
}

/// How many sources there are of which kind.
pub(crate) fn kinds(sources: &[Source]) -> String {
    let count = |is: fn(&Emitter) -> bool| sources.iter().filter(|s| is(&s.emitter)).count();
    let counts = [
        ("triangle side", count(|e| matches!(e, Emitter::Surface { .. }))),
        ("point", count(|e| matches!(e, Emitter::Point { .. }))),
        ("distant light", count(|e| matches!(e, Emitter::Distant { .. }))),
        ("sky", count(|e| matches!(e, Emitter::Dome(_)))),
        ("ground", count(|e| matches!(e, Emitter::Ground(_)))),
    ];
    let named = counts.iter().filter(|(_, n)| *n > 0).map(|(name, n)| match *name {
        "sky" | "ground" => (*name).to_owned(),
        name => format!("{} {name}{}", grouped(*n as u64), if *n == 1 { "" } else { "s" }),
    });
    named.collect::<Vec<_>>().join(", ")
}

/// A size in a unit that people can grasp.
pub(crate) fn bytes(n: usize) -> String {
    let (mut x, mut unit) = (n as f64, "B");
    for next in ["kiB", "MiB", "GiB", "TiB"] {
        if x < 1024.0 {
            break;
        }
        (x, unit) = (x / 1024.0, next);
    }
    if unit == "B" { format!("{n} B") } else { format!("{x:.1} {unit}") }
}

/// A time in a unit that people can grasp.
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_times_are_readable() {
        assert_eq!([0, 1023, 1024, 5 << 20].map(bytes), ["0 B", "1023 B", "1.0 kiB", "5.0 MiB"]);
        assert_eq!(
            [0.26, 119.0, 600.0, 7200.0, 172_800.0].map(duration),
            ["0.3 s", "119.0 s", "10.0 min", "2.0 h", "2.0 days"]
        );
    }

    #[test]
    fn a_rate_counts_every_line_once() {
        let mut seen = 0;
        let rate = rate(2500, |block| {
            assert_eq!(block.start, seen);
            seen = block.end;
        });
        assert!(seen == 2500 && rate > 0.0);
    }
}
