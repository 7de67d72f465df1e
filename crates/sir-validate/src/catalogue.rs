//! Which case is run how.

use crate::data::Case;
use crate::trial::Trial;
use crate::{ValidateError, radiosity};

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
        "RE-02" => Plan::Skip("infinite plates; RE-05, concentric spheres with a narrow gap, is next to them"),
        id if id.starts_with("RE-") => Plan::Run(radiosity::surfaces(case)?),
        _ => Plan::Skip("this program does not know how to run it"),
    })
}
