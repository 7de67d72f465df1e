//! All parts of the experiment on one scene.

use std::fs;

use crate::error::StudyError;
use crate::experiment::accuracy::Reference;
use crate::experiment::document::{SceneFindings, figures};
use crate::experiment::error::ExperimentError;
use crate::experiment::files::write_file;
use crate::experiment::options::{ExperimentOptions, Part};
use crate::experiment::runs::{Done, Runs, Wanted};
use crate::experiment::subject::{Changes, Subject, TABLE};
use crate::experiment::{bodies, farm, mix, precision, speed, spread};
use crate::scaling::workers::{Plan, Workers};
use sir_pipeline::NoProgress;
use sir_pipeline::plan::Output;
use sir_pipeline::prepare::prepare;

/// Parts that compare results with the reference.
const COMPARING: [Part; 3] = [Part::Error, Part::Mix, Part::Farm];

/// Parts that need a run of the pipeline itself, with its images.
const FULL: [Part; 3] = [Part::Error, Part::Farm, Part::Pictures];

/// Returns the run of the pipeline itself.
fn full(runs: &Runs, subject: &Subject) -> Wanted {
    Wanted::new("full", Changes { direct: true, pictures: true, ..subject.changes() }, runs.cores)
}

/// Returns the reference run, with many more lines and other random numbers.
fn reference(runs: &Runs, subject: &Subject, factor: f64) -> Wanted {
    let lines = subject.lines.times(factor);
    let changes = Changes {
        lines,
        transport: subject.transport_of(lines.global),
        seed: subject.pipeline.seed.wrapping_add(1),
        direct: true,
        pictures: false,
    };
    Wanted::new("reference", changes, runs.cores)
}

/// Adds all runs of a scene to the agenda.
pub(crate) fn plan(runs: &mut Runs, subject: &Subject, options: &ExperimentOptions, plan: &Plan) {
    let parts = options.parts();
    let any = |some: &[Part]| some.iter().any(|part| parts.contains(part));
    if any(&[Part::Scaling]) {
        for &workers in &plan.workers {
            runs.plan(subject, &speed::wanted(subject, workers));
        }
    }
    if any(&FULL) {
        runs.plan(subject, &full(runs, subject));
    }
    if any(&COMPARING) {
        runs.plan(subject, &reference(runs, subject, options.reference));
    }
    if any(&[Part::Mix]) {
        runs.plan(subject, &speed::wanted(subject, Workers::BASELINE));
        mix::plan(runs, subject);
    }
    if any(&[Part::Farm]) {
        farm::plan(runs, subject);
    }
}

/// Makes the runs of the requested parts and evaluates them.
pub(crate) fn find(
    runs: &mut Runs,
    subject: &Subject,
    options: &ExperimentOptions,
    plan: &Plan,
) -> Result<SceneFindings, StudyError> {
    let parts = options.parts();
    let wants = |part: Part| parts.contains(&part);
    let any = |some: &[Part]| some.iter().any(|&part| wants(part));
    let [scaling_figure, mix_figure] = figures(&subject.name).map(|name| runs.folder.join(name));
    let mut found = in_this_process(runs, subject, options)?;
    if wants(Part::Scaling) {
        let speed = speed::find(runs, subject, plan, found.patches)?;
        write_figure(&scaling_figure, speed.svg())?;
        found.scaling = Some(speed);
    }
    let full = if any(&FULL) { Some(runs.get(subject, &full(runs, subject))?) } else { None };
    if let Some(full) = full.as_ref().filter(|_| wants(Part::Pictures)) {
        found.pictures = Some(pictures(runs, subject, full)?);
    }
    if any(&COMPARING) {
        let wanted = reference(runs, subject, options.reference);
        let reference = Reference::read(&runs.get(subject, &wanted)?)?;
        if let Some(full) = &full {
            if wants(Part::Error) {
                let lines = (subject.lines, wanted.changes.lines);
                found.error = Some(precision::find(&full.table(TABLE)?, &reference, lines)?);
            }
            if wants(Part::Farm) {
                found.farm = Some(farm::find(runs, subject, &reference, full)?);
            }
        }
        if wants(Part::Mix) {
            let mix = mix::find(runs, subject, &reference)?;
            write_figure(&mix_figure, mix.svg(&subject.name))?;
            found.mix = Some(mix);
        }
    }
    found.claims = found.judge();
    Ok(found)
}

/// Does the parts that need no solution. The scene is dropped from memory before other parts run.
fn in_this_process(
    runs: &Runs,
    subject: &Subject,
    options: &ExperimentOptions,
) -> Result<SceneFindings, StudyError> {
    let parts = options.parts();
    let model = prepare(&subject.pipeline, &NoProgress)?.model;
    let count = |part: Part, what: &str| {
        let wanted = parts.contains(&part);
        if wanted {
            runs.progress.message(&format!("{}: {what}", subject.name));
        }
        wanted
    };
    let domains = count(Part::Domains, "lines that miss the scene")
        .then(|| bodies::find(runs, &model, options.scale))
        .transpose()?;
    let spread = count(Part::Spread, "crossings per line")
        .then(|| spread::find(runs, subject, &model, options.scale))
        .transpose()?;
    Ok(SceneFindings {
        name: subject.name.clone(),
        pipeline: subject.pipeline.path.display().to_string(),
        triangles: model.scene.triangles().len(),
        patches: model.mesh.patch_count(),
        lines: subject.lines,
        scaling: None,
        error: None,
        mix: None,
        domains,
        spread,
        farm: None,
        pictures: None,
        claims: Vec::new(),
    })
}

/// Copies the image that the report shows, the first PNG, next to the report. Returns the paths of all images, that one
/// first.
fn pictures(runs: &Runs, subject: &Subject, full: &Done) -> Result<Vec<String>, StudyError> {
    let is_png = |path: &std::path::Path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    let mut paths: Vec<_> = subject.pictures().map(Output::path).collect();
    // Moves the first PNG to the front; the others keep their order.
    if let Some(first) = paths.iter().position(|path| is_png(path)) {
        paths[..=first].rotate_right(1);
    }
    let mut files: Vec<String> =
        paths.iter().map(|path| format!("runs/{}/full/{}", subject.name, path.display())).collect();
    if let Some(first) = paths.first().filter(|path| is_png(path)) {
        let name = format!("{}.png", subject.name);
        let (from, to) = (full.directory.join(first), runs.folder.join(&name));
        fs::copy(from, &to).map_err(|source| ExperimentError::Picture { path: to, source })?;
        files[0] = name;
    }
    Ok(files)
}

fn write_figure(path: &std::path::Path, svg: std::io::Result<String>) -> Result<(), StudyError> {
    let svg = svg.map_err(|source| ExperimentError::Picture { path: path.to_owned(), source })?;
    write_file(path, &svg)
}
