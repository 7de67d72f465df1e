//! Which case is run how.

use crate::data::Case;
use crate::error::ValidateError;
use crate::points::Setting;
use crate::trial::Trial;
use crate::{cube, factors, flux, points, radiosity};

/// What is to be done for a case.
pub(crate) enum Plan<'a> {
    /// These runs.
    Run(Vec<Trial<'a>>),
    /// Nothing, for this reason.
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

/// What is to be done for a case: by its name, which says what kind it is.
pub(crate) fn plan(case: &Case) -> Result<Plan<'_>, ValidateError> {
    Ok(match case.id.as_str() {
        "RE-01" => Plan::Run(radiosity::enclosures(case)?),
        "RE-02" => {
            Plan::Skip("infinite plates; RE-05, concentric spheres with a narrow gap, is next to them")
        }
        id if id.starts_with("RE-") => Plan::Run(radiosity::surfaces(case)?),
        id if id.starts_with("VF-") => Plan::Run(factors::factors(case)?),
        "CIE-5.2" => Plan::Run(points::points(case, Setting::PointLight)?),
        "CIE-5.3" => Plan::Run(points::points(case, Setting::Lamp)?),
        "CIE-5.4a" => Plan::Run(flux::of_point(case)?),
        "CIE-5.4b" => Plan::Run(flux::of_openings(case)?),
        "CIE-5.6a" | "CIE-5.6b" | "CIE-5.7" => Plan::Run(points::points(case, Setting::Reflector)?),
        "CIE-5.8" => Plan::Run(cube::cube(case)?),
        "CIE-5.9a" | "CIE-5.9b" => Plan::Run(points::points(case, Setting::Sky)?),
        _ => Plan::Skip("this program does not know how to run it"),
    })
}
