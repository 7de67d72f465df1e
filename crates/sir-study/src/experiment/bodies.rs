//! Part `domains`: the share of global lines that miss the scene.

use serde::Serialize;
use sir_radiosity::Model;

use crate::error::StudyError;
use crate::experiment::crossings::{count, scaled};
use crate::experiment::markdown;
use crate::experiment::markdown::{Grid, percent};
use crate::experiment::runs::Runs;
use sir_pipeline::plan::DomainKind;

/// Number of lines through each domain before scaling, and the minimum after it.
const LINES: (u64, u64) = (1_000_000, 100_000);

/// Domain, with the share of lines that miss the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Miss {
    /// Kind of domain: `Sphere`, `Box` or `Hull`.
    pub(crate) domain: String,
    /// Surface of the domain \[m²\].
    pub(crate) surface: f64,
    /// Share of the lines that hit nothing.
    pub(crate) empty_share: f64,
}

/// Results of the part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Bodies {
    /// Number of lines through each domain.
    pub(crate) lines: u64,
    /// Results for each domain.
    pub(crate) bodies: Vec<Miss>,
    /// Volume of the bounding sphere over that of the bounding box; `None` if the box is flat.
    pub(crate) sphere_to_box: Option<f64>,
}

/// Traces lines through each domain.
pub(crate) fn find(runs: &Runs, model: &Model, scale: f64) -> Result<Bodies, StudyError> {
    let lines = scaled(LINES.0, scale, LINES.1);
    let miss = |kind: DomainKind| -> Result<Miss, StudyError> {
        let domain = kind.around(&model.scene);
        let mut empty = 0u64;
        count(runs, model, &domain, 0..lines, |crossings| empty += u64::from(crossings == 0))?;
        // A hull without volume is replaced by a box; the name is that of the requested domain.
        Ok(Miss {
            domain: format!("{kind:?}"),
            surface: domain.surface(),
            empty_share: empty as f64 / lines.max(1) as f64,
        })
    };
    let bodies = [DomainKind::Sphere, DomainKind::Box, DomainKind::Hull]
        .into_iter()
        .map(miss)
        .collect::<Result<_, _>>()?;
    let sphere = 4.0 / 3.0 * std::f64::consts::PI * model.scene.bounding_sphere().radius.powi(3);
    let volume = model.scene.bounding_box().size().element_product();
    Ok(Bodies { lines, bodies, sphere_to_box: (volume > 0.0).then(|| sphere / volume) })
}

impl Bodies {
    /// Returns the share of the lines through the sphere that hit nothing.
    pub(crate) fn empty_in_sphere(&self) -> Option<f64> {
        self.bodies.iter().find(|miss| miss.domain == "Sphere").map(|miss| miss.empty_share)
    }

    /// Returns the section of the report.
    pub(crate) fn section(&self) -> String {
        let columns = ["domain", "surface [m²]", "lines that miss the hull", "lines that hit nothing"];
        let mut grid = Grid::new(&columns);
        // The probability that a line through a convex body crosses a convex body inside it is the ratio of their
        // surfaces.
        let least = self.bodies.iter().map(|miss| miss.surface).fold(f64::INFINITY, f64::min);
        for Miss { domain, surface, empty_share } in &self.bodies {
            let past = if *surface > 0.0 { 1.0 - least / surface } else { 0.0 };
            grid.row([domain.clone(), format!("{surface:.2}"), percent(past), percent(*empty_share)]);
        }
        let filled = self.sphere_to_box.map_or_else(String::new, |ratio| {
            format!(
                "The bounding box fills {} of the bounding sphere, whose volume is therefore {} larger. The \
                 share of lines that miss a convex body depends on surfaces, not on volumes.\n\n",
                percent(1.0 / ratio),
                percent(ratio - 1.0)
            )
        });
        format!(
            "### Lines that miss the scene\n\n{} lines through each domain. The share that misses the convex \
             hull follows from the surfaces; the share that hits nothing was counted:\n\n{}{filled}",
            markdown::count(self.lines),
            grid.end()
        )
    }
}
