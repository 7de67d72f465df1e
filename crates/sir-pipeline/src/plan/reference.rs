//! Tables of the fields of a pipeline file, for the reference.

use crate::plan::focus::Focus;
use crate::plan::image::{Camera, Image};
use crate::plan::light::Distant;
use crate::plan::light_group::FileLights;
use crate::plan::lightmap::Lightmap;
use crate::plan::lines::{FirstShot, SecondShot, ShadowRays, Solve};
use crate::plan::load::Load;
use crate::plan::luminaire::Luminaire;
use crate::plan::measure::SemiCylindrical;
use crate::plan::multipath::{Multipath, Replicas};
use crate::plan::panel::Panel;
use crate::plan::pipeline::Content;
use crate::plan::point::{Lambertian, Point, Spot};
use crate::plan::probes::Probes;
use crate::plan::require::Require;
use crate::plan::save::{Gltf, Report, Table};
use crate::plan::sensors::{Grid, Plane, SensorPoint, Sensors};
use crate::plan::sky::{Cie, Environment, Sky};
use crate::plan::stage::Repeat;
use crate::plan::subdivide::Subdivide;
use crate::text::field::Row;
use crate::text::record::Record;

/// Returns a Markdown table of fields for each record, with its name in a pipeline file.
#[must_use]
pub fn field_tables() -> Vec<(&'static str, String)> {
    vec![
        table::<Content>(),
        table::<Load>(),
        table::<Point>(),
        table::<Lambertian>(),
        table::<Spot>(),
        table::<Distant>(),
        table::<Panel>(),
        table::<Luminaire>(),
        table::<Sky>(),
        table::<Cie>(),
        table::<Environment>(),
        table::<FileLights>(),
        table::<Subdivide>(),
        table::<Focus>(),
        table::<Solve>(),
        table::<FirstShot>(),
        table::<ShadowRays>(),
        table::<SecondShot>(),
        table::<Multipath>(),
        table::<Replicas>(),
        table::<Repeat>(),
        table::<Sensors>(),
        table::<SensorPoint>(),
        table::<Grid>(),
        table::<Plane>(),
        table::<SemiCylindrical>(),
        table::<Require>(),
        table::<Probes>(),
        table::<Image>(),
        table::<Camera>(),
        table::<Gltf>(),
        table::<Table>(),
        table::<Report>(),
        table::<Lightmap>(),
    ]
}

fn table<T: Record>() -> (&'static str, String) {
    let rows = T::rows();
    let has_units = rows.iter().any(|row| !row.unit.is_empty());
    let line = |[name, values, unit, default, meaning]: [&str; 5]| {
        let unit = if has_units { format!(" {unit} |") } else { String::new() };
        format!("| {name} | {values} |{unit} {default} | {meaning} |\n")
    };
    let mut text = line([&format!("field of `{}`", T::NAME), "value", "unit", "default", "meaning"]);
    text += &line(["---"; 5]);
    for Row { name, values, unit, default, meaning } in &rows {
        text += &line([&format!("`{name}`"), values, unit, default, meaning.trim()]);
    }
    (T::NAME, text)
}
