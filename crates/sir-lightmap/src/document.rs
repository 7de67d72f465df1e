//! A glTF document that can be changed: its JSON, and the bytes of its buffer views.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use sir_geom::{GltfFile, RawElements};

use crate::compact::compact;
use crate::error::LightmapError;
use crate::json::{array, list, object};

/// Component type of 32-bit floats in glTF.
pub(crate) const FLOAT: u32 = 5126;
/// Component type of 32-bit unsigned integers in glTF.
pub(crate) const UNSIGNED_INT: u32 = 5125;

const ARRAY_BUFFER: u32 = 34_962;
const ELEMENT_ARRAY_BUFFER: u32 = 34_963;

/// A glTF document, from a file or new.
pub(crate) struct Document {
    pub(crate) json: Value,
    /// Bytes of the buffer views.
    views: Vec<Vec<u8>>,
    /// The file, if there is one, and the number of its accessors.
    file: Option<(GltfFile, usize)>,
    path: PathBuf,
    /// Images that could not be embedded, with the reasons.
    pub(crate) missing_images: Vec<String>,
}

impl Document {
    /// Creates a document without contents.
    pub(crate) fn new(path: &Path) -> Self {
        let json = json!({
            "asset": { "version": "2.0", "generator": concat!("SIR ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": [] }],
        });
        Self { json, views: Vec::new(), file: None, path: path.to_owned(), missing_images: Vec::new() }
    }

    /// Reads the document of a glTF file.
    pub(crate) fn open(path: &Path) -> Result<Self, LightmapError> {
        let file = GltfFile::open(path)?;
        let json = file.json().clone();
        let buffers: Vec<&[u8]> = file.buffers().collect();
        let number = |value: &Value, name: &str| value[name].as_f64().unwrap_or(0.0) as usize;
        let views = list(&json, "bufferViews").iter().map(|view| {
            let buffer = buffers.get(number(view, "buffer")).copied().unwrap_or_default();
            let start = number(view, "byteOffset");
            let end = start.saturating_add(number(view, "byteLength"));
            buffer.get(start..end).unwrap_or_default().to_vec()
        });
        let views: Vec<Vec<u8>> = views.collect();
        let accessors = list(&json, "accessors").len();
        let mut document = Self {
            json,
            views,
            file: Some((file, accessors)),
            path: path.to_owned(),
            missing_images: Vec::new(),
        };
        document.embed_images();
        Ok(document)
    }

    /// Returns the file from which the document was read, if there is one.
    pub(crate) fn file(&self) -> Option<&GltfFile> {
        self.file.as_ref().map(|(file, _)| file)
    }

    /// Returns an error about the document.
    pub(crate) fn error(&self, what: impl Into<String>) -> LightmapError {
        LightmapError::Document { path: self.path.clone(), what: what.into() }
    }

    /// Adds an element to a list of the document, and returns its index.
    pub(crate) fn add(&mut self, list: &str, element: Value) -> usize {
        let list = self.list_mut(list);
        list.push(element);
        list.len() - 1
    }

    /// Returns a list of the document, which is added if it is absent.
    pub(crate) fn list_mut(&mut self, name: &str) -> &mut Vec<Value> {
        array(object(&mut self.json).entry(name).or_insert_with(|| json!([])))
    }

    /// Adds a node to the default scene, and returns its index.
    pub(crate) fn add_root(&mut self, node: Value) -> usize {
        let index = self.add("nodes", node);
        let scene = self.json["scene"].as_u64().unwrap_or(0) as usize;
        let scenes = self.list_mut("scenes");
        if scenes.is_empty() {
            scenes.push(json!({}));
        }
        let scene = scene.min(scenes.len() - 1);
        array(object(&mut scenes[scene]).entry("nodes").or_insert_with(|| json!([]))).push(json!(index));
        index
    }

    /// Adds a member to the extras of the default scene, unless these are no object.
    pub(crate) fn add_scene_extras(&mut self, name: &str, value: Value) {
        let scene = self.json["scene"].as_u64().unwrap_or(0) as usize;
        if let Some(scene) = self.list_mut("scenes").get_mut(scene) {
            let extras = object(scene).entry("extras").or_insert_with(|| json!({}));
            if let Some(extras) = extras.as_object_mut() {
                extras.insert(name.to_owned(), value);
            }
        }
    }

    /// Adds an extension to those that the document uses.
    pub(crate) fn use_extension(&mut self, name: &str) {
        let used = self.list_mut("extensionsUsed");
        if !used.iter().any(|other| other == name) {
            used.push(json!(name));
        }
    }

    /// Removes an extension from those that the document uses and requires.
    pub(crate) fn forget_extension(&mut self, name: &str) {
        for list in ["extensionsUsed", "extensionsRequired"] {
            let is_empty = match self.json.get_mut(list).and_then(Value::as_array_mut) {
                Some(names) => {
                    names.retain(|other| other != name);
                    names.is_empty()
                }
                None => false,
            };
            if is_empty {
                object(&mut self.json).remove(list);
            }
        }
    }

    /// Adds an image in PNG, and returns its index.
    pub(crate) fn add_png(&mut self, name: &str, bytes: Vec<u8>) -> usize {
        let view = self.add_view(bytes, None);
        self.add("images", json!({ "name": name, "bufferView": view, "mimeType": "image/png" }))
    }

    /// Adds an accessor of vectors of `N` floats, and returns its index.
    pub(crate) fn add_vectors<const N: usize>(&mut self, vectors: &[[f32; N]], with_bounds: bool) -> usize {
        let bytes = vectors.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.add_view(bytes, Some(ARRAY_BUFFER));
        let type_ = format!("VEC{N}");
        let mut accessor =
            json!({ "bufferView": view, "componentType": FLOAT, "count": vectors.len(), "type": type_ });
        if with_bounds {
            let fold = |start: f32, choose: fn(f32, f32) -> f32| {
                vectors.iter().fold([start; N], |all, v| std::array::from_fn(|k| choose(all[k], v[k])))
            };
            accessor["min"] = json!(fold(f32::INFINITY, f32::min).as_slice());
            accessor["max"] = json!(fold(f32::NEG_INFINITY, f32::max).as_slice());
        }
        self.add("accessors", accessor)
    }

    /// Adds an accessor of indices, and returns its index.
    pub(crate) fn add_indices(&mut self, indices: impl Iterator<Item = u32>) -> usize {
        let bytes: Vec<u8> = indices.flat_map(u32::to_le_bytes).collect();
        let count = bytes.len() / 4;
        let view = self.add_view(bytes, Some(ELEMENT_ARRAY_BUFFER));
        let accessor =
            json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR" });
        self.add("accessors", accessor)
    }

    /// Adds an accessor with chosen elements of another one, one for each number in `chosen`, and returns its index.
    pub(crate) fn add_selection(&mut self, accessor: usize, chosen: &[u32]) -> Result<usize, LightmapError> {
        let RawElements { bytes, size } = self.elements(accessor)?;
        // Elements of vertices are aligned to four bytes.
        let stride = size.next_multiple_of(4);
        let mut selected = Vec::with_capacity(stride * chosen.len());
        for &i in chosen {
            let start = i as usize * size;
            let element = bytes.get(start..start + size);
            let element =
                element.ok_or_else(|| self.error(format!("accessor {accessor} has no element {i}")))?;
            selected.extend_from_slice(element);
            selected.resize(selected.len().next_multiple_of(4), 0);
        }
        let view = self.add_view(selected, Some(ARRAY_BUFFER));
        if stride != size {
            self.list_mut("bufferViews")[view]["byteStride"] = json!(stride);
        }
        let mut copy = self.json["accessors"][accessor].clone();
        for absent in ["byteOffset", "sparse"] {
            object(&mut copy).remove(absent);
        }
        copy["bufferView"] = json!(view);
        copy["count"] = json!(chosen.len());
        if let Some(width) = copy["min"].as_array().map(Vec::len) {
            let component = copy["componentType"].as_u64().unwrap_or(0);
            let [low, high] = bounds(&self.views[view], stride, component, width);
            (copy["min"], copy["max"]) = (json!(low), json!(high));
        }
        Ok(self.add("accessors", copy))
    }

    /// Returns the elements of an accessor.
    pub(crate) fn elements(&self, accessor: usize) -> Result<RawElements, LightmapError> {
        match &self.file {
            Some((file, count)) if accessor < *count => Ok(file.raw_elements(accessor)?),
            // All others were added above, each with a view of its own.
            _ => {
                let of = &self.json["accessors"][accessor];
                let view = of["bufferView"].as_u64().and_then(|view| self.views.get(view as usize));
                let count = of["count"].as_u64().unwrap_or(0) as usize;
                let bytes = view.ok_or_else(|| self.error(format!("accessor {accessor} does not exist")))?;
                Ok(RawElements { bytes: bytes.clone(), size: bytes.len() / count.max(1) })
            }
        }
    }

    /// Returns the bytes of a buffer view.
    pub(crate) fn view_mut(&mut self, view: usize) -> &mut [u8] {
        &mut self.views[view]
    }

    fn add_view(&mut self, bytes: Vec<u8>, target: Option<u32>) -> usize {
        let mut view = json!({ "buffer": 0, "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(bytes);
        self.add("bufferViews", view)
    }

    /// Moves images that lie in files or in the JSON text to buffer views.
    fn embed_images(&mut self) {
        let count = list(&self.json, "images").len();
        for i in 0..count {
            if self.json["images"][i].get("uri").is_none() {
                continue;
            }
            let Some(read) = self.file().map(|file| file.image(i)) else { return };
            match read {
                Ok(bytes) => {
                    let is_png = bytes.starts_with(b"\x89PNG");
                    let mime = if is_png { "image/png" } else { "image/jpeg" };
                    let known = is_png || bytes.starts_with(&[0xff, 0xd8]);
                    let view = self.add_view(bytes, None);
                    let image = object(&mut self.json["images"][i]);
                    image.remove("uri");
                    image.insert("bufferView".into(), json!(view));
                    if known || !image.contains_key("mimeType") {
                        image.insert("mimeType".into(), json!(mime));
                    }
                }
                Err(why) => self.missing_images.push(format!("image {i} ({why})")),
            }
        }
    }

    /// Returns the JSON of a GLB file, and its binary chunk. Accessors and buffer views that nothing refers to are left out.
    pub(crate) fn into_parts(mut self) -> (Value, Vec<u8>) {
        let kept = compact(&mut self.json);
        let mut binary = Vec::new();
        let views = std::mem::take(&mut self.views).into_iter().enumerate();
        let views = views.filter(|(i, _)| kept.as_ref().is_none_or(|kept| kept[*i])).map(|(_, view)| view);
        for (view, bytes) in self.list_mut("bufferViews").iter_mut().zip(views) {
            let view = object(view);
            view.insert("buffer".into(), json!(0));
            view.insert("byteOffset".into(), json!(binary.len()));
            view.insert("byteLength".into(), json!(bytes.len()));
            binary.extend(bytes);
            binary.resize(binary.len().next_multiple_of(4), 0);
        }
        self.json["buffers"] = json!([{ "byteLength": binary.len() }]);
        let lists =
            ["bufferViews", "accessors", "images", "textures", "samplers", "materials", "meshes", "nodes"];
        for name in lists {
            if list(&self.json, name).is_empty() {
                object(&mut self.json).remove(name);
            }
        }
        if binary.is_empty() {
            object(&mut self.json).remove("buffers");
        }
        (self.json, binary)
    }
}

/// Returns the smallest and largest components of vertices with `N` components each.
fn bounds(bytes: &[u8], stride: usize, component: u64, width: usize) -> [Vec<Value>; 2] {
    let number = |bytes: &[u8]| match (component, bytes) {
        (5120, &[a, ..]) => f64::from(a as i8),
        (5121, &[a, ..]) => f64::from(a),
        (5122, &[a, b, ..]) => f64::from(i16::from_le_bytes([a, b])),
        (5123, &[a, b, ..]) => f64::from(u16::from_le_bytes([a, b])),
        (5125, &[a, b, c, d, ..]) => f64::from(u32::from_le_bytes([a, b, c, d])),
        (_, &[a, b, c, d, ..]) => f64::from(f32::from_le_bytes([a, b, c, d])),
        _ => 0.0,
    };
    let size = match component {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        _ => 4,
    };
    let (mut low, mut high) = (vec![f64::INFINITY; width], vec![f64::NEG_INFINITY; width]);
    for element in bytes.chunks_exact(stride.max(1)) {
        for c in 0..width {
            let x = number(&element[(c * size).min(element.len())..]);
            (low[c], high[c]) = (low[c].min(x), high[c].max(x));
        }
    }
    [low, high].map(|all| all.into_iter().map(|x| json!(x)).collect())
}
