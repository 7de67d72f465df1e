//! Runs a pipeline: its stages in order, checkpoints, files and the report.
//!
//! * `execute`: starts or resumes a run; `resume`: contents of a checkpoint; `directory`: run directories, `lock`: their locks.
//! * `stages`: one stage after the other; `lighting`: the light so far; `repeating`: repeats of
//!   the stages with lines; `sharing`: their number; `split`: the lines of a `Solve`, `pilot`: how they are found; `reach`: the global lines that met what is lit.
//! * `groups`: light groups, one after the other, `group_file`: their files; `mix`: the results for their sum, `mix_result`:
//!   with other factors.
//! * `save`: images, lit scenes and tables; `sensor_files`, `probe_files`: files of sensors and
//!   probes; `measured`: their measurements in all repeats.

pub(crate) mod computed;
pub(crate) mod directory;
pub(crate) mod execute;
mod group_file;
mod groups;
mod lighting;
mod lightmap;
pub(crate) mod lock;
mod measured;
mod mix;
mod mix_result;
pub(crate) mod pages;
mod pilot;
mod probe_files;
mod reach;
mod repeat_sums;
mod repeating;
pub(crate) mod resume;
pub(crate) mod save;
mod saver;
mod sensor_files;
mod sharing;
pub(crate) mod split;
mod stages;
mod step;

pub use crate::run_files::CHECKPOINT;
pub use directory::{absolute, make_new, run_name};
pub use execute::{
    RunOptions, RunResult, read_report, resume, resume_together, run, run_pipeline, run_together,
};
pub use mix_result::{MixOptions, mix};
