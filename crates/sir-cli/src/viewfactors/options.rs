//! The arguments of `sir viewfactors`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::ValueEnum;
use sir_geom::SidesPolicy;
use sir_pipeline::text::whole_number;
use sir_pipeline::view_factors::{By, ViewFactorsOptions};
use sir_radiosity::{Accuracy, ViewFactorSettings};

use crate::numbers::threads;

/// Arguments of `sir viewfactors`.
#[derive(Debug, clap::Args)]
pub struct ViewFactorsArgs {
    /// The scene file: .gltf, .glb or .obj.
    pub scene: PathBuf,
    /// Criterion by which surfaces are grouped.
    #[arg(long, value_enum, default_value_t)]
    pub by: ByOption,
    /// Sides of surfaces that send and receive. The other sides absorb: the share that arrives there is `blocked`.
    #[arg(long, value_enum, default_value_t)]
    pub sides: SidesOption,
    /// Trace lines until no factor has a larger standard error; default 0.001, unless --lines is given.
    #[arg(long, value_name = "E", value_parser = error)]
    pub error: Option<f64>,
    /// With --error E: accept a standard error of R times the factor where that is more than E.
    #[arg(long, value_name = "R", value_parser = relative, requires = "error")]
    pub relative: Option<f64>,
    /// Maximum number of lines of all groups together. The reported number of lines reproduces the result.
    #[arg(long, value_name = "N", value_parser = lines)]
    pub lines: Option<u64>,
    /// Seed of the random numbers.
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// Also adjust the factors, within their errors, to satisfy reciprocity and row sums of 1.
    #[arg(long)]
    pub closure: bool,
    /// Directory for viewfactors.json, factors.csv, errors.csv and pairs.csv; default: nothing is written.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the view factors in the directory given with --out.
    #[arg(long, requires = "out")]
    pub force: bool,
    /// Threads of each process, 1 to 4096; default: one per processor core. The result does not depend on it.
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<NonZeroUsize>,
    /// Show no progress; warnings and errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print the content of viewfactors.json instead of a table.
    #[arg(long)]
    pub json: bool,
}

/// Criterion by which surfaces are grouped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ByOption {
    /// The material.
    #[default]
    Material,
    /// The name: of the node, or else of its mesh (glTF); in an `o` or `g` statement (OBJ).
    Group,
}

/// Sides of surfaces that send and receive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum SidesOption {
    /// As in the file: `doubleSided` in glTF; both in OBJ.
    #[default]
    AsAuthored,
    /// Both sides of every surface.
    Both,
    /// Only fronts.
    Front,
}

impl From<SidesOption> for SidesPolicy {
    fn from(sides: SidesOption) -> Self {
        match sides {
            SidesOption::AsAuthored => Self::AsAuthored,
            SidesOption::Both => Self::Both,
            SidesOption::Front => Self::Front,
        }
    }
}

impl From<ByOption> for By {
    fn from(by: ByOption) -> Self {
        match by {
            ByOption::Material => Self::Material,
            ByOption::Group => Self::Group,
        }
    }
}

/// Target standard error if neither an error nor a number of lines is given.
const DEFAULT_ERROR: f64 = 1e-3;

impl ViewFactorsArgs {
    /// Returns the stopping criteria and the seed.
    #[must_use]
    pub fn settings(&self) -> ViewFactorSettings {
        let error = self.error.or(self.lines.is_none().then_some(DEFAULT_ERROR));
        ViewFactorSettings {
            accuracy: error.map(|error| Accuracy { error, relative: self.relative.unwrap_or(0.0) }),
            lines: self.lines.unwrap_or(u64::MAX),
            seed: self.seed,
        }
    }

    /// Returns the options of the computation.
    #[must_use]
    pub fn options(&self) -> ViewFactorsOptions {
        ViewFactorsOptions {
            scene: self.scene.clone(),
            by: self.by.into(),
            sides: self.sides.into(),
            settings: self.settings(),
            closure: self.closure,
            out: self.out.clone(),
            force: self.force,
            threads: self.threads,
        }
    }
}

fn between(text: &str, least: f64, most: f64) -> Result<f64, String> {
    let number = text.parse().ok().filter(|x| (least..=most).contains(x));
    number.ok_or_else(|| format!("write a number from {least} to {most}"))
}

fn error(text: &str) -> Result<f64, String> {
    between(text, 1e-6, 0.5)
}

fn relative(text: &str) -> Result<f64, String> {
    between(text, 1e-4, 1.0)
}

fn lines(text: &str) -> Result<u64, String> {
    let number = whole_number(text).filter(|n| (1..=1 << 50).contains(n));
    number.ok_or_else(|| "write a whole number from 1 to 2^50, such as 1_000_000".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: ViewFactorsArgs,
    }

    fn parse(text: &str) -> Result<ViewFactorSettings, clap::Error> {
        Line::try_parse_from(["sir"].into_iter().chain(text.split(' '))).map(|line| line.args.settings())
    }

    #[test]
    fn lines_or_an_error_say_when_to_stop() {
        let settings = |text| parse(text).unwrap();
        assert_eq!(
            settings("a.obj"),
            ViewFactorSettings { lines: u64::MAX, ..ViewFactorSettings::to_error(1e-3, 1) }
        );
        assert_eq!(settings("a.obj --lines 1_000 --seed 7"), ViewFactorSettings::of_lines(1000, 7));
        let both = settings("a.obj --lines 1000 --error 0.01 --relative 0.1");
        assert_eq!((both.lines, both.accuracy), (1000, Some(Accuracy { error: 0.01, relative: 0.1 })));
        for bad in [
            "",
            "a.obj --error 0",
            "a.obj --error 0.6",
            "a.obj --error nan",
            "a.obj --relative 0.1",
            "a.obj --error 0.1 --relative 2",
            "a.obj --lines 0",
            "a.obj --lines 1e99",
            "a.obj --by color",
            "a.obj --sides none",
            "a.obj --force",
            "a.obj --threads 0",
        ] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
