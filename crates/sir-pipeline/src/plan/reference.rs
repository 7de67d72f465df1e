//! The records of a pipeline file and their fields, for the reference and for editors.

use serde::Serialize;

use crate::plan::focus::Focus;
use crate::plan::image::{Camera, Image};
use crate::plan::light::{Distant, Lamp};
use crate::plan::light_group::FileLights;
use crate::plan::lightmap::Lightmap;
use crate::plan::lines::{FirstShot, SecondShot, ShadowRays, Solve};
use crate::plan::load::Load;
use crate::plan::luminaire::Luminaire;
use crate::plan::measure::{Measure, SemiCylindrical};
use crate::plan::multipath::{Multipath, Replicas, Transport};
use crate::plan::panel::Panel;
use crate::plan::pipeline::Content;
use crate::plan::point::{Lambertian, Point, Spot, Spread};
use crate::plan::probes::Probes;
use crate::plan::require::Require;
use crate::plan::save::{Gltf, Output, Report, Table};
use crate::plan::sensors::{Grid, Place, Plane, SensorPoint, Sensors};
use crate::plan::sky::{Cie, Environment, Sky, SkyModel};
use crate::plan::stage::{Action, Repeat};
use crate::plan::subdivide::Subdivide;
use crate::text::field::Row;
use crate::text::record::{Choose, Record};

/// Version of the JSON layout of a [`Schema`].
const VERSION: u32 = 1;

/// What a pipeline file may contain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Schema {
    /// Version of the JSON layout.
    pub version: u32,
    /// Records: `Name(field: value, …)`.
    pub records: Vec<RecordSchema>,
    /// Choices among records and names.
    pub choices: Vec<ChoiceSchema>,
}

/// A record and its fields.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordSchema {
    /// Name in a pipeline file.
    pub name: &'static str,
    /// Fields, in their order.
    pub fields: Vec<Row>,
}

/// A choice.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChoiceSchema {
    /// Noun for what is chosen, such as `stage`.
    pub what: &'static str,
    /// Names of the variants. Those that have fields are records.
    pub variants: &'static [&'static str],
}

impl RecordSchema {
    fn of<T: Record>() -> Self {
        Self { name: T::NAME, fields: T::rows() }
    }

    /// Returns a Markdown table of the fields.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let has_units = self.fields.iter().any(|row| !row.unit.is_empty());
        let line = |[name, values, unit, default, meaning]: [&str; 5]| {
            let unit = if has_units { format!(" {unit} |") } else { String::new() };
            format!("| {name} | {values} |{unit} {default} | {meaning} |\n")
        };
        let mut text = line([&format!("field of `{}`", self.name), "value", "unit", "default", "meaning"]);
        text += &line(["---"; 5]);
        for Row { name, values, unit, default, meaning } in &self.fields {
            text += &line([&format!("`{name}`"), values, unit, default, meaning.trim()]);
        }
        text
    }
}

impl ChoiceSchema {
    fn of<T: Choose>() -> Self {
        Self { what: T::WHAT, variants: T::NAMES }
    }
}

/// Returns what a pipeline file may contain.
#[must_use]
pub fn schema() -> Schema {
    Schema {
        version: VERSION,
        records: vec![
            RecordSchema::of::<Content>(),
            RecordSchema::of::<Load>(),
            RecordSchema::of::<Point>(),
            RecordSchema::of::<Lambertian>(),
            RecordSchema::of::<Spot>(),
            RecordSchema::of::<Distant>(),
            RecordSchema::of::<Panel>(),
            RecordSchema::of::<Luminaire>(),
            RecordSchema::of::<Sky>(),
            RecordSchema::of::<Cie>(),
            RecordSchema::of::<Environment>(),
            RecordSchema::of::<FileLights>(),
            RecordSchema::of::<Subdivide>(),
            RecordSchema::of::<Focus>(),
            RecordSchema::of::<Solve>(),
            RecordSchema::of::<FirstShot>(),
            RecordSchema::of::<ShadowRays>(),
            RecordSchema::of::<SecondShot>(),
            RecordSchema::of::<Multipath>(),
            RecordSchema::of::<Replicas>(),
            RecordSchema::of::<Repeat>(),
            RecordSchema::of::<Sensors>(),
            RecordSchema::of::<SensorPoint>(),
            RecordSchema::of::<Grid>(),
            RecordSchema::of::<Plane>(),
            RecordSchema::of::<SemiCylindrical>(),
            RecordSchema::of::<Require>(),
            RecordSchema::of::<Probes>(),
            RecordSchema::of::<Image>(),
            RecordSchema::of::<Camera>(),
            RecordSchema::of::<Gltf>(),
            RecordSchema::of::<Table>(),
            RecordSchema::of::<Report>(),
            RecordSchema::of::<Lightmap>(),
        ],
        choices: vec![
            ChoiceSchema::of::<Action>(),
            ChoiceSchema::of::<Lamp>(),
            ChoiceSchema::of::<SkyModel>(),
            ChoiceSchema::of::<Spread>(),
            ChoiceSchema::of::<Transport>(),
            ChoiceSchema::of::<Place>(),
            ChoiceSchema::of::<Measure>(),
            ChoiceSchema::of::<Output>(),
        ],
    }
}
