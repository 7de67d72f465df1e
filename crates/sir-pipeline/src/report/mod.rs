//! `result.json`: report of a run, for people and programs.

pub(crate) mod compare;
pub(crate) mod glare;
pub(crate) mod groups;
pub(crate) mod light;
pub(crate) mod lines;
pub(crate) mod luminaires;
pub(crate) mod page;
pub(crate) mod probes;
pub(crate) mod requirements;
pub(crate) mod result;
pub(crate) mod sensors;
pub(crate) mod uncertain;

pub use compare::compare;
pub use glare::GlareReport;
pub use luminaires::{LuminaireReport, installed_watts};
pub use requirements::{RequirementReport, Verdict};
pub use result::{
    BalanceReport, DomainReport, ErrorsFrom, ErrorsReport, GroupReport, LightReport, LinesReport,
    OutputReport, PipelineReport, Report, SceneReport, StageReport, Time, VERSION,
};
pub use sensors::{DaylightReport, SensorsReport};

pub use crate::run_files::REPORT as FILE_NAME;
