//! Luminaires of a run: their flux and electric power.

use serde::{Deserialize, Serialize};
use sir_geom::Rgb;

use crate::format::grouped;
use crate::plan::{Luminaire, OTHER, Pipeline};

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
    /// Flux of one luminaire with all factors, including that of its light group in a mix \[lm\].
    pub flux: f64,
    /// Electric power of one luminaire at full output \[W\], if it is known.
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
            count: luminaire.count(),
            flux: luminaire.flux_of_one(),
            watts: luminaire.watts_of_one(),
        }
    }

    /// Returns the luminaires of a pipeline.
    pub(crate) fn all(pipeline: &Pipeline) -> Vec<Self> {
        pipeline.luminaires().map(Self::of).collect()
    }

    /// Returns the same for a mix of light groups, given as names and factors: the flux of each luminaire times the factor of
    /// its group.
    pub(crate) fn mixed(pipeline: &Pipeline, factors: &[(&str, Rgb)]) -> Vec<Self> {
        let of_group = |luminaire: &Luminaire| {
            let name = luminaire.group.as_deref().unwrap_or(OTHER);
            let factor =
                factors.iter().find(|(group, _)| *group == name).map_or(Rgb::ONE, |(_, factor)| *factor);
            let report = Self::of(luminaire);
            Self { flux: report.flux * luminaire.dimming_by(factor), ..report }
        };
        pipeline.luminaires().map(of_group).collect()
    }

    /// Returns the luminaires in one line, such as `12 × recessed, 2960 lm and 30 W each`.
    #[must_use]
    pub fn in_short(&self) -> String {
        let watts = self.watts.map_or(String::new(), |watts| format!(" and {watts} W"));
        format!("{} × {}, {:.0} lm{watts} each", grouped(self.count), self.name, self.flux)
    }
}

/// Returns the electric power of all luminaires at full output \[W\]; `None` if that of any is unknown, or there are none.
#[must_use]
pub fn installed_watts(all: &[LuminaireReport]) -> Option<f64> {
    let watts = |luminaire: &LuminaireReport| Some(luminaire.count as f64 * luminaire.watts?);
    if all.is_empty() { None } else { all.iter().map(watts).sum() }
}

/// Returns what the readers of photometric files had to guess, and where a file contradicts itself.
pub(crate) fn warnings(pipeline: &Pipeline) -> Vec<String> {
    let mut all = Vec::new();
    for luminaire in pipeline.luminaires() {
        let (path, contents) = (luminaire.file.path.display(), &luminaire.file.contents);
        all.extend(contents.warnings.iter().map(|warning| format!("{path}: {warning}")));
        if luminaire.flux.is_some() {
            continue;
        }
        let found = contents.distribution.flux();
        let contradiction = match (contents.stated_flux, contents.lamp_flux) {
            (Some(stated), _) if (found / stated - 1.0).abs() > LARGEST_DIFFERENCE => {
                Some((stated, format!("but the file states {stated:.0} lm for the luminaire")))
            }
            (None, Some(lamps)) if found / lamps - 1.0 > LARGEST_DIFFERENCE => Some((
                lamps,
                format!(
                    "more than the {lamps:.0} lm of its lamps (a light output ratio of {:.0} %)",
                    100.0 * found / lamps
                ),
            )),
            _ => None,
        };
        all.extend(contradiction.map(|(stated, but)| {
            format!(
                "{path}: the intensities give {found:.0} lm, {but}; the intensities are used; set `flux: {stated:.0}` if the \
                 statement is right"
            )
        }));
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

    const IES: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 1500 1 3 1 1 2 0 0 0\n1 1 15\n0 45 90\n0\n1200 700 0\n";

    /// Reads a pipeline with two equal luminaires, of which one is red and in a group.
    fn pipeline(ies: &str) -> Pipeline {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("down.ies"), ies).unwrap();
        std::fs::write(folder.path().join("x.obj"), "").unwrap();
        let text = "(units: Photometric, stages: [Load(path: \"x.obj\"), Light([
            Luminaire(file: \"down.ies\", position: (0, 0, 0), color: (1, 0, 0), group: \"red\"),
            Luminaire(file: \"down.ies\", position: (0, 0, 0), dimming: 0.5)]), FirstShot(lines: 10)])";
        Pipeline::parse(text, &folder.path().join("x.ron")).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn the_flux_follows_the_factors_of_a_mix() {
        let pipeline = pipeline(IES);
        let fluxes = |red, other| {
            let mixed = LuminaireReport::mixed(
                &pipeline,
                &[("red", Rgb::from_array(red)), (OTHER, Rgb::from_array(other))],
            );
            assert!(mixed.iter().all(|one| one.watts == Some(15.0)), "at full output");
            [mixed[0].flux, mixed[1].flux]
        };
        let full = fluxes([1.0; 3], [1.0; 3]);
        assert!((full[0] / full[1] - 2.0).abs() < 1e-12);
        let [red, other] = fluxes([0.25, 7.0, 9.0], [0.5; 3]);
        assert!((red / full[0] - 0.25).abs() < 1e-12 && (other / full[1] - 0.5).abs() < 1e-12);
    }

    #[test]
    fn more_flux_than_that_of_the_lamps_is_pointed_out() {
        let all = warnings(&pipeline(IES));
        assert!(
            all.len() == 1
                && all[0].contains(" lm, more than the 1500 lm of its lamps (a light output ratio of "),
            "{all:?}"
        );
        assert!(all[0].ends_with("set `flux: 1500` if the statement is right"), "{all:?}");
        for enough in ["1 -1 1", "1 9000 1", "6 1500 1"] {
            assert_eq!(warnings(&pipeline(&IES.replace("1 1500 1", enough))), [""; 0], "{enough}");
        }
    }
}
