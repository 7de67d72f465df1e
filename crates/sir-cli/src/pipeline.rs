//! What a pipeline file says, with every default filled in.

use std::io::Read as _;
use std::ops::Range;
use std::path::{Path, PathBuf};

use sir_geom::{BoundingBox, Camera, Scene, SidesPolicy};
use sir_lines::{Domain, Focus, GlobalLines};
use sir_mesh::Subdivision;
use sir_view::Exposure;

use crate::decode;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::lights::Lamp;
use crate::sensors::Sensors;
use crate::units::Units;

/// A valid pipeline: its stages are in a possible order, its numbers are in range and its inputs exist.
#[derive(Clone, Debug, PartialEq)]
pub struct Pipeline {
    /// The file, as it was named.
    pub path: PathBuf,
    /// What the file says.
    pub text: String,
    /// Seed of all random numbers. Default 1.
    pub seed: u64,
    /// What its numbers are measured in. Default radiometric.
    pub units: Units,
    /// The stages, in the order in which they run.
    pub stages: Vec<Stage>,
}

/// A stage, and where the file asks for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// What to do.
    pub action: Action,
    /// Bytes of the pipeline's text.
    pub span: Range<usize>,
}

/// What a stage does.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Reads a scene.
    Load {
        /// The scene file (glTF, GLB or OBJ): the path in the pipeline, joined to the folder of its file.
        path: PathBuf,
        /// Which sides of surfaces take part.
        sides: SidesPolicy,
    },
    /// Adds lights to the scene.
    Light {
        /// The lights.
        lamps: Vec<Lamp>,
        /// What the file says of them.
        text: String,
    },
    /// Cuts the triangles into patches.
    Subdivide(Subdivision),
    /// Says which part of the scene matters.
    Focus {
        /// The box around it.
        bounds: BoundingBox,
        /// Share of the lines that are drawn through it: from 0 to 0.95. Default three quarters.
        share: f64,
    },
    /// Sends the power of the light sources along local lines.
    FirstShot {
        /// How many lines, at least 1.
        lines: u64,
    },
    /// Lets the brightest patches send what they reflect along local lines, too.
    SecondShot {
        /// How many lines, at least 1.
        lines: u64,
    },
    /// Distributes the reflected light along global lines.
    Multipath {
        /// How many lines, at least 1.
        lines: u64,
        /// How they pass on the light.
        transport: Transport,
        /// What they are drawn through.
        body: Body,
    },
    /// Runs stages of lines again and again, for the mean of independent results.
    Repeat(Repeat),
    /// Measures irradiance at points.
    Sensors(Sensors),
    /// Writes files.
    Save(Vec<Output>),
}

/// Stages that are run again and again.
#[derive(Clone, Debug, PartialEq)]
pub struct Repeat {
    /// How often.
    pub until: Until,
    /// Not more often than this, in any case: at least 1. Default: no limit.
    pub at_most: Option<u64>,
    /// A first shot, and what may follow it but for `Save`.
    pub stages: Vec<Stage>,
}

/// When there have been enough repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// After so many: at least 1.
    Times(u64),
    /// When the relative error of the mean is not above this, in any band: above 0.
    RelativeError(f64),
    /// When another one would end later than after so many seconds: above 0.
    Seconds(f64),
}

/// How global lines pass on the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transport {
    /// In frozen batches. Default, unless there are `replicas` or a `tail`.
    #[default]
    Batches,
    /// One after the other, in independent replicas, as Martínez, Forés and Martín (2009) published it.
    Replicas {
        /// Among how many replicas the lines are shared: from 1 to the number of lines. Default 1.
        replicas: u64,
        /// How many of the lines, at the ends of the replicas, only send on what was reflected: fewer than `lines`.
        /// Default a tenth.
        tail: u64,
    },
}

/// The convex body around the scene from whose surface global lines are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Body {
    /// The bounding sphere.
    Sphere,
    /// The axis-aligned bounding box.
    Box,
    /// The convex hull, which wastes the fewest lines. Default.
    #[default]
    Hull,
}

impl Body {
    /// The body around a scene.
    #[must_use]
    pub fn around(self, scene: &Scene) -> Domain {
        match self {
            Self::Sphere => Domain::Sphere(scene.bounding_sphere()),
            Self::Box => Domain::Box(scene.bounding_box()),
            Self::Hull => Domain::hull(scene.vertices()),
        }
    }

    /// The lines through the body around a scene, and maybe a focus.
    #[must_use]
    pub fn lines_around(self, scene: &Scene, focus: Option<Focus>) -> GlobalLines {
        let domain = self.around(scene);
        match focus {
            Some(focus) => GlobalLines::focused(domain, focus),
            None => domain.into(),
        }
    }
}

impl Action {
    /// The name of the stage in a pipeline file.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Load { .. } => "Load",
            Self::Light { .. } => "Light",
            Self::Subdivide(_) => "Subdivide",
            Self::Focus { .. } => "Focus",
            Self::FirstShot { .. } => "FirstShot",
            Self::SecondShot { .. } => "SecondShot",
            Self::Multipath { .. } => "Multipath",
            Self::Repeat(_) => "Repeat",
            Self::Sensors(_) => "Sensors",
            Self::Save(_) => "Save",
        }
    }

    /// How many lines it has, those of a `Repeat` once.
    #[must_use]
    pub fn lines(&self) -> u64 {
        match self {
            Self::FirstShot { lines } | Self::SecondShot { lines } | Self::Multipath { lines, .. } => *lines,
            Self::Repeat(repeat) => repeat.stages.iter().map(|stage| stage.action.lines()).sum(),
            Self::Load { .. }
            | Self::Light { .. }
            | Self::Subdivide(_)
            | Self::Focus { .. }
            | Self::Sensors(_)
            | Self::Save(_) => 0,
        }
    }
}

/// A file to write.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its path inside the run directory.
    pub path: PathBuf,
    /// What it holds.
    pub content: Content,
}

/// What an output file holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// A picture.
    Image(Image),
    /// The lit mesh, as binary glTF.
    Gltf,
    /// Radiosity, irradiance and error of every patch, as CSV or NPY.
    Table,
}

/// A picture of the solution.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width in pixels. Default 800.
    pub width: u32,
    /// Height in pixels. Default: as the shape of the camera asks for, else three
    /// quarters of the width.
    pub height: Option<u32>,
    /// Samples per pixel along each edge: 4 means 4 × 4 samples. Default 4.
    pub samples: u32,
    /// How bright a PNG picture is made. Default `Auto`.
    pub exposure: Exposure,
    /// Whether noise is taken out of a PNG picture. Default `true`.
    pub calm: bool,
    /// From where it is taken.
    pub camera: CameraChoice,
}

/// The point of view of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum CameraChoice {
    /// The first camera of the scene, or, if it has none, one from which all of the scene is seen.
    #[default]
    Default,
    /// A camera of the scene by its number, from 0.
    Number {
        /// The number.
        number: usize,
        /// Where the pipeline says so.
        span: Range<usize>,
    },
    /// A camera of the scene by its name.
    Name {
        /// The name.
        name: String,
        /// Where the pipeline says so.
        span: Range<usize>,
    },
    /// A camera that the pipeline describes.
    Own(Camera),
}

/// The most bytes of a pipeline file. Thousands of outputs fit in.
const LONGEST: u64 = 1 << 18;

impl Pipeline {
    /// Reads the pipeline file `path`.
    ///
    /// # Errors
    ///
    /// All problems of the file, or why it cannot be read.
    pub fn read(path: &Path) -> Result<Self, crate::error::Error> {
        let mut bytes = Vec::new();
        // Also what never ends can be given as a file.
        std::fs::File::open(path)
            .and_then(|file| file.take(LONGEST + 1).read_to_end(&mut bytes))
            .map_err(|source| crate::error::Error::ReadPipeline { path: path.to_owned(), source })?;
        if bytes.len() as u64 > LONGEST {
            return Err(crate::error::Error::LongPipeline { path: path.to_owned(), most: LONGEST });
        }
        let text =
            String::from_utf8(bytes).map_err(|_| crate::error::Error::NotText { path: path.to_owned() })?;
        Ok(Self::parse(&text, path)?)
    }

    /// Reads the text of a pipeline file. Paths in it are relative to the folder of `path`.
    ///
    /// # Errors
    ///
    /// All problems of the text, each with its place and what to write instead. A missing input file is one.
    pub fn parse(text: &str, path: &Path) -> Result<Self, Diagnostics> {
        decode::decode(text, path)
    }

    /// Problems of this pipeline, ready to be shown.
    #[must_use]
    pub fn diagnostics(&self, problems: Vec<Diagnostic>) -> Diagnostics {
        Diagnostics::new(&self.path, &self.text, problems)
    }

    /// All stages, with those of a `Repeat`, once, in its place.
    pub fn flat_stages(&self) -> impl Iterator<Item = &Stage> {
        self.stages.iter().flat_map(|stage| match &stage.action {
            Action::Repeat(repeat) => repeat.stages.as_slice(),
            _ => std::slice::from_ref(stage),
        })
    }

    /// All files that the pipeline asks for, in the order of the file.
    pub fn outputs(&self) -> impl Iterator<Item = &Output> {
        self.stages.iter().flat_map(|stage| match &stage.action {
            Action::Save(outputs) => outputs.as_slice(),
            _ => &[],
        })
    }

    /// The scene file.
    #[must_use]
    pub fn scene_path(&self) -> &Path {
        self.stages
            .iter()
            .find_map(|stage| match &stage.action {
                Action::Load { path, .. } => Some(path.as_path()),
                _ => None,
            })
            .unwrap_or(Path::new(""))
    }
}
