//! Luminaires of a run: their flux and electric power.

use serde::{Deserialize, Serialize};

use crate::format::grouped;
use crate::plan::{Action, Lamp, Luminaire, Pipeline};

/// Equal luminaires of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LuminaireReport {
    /// Name.
    pub name: String,
    /// Path of the photometric file.
    pub file: String,
    /// Format of the file.
    pub format: String,
    /// Number of luminaires.
    pub count: u64,
    /// Flux of one luminaire with all factors \[lm\].
    pub flux: f64,
    /// Electric power of one luminaire \[W\], if it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub watts: Option<f64>,
}

/// Largest relative difference between the flux of the intensities and the flux that a file states, without a warning.
const LARGEST_DIFFERENCE: f64 = 0.02;

impl LuminaireReport {
    fn of(luminaire: &Luminaire) -> Self {
        Self {
            name: luminaire.label(),
            file: luminaire.file.path.display().to_string(),
            format: luminaire.file.contents.format.clone(),
            count: u64::from(luminaire.columns) * u64::from(luminaire.rows),
            flux: luminaire.flux_of_one(),
            watts: luminaire.watts_of_one(),
        }
    }

    /// Returns the luminaires of a pipeline.
    pub(crate) fn all(pipeline: &Pipeline) -> Vec<Self> {
        luminaires(pipeline).map(Self::of).collect()
    }

    /// Returns the luminaires in one line, such as `12 × recessed, 2960 lm and 30 W each`.
    #[must_use]
    pub fn in_short(&self) -> String {
        let watts = self.watts.map_or(String::new(), |watts| format!(" and {watts} W"));
        format!("{} × {}, {:.0} lm{watts} each", grouped(self.count), self.name, self.flux)
    }
}

/// Returns the electric power of all luminaires \[W\]; `None` if that of any is unknown, or there are none.
#[must_use]
pub fn installed_watts(all: &[LuminaireReport]) -> Option<f64> {
    let watts = |luminaire: &LuminaireReport| Some(luminaire.count as f64 * luminaire.watts?);
    if all.is_empty() { None } else { all.iter().map(watts).sum() }
}

/// Returns what the readers of photometric files had to guess, and where a file contradicts itself.
pub(crate) fn warnings(pipeline: &Pipeline) -> Vec<String> {
    let mut all = Vec::new();
    for luminaire in luminaires(pipeline) {
        let (path, contents) = (luminaire.file.path.display(), &luminaire.file.contents);
        all.extend(contents.warnings.iter().map(|warning| format!("{path}: {warning}")));
        let (found, factor) = (contents.distribution.flux(), luminaire.flux);
        if let (Some(stated), None) = (contents.stated_flux, factor)
            && (found / stated - 1.0).abs() > LARGEST_DIFFERENCE
        {
            all.push(format!(
                "{path}: the intensities give {found:.0} lm, but the file states {stated:.0} lm for the luminaire; the intensities \
                 are used; set `flux: {stated:.0}` if the statement is right"
            ));
        }
    }
    // Luminaires with the same file have the same warnings.
    let mut unique: Vec<String> = Vec::new();
    for warning in all {
        if !unique.contains(&warning) {
            unique.push(warning);
        }
    }
    unique
}

fn luminaires(pipeline: &Pipeline) -> impl Iterator<Item = &Luminaire> {
    let lamps = pipeline.stages.iter().flat_map(|stage| match &stage.action {
        Action::Light(light) => light.lamps.as_slice(),
        _ => &[],
    });
    lamps.filter_map(|lamp| if let Lamp::Luminaire(luminaire) = lamp { Some(luminaire) } else { None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn watts_add_up_if_all_are_known() {
        let report = |count, watts| LuminaireReport {
            name: "recessed".into(),
            file: "recessed.ldt".into(),
            format: "EULUMDAT".into(),
            count,
            flux: 2960.0,
            watts,
        };
        let [all, some] = [report(12, Some(30.0)), report(1, None)];
        assert_eq!(all.in_short(), "12 × recessed, 2960 lm and 30 W each");
        assert_eq!(installed_watts(&[all.clone(), report(2, Some(5.0))]), Some(370.0));
        assert_eq!(installed_watts(&[all, some]), None);
        assert_eq!(installed_watts(&[]), None);
    }
}
