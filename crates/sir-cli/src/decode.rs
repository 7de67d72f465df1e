//! From the tree of a pipeline file to a [`Pipeline`]: which stages there are, their fields and defaults.

use std::path::{Component, Path, PathBuf};

use glam::DVec3;
use sir_geom::{Camera, SidesPolicy};
use sir_mesh::Subdivision;
use sir_view::Exposure;

use crate::diagnostic::Diagnostics;
use crate::fields::{ABSURD, Reader, did_you_mean, list};
use crate::order::check_order;
use crate::pipeline::{Action, CameraChoice, Content, Image, Output, Pipeline, Stage};
use crate::ron_tree::{self, Node, Value};

pub(crate) const STAGES: [&str; 5] = ["Load", "Subdivide", "FirstShot", "Multipath", "Save"];
const OUTPUTS: [&str; 3] = ["Image", "Gltf", "Table"];
const MAX_PIXELS: u64 = 16_384;
const MAX_SAMPLES: u64 = 64;

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
        Some((seed, stages)) if decoder.reader.problems.is_empty() => {
            Ok(Pipeline { path: path.to_owned(), text: text.to_owned(), seed, stages })
        }
        _ => Err(Diagnostics::new(path, text, decoder.reader.problems)),
    }
}

struct Decoder<'a> {
    reader: Reader<'a>,
    /// The folder to which input paths are relative.
    folder: &'a Path,
    /// The output paths so far, in lower case for file systems that do not tell cases apart.
    outputs: Vec<(PathBuf, &'a str)>,
}

impl<'a> Decoder<'a> {
    fn pipeline(&mut self, root: Node<'a>) -> Option<(u64, Vec<Stage>)> {
        if !matches!(root.name(), "" | "Pipeline")
            || !matches!(root.value, Value::Fields(_) | Value::Items(_))
        {
            let message = format!("the file must hold `Pipeline(…)`, but it holds {}", root.kind());
            self.reader.problem(root.text, message, "write `Pipeline(stages: […])`");
            return None;
        }
        let mut fields = self.reader.fields(root, "Pipeline", &["seed", "stages"]);
        let seed = match fields.take("seed") {
            Some(node) => self.reader.count(&node, "seed", (0, u64::MAX), "1"),
            None => Some(1),
        };
        let node = self.reader.required(&mut fields, "stages", "[Load(path: \"scene.gltf\"), …]")?;
        let Value::List(nodes) = node.value else {
            let message = format!("`stages` must be a list, but it is {}", node.kind());
            self.reader.problem(node.text, message, "write `stages: [Load(…), …]`");
            return None;
        };
        let mut stages = Vec::new();
        let mut order = Vec::new();
        for stage in nodes {
            let Some(name) = self.name_of(&stage, "stage", &STAGES) else { continue };
            let place = stage.name();
            order.push((name, place));
            let span = self.reader.span(place);
            if let Some(action) = self.action(name, stage) {
                stages.push(Stage { action, span });
            }
        }
        check_order(&mut self.reader, &order, node.text);
        Some((seed?, stages))
    }

    /// Which of the `known` things a node `Name(…)` is.
    fn name_of(&mut self, node: &Node<'a>, what: &str, known: &[&'static str]) -> Option<&'static str> {
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
            "Subdivide" => self.subdivide(node).map(Action::Subdivide),
            "FirstShot" => {
                let mut fields = self.reader.fields(node, "FirstShot", &["lines"]);
                let lines = self.reader.required(&mut fields, "lines", "1_000_000")?;
                Some(Action::FirstShot {
                    lines: self.reader.count(&lines, "lines", (1, ABSURD), "1_000_000")?,
                })
            }
            "Multipath" => self.multipath(node),
            _ => self.save(node),
        }
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
        let mut fields = self.reader.fields(node, "Multipath", &["lines", "tail", "domain", "replicas"]);
        let lines = self.reader.required(&mut fields, "lines", "1_000_000");
        if let Some(domain) = fields.take("domain") {
            if matches!(domain.name(), "Box" | "Hull") {
                let message = format!("the domain `{}` is not available yet", domain.name());
                self.reader.problem(domain.text, message, "write `domain: Sphere`");
            } else {
                self.reader.choice(&domain, "domain", &["Sphere"]);
            }
        }
        if let Some(replicas) = fields.take("replicas")
            && self.reader.count(&replicas, "replicas", (1, ABSURD), "1").is_some_and(|n| n > 1)
        {
            self.reader.problem(
                replicas.text,
                "more than one replica is not available yet",
                "write `replicas: 1`",
            );
        }
        let tail = fields.take("tail");
        let lines = self.reader.count(&lines?, "lines", (1, ABSURD), "1_000_000")?;
        let tail = match tail {
            Some(node) => {
                let example = (lines / 10).to_string();
                self.reader.count(&node, "tail", (0, lines - 1), &example)?
            }
            None => lines / 10,
        };
        Some(Action::Multipath { lines, tail })
    }

    fn save(&mut self, node: Node<'a>) -> Option<Action> {
        let example = "write `Save([Image(path: \"view.png\")])`";
        let items = match node.value {
            Value::Items(mut items) if items.len() == 1 => match items.remove(0) {
                Node { value: Value::List(outputs), .. } => Some(outputs),
                single => Some(vec![single]),
            },
            _ => None,
        };
        match items {
            Some(items) if !items.is_empty() => {
                let outputs: Vec<_> = items.into_iter().map(|item| self.output(item)).collect();
                outputs.into_iter().collect::<Option<_>>().map(Action::Save)
            }
            _ => {
                self.reader.problem(node.text, "`Save` must have a list of outputs", example);
                None
            }
        }
    }

    fn output(&mut self, node: Node<'a>) -> Option<Output> {
        match self.name_of(&node, "output", &OUTPUTS)? {
            "Image" => self.image(node),
            "Gltf" => {
                let mut fields = self.reader.fields(node, "Gltf", &["path"]);
                let path = self.reader.required(&mut fields, "path", "\"result.glb\"")?;
                let path = self.output_path(&path, &["glb"])?;
                Some(Output { path, content: Content::Gltf })
            }
            _ => {
                let mut fields = self.reader.fields(node, "Table", &["path"]);
                let path = self.reader.required(&mut fields, "path", "\"patches.csv\"")?;
                let path = self.output_path(&path, &["csv", "npy"])?;
                Some(Output { path, content: Content::Table })
            }
        }
    }

    /// A path inside the run directory that ends in one of `extensions` and is not used twice.
    fn output_path(&mut self, node: &Node<'a>, extensions: &[&str]) -> Option<PathBuf> {
        let example = format!("\"result.{}\"", extensions[0]);
        let text = self.reader.text(node, "path", &example)?;
        let given = Path::new(&text);
        if !given.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir))
            || text.contains('\\')
        {
            let message = format!("the output path \"{text}\" may lead out of the run directory");
            self.reader.problem(
                node.text,
                message,
                "write a relative path without `..`; `sir run --out` says where the run directory is",
            );
            return None;
        }
        let path: PathBuf = given.components().filter(|c| matches!(c, Component::Normal(_))).collect();
        if !extensions.contains(&extension(&path).as_str()) {
            let known: Vec<String> = extensions.iter().map(|e| format!(".{e}")).collect();
            let message = format!("the name of the output \"{text}\" does not end in {}", known.join(" or "));
            self.reader.problem(node.text, message, format!("write for instance `path: {example}`"));
            return None;
        }
        let key = PathBuf::from(path.to_string_lossy().to_lowercase());
        let clash =
            self.outputs.iter().find(|(p, _)| p.starts_with(&key) || key.starts_with(p)).map(|(_, t)| *t);
        if let Some(other) = clash {
            let line = self.reader.line(other);
            let message = format!("the output path \"{text}\" is used twice");
            self.reader.problem(
                node.text,
                message,
                format!("choose another name; {other} is in line {line}"),
            );
            return None;
        }
        self.outputs.push((key, node.text));
        Some(path)
    }

    fn image(&mut self, node: Node<'a>) -> Option<Output> {
        let mut fields =
            self.reader.fields(node, "Image", &["path", "width", "height", "samples", "exposure", "camera"]);
        let path = self.reader.required(&mut fields, "path", "\"view.png\"");
        let mut whole = |reader: &mut Reader<'a>, name, most, default: Option<u32>| match fields.take(name) {
            Some(node) => {
                let example = default.unwrap_or(600).to_string();
                reader.count(&node, name, (1, most), &example).map(|n| Some(n as u32))
            }
            None => Some(default),
        };
        let width = whole(&mut self.reader, "width", MAX_PIXELS, Some(800));
        let height = whole(&mut self.reader, "height", MAX_PIXELS, None);
        let samples = whole(&mut self.reader, "samples", MAX_SAMPLES, Some(4));
        let exposure = match fields.take("exposure") {
            None => Some(Exposure::Auto),
            Some(node) if node.name() == "Auto" => Some(Exposure::Auto),
            Some(node) if node.value == Value::Number => {
                self.reader.positive(&node, "exposure", "1.0").map(Exposure::Factor)
            }
            Some(node) => {
                let message = format!("`exposure` must be `Auto` or a number, but it is {}", node.kind());
                self.reader.problem(
                    node.text,
                    message,
                    "write `exposure: Auto` or for instance `exposure: 1.0`",
                );
                None
            }
        };
        let camera = match fields.take("camera") {
            Some(node) => self.camera(node),
            None => Some(CameraChoice::Default),
        };
        let path = path.and_then(|p| self.output_path(&p, &["png", "exr"]));
        let image = Image {
            width: width??,
            height: height?,
            samples: samples??,
            exposure: exposure?,
            camera: camera?,
        };
        Some(Output { path: path?, content: Content::Image(image) })
    }

    fn camera(&mut self, node: Node<'a>) -> Option<CameraChoice> {
        let span = self.reader.span(node.text);
        match (&node.value, node.name()) {
            (Value::Number, _) => {
                let number = self.reader.count(&node, "camera", (0, 1_000_000), "0")?;
                Some(CameraChoice::Number { number: number as usize, span })
            }
            (Value::Text(name), _) => Some(CameraChoice::Name { name: name.clone(), span }),
            (Value::Fields(_) | Value::Items(_), "Camera") => self.own_camera(node).map(CameraChoice::Own),
            _ => {
                let message = format!(
                    "`camera` must be a `Camera(…)`, or the number or name of one, but it is {}",
                    node.kind()
                );
                self.reader.problem(
                    node.text,
                    message,
                    "write for instance `camera: 0` or `camera: Camera(eye: (1, 2, 5), target: (1, 1, 0))`",
                );
                None
            }
        }
    }

    fn own_camera(&mut self, node: Node<'a>) -> Option<Camera> {
        let text = node.text;
        let mut fields = self.reader.fields(node, "Camera", &["eye", "target", "up", "fov"]);
        let eye = self.reader.required(&mut fields, "eye", "(1, 2, 5)");
        let target = self.reader.required(&mut fields, "target", "(1, 1, 0)");
        let eye = eye.and_then(|n| self.reader.vector(&n, "eye", "(1, 2, 5)"));
        let target = target.and_then(|n| self.reader.vector(&n, "target", "(1, 1, 0)"));
        let up = match fields.take("up") {
            Some(node) => self.reader.vector(&node, "up", "(0, 1, 0)"),
            None => Some([0.0, 1.0, 0.0]),
        };
        let fov = match fields.take("fov") {
            Some(node) => self.reader.positive(&node, "fov", "45").and_then(|fov| {
                if fov < 180.0 {
                    return Some(fov);
                }
                let message = format!("`fov` must be below 180 degrees, but it is {}", node.text);
                self.reader.problem(node.text, message, "write for instance `fov: 45`");
                None
            }),
            None => Some(45.0),
        };
        let (eye, target, up) = (DVec3::from(eye?), DVec3::from(target?), DVec3::from(up?));
        let camera = Camera::looking_at(eye, target, up, fov?.to_radians());
        if camera.is_none() {
            self.reader.problem(
                text,
                "this camera has no direction: `eye` and `target` coincide, or `up` points along the view",
                "move `target` away from `eye`, and choose an `up` that is not parallel to the view",
            );
        }
        camera
    }
}

/// The extension of a path in lower case, or an empty text.
fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}
