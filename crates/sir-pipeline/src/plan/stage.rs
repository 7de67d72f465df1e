//! Stages of a pipeline, and those in a `Repeat`.

use crate::plan::focus::Focus;
use crate::plan::light::Light;
use crate::plan::lines::{FirstShot, MAX_LINES, SecondShot, ShadowRays, Solve};
use crate::plan::load::Load;
use crate::plan::multipath::{Multipath, Transport};
use crate::plan::order::{Named, check_order, check_repeated};
use crate::plan::save::Save;
use crate::plan::sensors::Sensors;
use crate::plan::subdivide::Subdivide;
use crate::text::diagnostic::Diagnostic;
use crate::text::field::{Format, OneOf};
use crate::text::formats::{count, positive, write_number};
use crate::text::reader::Reader;
use crate::text::record::{Choose, choice, record};
use crate::text::ron_tree::{Node, Value};
use crate::text::span::Span;
use crate::text::suggest::resembling;

/// Stage with its position in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Action of the stage.
    pub action: Action,
    /// Position of the name of the stage in the file.
    pub span: Span,
}

impl Stage {
    /// Returns the stages of a `Repeat`, or the stage itself if it is another one.
    pub fn flat(&self) -> impl Iterator<Item = &Self> {
        match &self.action {
            Action::Repeat(Repeat { stages, .. }) => stages.iter(),
            _ => std::slice::from_ref(self).iter(),
        }
    }
}

choice! {
    /// Action of a stage.
    pub enum Action as "stage" {
        /// Reads a scene.
        Load(Load),
        /// Adds lights to the scene.
        Light(Light),
        /// Divides the triangles into patches.
        Subdivide(Subdivide),
        /// Gives a box of interest a larger share of the lines.
        Focus(Focus),
        /// Computes all light, with one number of lines.
        Solve(Solve),
        /// Sends the power of the light sources along local lines.
        FirstShot(FirstShot),
        /// Measures the direct light by rays from the patches to the light sources.
        ShadowRays(ShadowRays),
        /// Sends the power reflected by the brightest patches along local lines.
        SecondShot(SecondShot),
        /// Distributes the reflected light along global lines.
        Multipath(Multipath),
        /// Runs stages of lines repeatedly, and averages the independent results.
        Repeat(Repeat),
        /// Measures irradiance at points.
        Sensors(Sensors),
        /// Writes files.
        Save(Save),
    }
}

impl Action {
    /// Returns the name of the stage in a pipeline file.
    #[must_use]
    pub fn name(&self) -> &'static str {
        Choose::name(self)
    }

    /// Returns the number of lines or rays of the stage, for a `Repeat` that of one repeat.
    #[must_use]
    pub fn lines(&self) -> u64 {
        match self {
            Self::FirstShot(FirstShot { lines })
            | Self::ShadowRays(ShadowRays { rays: lines })
            | Self::SecondShot(SecondShot { lines, .. })
            | Self::Solve(Solve { lines })
            | Self::Multipath(Multipath { lines, .. }) => *lines,
            Self::Repeat(repeat) => repeat.stages.iter().map(|stage| stage.action.lines()).sum(),
            Self::Load(_)
            | Self::Light(_)
            | Self::Subdivide(_)
            | Self::Focus(_)
            | Self::Sensors(_)
            | Self::Save(_) => 0,
        }
    }
}

record! {
    /// Stages that are run repeatedly.
    pub struct Repeat {
        /// Target at which to stop.
        pub until: Until = until();
        /// Maximum number of repeats. A warning reports that a target was not reached.
        pub at_most: Option<u64> = count(1, MAX_LINES, 100).optional("no limit");
        /// Time limit beside `until: RelativeError(…)` or `times`: ends like `Seconds(s)`, if the target is not reached
        /// before.
        pub at_most_seconds: Option<f64> = positive(600.0).optional("no limit").unit("s");
        /// `Solve`, or `FirstShot` and the stages that may follow it, except `Sensors` and `Save`.
        pub stages: Vec<Stage> = StageList::REPEATED.required();
    }
}

impl Repeat {
    /// Returns when it ends.
    #[must_use]
    pub fn ending(&self) -> Ending {
        let Self { until, at_most, at_most_seconds, .. } = *self;
        Ending { until, at_most, at_most_seconds }
    }
}

/// When a `Repeat` ends: at its target, or at a limit before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ending {
    /// Target.
    pub until: Until,
    /// Maximum number of repeats.
    pub at_most: Option<u64>,
    /// Time limit \[s\].
    pub at_most_seconds: Option<f64>,
}

/// Target of a `Repeat`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// Number of repeats, at least 1.
    Times(u64),
    /// Upper limit of the relative error of the mean in all bands, above 0.
    RelativeError(f64),
    /// Time limit \[s\], above 0. A repeat that would end later is not begun.
    Seconds(f64),
}

fn until() -> OneOf<Until> {
    OneOf::new()
        .field("times", count(1, MAX_LINES, 16), "", "Number of repeats.", Until::Times, |until| match until {
            Until::Times(times) => Some(*times),
            _ => None,
        })
        .field(
            "until",
            Target,
            "",
            "`RelativeError(e)`: repeats until the `relative_error` of the mean, as in `result.json`, is at most `e` in every band; \
             0.01 is 1 %. `Seconds(s)`: repeats for at most `s` seconds, but at least once. A repeat is not begun if it would end \
             later, assuming the mean duration of those before. Time before a run was resumed counts.",
            |until| until,
            |until| (!matches!(until, Until::Times(_))).then_some(*until),
        )
}

/// Format of a target that is not a number of repeats.
#[derive(Clone, Copy)]
struct Target;

impl Format for Target {
    type Value = Until;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<Until> {
        let kind = reader.name_of(node, "target", &["RelativeError", "Seconds"])?;
        let (example, target): (_, fn(f64) -> Until) = match kind {
            "Seconds" => (60.0, Until::Seconds),
            _ => (0.01, Until::RelativeError),
        };
        let help = format!("write `{name}: {}`", self.write(&target(example)));
        if let Value::Items(items) = &node.value
            && let [number] = items.as_slice()
        {
            match positive(example).value(number) {
                Ok(value) => return Some(target(value)),
                Err(what) => {
                    let message = format!("`{kind}` must have {what}, but it has {}", number.kind());
                    reader.problem(number.text, message, help);
                }
            }
        } else {
            let message = format!("`{kind}` takes one number, but this is {}", node.kind());
            reader.problem(node.text, message, help);
        }
        None
    }

    fn write(&self, value: &Until) -> String {
        match value {
            Until::Times(times) => times.to_string(),
            Until::RelativeError(error) => format!("RelativeError({})", write_number(*error)),
            Until::Seconds(seconds) => format!("Seconds({})", write_number(*seconds)),
        }
    }

    fn describe(&self) -> String {
        "`RelativeError(e)` or `Seconds(s)`, of a number above 0".into()
    }

    fn example(&self) -> String {
        "RelativeError(0.01)".into()
    }
}

/// Reports all stages with replicas, because there is a focus. A line of a replica takes all unshot power of a side, so
/// the density of lines must be uniform.
fn refuse_replicas<'s>(reader: &mut Reader<'_>, stages: impl Iterator<Item = &'s Stage>) {
    for stage in stages.flat_map(Stage::flat) {
        if let Action::Multipath(Multipath { transport: Transport::Replicas(_), .. }) = stage.action {
            reader.problems.push(Diagnostic {
                span: stage.span.0.clone(),
                message: "the transport `Replicas` cannot be combined with a `Focus`: each line takes all unshot power of a \
                          surface, so the density of lines must be uniform"
                    .into(),
                help: "write `transport: Batches`, or leave `Focus` out".into(),
            });
        }
    }
}

/// Format of a list of stages in a valid order.
#[derive(Clone, Copy)]
pub(crate) struct StageList {
    /// Noun for an element of the list.
    what: &'static str,
    /// Valid stages.
    known: &'static [&'static str],
    /// Function that reports problems of the order.
    check_order: fn(&mut Reader<'_>, &[Named<'_>], &str),
    example: &'static str,
    /// White space before each stage, and at the end.
    breaks: [&'static str; 2],
}

impl StageList {
    /// All stages of a pipeline.
    pub(crate) const ALL: Self = Self {
        what: "stage",
        known: Action::NAMES,
        check_order,
        example: "[Load(path: \"scene.gltf\"), …]",
        breaks: ["\n        ", "\n    "],
    };

    /// Stages of a `Repeat`.
    const REPEATED: Self = Self {
        what: "repeated stage",
        known: &["Solve", "FirstShot", "ShadowRays", "SecondShot", "Multipath"],
        check_order: check_repeated,
        example: "[FirstShot(lines: 1_000_000), …]",
        breaks: ["", ""],
    };
}

impl Format for StageList {
    type Value = Vec<Stage>;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<Vec<Stage>> {
        let Value::List(nodes) = &node.value else {
            let message = format!("`{name}` must be a list, but it is {}", node.kind());
            reader.problem(node.text, message, format!("write `{name}: {}`", self.example));
            return None;
        };
        let mut stages = Vec::new();
        // The order is checked only if all names are valid or resemble a valid one: the output of an unknown stage is
        // not known.
        let (mut order, mut all_known) = (Vec::new(), true);
        for node in nodes {
            let place = node.name();
            if Action::NAMES.contains(&place) && !self.known.contains(&place) {
                let message = format!("`{place}` inside of `Repeat`");
                reader.problem(place, message, format!("move `{place}` out of `Repeat`"));
                stages.push(None);
                all_known &= place != "Repeat";
                continue;
            }
            match reader.name_of(node, self.what, self.known) {
                Some(name) => {
                    order.push((name, place));
                    let span = Span(reader.span(place));
                    stages.push(Action::read_named(name, reader, node).map(|action| Stage { action, span }));
                }
                None => {
                    stages.push(None);
                    match resembling(place, self.known) {
                        Some(meant) => order.push((*meant, place)),
                        None => all_known = false,
                    }
                }
            }
        }
        if all_known {
            (self.check_order)(reader, &order, node.text);
        }
        if order.iter().any(|(name, _)| *name == "Focus") {
            refuse_replicas(reader, stages.iter().flatten());
        }
        stages.into_iter().collect()
    }

    fn write(&self, value: &Vec<Stage>) -> String {
        let [before, end] = self.breaks;
        let stages: Vec<String> =
            value.iter().map(|stage| format!("{before}{}", stage.action.write())).collect();
        format!("[{}{end}]", stages.join(if before.is_empty() { ", " } else { "," }))
    }

    fn describe(&self) -> String {
        "list of stages".into()
    }

    fn example(&self) -> String {
        self.example.into()
    }
}
