//! Selection of the trials of each case.

use crate::data::Case;
use crate::error::ValidateError;
use crate::points::Lighting;
use crate::trial::Trial;
use crate::{cube, factors, flux, luminaire, points, radiosity};

/// Plan for a case.
pub(crate) enum Plan<'a> {
    /// Trials to run.
    Run(Vec<Trial<'a>>),
    /// The case is skipped, for this reason.
    Skip(&'static str),
}

impl<'a> Plan<'a> {
    pub(crate) fn trials(&self) -> &[Trial<'a>] {
        match self {
            Self::Run(trials) => trials,
            Self::Skip(_) => &[],
        }
    }

    pub(crate) fn skipped(&self) -> Option<&'static str> {
        match self {
            Self::Run(_) => None,
            Self::Skip(why) => Some(why),
        }
    }
}

/// Returns the plan for a case, chosen by its ID.
pub(crate) fn plan(case: &Case) -> Result<Plan<'_>, ValidateError> {
    Ok(match case.id.as_str() {
        "RE-01" => Plan::Run(radiosity::enclosures(case)?),
        "RE-02" => {
            Plan::Skip("a scene cannot be infinite; RE-05, concentric spheres with a narrow gap, is similar")
        }
        id if id.starts_with("RE-") => Plan::Run(radiosity::surfaces(case)?),
        id if id.starts_with("VF-") => Plan::Run(factors::factors(case)?),
        "LU-06" => Plan::Run(luminaire::glare(case)?),
        id if id.starts_with("LU-") => Plan::Run(luminaire::luminaires(case)?),
        "CIE-5.2" => Plan::Run(points::points(case, Lighting::PointLight)?),
        "CIE-5.3" => Plan::Run(points::points(case, Lighting::Lamp)?),
        "CIE-5.4a" => Plan::Run(flux::of_point(case)?),
        "CIE-5.4b" => Plan::Run(flux::of_openings(case)?),
        "CIE-5.6a" | "CIE-5.6b" | "CIE-5.7" => Plan::Run(points::points(case, Lighting::Reflector)?),
        "CIE-5.8" => Plan::Run(cube::cube(case)?),
        "CIE-5.9a" | "CIE-5.9b" => Plan::Run(points::points(case, Lighting::Sky)?),
        _ => Plan::Skip("SIR has no trial for a case with this ID"),
    })
}
