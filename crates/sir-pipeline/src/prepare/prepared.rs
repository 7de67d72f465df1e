//! Everything that must work before the first line is traced.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec3;
use sir_geom::{LoadOptions, Scene};
use sir_lines::Focus;
use sir_mesh::Subdivision;
use sir_radiosity::{FocusSides, Model, ModelError, SolveError, Source, emits, sources};
use sir_view::guess_up;

use crate::error::Error;
use crate::prepare::cameras::camera_problems;
use crate::text::diagnostic::Diagnostic;

use crate::plan::{Action, Pipeline, SceneLight, Stage};
use crate::prepare::layout::Layout;
use crate::progress::Progress;
use crate::stopwatch::Stopwatch;

/// A pipeline's scene, ready for lines.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// Scene, patches and acceleration structure.
    pub model: Model,
    /// Which way is up: known of glTF files, guessed of others.
    pub up: DVec3,
    /// What the reader of the scene changed or left out.
    pub warnings: Vec<String>,
    /// The light sources: at least one.
    pub sources: Vec<Source>,
    /// What matters, if not everything does.
    pub focus: Option<Focus>,
    /// The sides in it.
    pub inside: FocusSides,
    /// Where the sensors of each stage `Sensors` are, by the number of the stage.
    pub layouts: BTreeMap<usize, Layout>,
    /// Seconds to read the scene.
    pub load_seconds: f64,
    /// Seconds to make patches and the acceleration structure.
    pub build_seconds: f64,
}

/// Reads the scene of a pipeline, makes its patches, and checks what the pipeline says about the scene.
///
/// # Errors
///
/// If the scene cannot be read, emits no light, has none of the cameras that pictures ask for, has no room for sensors, or cannot be
/// cut as the pipeline says; the latter three are shown with their place in the pipeline.
pub fn prepare(pipeline: &Pipeline, progress: &dyn Progress) -> Result<Prepared, Error> {
    let mut options = LoadOptions::default();
    let mut lights: Vec<SceneLight> = Vec::new();
    let mut subdivision = (Subdivision::PerTriangle, 0..0);
    let mut asked = None;
    for stage in &pipeline.stages {
        match &stage.action {
            Action::Load(load) => options.sides = load.sides,
            Action::Light(light) => {
                for lamp in &light.lamps {
                    lights.push(
                        lamp.to_scene().ok_or_else(|| pipeline.diagnostics(vec![impossible_light(stage)]))?,
                    );
                }
            }
            Action::Subdivide(subdivide) => subdivision = (subdivide.how, stage.span.0.clone()),
            Action::Focus(focus) => asked = Some((focus.bounds(), focus.share)),
            _ => {}
        }
    }
    let watch = Stopwatch::start();
    let built = sir_geom::load_with(pipeline.scene_path(), &options, |builder| {
        lights.iter().for_each(|light| light.add_to(builder));
        asked.iter().for_each(|(bounds, _)| builder.split_at(bounds));
    })?;
    let load_seconds = watch.seconds();
    let warnings: Vec<String> = built.warnings.iter().map(ToString::to_string).collect();
    progress.warn(&warnings);

    if !emits(&built.scene) {
        return Err(SolveError::NoLight.into());
    }
    let mut problems = camera_problems(pipeline, &built.scene);
    let watch = Stopwatch::start();
    let (how, span) = subdivision;
    let focus = asked.map(|(bounds, share)| {
        let focus = Focus::new(bounds, share, built.scene.bounding_box(), built.scene.bounding_sphere());
        focus.ok_or_else(|| pipeline.diagnostics(nothing_inside(pipeline, &built.scene)))
    });
    let focus = focus.transpose()?;
    match Model::within(built.scene, how, focus.map(|focus| focus.bounds())) {
        Ok(model) if problems.is_empty() => {
            let build_seconds = watch.seconds();
            let sources = sources(&model.scene, &model.mesh);
            if sources.is_empty() {
                return Err(SolveError::NoLight.into());
            }
            let up = up(pipeline.scene_path(), &model.scene);
            let inside = FocusSides::of(&model, focus.as_ref());
            if inside.is_empty() {
                return Err(pipeline.diagnostics(nothing_inside(pipeline, &model.scene)).into());
            }
            let layouts = layouts(pipeline, &model, up).map_err(|problems| pipeline.diagnostics(problems))?;
            Ok(Prepared { model, up, warnings, sources, focus, inside, layouts, load_seconds, build_seconds })
        }
        outcome => {
            problems.extend(outcome.err().map(|error| model_problem(error, span)));
            Err(pipeline.diagnostics(problems).into())
        }
    }
}

/// What is wrong with a light that was not read from a file.
fn impossible_light(stage: &Stage) -> Diagnostic {
    Diagnostic {
        span: stage.span.0.clone(),
        message: "a light of this stage is impossible".into(),
        help: "give directions a length, a spot an `outer` not below its `inner`, and colors that are not negative".into(),
    }
}

/// That nothing is in the focus, said at its stage.
fn nothing_inside(pipeline: &Pipeline, scene: &Scene) -> Vec<Diagnostic> {
    let around = scene.bounding_box();
    let is_focus = |stage: &&Stage| matches!(stage.action, Action::Focus(_));
    let stages = pipeline.stages.iter().filter(is_focus);
    stages
        .map(|stage| Diagnostic {
            span: stage.span.0.clone(),
            message: "no patch of the scene lies in the box of `Focus`".into(),
            help: format!("the scene reaches from {:.4} to {:.4}, in its own units", around.min, around.max),
        })
        .collect()
}

/// Where all sensors are, or why they cannot be where they should.
fn layouts(
    pipeline: &Pipeline,
    model: &Model,
    up: DVec3,
) -> Result<BTreeMap<usize, Layout>, Vec<Diagnostic>> {
    let (mut layouts, mut problems) = (BTreeMap::new(), Vec::new());
    for (number, stage) in pipeline.stages.iter().enumerate() {
        let Action::Sensors(sensors) = &stage.action else { continue };
        match Layout::new(&sensors.at.value, model, up) {
            Ok(layout) => drop(layouts.insert(number, layout)),
            Err((message, help)) => {
                problems.push(Diagnostic { span: sensors.at.span.0.clone(), message, help });
            }
        }
    }
    if problems.is_empty() { Ok(layouts) } else { Err(problems) }
}

pub(crate) fn up(path: &Path, scene: &Scene) -> DVec3 {
    // By the standard, +y is up in glTF; OBJ does not say.
    let is_obj = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj"));
    if is_obj { guess_up(scene) } else { DVec3::Y }
}

fn model_problem(error: ModelError, span: std::ops::Range<usize>) -> Diagnostic {
    let help = match error {
        ModelError::Mesh(_) => "ask for fewer or larger patches",
        ModelError::Accel(_) => "change the scene",
    };
    Diagnostic { span, message: error.to_string(), help: help.into() }
}
