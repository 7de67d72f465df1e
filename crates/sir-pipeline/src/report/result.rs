//! `result.json`: what a run did, for people and programs.
//!
//! Two runs of one pipeline with one program give the same report, but for the times. These are in fields called
//! `time`, and nothing else is in there.

use serde::{Deserialize, Serialize};

use crate::report::sensors::SensorsReport;
use crate::units::Units;

/// Version of the layout of `result.json`.
pub const VERSION: u32 = 3;

/// Name of the report in a run directory.
pub const FILE_NAME: &str = "result.json";

/// The report of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Version of this layout: [`VERSION`].
    pub version: u32,
    /// Name and version of the program.
    pub program: String,
    /// What was asked for.
    pub pipeline: PipelineReport,
    /// Seed of all random numbers, which the command line may have set.
    pub seed: u64,
    /// What the numbers are. This documentation names radiometric units; of photometric ones, read lm for W and lx for W/m².
    #[serde(default)]
    pub units: Units,
    /// What was lit.
    pub scene: SceneReport,
    /// The stages, in order.
    pub stages: Vec<StageReport>,
    /// The files, in order. This report is not among them.
    pub outputs: Vec<OutputReport>,
    /// Time of the whole run.
    pub time: Time,
}

/// The pipeline of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PipelineReport {
    /// Its file, as it was named.
    pub path: String,
    /// What it said.
    pub text: String,
}

/// The scene of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneReport {
    /// Its file.
    pub path: String,
    /// Triangles, those without an area left out.
    pub triangles: usize,
    /// Patches.
    pub patches: usize,
    /// Active sides of patches.
    pub sides: usize,
    /// Area of all triangles, one side each \[m²\].
    pub area: f64,
    /// Emitted power per band \[W\]; of light from outside, what enters the box around the scene.
    pub power: [f64; 3],
    /// What the reader changed or left out.
    pub warnings: Vec<String>,
}

/// One stage of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StageReport {
    /// Name of the stage, such as `FirstShot`.
    pub name: String,
    /// What its lines did, if it has any. In the `stages` of a `Repeat`: of all repeats together, but for the balance and what was
    /// made up, which are means.
    #[serde(default, flatten, skip_serializing_if = "Option::is_none")]
    pub lines: Option<LinesReport>,
    /// All light after it, if it adds to it.
    #[serde(default, flatten, skip_serializing_if = "Option::is_none")]
    pub light: Option<LightReport>,
    /// How often a `Repeat` ran its stages: `Repeat(times: …)` with this number gives the same result.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeats: Option<u64>,
    /// The stages of a `Repeat`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<Self>,
    /// What its sensors have measured, if it has any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensors: Option<SensorsReport>,
    /// How long it took.
    pub time: Time,
}

/// What the lines of a stage did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinesReport {
    /// Lines traced.
    pub lines: u64,
    /// The convex body that they were drawn through, if they are global lines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub domain: Option<DomainReport>,
    /// Share of the lines that met nothing.
    pub empty_share: f64,
    /// Global lines that met an odd number of triangles: none in scenes of closed surfaces.
    pub odd_lines: u64,
    /// Triangles met.
    pub crossings: u64,
    /// Batches in which the lines were traced, or replicas that shared them: 1 in the first shot.
    pub batches: u64,
    /// Where the power went.
    pub balance: BalanceReport,
    /// Power that was added to what surfaces received to make up for the unshot \[W\], per band.
    pub extrapolated: [f64; 3],
}

/// All light so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightReport {
    /// Estimated relative error of the irradiance, per band: root of the area-weighted mean square of the standard errors,
    /// over the area-weighted mean irradiance; with a focus, of the patches in it. Zero in a band without light.
    pub relative_error: [f64; 3],
    /// Where the standard errors come from.
    pub errors: ErrorsReport,
    /// SHA-256 of the tallies of received power: the same for the same result.
    pub tally_hash: String,
}

/// Where standard errors come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ErrorsReport {
    /// From what?
    pub from: ErrorsFrom,
    /// How many independent samples there are: lines of all stages so far, or repeats.
    pub samples: u64,
}

/// What standard errors come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ErrorsFrom {
    /// From what single lines have brought.
    Lines,
    /// From the spread of independent repeats.
    Spread,
}

/// The domain of global lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DomainReport {
    /// `Sphere`, `Box` or `Hull`.
    pub kind: String,
    /// Its surface \[m²\]; of a flat body, both sides.
    pub surface: f64,
    /// Share of the lines that were drawn through the focus, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub focus: Option<f64>,
}

/// Energy balance of a stage per band \[W\]: `emitted = absorbed + blocked + escaped + unshot`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BalanceReport {
    /// Sent out: by the sources in the first shot, by what the first shot left in multipath.
    pub emitted: [f64; 3],
    /// Absorbed by the sides that received it.
    pub absorbed: [f64; 3],
    /// Absorbed by the backs of one-sided surfaces.
    pub blocked: [f64; 3],
    /// Left the scene, or came from outside and never met it.
    pub escaped: [f64; 3],
    /// Reflected, but not sent out again. After the first shot it is what multipath distributes; after multipath
    /// it is missing from the result, unless something was `extrapolated` for it.
    pub unshot: [f64; 3],
}

/// A file that a run wrote.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutputReport {
    /// Its path in the run directory.
    pub path: String,
    /// `image`, `gltf`, `table`, `sensors` (a table of them) or `map` (of sensors, in false colors).
    pub kind: String,
    /// Its size.
    pub bytes: u64,
}

/// How long something took.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Wall-clock time \[s\].
    pub seconds: f64,
    /// Lines per second, if it is a stage with lines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lines_per_second: Option<f64>,
    /// Of a stage with lines: time in which no lines were traced \[s\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sequential: Option<f64>,
    /// Of a stage with lines: time for exchanging numbers with other ranks, and for waiting for them \[s\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub communication: Option<f64>,
    /// Of a whole run: most memory that a rank had in use, that of the largest one \[bytes\]; only where the operating system
    /// tells, as Linux does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_memory: Option<u64>,
}

impl Report {
    /// The report as JSON, as `result.json` has it.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Serialising a tree of plain structs fails only for keys that are not text, of which there are none.
        serde_json::to_string_pretty(self).map(|json| json + "\n").unwrap_or_default()
    }
}

impl StageReport {
    /// A stage that took so long, of which there is nothing else to say.
    #[must_use]
    pub fn of(name: &str, time: Time) -> Self {
        Self {
            name: name.into(),
            lines: None,
            light: None,
            repeats: None,
            stages: Vec::new(),
            sensors: None,
            time,
        }
    }
}

impl Time {
    /// The time of something without lines.
    #[must_use]
    pub fn of(seconds: f64) -> Self {
        Self { seconds, lines_per_second: None, sequential: None, communication: None, peak_memory: None }
    }
}
