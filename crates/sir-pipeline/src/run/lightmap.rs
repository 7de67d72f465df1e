//! Makes and writes lightmaps.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::Ordering::Relaxed;

use sir_geom::Rgb;
use sir_lightmap::{LightmapFiles, Observer, Solution, Step};
use sir_radiosity::Model;

use crate::error::Error;
use crate::format::grouped;
use crate::plan::{Action, Lightmap};
use crate::progress::{Meter, StageKind};
use crate::run::computed::Computed;
use crate::run::saver::Saver;

/// Makes a lightmap of this irradiance and writes its files. Returns those beside the lit scene.
pub(crate) fn write(
    saver: Saver<'_>,
    light: &Computed,
    irradiance: &[Rgb],
    output: &Lightmap,
    path: &Path,
) -> Result<Vec<PathBuf>, Error> {
    let Saver { pipeline, prepared, threads, progress, .. } = saver;
    let Model { scene, mesh, .. } = &prepared.model;
    let load = pipeline.stages.iter().find_map(|stage| match &stage.action {
        Action::Load(load) => Some(load),
        _ => None,
    });
    let solution = Solution {
        scene,
        mesh,
        irradiance,
        errors: &light.solution.error,
        is_denoised: output.denoise,
        direct: light.direct.as_deref().filter(|_| output.direct),
        source: pipeline.scene_path(),
        scale: load.map_or(1.0, |load| load.scale),
        up: prepared.up,
    };
    let watcher = Watch { saver, state: Mutex::new(None) };
    let lightmap = sir_lightmap::Lightmap::new(solution, output.options(threads), &watcher)?;
    progress.warn(lightmap.notes());
    let ([width, height], pages) = lightmap.size();
    progress.note(&format!(
        "Lightmap: {} of {width} × {height} texels, {} charts, {:.3} texels per meter, {:.0} % covered",
        if pages == 1 { "a page".to_owned() } else { format!("{pages} pages") },
        grouped(lightmap.charts().into()),
        lightmap.texels_per_meter(),
        100.0 * lightmap.covered(),
    ));
    let files = LightmapFiles {
        exr: output.exr,
        rgbm: output.rgbm,
        combined: output.combined,
        unit: pipeline.units.irradiance(),
    };
    let mut written = lightmap.write(path, files, &watcher)?;
    written.retain(|file| file != path);
    Ok(written)
}

/// Shows the progress of each step, and stops the work when the run is asked to stop.
struct Watch<'a> {
    saver: Saver<'a>,
    /// The step, and its meter.
    state: Mutex<Option<(Step, Box<dyn Meter>)>>,
}

impl Observer for Watch<'_> {
    fn progress(&self, step: Step, done: u64, total: Option<u64>) -> bool {
        // A step without a known total has no meter, but ends the one before.
        if let Ok(mut state) = self.state.lock() {
            if state.as_ref().is_none_or(|(known, _)| *known != step) {
                let (title, unit) = titles(step);
                if step == Step::Packing {
                    // It may take minutes for many charts, and nobody knows how many.
                    self.saver.progress.note(title);
                }
                let meter = self.saver.progress.begin(title, total.unwrap_or(0), StageKind::Work(unit));
                *state = Some((step, meter));
            }
            if let (Some((_, meter)), Some(total)) = (state.as_mut(), total) {
                meter.progress(done, total);
            }
        }
        !self.saver.stop.load(Relaxed)
    }
}

/// Returns the title of a step, and what it counts.
fn titles(step: Step) -> (&'static str, &'static str) {
    match step {
        Step::Unwrapping => ("Lightmap: unfolding surfaces", "triangles"),
        Step::Packing => ("Lightmap: placing charts", "attempts"),
        Step::Filling => ("Lightmap: filling texels", "sides of patches"),
        Step::Seams => ("Lightmap: fitting seams", "steps"),
    }
}
