//! From the tree of a pipeline file to a [`Pipeline`]: which stages there are, their fields and defaults.

use std::path::{Path, PathBuf};

use sir_geom::SidesPolicy;
use sir_mesh::Subdivision;

use crate::format::list;
use crate::plan::pipeline::{Action, Pipeline, Stage};
use crate::plan::transport::{DomainKind, Transport};
use crate::text::diagnostic::Diagnostics;
use crate::text::order::{Named, check_order};
use crate::text::reader::{ABSURD, Reader};
use crate::text::ron_tree;
use crate::text::ron_tree::{Node, Value};
use crate::text::suggest::{did_you_mean, resembling};
use crate::units::Units;

const STAGES: [&str; 10] = [
    "Load",
    "Light",
    "Subdivide",
    "Focus",
    "FirstShot",
    "SecondShot",
    "Multipath",
    "Repeat",
    "Sensors",
    "Save",
];

/// Most replicas: a table of them must fit into memory.
const MOST_REPLICAS: u64 = 1_000_000;

/// Reads the text of a pipeline file, or tells all that is wrong with it.
pub(crate) fn decode(text: &str, path: &Path) -> Result<Pipeline, Diagnostics> {
    // A comment in the last line must end before the file does, or `ron` refuses it.
    let source = format!("{text}\n");
    let folder = path.parent().unwrap_or(Path::new(""));
    let reader = Reader { source: &source, problems: Vec::new() };
    let mut decoder = Decoder { reader, folder, outputs: Vec::new() };
    let decoded = match ron_tree::parse(&source) {
        Ok(root) => decoder.pipeline(root),
        Err(problem) => {
            decoder.reader.problems.push(problem);
            None
        }
    };
    match decoded {
        Some((seed, units, stages)) if decoder.reader.problems.is_empty() => {
            Ok(Pipeline { path: path.to_owned(), text: text.to_owned(), seed, units, stages })
        }
        _ => Err(Diagnostics::new(path, text, decoder.reader.problems)),
    }
}

pub(crate) struct Decoder<'a> {
    pub(crate) reader: Reader<'a>,
    /// The folder to which input paths are relative.
    pub(crate) folder: &'a Path,
    /// The output paths so far, in lower case for file systems that do not tell cases apart.
    pub(crate) outputs: Vec<(PathBuf, &'a str)>,
}

impl<'a> Decoder<'a> {
    fn pipeline(&mut self, root: Node<'a>) -> Option<(u64, Units, Vec<Stage>)> {
        if !matches!(root.name(), "" | "Pipeline")
            || !matches!(root.value, Value::Fields(_) | Value::Items(_))
        {
            let message = format!("the file must hold `Pipeline(…)`, but it holds {}", root.kind());
            self.reader.problem(root.text, message, "write `Pipeline(stages: […])`");
            return None;
        }
        let mut fields = self.reader.fields(root, "Pipeline", &["seed", "units", "stages"]);
        let seed = match fields.take("seed") {
            Some(node) => self.reader.count(&node, "seed", (0, u64::MAX), "1"),
            None => Some(1),
        };
        let units = match fields.take("units") {
            Some(node) => match self.reader.choice(&node, "units", &["Radiometric", "Photometric"]) {
                Some("Photometric") => Units::Photometric,
                _ => Units::Radiometric,
            },
            None => Units::default(),
        };
        let node = self.reader.required(&mut fields, "stages", "[Load(path: \"scene.gltf\"), …]")?;
        let Value::List(nodes) = node.value else {
            let message = format!("`stages` must be a list, but it is {}", node.kind());
            self.reader.problem(node.text, message, "write `stages: [Load(…), …]`");
            return None;
        };
        let (stages, order) = self.stages(nodes, "stage", &STAGES);
        if let Some(order) = order {
            check_order(&mut self.reader, &order, node.text);
        }
        self.check_focus(&stages);
        Some((seed?, units, stages))
    }

    /// The stages of a list that may have those in `known`, and their names and places; these only if all are known, or
    /// nearly: what an unknown stage would have made is not known.
    pub(crate) fn stages(
        &mut self,
        nodes: Vec<Node<'a>>,
        what: &str,
        known: &[&'static str],
    ) -> (Vec<Stage>, Option<Vec<Named<'a>>>) {
        let mut stages = Vec::new();
        let mut order = Vec::new();
        let mut all_known = true;
        for stage in nodes {
            let place = stage.name();
            let Some(name) = self.name_of(&stage, what, known) else {
                match resembling(place, known) {
                    Some(meant) => order.push((*meant, place)),
                    None => all_known = false,
                }
                continue;
            };
            order.push((name, place));
            let span = self.reader.span(place);
            if let Some(action) = self.action(name, stage) {
                stages.push(Stage { action, span });
            }
        }
        (stages, all_known.then_some(order))
    }

    /// Which of the `known` things a node `Name(…)` is.
    pub(crate) fn name_of(
        &mut self,
        node: &Node<'a>,
        what: &str,
        known: &[&'static str],
    ) -> Option<&'static str> {
        let name = node.name();
        let found = known.iter().copied().find(|k| *k == name);
        if found.is_none() {
            let help =
                did_you_mean(name, known).unwrap_or_else(|| format!("{what}s are {}", list(known, "and")));
            if name.is_empty() {
                self.reader.problem(
                    node.text,
                    format!("expected one of the {what}s, but this is {}", node.kind()),
                    help,
                );
            } else {
                self.reader.problem(name, format!("unknown {what} `{name}`"), help);
            }
        }
        found
    }

    fn action(&mut self, name: &'static str, node: Node<'a>) -> Option<Action> {
        match name {
            "Load" => self.load(node),
            "Light" => self.light(node),
            "Subdivide" => self.subdivide(node).map(Action::Subdivide),
            "Focus" => self.focus(node),
            "FirstShot" => self.local_lines(node, name).map(|lines| Action::FirstShot { lines }),
            "SecondShot" => self.local_lines(node, name).map(|lines| Action::SecondShot { lines }),
            "Multipath" => self.multipath(node),
            "Repeat" => self.repeat(node).map(Action::Repeat),
            "Sensors" => self.sensors(node),
            _ => self.save(node),
        }
    }

    fn local_lines(&mut self, node: Node<'a>, name: &'static str) -> Option<u64> {
        let mut fields = self.reader.fields(node, name, &["lines"]);
        let lines = self.reader.required(&mut fields, "lines", "1_000_000")?;
        self.reader.count(&lines, "lines", (1, ABSURD), "1_000_000")
    }

    fn load(&mut self, node: Node<'a>) -> Option<Action> {
        let mut fields = self.reader.fields(node, "Load", &["path", "sides"]);
        let path = self.reader.required(&mut fields, "path", "\"scene.gltf\"");
        let sides = match fields.take("sides") {
            Some(node) => match self.reader.choice(&node, "sides", &["AsAuthored", "Both", "Front"]) {
                Some("Both") => SidesPolicy::Both,
                Some("Front") => SidesPolicy::Front,
                _ => SidesPolicy::AsAuthored,
            },
            None => SidesPolicy::default(),
        };
        let path = self.input(&path?)?;
        Some(Action::Load { path, sides })
    }

    /// An input file, which must exist.
    fn input(&mut self, node: &Node<'a>) -> Option<PathBuf> {
        let text = self.reader.text(node, "path", "\"scene.gltf\"")?;
        let path = self.folder.join(&text);
        let extension = extension(&path);
        if !["gltf", "glb", "obj"].contains(&extension.as_str()) {
            self.reader.problem(
                node.text,
                format!("\"{text}\" is not a scene file by its name"),
                "scenes are read from .gltf, .glb and .obj files",
            );
            return None;
        }
        if path.is_file() {
            return Some(path);
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut neighbours: Vec<String> = std::fs::read_dir(folder)
            .map(|entries| entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect())
            .unwrap_or_default();
        neighbours.sort();
        let what = if path.exists() { "is not a file" } else { "does not exist" };
        let help = did_you_mean(&name, &neighbours)
            .unwrap_or_else(|| "paths are relative to the folder of the pipeline file".into());
        self.reader.problem(node.text, format!("the scene file {} {what}", path.display()), help);
        None
    }

    fn subdivide(&mut self, node: Node<'a>) -> Option<Subdivision> {
        const WAYS: [&str; 4] = ["patches", "max_area", "max_edge", "per_face"];
        let place = node.name();
        let mut fields = self.reader.fields(node, "Subdivide", &WAYS);
        let mut given = WAYS.iter().filter_map(|&way| Some((way, fields.take(way)?)));
        let Some((way, value)) = given.next() else {
            self.reader.problem(
                place,
                "`Subdivide` does not say how finely",
                "write one of `patches: 20_000`, `max_area: 0.01`, `max_edge: 0.1` or `per_face: true`",
            );
            return None;
        };
        if let Some((other, _)) = given.next() {
            self.reader.problem(
                place,
                format!("`Subdivide` has both `{way}` and `{other}`"),
                "keep one of them",
            );
        }
        match way {
            "patches" => {
                self.reader.count(&value, way, (1, u64::from(u32::MAX)), "20_000").map(Subdivision::Patches)
            }
            "max_area" => self.reader.positive(&value, way, "0.01").map(Subdivision::MaxArea),
            "max_edge" => self.reader.positive(&value, way, "0.1").map(Subdivision::MaxEdge),
            _ => {
                if value.value == Value::Bool(true) {
                    return Some(Subdivision::PerFace);
                }
                let message = format!("`per_face` can only be `true`, but it is {}", value.kind());
                self.reader.problem(value.text, message, "write `per_face: true`, or leave `Subdivide` out");
                None
            }
        }
    }

    fn multipath(&mut self, node: Node<'a>) -> Option<Action> {
        const FIELDS: [&str; 5] = ["lines", "transport", "replicas", "tail", "domain"];
        let mut fields = self.reader.fields(node, "Multipath", &FIELDS);
        let lines = self.reader.required(&mut fields, "lines", "1_000_000");
        let domain = match fields.take("domain") {
            Some(node) => match self.reader.choice(&node, "domain", &["Hull", "Box", "Sphere"]) {
                Some("Box") => DomainKind::Box,
                Some("Sphere") => DomainKind::Sphere,
                _ => DomainKind::Hull,
            },
            None => DomainKind::default(),
        };
        let (replicas, tail) = (fields.take("replicas"), fields.take("tail"));
        let in_replicas = match fields.take("transport") {
            Some(node) => self.reader.choice(&node, "transport", &["Batches", "Replicas"])? == "Replicas",
            None => replicas.is_some() || tail.is_some(),
        };
        for (name, node) in [("replicas", &replicas), ("tail", &tail)] {
            if let Some(node) = node.as_ref().filter(|_| !in_replicas) {
                let message = format!("the transport `Batches` has no `{name}`");
                let help = format!("leave `{name}` out, or write `transport: Replicas`");
                self.reader.problem(node.text, message, help);
            }
        }
        let lines = lines.and_then(|lines| self.reader.count(&lines, "lines", (1, ABSURD), "1_000_000"));
        let most = lines.unwrap_or(ABSURD);
        let replicas = match replicas {
            Some(node) => self.reader.count(&node, "replicas", (1, most.min(MOST_REPLICAS)), "8"),
            None => Some(1),
        };
        let tail = match tail {
            Some(node) => self.reader.count(&node, "tail", (0, most - 1), &(most / 10).to_string()),
            None => Some(most / 10),
        };
        let (lines, replicas, tail) = (lines?, replicas?, tail?);
        let transport = if in_replicas { Transport::Replicas { replicas, tail } } else { Transport::Batches };
        Some(Action::Multipath { lines, transport, domain })
    }
}

/// The extension of a path in lower case, or an empty text.
pub(crate) fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}
