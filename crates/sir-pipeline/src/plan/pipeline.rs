//! What a pipeline file says, with every default filled in.

use std::ops::Range;
use std::path::{Path, PathBuf};

use sir_geom::{BoundingBox, SidesPolicy};
use sir_mesh::Subdivision;

use crate::plan::lights::Lamp;
use crate::plan::output::Output;
use crate::plan::sensors::Sensors;
use crate::plan::transport::{DomainKind, Transport};
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
        domain: DomainKind,
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

impl Pipeline {
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
