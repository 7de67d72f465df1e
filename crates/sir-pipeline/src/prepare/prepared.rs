//! Reads the scene of a pipeline, makes its patches, and checks the pipeline against the scene.

use std::collections::BTreeMap;

use glam::DVec3;
use sir_geom::{BoundingBox, LoadOptions, Rgb, Scene};
use sir_lines::Focus;
use sir_mesh::Subdivision;
use sir_radiosity::{FocusSides, Model, ModelError, SolveError, Source, emits, sources, total_power};

use crate::error::Error;
use crate::info::survey::Survey;
use crate::memory::refuse_more_than_available;
use crate::prepare::cameras::camera_problems;
use crate::prepare::up::{Up, sky_doubt};
use crate::text::diagnostic::Diagnostic;

use crate::plan::{Action, Lamp, Pipeline, Stage, Transport};
use crate::prepare::layout::Placed;
use crate::prepare::light_groups::{LightGroup, dimming, light_groups};
use crate::prepare::{daylight, glare, outside};
use crate::progress::Progress;
use crate::report::luminaires;
use crate::report::luminaires::LuminaireReport;
use crate::stopwatch::Stopwatch;

/// Number of lines from lamps that show what is suspicious. They take a few hundredths of a second.
const SURVEY_LINES: u64 = 10_000;

/// Memory that a cell of a surface needs while surfaces are divided: measured on a million cells, rounded up.
const BYTES_PER_CELL: f64 = 200.0;

/// Scene of a pipeline, ready for tracing.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// Scene, patches and acceleration structure.
    pub model: Model,
    /// Up direction, of unit length.
    pub up: DVec3,
    /// Reason for the up direction.
    pub up_from: String,
    /// Warnings of the scene reader about what it changed or left out.
    pub warnings: Vec<String>,
    /// What is suspicious about the scene, such as its size.
    pub suspicions: Vec<String>,
    /// True if most of the light of lamps ends on surfaces that cover them.
    pub lamps_are_covered: bool,
    /// Light sources, at least one.
    pub sources: Vec<Source>,
    /// Light groups, if the pipeline names any; together they emit all light.
    pub groups: Vec<LightGroup>,
    /// Focus, if there is one.
    pub focus: Option<Focus>,
    /// Sides in the focus.
    pub inside: FocusSides,
    /// Sensors or probes of each stage `Sensors`, by the number of the stage.
    pub placed: BTreeMap<usize, Placed>,
    /// Luminance-weighted irradiance of an unobstructed horizontal surface by the sky \[W/m²\], if there are daylight
    /// factors.
    pub outdoor: Option<f64>,
    /// Luminaires of the pipeline.
    pub luminaires: Vec<LuminaireReport>,
    /// Time to read the scene \[s\].
    pub load_seconds: f64,
    /// Time to make the patches and the acceleration structure \[s\].
    pub build_seconds: f64,
}

impl Prepared {
    /// Returns the same with the light of each light group multiplied by a factor per band.
    pub(crate) fn dimmed(&self, factors: &[Rgb]) -> Self {
        let model = self.model.dimmed(&dimming(&self.model.scene, &self.groups, factors));
        let sources = sources(&model.scene, &model.mesh);
        Self { model, sources, ..self.clone() }
    }
}

/// Reads the scene of a pipeline, makes its patches, and checks the references of the pipeline to the scene.
///
/// # Errors
///
/// If the scene cannot be read, emits no light, lacks a camera that an image refers to, has no room for sensors, or
/// cannot be divided into patches as specified. The latter three are shown with their position in the pipeline.
pub fn prepare(pipeline: &Pipeline, progress: &dyn Progress) -> Result<Prepared, Error> {
    let (mut options, mut stated_up) = (LoadOptions::default(), None);
    let (mut lamps, mut added): (Vec<&Lamp>, _) = (Vec::new(), Vec::new());
    let mut subdivision = (Subdivision::PerTriangle, 0..0);
    let mut requested_focus = None;
    for stage in &pipeline.stages {
        match &stage.action {
            Action::Load(load) => {
                options = LoadOptions { sides: load.sides, scale: load.scale };
                stated_up = load.up;
            }
            Action::Light(light) => lamps.extend(&light.lamps),
            Action::Subdivide(subdivide) => subdivision = (subdivide.subdivision(), stage.span.0.clone()),
            Action::Focus(focus) => requested_focus = Some((focus.bounds(), focus.share)),
            _ => {}
        }
    }
    // The sum saturates: an array may have any size here.
    let needed = lamps.iter().filter_map(|lamp| match lamp {
        Lamp::Luminaire(luminaire) => Some(luminaire.bytes_in_scene()),
        _ => None,
    });
    refuse_more_than_available(needed.fold(0, usize::saturating_add))?;
    if lamps.iter().any(|lamp| lamp.to_scene(DVec3::Y).is_none()) {
        return Err(pipeline.diagnostics(impossible_lights(pipeline)).into());
    }
    let watch = Stopwatch::start();
    let built = sir_geom::load_with(pipeline.scene_path(), &options, |builder| {
        let needs_up = lamps.iter().any(|lamp| lamp.needs_up());
        let up =
            if needs_up { Up::before_lamps(pipeline.scene_path(), builder, stated_up) } else { DVec3::Y };
        let add = |lamp: &&Lamp| {
            let lights = lamp.to_scene(up).unwrap_or_default();
            lights.iter().flat_map(|light| light.add_to(builder)).collect::<Vec<_>>()
        };
        added = lamps.iter().map(add).collect();
        requested_focus.iter().for_each(|(bounds, _)| builder.split_at(bounds));
    })?;
    let load_seconds = watch.seconds();
    let mut warnings: Vec<String> = built.warnings.iter().map(ToString::to_string).collect();
    warnings.extend(luminaires::warnings(pipeline));
    progress.warn(&warnings);

    if !emits(&built.scene) {
        return Err(no_light(pipeline));
    }
    let mut problems = camera_problems(pipeline, &built.scene);
    let watch = Stopwatch::start();
    let (how, span) = subdivision;
    let focus = requested_focus.map(|(bounds, share)| {
        let focus = Focus::new(bounds, share, built.scene.bounding_box());
        focus.ok_or_else(|| pipeline.diagnostics(nothing_inside(pipeline, &built.scene)))
    });
    let focus = focus.transpose()?;
    let cells = how.estimated_cells(&built.scene, focus.map(|focus| focus.bounds()));
    // What cannot even be counted is an error of the pipeline.
    let cells = cells.filter(|&cells| cells <= f64::from(u32::MAX));
    refuse_more_than_available((BYTES_PER_CELL * cells.unwrap_or(0.0)) as usize)?;
    match Model::within(built.scene, how, focus.map(|focus| focus.bounds())) {
        Ok(model) if problems.is_empty() => {
            let build_seconds = watch.seconds();
            let sources = sources(&model.scene, &model.mesh);
            match total_power(&sources) {
                Err(SolveError::NoLight) => return Err(no_light(pipeline)),
                other => drop(other?),
            }
            let Up { direction: up, why: up_from, doubt } =
                Up::of(pipeline.scene_path(), &model.scene, stated_up);
            let inside = FocusSides::of(&model, focus.as_ref());
            if inside.is_empty() {
                return Err(pipeline.diagnostics(nothing_inside(pipeline, &model.scene)).into());
            }
            let bounds = focus.map(|focus| focus.bounds());
            let placed =
                place(pipeline, &model, up, bounds).map_err(|problems| pipeline.diagnostics(problems))?;
            let outdoor =
                outdoor(pipeline, &sources).map_err(|problem| pipeline.diagnostics(vec![problem]))?;
            let groups =
                light_groups(pipeline, &model, &added).map_err(|problems| pipeline.diagnostics(problems))?;
            let survey = Survey::new(&model.scene, &model.accel, &sources, up, SURVEY_LINES);
            let mut suspicions = survey.suspicions(focus.is_some());
            suspicions.extend(doubt);
            suspicions.extend(sky_doubt(&model.scene, up));
            suspicions.extend(bent_patches(pipeline, &model));
            suspicions.extend(outside::luminaires(pipeline, &model, up, &added));
            suspicions.extend(outside::grids(pipeline, &placed, &model, up));
            progress.warn(&suspicions);
            Ok(Prepared {
                model,
                up,
                up_from,
                warnings,
                suspicions,
                lamps_are_covered: survey.are_lamps_covered(),
                sources,
                groups,
                focus,
                inside,
                placed,
                outdoor,
                luminaires: LuminaireReport::all(pipeline),
                load_seconds,
                build_seconds,
            })
        }
        outcome => {
            problems.extend(outcome.err().map(|error| model_problem(error, span)));
            Err(pipeline.diagnostics(problems).into())
        }
    }
}

/// Returns the problem of lights with contradictory numbers, which can only come from a pipeline that was not read from a
/// file.
fn impossible_lights(pipeline: &Pipeline) -> Vec<Diagnostic> {
    let stages = pipeline.stages.iter().filter(|stage| matches!(stage.action, Action::Light(_)));
    stages
        .map(|stage| Diagnostic {
            span: stage.span.0.clone(),
            message: "a light of this stage has contradictory numbers".into(),
            help: "use directions of nonzero length, an `outer` that is not less than `inner`, and colors that are not negative"
                .into(),
        })
        .collect()
}

/// Returns the error that nothing emits, at the luminaires that are turned off if there are any.
fn no_light(pipeline: &Pipeline) -> Error {
    let off: Vec<Diagnostic> = pipeline
        .luminaires()
        .filter(|luminaire| luminaire.dimming.value == 0.0)
        .map(|luminaire| Diagnostic {
            span: luminaire.dimming.span.0.clone(),
            message: "nothing emits light (the `dimming` of this luminaire is 0)".into(),
            help: "choose a `dimming` above 0, or add another light".into(),
        })
        .collect();
    if off.is_empty() { SolveError::NoLight.into() } else { pipeline.diagnostics(off).into() }
}

/// Returns the problem that no patch is in the focus, at the stage `Focus`.
fn nothing_inside(pipeline: &Pipeline, scene: &Scene) -> Vec<Diagnostic> {
    let around = scene.bounding_box();
    let is_focus = |stage: &&Stage| matches!(stage.action, Action::Focus(_));
    let stages = pipeline.stages.iter().filter(is_focus);
    stages
        .map(|stage| Diagnostic {
            span: stage.span.0.clone(),
            message: "no patch of the scene lies in the box of `Focus`".into(),
            help: format!(
                "choose a box in the scene, which extends from {:.4} to {:.4} in meters",
                around.min, around.max
            ),
        })
        .collect()
}

/// Returns the irradiance to which daylight factors refer, if there are any. The error is the problem of the first stage
/// that cannot have them.
fn outdoor(pipeline: &Pipeline, sources: &[Source]) -> Result<Option<f64>, Diagnostic> {
    let wants = |stage: &&Stage| matches!(&stage.action, Action::Sensors(sensors) if sensors.daylight_factor);
    let Some(stage) = pipeline.stages.iter().find(wants) else { return Ok(None) };
    let problem = |(message, help)| Diagnostic { span: stage.span.0.clone(), message, help };
    daylight::outdoor(pipeline, sources).map(Some).map_err(problem)
}

/// Places all sensors. The error has a problem for each stage whose sensors cannot be placed.
fn place(
    pipeline: &Pipeline,
    model: &Model,
    up: DVec3,
    focus: Option<BoundingBox>,
) -> Result<BTreeMap<usize, Placed>, Vec<Diagnostic>> {
    let (mut all, mut problems) = (BTreeMap::new(), Vec::new());
    for (number, stage) in pipeline.stages.iter().enumerate() {
        let Action::Sensors(sensors) = &stage.action else { continue };
        let checked = |placed: Placed| match sensors.ugr {
            true => glare::check(&placed, &model.scene, up).map(|()| placed),
            false => Ok(placed),
        };
        match Placed::new(sensors, model, up, focus).and_then(checked) {
            Ok(placed) => drop(all.insert(number, placed)),
            Err((message, help)) => {
                problems.push(Diagnostic { span: sensors.at.span.0.clone(), message, help });
            }
        }
    }
    if problems.is_empty() { Ok(all) } else { Err(problems) }
}

fn model_problem(error: ModelError, span: std::ops::Range<usize>) -> Diagnostic {
    let help = match error {
        ModelError::Mesh(_) => "use fewer or larger patches",
        ModelError::Accel(_) => "change the scene",
    };
    Diagnostic { span, message: error.to_string(), help: help.into() }
}

/// Returns a warning if replicas meet patches that are not flat.
fn bent_patches(pipeline: &Pipeline, model: &Model) -> Option<String> {
    let has_replicas = pipeline.flat_stages().any(|stage| {
        matches!(&stage.action, Action::Multipath(multipath) if matches!(multipath.transport, Transport::Replicas(_)))
    });
    (has_replicas && model.mesh.has_bent_patches()).then(|| {
        "some patches join small triangles of bent surfaces, which a line may cross twice; `Replicas` does not foresee this and \
         may bring such a patch too much light; set `of: Triangles` in `Subdivide`"
            .into()
    })
}
