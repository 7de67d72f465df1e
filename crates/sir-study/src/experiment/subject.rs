//! The subject of the experiment: a pipeline, and the pipelines derived from it.

use std::path::{Path, PathBuf};

use sir_geom::LoadOptions;

use crate::error::StudyError;
use crate::experiment::error::ExperimentError;
use crate::experiment::lines::{Lines, fitted};
use sir_pipeline::fingerprint::{self, hex};
use sir_pipeline::plan::{
    Action, DomainKind, FirstShot, Load, Multipath, Output, Pipeline, Save, SecondShot, Solve, Stage, Table,
    Transport,
};
use sir_pipeline::run::{absolute, run_name};
use sir_pipeline::text::Span;

/// File name of the tables of all light in derived pipelines.
pub(crate) const TABLE: &str = "patches.npy";

/// File name of the tables after the first shot.
pub(crate) const DIRECT: &str = "direct.npy";

/// Pipeline whose numbers of lines can be changed.
pub(crate) struct Subject {
    pub(crate) name: String,
    pub(crate) pipeline: Pipeline,
    /// Numbers of lines of the pipeline.
    pub(crate) asked: Lines,
    /// Numbers of lines times the scale.
    pub(crate) lines: Lines,
    pub(crate) transport: Transport,
    pub(crate) domain: DomainKind,
    /// SHA-256 of the scene with its materials and textures, so that runs of a changed scene are distinct.
    digest: String,
}

/// Changes of a derived pipeline relative to the original one.
#[derive(Clone, Debug)]
pub(crate) struct Changes {
    pub(crate) lines: Lines,
    pub(crate) transport: Transport,
    pub(crate) seed: u64,
    /// True if the direct light is also saved.
    pub(crate) direct: bool,
    pub(crate) pictures: bool,
}

impl Subject {
    /// Reads a pipeline.
    pub(crate) fn read(path: &Path, scale: f64) -> Result<Self, StudyError> {
        let pipeline = Pipeline::read(path)?;
        // The lines of a `Solve` are divided as in the publication: 100 million local and 130 million global ones.
        let local_share = |lines: u64| (lines as f64 / 2.3).round() as u64;
        let local = pipeline.flat_stages().find_map(|stage| match &stage.action {
            Action::FirstShot(FirstShot { lines }) => Some(*lines),
            Action::Solve(Solve { lines }) => Some(local_share(*lines)),
            _ => None,
        });
        let multipath = pipeline.flat_stages().find_map(|stage| match &stage.action {
            Action::Multipath(multipath) => Some(multipath.clone()),
            Action::Solve(Solve { lines }) => {
                let (lines, transport, domain) =
                    (lines - local_share(*lines), Transport::Batches, DomainKind::Hull);
                Some(Multipath { lines, transport, domain })
            }
            _ => None,
        });
        let (Some(local), Some(Multipath { lines: global, transport, domain })) = (local, multipath) else {
            return Err(ExperimentError::NoMultipath { path: path.to_owned() }.into());
        };
        let scene = pipeline.scene_path();
        let built = sir_geom::load(scene, &LoadOptions::default()).map_err(sir_pipeline::Error::from)?;
        let asked = Lines { local, global };
        Ok(Self {
            name: run_name(path),
            digest: hex(fingerprint::of_scene(&built.scene)),
            lines: asked.times(scale),
            pipeline,
            asked,
            transport,
            domain,
        })
    }

    /// Returns the pipeline's transport, adapted to a number of global lines.
    pub(crate) fn transport_of(&self, lines: u64) -> Transport {
        fitted(&self.transport, self.asked.global, lines)
    }

    /// Returns the changes of the pipeline itself, with its lines times the scale.
    pub(crate) fn changes(&self) -> Changes {
        Changes {
            lines: self.lines,
            transport: self.transport_of(self.lines.global),
            seed: self.pipeline.seed,
            direct: false,
            pictures: false,
        }
    }

    /// Returns the images among the pipeline's outputs.
    pub(crate) fn pictures(&self) -> impl Iterator<Item = &Output> {
        self.pipeline.outputs().filter(|output| matches!(output, Output::Image(_)))
    }

    /// Returns the text of a derived pipeline.
    pub(crate) fn derived(&self, changes: &Changes) -> String {
        let table = |name: &str| Output::Table(Table { path: PathBuf::from(name), per: None });
        let mut actions = Vec::new();
        for stage in &self.pipeline.stages {
            match &stage.action {
                Action::Load(load) => {
                    actions.push(Action::Load(Load { path: absolute(&load.path), ..load.clone() }))
                }
                kept @ (Action::Light(_) | Action::Subdivide(_)) => actions.push(kept.clone()),
                // `Focus` and `ShadowRays` are left out because the paper does not have them and replicas do not support a
                // focus. Sensors are left out because the experiment measures patches.
                _ => {}
            }
        }
        let second_shot = self.pipeline.flat_stages().find_map(|stage| match &stage.action {
            // In proportion to the local lines.
            Action::SecondShot(SecondShot { lines, share }) => {
                let scale = changes.lines.local as f64 / self.asked.local as f64;
                let lines = ((*lines as f64 * scale) as u64).max(1);
                Some(Action::SecondShot(SecondShot { lines, share: *share }))
            }
            _ => None,
        });
        actions.push(Action::FirstShot(FirstShot { lines: changes.lines.local }));
        if changes.direct {
            actions.push(Action::Save(Save { outputs: vec![table(DIRECT)] }));
        }
        let (lines, transport, domain) = (changes.lines.global, changes.transport.clone(), self.domain);
        actions.extend(second_shot);
        actions.push(Action::Multipath(Multipath { lines, transport, domain }));
        let pictures = self.pictures().filter(|_| changes.pictures).cloned();
        actions.push(Action::Save(Save { outputs: std::iter::once(table(TABLE)).chain(pictures).collect() }));
        let stages = actions.into_iter().map(|action| Stage { action, span: Span::default() }).collect();
        let (seed, units, points) = (changes.seed, self.pipeline.units, self.pipeline.points);
        let derived = Pipeline { path: PathBuf::new(), text: String::new(), seed, units, points, stages };
        let Self { name, digest, .. } = self;
        format!(
            "// Derived from the pipeline of {name} by `sir experiment`. SHA-256 of the scene:\n// \
             {digest}\n{}",
            derived.to_ron()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: &str = "../../scenes/cornell-box/pipeline.ron";

    #[test]
    fn derived_pipelines_are_valid_anywhere() {
        let subject = Subject::read(Path::new(BOX), 0.01).unwrap();
        assert_eq!(subject.lines, Lines { local: 130_435, global: 169_565 });
        let changes = Changes { direct: true, pictures: true, seed: 9, ..subject.changes() };
        let folder = tempfile::tempdir().unwrap();
        let derived = Pipeline::parse(&subject.derived(&changes), &folder.path().join("x.ron")).unwrap();
        assert_eq!(derived.seed, 9);
        assert_eq!(derived.stages[1].action, subject.pipeline.stages[1].action);
        assert_eq!(derived.stages[2].action, Action::FirstShot(FirstShot { lines: 130_435 }));
        let names: Vec<_> = derived.outputs().map(|o| o.path().display().to_string()).collect();
        assert_eq!(names, ["direct.npy", "patches.npy", "view.png", "view.exr"]);
    }

    #[test]
    fn multipath_is_needed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.ron");
        std::fs::write(folder.path().join("x.obj"), "").unwrap();
        std::fs::write(&path, r#"(stages: [Load(path: "x.obj"), FirstShot(lines: 1)])"#).unwrap();
        let error = Subject::read(&path, 1.0).err().unwrap();
        assert!(error.to_string().contains("x.ron has no `Multipath` stage"), "{error}");
        assert_eq!(error.kind(), sir_pipeline::ErrorKind::Usage);
    }
}
