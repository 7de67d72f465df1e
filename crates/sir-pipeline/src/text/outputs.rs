//! The outputs of a `Save` stage.

use std::path::{Component, Path, PathBuf};

use glam::DVec3;
use sir_geom::Camera;
use sir_view::Exposure;

use crate::plan::output::{CameraChoice, Content, Image, Output};
use crate::plan::pipeline::Action;
use crate::text::decode::{Decoder, extension};
use crate::text::reader::Reader;
use crate::text::ron_tree::{Node, Value};

const OUTPUTS: [&str; 3] = ["Image", "Gltf", "Table"];
const MAX_PIXELS: u64 = 16_384;
const MAX_SAMPLES: u64 = 64;

impl<'a> Decoder<'a> {
    pub(crate) fn save(&mut self, node: Node<'a>) -> Option<Action> {
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
        if !extensions.contains(&extension(Path::new(&text)).as_str()) {
            let known: Vec<String> = extensions.iter().map(|e| format!(".{e}")).collect();
            let message = format!("the name of the output \"{text}\" does not end in {}", known.join(" or "));
            self.reader.problem(node.text, message, format!("write for instance `path: {example}`"));
            return None;
        }
        self.claim(node, &text)
    }

    /// Takes a path inside the run directory, which `node` asks for and nothing else may.
    pub(crate) fn claim(&mut self, node: &Node<'a>, text: &str) -> Option<PathBuf> {
        let given = Path::new(text);
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
        const FIELDS: [&str; 7] = ["path", "width", "height", "samples", "exposure", "denoise", "camera"];
        let mut fields = self.reader.fields(node, "Image", &FIELDS);
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
        let denoise = match fields.take("denoise") {
            None => Some(true),
            Some(Node { value: Value::Bool(denoise), .. }) => Some(denoise),
            Some(node) => {
                let message = format!("`denoise` must be `true` or `false`, but it is {}", node.kind());
                self.reader.problem(node.text, message, "write `denoise: false` to see the noise");
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
            denoise: denoise?,
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
