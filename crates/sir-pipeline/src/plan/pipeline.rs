//! Contents of a pipeline file, with every default filled in.

use std::collections::BTreeSet;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use sir_mesh::Per;
use sir_radiosity::Points;

use crate::error::Error;
use crate::plan::light::Lamp;
use crate::plan::luminaire::Luminaire;
use crate::plan::save::{Output, Save};
use crate::plan::sensors::Place;
use crate::plan::stage::{Action, Stage, StageList};
use crate::text::diagnostic::{Diagnostic, Diagnostics};
use crate::text::field::Format as _;
use crate::text::formats::{Choice, count};
use crate::text::reader::{Fields, Reader};
use crate::text::record::{Body as _, Record as _, record};
use crate::text::ron_tree;
use crate::text::ron_tree::Value;
use crate::units::Units;

/// Maximum size of a pipeline file \[bytes\]: enough for thousands of outputs.
const MAX_BYTES: u64 = 1 << 18;

const UNITS: Choice<Units> =
    Choice(&[("Radiometric", Units::Radiometric), ("Photometric", Units::Photometric)]);

const POINTS: Choice<Points> = Choice(&[("Sobol", Points::Sobol), ("Random", Points::Random)]);

record! {
    /// Contents of a pipeline file.
    pub(crate) struct Content as "Pipeline", check Content::check {
        /// Seed of all random numbers. Runs with different seeds are independent; `--seed` on the command line takes
        /// precedence.
        pub seed: u64 = count(0, u64::MAX, 1).or(1);
        /// Radiometric or photometric units. With the latter, read lumens (lm) for W, lux (lx) for W/m², candelas for
        /// W/sr and cd/m² for W/(m² sr); nothing is converted.
        pub units: Units = UNITS.or(Units::Radiometric);
        /// Points of the lines of both shots: `Sobol`, a scrambled Sobol' sequence, has less noise. `Random` points are
        /// independent. Without repeats they are always random, see `Multipath`.
        pub points: Points = POINTS.or(Points::Sobol);
        /// Stages, in the order in which they run.
        pub stages: Vec<Stage> = StageList::ALL.required();
    }
}

impl Content {
    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        let needs = |what: &str, why: &str| format!("{what} needs photometric units ({why})");
        let has_luminaire = self.stages.iter().any(|stage| match &stage.action {
            Action::Light(light) => light.lamps.iter().any(|lamp| matches!(lamp, Lamp::Luminaire(_))),
            _ => false,
        });
        let has_glare =
            self.stages.iter().any(|stage| matches!(&stage.action, Action::Sensors(sensors) if sensors.ugr));
        let message = match (has_luminaire, has_glare) {
            _ if self.units == Units::Photometric => return,
            (true, _) => needs("a `Luminaire`", "its file states candelas"),
            (_, true) => needs("`ugr`", "glare depends on luminances in cd/m²"),
            _ => return,
        };
        reader.problem(fields.place_of("units"), message, "write `units: Photometric` in `Pipeline`");
    }
}

/// A valid pipeline: its stages are in a possible order, its numbers are in range and its inputs exist.
#[derive(Clone, Debug, PartialEq)]
pub struct Pipeline {
    /// Path of the file, as given.
    pub path: PathBuf,
    /// Text of the file.
    pub text: String,
    /// Seed of all random numbers. Default 1.
    pub seed: u64,
    /// Units of its numbers. Default radiometric.
    pub units: Units,
    /// Points of the lines of both shots. Default Sobol'.
    pub points: Points,
    /// Stages, in the order in which they run.
    pub stages: Vec<Stage>,
}

impl Pipeline {
    /// Reads the pipeline file `path`.
    ///
    /// # Errors
    ///
    /// Returns all problems of the file, or the reason why it cannot be read.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let mut bytes = Vec::new();
        // The file may be endless, such as /dev/zero.
        std::fs::File::open(path)
            .and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes))
            .map_err(|source| Error::ReadPipeline { path: path.to_owned(), source })?;
        if bytes.len() as u64 > MAX_BYTES {
            return Err(Error::LongPipeline { path: path.to_owned(), most: MAX_BYTES });
        }
        let text = String::from_utf8(sir_geom::utf8_text(bytes))
            .map_err(|_| Error::NotText { path: path.to_owned() })?;
        Ok(Self::parse(&text, path)?)
    }

    /// Parses the text of a pipeline file. Paths in it are relative to the folder of `path`.
    ///
    /// # Errors
    ///
    /// Returns all problems of the text, each with its position and a suggested fix. A missing input file is a problem,
    /// too.
    pub fn parse(text: &str, path: &Path) -> Result<Self, Diagnostics> {
        // `ron` rejects a comment in the last line unless a line break follows.
        // A byte order mark becomes as many spaces, so that places stay what they are.
        let source = match text.strip_prefix('\u{feff}') {
            Some(rest) => format!("   {rest}\n"),
            None => format!("{text}\n"),
        };
        let mut reader = Reader::new(&source, path.parent().unwrap_or(Path::new("")));
        let content = match ron_tree::parse(&source) {
            Ok(root)
                if matches!(root.name(), "" | Content::NAME)
                    && matches!(root.value, Value::Fields(_) | Value::Items(_)) =>
            {
                Content::read(&mut reader, &root)
            }
            Ok(root) => {
                let message = format!("the file must contain `Pipeline(…)`, but it contains {}", root.kind());
                reader.problem(root.text, message, "write `Pipeline(stages: […])`");
                None
            }
            Err(problem) => {
                reader.problems.push(problem);
                None
            }
        };
        match content {
            Some(Content { seed, units, points, stages }) if reader.problems.is_empty() => {
                Ok(Self { path: path.to_owned(), text: text.to_owned(), seed, units, points, stages })
            }
            _ => Err(Diagnostics::new(path, text, reader.problems)),
        }
    }

    /// Writes the pipeline as RON, independent of its original text. Input paths are written as they are stored: joined
    /// to the folder of the file.
    #[must_use]
    pub fn to_ron(&self) -> String {
        let content =
            Content { seed: self.seed, units: self.units, points: self.points, stages: self.stages.clone() };
        let fields = content.write_fields().into_iter();
        let fields: String = fields.map(|(name, value)| format!("    {name}: {value},\n")).collect();
        format!("{}(\n{fields})\n", Content::NAME)
    }

    /// Returns problems of this pipeline in displayable form.
    #[must_use]
    pub fn diagnostics(&self, problems: Vec<Diagnostic>) -> Diagnostics {
        Diagnostics::new(&self.path, &self.text, problems)
    }

    /// Returns all stages. The stages of a `Repeat` replace it, once.
    pub fn flat_stages(&self) -> impl Iterator<Item = &Stage> {
        self.stages.iter().flat_map(Stage::flat)
    }

    /// Returns all luminaires, with arrays as one, in the order of the file.
    pub fn luminaires(&self) -> impl Iterator<Item = &Luminaire> {
        let lamps = self.stages.iter().flat_map(|stage| match &stage.action {
            Action::Light(light) => light.lamps.as_slice(),
            _ => &[],
        });
        lamps.filter_map(|lamp| if let Lamp::Luminaire(luminaire) = lamp { Some(luminaire) } else { None })
    }

    /// Returns all outputs of `Save` stages, in the order of the file.
    pub fn outputs(&self) -> impl Iterator<Item = &Output> {
        self.stages.iter().flat_map(|stage| match &stage.action {
            Action::Save(Save { outputs }) => outputs.as_slice(),
            _ => &[],
        })
    }

    /// True if there is a page.
    pub(crate) fn has_page(&self) -> bool {
        self.outputs().any(|output| matches!(output, Output::Report(_)))
    }

    /// True if an output shows the direct light.
    pub(crate) fn shows_direct(&self) -> bool {
        let shows = |output: &Output| match output {
            Output::Report(_) => true,
            Output::Lightmap(lightmap) => lightmap.direct,
            _ => false,
        };
        self.outputs().any(shows)
    }

    /// Returns the parts of the scene for which there are tables, each once.
    pub(crate) fn parts_of_tables(&self) -> BTreeSet<Per> {
        let per = |output: &Output| if let Output::Table(table) = output { table.per } else { None };
        self.outputs().filter_map(per).collect()
    }

    /// Returns the paths of all files in the run directory that the stages write.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let sensors = self.stages.iter().filter_map(|stage| match &stage.action {
            Action::Sensors(sensors) => Some(sensors),
            _ => None,
        });
        let measured = sensors.flat_map(|sensors| [Some(sensors.table()), sensors.map()]).flatten();
        self.outputs().flat_map(Output::files).chain(measured).collect()
    }

    /// Returns the paths of the pipeline file and of all files that it names.
    pub(crate) fn inputs(&self) -> impl Iterator<Item = &Path> {
        let points = self.stages.iter().filter_map(|stage| match &stage.action {
            Action::Sensors(sensors) => match &sensors.at.value {
                Place::File(file) => Some(file.path.as_path()),
                _ => None,
            },
            _ => None,
        });
        [self.path.as_path(), self.scene_path()].into_iter().chain(points)
    }

    /// Returns the path of the scene file.
    #[must_use]
    pub fn scene_path(&self) -> &Path {
        let path = self.stages.iter().find_map(|stage| match &stage.action {
            Action::Load(load) => Some(load.path.as_path()),
            _ => None,
        });
        path.unwrap_or(Path::new(""))
    }
}
