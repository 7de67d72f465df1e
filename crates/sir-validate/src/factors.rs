//! Cases of `view-factors.json`.

use std::collections::BTreeMap;

use sir_mesh::Subdivision;
use sir_parallel::Start;
use sir_radiosity::{Grouping, Model, ViewFactorLines, ViewFactorSettings, ViewFactorTask};

use crate::data::{Case, Surface};
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::light::{Paint, scene};
use crate::shape::SEGMENTS;
use crate::trial::{Quantity, Sample, Trial};

/// Smallest number of lines per run, from all surfaces together.
const MIN_LINES: u64 = 1_000_000;

/// Number of lines of a run that arrive at the surface with the smallest factor. Small factors need more lines.
const MIN_ARRIVALS: f64 = 1000.0;

/// Creates the trial for view factors between the surfaces of a case, which local lines estimate.
pub(crate) fn factors(case: &Case) -> Result<Vec<Trial<'_>>, ValidateError> {
    let surfaces: Vec<&Surface> = case.geometry.surfaces.iter().collect();
    let values: BTreeMap<String, f64> = case.values()?;
    let (mut pairs, mut quantities) = (Vec::new(), Vec::new());
    for (name, &exact) in &values {
        let number = |name: &str| surfaces.iter().position(|surface| surface.name == name);
        let pair = names(name).and_then(|(from, to)| Some((number(from)?, number(to)?)));
        pairs.push(*case.need("surfaces for all factors", pair.as_ref())?);
        quantities.push(Quantity::new(name, exact));
    }
    let smallest = values.values().copied().filter(|&f| f > 0.0).fold(1.0, f64::min);
    let lines = (MIN_ARRIVALS * surfaces.len() as f64 / smallest).max(MIN_LINES as f64) as u64;
    let prepare = move |effort: Effort| -> Result<Sample<'_>, ValidateError> {
        let scene = scene(&surfaces, |_| Paint::gray(0.0, 0.0), effort.segments(SEGMENTS))?;
        let model = Model::new(scene, Subdivision::PerTriangle)?;
        // Every surface has a material of its own and at least one triangle, so groups have the numbers of surfaces.
        let grouping = Grouping::by_material(&model.scene);
        let pairs = pairs.clone();
        Ok(Box::new(move |lines, seed, executor| {
            let settings = ViewFactorSettings::of_lines(lines, seed);
            let task = ViewFactorTask { model: &model, grouping: &grouping, settings };
            let found = executor.run::<ViewFactorLines<'_>>(task, Start::Fresh(()))?.outcome;
            Ok(pairs.iter().map(|&(from, to)| found.factor(from, to)).collect())
        }))
    };
    Ok(vec![Trial { quantities, lines, prepare: Box::new(prepare) }])
}

/// Returns the names of the two surfaces of a factor: `F12` or `F_base_side`.
fn names(factor: &str) -> Option<(&str, &str)> {
    let names = factor.strip_prefix('F')?;
    match names.strip_prefix('_') {
        Some(words) => words.split_once('_'),
        None if names.len() == 2 => names.split_at_checked(1),
        None => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_name_two_surfaces() {
        assert_eq!(names("F12"), Some(("1", "2")));
        assert_eq!(names("F_base_side"), Some(("base", "side")));
        assert_eq!([names("F1"), names("F_base"), names("G12")], [None; 3]);
    }
}
