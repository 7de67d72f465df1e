//! Syntax of file paths in a pipeline file.

use std::path::{Path, PathBuf};

use crate::text::back_slashes::{path_help, printable};
use crate::text::field::Format;
use crate::text::formats::{Text, quoted};
use crate::text::reader::Reader;
use crate::text::ron_tree::Node;
use crate::text::suggest::did_you_mean;

/// Path of a scene file, which must exist.
#[derive(Clone, Copy)]
pub(crate) struct SceneFile;

impl SceneFile {
    const EXTENSIONS: [&str; 3] = ["gltf", "glb", "obj"];
    const TEXT: Text = Text("scene.gltf");
}

impl Format for SceneFile {
    type Value = PathBuf;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<PathBuf> {
        let text = Self::TEXT.read(reader, node, name)?;
        let path = reader.folder.join(&text);
        if !Self::EXTENSIONS.contains(&extension(&path).as_str()) {
            let message = format!("the extension of \"{text}\" is not that of a scene file");
            reader.problem(node.text, message, path_help(node.text, "use a .gltf, .glb or .obj file"));
            return None;
        }
        if path.is_file() {
            return Some(path);
        }
        let what = if path.exists() { "is not a file" } else { "does not exist" };
        let help = similar_file(&path);
        let help = path_help(
            node.text,
            help.as_deref().unwrap_or("paths are relative to the folder of the pipeline file"),
        );
        reader.problem(node.text, format!("the scene file {} {what}", printable(&path)), help);
        None
    }

    fn write(&self, value: &PathBuf) -> String {
        quoted(&value.to_string_lossy())
    }

    fn describe(&self) -> String {
        "string".into()
    }

    fn example(&self) -> String {
        Self::TEXT.example()
    }
}

/// Returns "did you mean …?" if the folder of a path has a file with a similar name.
pub(crate) fn similar_file(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_string_lossy();
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).ok()?.flatten();
    let mut neighbors: Vec<String> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    neighbors.retain(|neighbor| *neighbor != name);
    neighbors.sort();
    did_you_mean(&name, &neighbors)
}

/// Path of a file in the run directory, with one of these extensions. No other output may have the same path.
#[derive(Clone, Copy)]
pub(crate) struct OutputFile {
    /// Valid extensions, without the dot.
    pub(crate) extensions: &'static [&'static str],
    /// Example of a path.
    pub(crate) example: &'static str,
}

impl Format for OutputFile {
    type Value = PathBuf;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<PathBuf> {
        let text = Text(self.example).read(reader, node, name)?;
        if !self.extensions.contains(&extension(Path::new(&text)).as_str()) {
            let known: Vec<String> = self.extensions.iter().map(|e| format!(".{e}")).collect();
            let message = format!("the name of the output \"{text}\" does not end in {}", known.join(" or "));
            let example = format!("write for instance `{name}: {}`", self.example());
            reader.problem(node.text, message, path_help(node.text, &example));
            return None;
        }
        reader.claim_output(node, &text)
    }

    fn write(&self, value: &PathBuf) -> String {
        quoted(&value.to_string_lossy())
    }

    fn describe(&self) -> String {
        "string".into()
    }

    fn example(&self) -> String {
        quoted(self.example)
    }
}

/// Returns the extension of a path in lower case, or an empty string.
fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}
