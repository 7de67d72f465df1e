//! The stage `Save`: files that a run writes.

use std::path::{Path, PathBuf};

use sir_mesh::Per;

use crate::plan::image::Image;
use crate::plan::lightmap::Lightmap;
use crate::text::field::Format as _;
use crate::text::formats::Choice;
use crate::text::paths::OutputFile;
use crate::text::reader::Reader;
use crate::text::record::{Body, Choose as _, choice, list_items, record, write_list};
use crate::text::ron_tree::Node;

/// Stage that writes files.
#[derive(Clone, Debug, PartialEq)]
pub struct Save {
    /// Files, at least one.
    pub outputs: Vec<Output>,
}

choice! {
    /// File to write.
    pub enum Output as "output" {
        /// Image, as PNG or EXR.
        Image(Image),
        /// Lit mesh, as binary glTF.
        Gltf(Gltf),
        /// Radiosity, irradiance and errors of patches or of other parts of the scene, as CSV or NPY.
        Table(Table),
        /// Page with a viewer of the lit scene and all figures, as HTML.
        Report(Report),
        /// The scene with lightmaps, as binary glTF, with images and a manifest.
        Lightmap(Lightmap),
    }
}

record! {
    /// Lit mesh.
    pub struct Gltf {
        /// `.glb`: the scene with its light as vertex colors, for viewers and modeling programs; the radiosity in W/m²
        /// is in the attribute `_RADIOSITY`.
        pub path: PathBuf = OutputFile { extensions: &["glb"], example: "result.glb" }.required();
    }
}

record! {
    /// Radiosity, irradiance and errors, of patches or of other parts of the scene.
    pub struct Table {
        /// `.csv`: text; `.npy`: the same data as a structured array for NumPy, smaller and faster.
        pub path: PathBuf = OutputFile { extensions: &["csv", "npy"], example: "patches.csv" }.required();
        /// What has a row: each side of a patch, of a triangle or of a face; or each material or group.
        pub per: Option<Per> = PER.or(None);
    }
}

record! {
    /// Page with a viewer of the lit scene and all figures.
    pub struct Report {
        /// `.html`: a single file that a browser opens without a network.
        pub path: PathBuf = OutputFile { extensions: &["html"], example: "report.html" }.required();
    }
}

const PER: Choice<Option<Per>> = Choice(&[
    ("Patch", None),
    ("Triangle", Some(Per::Triangle)),
    ("Face", Some(Per::Face)),
    ("Material", Some(Per::Material)),
    ("Group", Some(Per::Group)),
]);

impl Output {
    /// Returns the image, if it is one.
    #[must_use]
    pub fn image(&self) -> Option<&Image> {
        if let Self::Image(image) = self { Some(image) } else { None }
    }

    /// Returns the path of the file inside the run directory.
    #[must_use]
    pub fn path(&self) -> &Path {
        match self {
            Self::Image(Image { path, .. })
            | Self::Gltf(Gltf { path })
            | Self::Table(Table { path, .. })
            | Self::Report(Report { path })
            | Self::Lightmap(Lightmap { path, .. }) => path,
        }
    }

    /// Returns the paths of all files that it writes inside the run directory, as far as they are known beforehand.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let mut files = vec![self.path().to_owned()];
        if let Self::Lightmap(lightmap) = self {
            files.extend(lightmap.files_beside());
        }
        files
    }
}

impl Body for Save {
    fn read<'a>(reader: &mut Reader<'a>, node: &Node<'a>) -> Option<Self> {
        let items = list_items(reader, node, "outputs", "Image(path: \"view.png\")")?;
        let outputs: Vec<_> = items.iter().map(|item| Output::read(reader, item)).collect();
        outputs.into_iter().collect::<Option<_>>().map(|outputs| Self { outputs })
    }

    fn write(&self, name: &str) -> String {
        write_list(name, &self.outputs)
    }
}
