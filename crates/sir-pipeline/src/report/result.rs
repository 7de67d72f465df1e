//! Contents of `result.json`.
//!
//! Two runs of one pipeline with one program give the same report, except for the times. Times, and nothing else, are
//! in fields called `time`.

use serde::{Deserialize, Serialize};

use crate::report::luminaires::LuminaireReport;
use crate::report::sensors::SensorsReport;
use crate::units::Units;

/// Version of the format of `result.json`.
pub const VERSION: u32 = 3;

/// The report of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Version of the format: [`VERSION`].
    pub version: u32,
    /// Name and version of the program.
    pub program: String,
    /// Pipeline of the run.
    pub pipeline: PipelineReport,
    /// Seed of all random numbers, from the pipeline or the command line.
    pub seed: u64,
    /// Units of the numbers. This documentation names radiometric units; if they are photometric, read lm for W and lx
    /// for W/m².
    #[serde(default)]
    pub units: Units,
    /// Scene of the run.
    pub scene: SceneReport,
    /// Stages, in order. With light groups, those of the sum of all groups times their factors.
    pub stages: Vec<StageReport>,
    /// Light groups, if the pipeline names any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub groups: Vec<GroupReport>,
    /// Run directory from whose light groups this result was mixed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mixed_from: Option<String>,
    /// Warnings of the run: what is suspicious about the scene, and about the result.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// Written files, in order, without this report.
    pub outputs: Vec<OutputReport>,
    /// Time of the whole run.
    pub time: Time,
}

/// Pipeline of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PipelineReport {
    /// Path of the file, as given.
    pub path: String,
    /// Text of the file.
    pub text: String,
    /// Absolute path of the file, if the run has light groups, which `sir mix` reads later.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub absolute: Option<String>,
}

/// Scene of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneReport {
    /// Path of the file.
    pub path: String,
    /// Number of triangles, without those of zero area.
    pub triangles: usize,
    /// Number of patches.
    pub patches: usize,
    /// Number of active sides of patches.
    pub sides: usize,
    /// Area of all triangles, one side each \[m²\].
    pub area: f64,
    /// Emitted power per band \[W\]. For light from outside, the power that enters the box around the scene.
    pub power: [f64; 3],
    /// Up direction, of unit length.
    #[serde(default)]
    pub up: [f64; 3],
    /// Reason for the up direction.
    #[serde(default)]
    pub up_from: String,
    /// Luminaires of the pipeline.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub luminaires: Vec<LuminaireReport>,
    /// Warnings of the reader about what it changed or left out.
    pub warnings: Vec<String>,
}

/// Light group of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroupReport {
    /// Name of the group.
    pub name: String,
    /// Power that it emits per band \[W\], before it is multiplied by `factor`.
    pub power: [f64; 3],
    /// Factor of its light in the results, per band: 1 in those of a run.
    pub factor: [f64; 3],
    /// Stages from the first one with lines on, without the factor. Sensors and files are only those of the sum.
    pub stages: Vec<StageReport>,
}

/// One stage of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StageReport {
    /// Name of the stage, such as `FirstShot`.
    pub name: String,
    /// Report of its lines, if it has any. If it was repeated: totals of all repeats, except for the balance and `walked`,
    /// which are means.
    #[serde(default, flatten, skip_serializing_if = "Option::is_none")]
    pub lines: Option<LinesReport>,
    /// Report of the light so far, if the stage adds to it.
    #[serde(default, flatten, skip_serializing_if = "Option::is_none")]
    pub light: Option<LightReport>,
    /// Number of repeats of a `Repeat`, or of those that share the lines of the stage. `Repeat(times: …)` with this number
    /// gives the same result.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeats: Option<u64>,
    /// Error of the light against lines and time, after each repeat from the eighth on; only of the last light.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub convergence: Vec<Convergence>,
    /// Stages of a `Repeat` or `Solve`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<Self>,
    /// Pilot of a `Solve`, whose lines the result does not contain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pilot: Option<PilotReport>,
    /// Summary of its sensors, if it has any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensors: Option<SensorsReport>,
    /// Time of the stage.
    pub time: Time,
}

/// Report of the pilot of a `Solve`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PilotReport {
    /// Number of its lines.
    pub lines: u64,
    /// Result of the pilot, besides the numbers of lines of the stages: share of the reflected light that the second shot
    /// carries; 0 if there is none.
    pub share: f64,
    /// Likewise, the number of shadow rays as a pipeline states it; 0 if there are none. Not all of them are traced: none
    /// are from behind a surface.
    #[serde(default)]
    pub rays: u64,
    /// Its time, which is a part of that of the stage.
    pub time: Time,
}

/// Error of the mean of some repeats.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Convergence {
    /// Number of repeats.
    pub repeats: u64,
    /// Number of lines of all stages in these repeats.
    pub lines: u64,
    /// Relative error of the irradiance, as in [`LightReport`].
    pub relative_error: [f64; 3],
    /// Time of these repeats.
    pub time: Time,
}

impl Default for Convergence {
    fn default() -> Self {
        Self { repeats: 0, lines: 0, relative_error: [0.0; 3], time: Time::of(0.0) }
    }
}

/// Report of the lines of a stage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinesReport {
    /// Number of lines traced.
    pub lines: u64,
    /// Domain of global lines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub domain: Option<DomainReport>,
    /// Share of the lines that hit nothing.
    pub empty_share: f64,
    /// Number of global lines that hit an odd number of triangles: zero in scenes of closed surfaces.
    pub odd_lines: u64,
    /// Number of triangles hit.
    pub crossings: u64,
    /// Number of batches in which the lines were traced, or of replicas that shared them; 1 in the first shot.
    pub batches: u64,
    /// Energy balance.
    pub balance: BalanceReport,
    /// Number of random walks that sent on what was unshot when the lines ended.
    pub walks: u64,
    /// Power with which they started \[W\], per band.
    pub walked: [f64; 3],
}

/// Report of the light so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightReport {
    /// Estimated relative error of the irradiance, per band: root of the area-weighted mean square of the standard
    /// errors, over the area-weighted mean irradiance. With a focus, only patches in it count. Zero in a band without
    /// light.
    pub relative_error: [f64; 3],
    /// Source of the standard errors.
    pub errors: ErrorsReport,
    /// SHA-256 of the tallies of received power: equal for equal results.
    pub tally_hash: String,
}

/// Source of standard errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ErrorsReport {
    /// Kind of samples.
    pub from: ErrorsFrom,
    /// Number of independent samples: lines of all stages so far, or repeats.
    pub samples: u64,
}

/// Kind of samples from which standard errors are estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ErrorsFrom {
    /// Power brought by single lines.
    Lines,
    /// Spread of independent repeats.
    Spread,
}

/// Domain of global lines: the convex body through which they were drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DomainReport {
    /// `Sphere`, `Box` or `Hull`.
    pub kind: String,
    /// Surface area \[m²\]; of a flat body, that of both sides.
    pub surface: f64,
    /// Share of the lines drawn through the focus, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub focus: Option<f64>,
}

/// Energy balance of a stage per band \[W\]: `emitted = absorbed + blocked + escaped + unshot`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BalanceReport {
    /// Power sent out: by the sources in the first shot, by the power that the first shot left in multipath.
    pub emitted: [f64; 3],
    /// Power absorbed by the sides that received it.
    pub absorbed: [f64; 3],
    /// Power absorbed by the backs of one-sided surfaces.
    pub blocked: [f64; 3],
    /// Power that left the scene, or came from outside and missed it.
    pub escaped: [f64; 3],
    /// Power that was reflected, but not sent out again. After the first shot, multipath distributes it. After
    /// replicas it is missing from the result; after batches it is what chance gives and takes, zero on average.
    pub unshot: [f64; 3],
}

/// File written by a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutputReport {
    /// Path in the run directory.
    pub path: String,
    /// `image`, `gltf`, `table`, `report`, `sensors` (a table of sensors) or `map` (a false-color image of sensors).
    pub kind: String,
    /// Size \[bytes\]; missing for pages, because they state times.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
    /// Camera of an image for which neither the pipeline nor the scene has one, as a pipeline can state it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<String>,
}

/// Time of a stage or a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Wall-clock time \[s\].
    pub seconds: f64,
    /// Lines per second of a stage with lines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lines_per_second: Option<f64>,
    /// Time of a stage with lines in which no lines were traced \[s\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sequential: Option<f64>,
    /// Time of a stage with lines for exchanging numbers with other ranks, and for waiting for them \[s\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub communication: Option<f64>,
    /// Peak memory use of a whole run \[bytes\], of the rank with the largest; only if the operating system reports it,
    /// as Linux does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_memory: Option<u64>,
}

impl Report {
    /// Returns the report as the JSON text of `result.json`.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Serializing a tree of plain structs fails only for keys that are not strings; there are none.
        serde_json::to_string_pretty(self).map(|json| json + "\n").unwrap_or_default()
    }
}

impl StageReport {
    /// Returns the report of a stage with a name and a time, and nothing else.
    #[must_use]
    pub fn of(name: &str, time: Time) -> Self {
        Self {
            name: name.into(),
            lines: None,
            light: None,
            repeats: None,
            convergence: Vec::new(),
            stages: Vec::new(),
            pilot: None,
            sensors: None,
            time,
        }
    }
}

impl Time {
    /// Returns the time of a stage without lines, or of a run.
    #[must_use]
    pub const fn of(seconds: f64) -> Self {
        Self { seconds, lines_per_second: None, sequential: None, communication: None, peak_memory: None }
    }
}
