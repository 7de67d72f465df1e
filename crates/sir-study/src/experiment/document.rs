//! The report, as JSON for programs and as Markdown for readers.

use serde::Serialize;

use crate::experiment::bodies::Bodies;
use crate::experiment::farm::Farm;
use crate::experiment::lines::Lines;
use crate::experiment::machine::Machine;
use crate::experiment::markdown::{Grid, count, megabytes};
use crate::experiment::mix::Mix;
use crate::experiment::options::Part;
use crate::experiment::paper::CITATION;
use crate::experiment::precision::Precision;
use crate::experiment::speed::Speed;
use crate::experiment::spread::Unevenness;
use crate::experiment::verdict;
use crate::experiment::verdict::Claim;
use crate::scaling::workers::counted;

/// Version of the layout of `report.json`.
pub(crate) const VERSION: u32 = 1;

/// All results of the experiment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Findings {
    /// Version of this layout: [`VERSION`].
    pub(crate) version: u32,
    /// Name and version of the program.
    pub(crate) program: String,
    /// The command line.
    pub(crate) command: String,
    /// Day on which the experiment ended.
    pub(crate) date: String,
    /// The machine.
    pub(crate) machine: Machine,
    /// Factor on the numbers of lines of the pipelines.
    pub(crate) scale: f64,
    /// Lines of the reference runs as a multiple of these scaled numbers.
    pub(crate) reference: f64,
    /// Parts that were done.
    pub(crate) parts: Vec<Part>,
    /// Results for each scene.
    pub(crate) scenes: Vec<SceneFindings>,
}

/// Results for a scene. Parts that were not requested are missing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct SceneFindings {
    /// Name of the scene.
    pub(crate) name: String,
    /// Path of the pipeline, as it was given.
    pub(crate) pipeline: String,
    /// Number of triangles.
    pub(crate) triangles: usize,
    /// Number of patches.
    pub(crate) patches: usize,
    /// Lines of the pipeline, scaled.
    pub(crate) lines: Lines,
    /// Times, speed-ups and efficiencies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) scaling: Option<Speed>,
    /// Error against the reference.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) error: Option<Precision>,
    /// Error over the share of local lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) mix: Option<Mix>,
    /// Share of lines that miss the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) domains: Option<Bodies>,
    /// Cost of lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) spread: Option<Unevenness>,
    /// Replicas and batches.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) farm: Option<Farm>,
    /// Paths of the images, relative to the report. The one that the report shows is first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) pictures: Option<Vec<String>>,
    /// Claims of the paper.
    pub(crate) claims: Vec<Claim>,
}

/// Returns the file names of a scene's diagrams.
pub(crate) fn figures(name: &str) -> [String; 2] {
    [format!("{name}-scaling.svg"), format!("{name}-mix.svg")]
}

impl SceneFindings {
    /// Judges the claims of the paper about the parts that were done.
    pub(crate) fn judge(&self) -> Vec<Claim> {
        [
            self.scaling.as_ref().map(verdict::of_speed),
            self.mix.as_ref().map(verdict::of_mix),
            self.domains.as_ref().map(verdict::of_bodies),
            self.spread.as_ref().map(verdict::of_spread),
            self.farm.as_ref().map(verdict::of_farm),
        ]
        .into_iter()
        .flatten()
        .flatten()
        .collect()
    }

    fn section(&self, scale: f64) -> String {
        let [scaling, mix] = figures(&self.name);
        let intro = format!(
            "## {}\n\n`{}`: {} triangles in {} patches; {} local and {} global lines.\n\n",
            self.name,
            self.pipeline,
            count(self.triangles as u64),
            count(self.patches as u64),
            count(self.lines.local),
            count(self.lines.global)
        );
        let sections = [
            Some(intro),
            self.pictures.as_deref().map(|files| pictures(&self.name, files)),
            self.scaling.as_ref().map(|speed| speed.section(&scaling, scale)),
            self.error.as_ref().map(Precision::section),
            self.mix.as_ref().map(|found| found.section(&mix)),
            self.domains.as_ref().map(Bodies::section),
            self.spread.as_ref().map(Unevenness::section),
            self.farm.as_ref().map(Farm::section),
        ];
        sections.into_iter().flatten().collect()
    }
}

fn pictures(name: &str, files: &[String]) -> String {
    let Some((first, others)) = files.split_first() else {
        return "### Pictures\n\nThe pipeline asks for none.\n\n".into();
    };
    let shown =
        if first.ends_with(".png") { format!("![{name}]({first})") } else { format!("[{first}]({first})") };
    let others: String = others.iter().map(|file| format!("* [{file}]({file})\n")).collect();
    let others = if others.is_empty() { others } else { format!("Others:\n\n{others}\n") };
    format!("### Pictures\n\n{shown}\n\n{others}")
}

impl Findings {
    /// Returns all numbers as JSON.
    pub(crate) fn json(&self) -> String {
        // Serializing cannot fail: this is a tree of plain structs. Non-finite numbers become `null`.
        serde_json::to_string_pretty(self).map(|json| json + "\n").unwrap_or_default()
    }

    /// Returns the report as Markdown.
    pub(crate) fn markdown(&self) -> String {
        let Self { program, command, date, machine, scale, .. } = self;
        let mut text = format!(
            "# The experiment of Martínez, Forés and Martín (2009), repeated\n\nAfter {CITATION}. Made by `{program}` on {date}.\n\n\
             * Command: `{command}`\n* Machine: {}, {}, {} of memory, {}\n",
            machine.cpu.as_deref().unwrap_or("unknown processor"),
            counted(machine.cores, "core"),
            megabytes(machine.memory),
            machine.system
        );
        if *scale < 1.0 {
            text += &format!("* Scale: all numbers of lines are {scale} times those of the pipelines.\n");
        }
        text += "* Each run is in its own folder in `runs`, with its pipeline (`sir run \
            runs/…/pipeline.ron` repeats it) and its `result.json`. All numbers are in `report.json`.\n\n";
        text += &self.summary();
        for scene in &self.scenes {
            text += &scene.section(*scale);
        }
        text.trim_end().to_owned() + "\n"
    }

    /// Returns the table of claims, and the rules by which they were judged.
    fn summary(&self) -> String {
        let claims =
            || self.scenes.iter().flat_map(|scene| scene.claims.iter().map(move |claim| (scene, claim)));
        let mut rules: Vec<&str> = Vec::new();
        let mut grid = Grid::of_words(&["claim of the paper", "scene", "here", "verdict", "rule"]);
        // Groups the rows by claim, each with all scenes.
        let mut names: Vec<&str> = Vec::new();
        for (_, claim) in claims() {
            if !names.contains(&claim.claim.as_str()) {
                names.push(&claim.claim);
            }
        }
        for name in &names {
            for (scene, claim) in claims().filter(|(_, claim)| claim.claim == *name) {
                let rule = rules.iter().position(|rule| *rule == claim.rule).unwrap_or_else(|| {
                    rules.push(&claim.rule);
                    rules.len() - 1
                });
                grid.row([
                    claim.claim.clone(),
                    scene.name.clone(),
                    claim.here.clone(),
                    claim.verdict.word().into(),
                    (rule + 1).to_string(),
                ]);
            }
        }
        if names.is_empty() {
            return String::new();
        }
        let rules: String =
            (1..).zip(&rules).map(|(number, rule): (usize, _)| format!("{number}. {rule}.\n")).collect();
        let smaller = if self.scale < 1.0 {
            "With so few lines, verdicts on speed, errors and replicas apply to a smaller task than the \
             paper's.\n\n"
        } else {
            ""
        };
        format!(
            "## Summary\n\n{}A claim is *confirmed* if its rule holds, *open* if too little was measured to \
             tell, otherwise *not confirmed*:\n\n{rules}\n{smaller}",
            grid.end()
        )
    }
}
