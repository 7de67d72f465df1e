//! The fields of `Sensors` in a pipeline file.

use std::path::PathBuf;

use glam::DVec3;
use sir_radiosity::{Sensor, SensorSettings};

use crate::plan::pipeline::Action;
use crate::plan::sensors::{Grid, Place, Plane, Sensors};
use crate::text::decode::Decoder;
use crate::text::points_file;
use crate::text::reader::Fields;
use crate::text::ron_tree::{Node, Value};

const PLACES: [&str; 4] = ["Points", "File", "Grid", "Plane"];
const DEFAULT_RAYS: u64 = 16_384;
/// Most rays of a sensor: all patches that they meet are remembered for the error.
const MOST_RAYS: u64 = 10_000_000;

impl<'a> Decoder<'a> {
    pub(crate) fn sensors(&mut self, node: Node<'a>) -> Option<Action> {
        let mut fields = self.reader.fields(node, "Sensors", &["name", "at", "rays", "error"]);
        let name = self.reader.required(&mut fields, "name", "\"desk\"");
        let at = self.reader.required(&mut fields, "at", "Plane(height: 0.75, spacing: 0.25)");
        let rays = match fields.take("rays") {
            Some(node) => self.reader.count(&node, "rays", (1, MOST_RAYS), "16_384"),
            None => Some(DEFAULT_RAYS),
        };
        let error = match fields.take("error") {
            Some(node) => self.reader.positive(&node, "error", "0.005"),
            None => Some(0.0),
        };
        let place = at.and_then(|node| {
            let span = self.reader.span(node.name());
            self.place(node).map(|place| (place, span))
        });
        let on_grid = matches!(place, Some((Place::Grid(_) | Place::Plane(_), _)));
        let named = name.and_then(|node| {
            let name = self.reader.text(&node, "name", "\"desk\"")?;
            let table = self.claim(&node, &format!("{name}.csv"))?;
            let map = if on_grid { Some(self.claim(&node, &format!("{name}.png"))?) } else { None };
            Some((name, table, map))
        });
        let ((name, table, map), (at, span)) = (named?, place?);
        let settings = SensorSettings { rays: rays?, error: error? };
        Some(Action::Sensors(Sensors { table, map, name, at, settings, span }))
    }

    fn place(&mut self, node: Node<'a>) -> Option<Place> {
        match self.name_of(&node, "place", &PLACES)? {
            "Points" => self.points(node).map(Place::Points),
            "File" => self.file_of_points(node).map(Place::Points),
            "Grid" => self.grid(node).map(Place::Grid),
            _ => self.plane(node).map(Place::Plane),
        }
    }

    fn points(&mut self, node: Node<'a>) -> Option<Vec<Sensor>> {
        let nodes = match node.value {
            Value::Items(mut items) if items.len() == 1 => match items.remove(0).value {
                Value::List(nodes) if !nodes.is_empty() => nodes,
                _ => Vec::new(),
            },
            _ => Vec::new(),
        };
        if nodes.is_empty() {
            let help = "write `Points([(position: (1, 0.75, 2), direction: (0, 1, 0))])`";
            self.reader.problem(node.text, "`Points` must have a list of points", help);
            return None;
        }
        let sensors: Vec<_> = nodes.into_iter().map(|node| self.sensor(node)).collect();
        sensors.into_iter().collect()
    }

    fn sensor(&mut self, node: Node<'a>) -> Option<Sensor> {
        let text = node.text;
        let mut fields = self.reader.fields(node, "Points", &["position", "direction"]);
        let position = self.vector_of(&mut fields, "position", "(1, 0.75, 2)");
        let direction = self.vector_of(&mut fields, "direction", "(0, 1, 0)");
        let sensor = Sensor::new(position?, direction?);
        if sensor.is_none() {
            self.no_direction(text);
        }
        sensor
    }

    /// A file of points, which is read now: what is wrong with it is a problem of the pipeline.
    fn file_of_points(&mut self, node: Node<'a>) -> Option<Vec<Sensor>> {
        let example = "write for instance `File(\"points.txt\")`; paths are relative to the folder of the pipeline file";
        let name = match &node.value {
            Value::Items(items) => match items.as_slice() {
                [Node { value: Value::Text(name), .. }] if !name.is_empty() => name.clone(),
                _ => String::new(),
            },
            _ => String::new(),
        };
        if name.is_empty() {
            self.reader.problem(node.text, "`File` must have the path of a file in quotes", example);
            return None;
        }
        let path: PathBuf = self.folder.join(name);
        let read = std::fs::read_to_string(&path);
        match read.map(|text| points_file::parse(&text)) {
            Ok(Ok(sensors)) => Some(sensors),
            Ok(Err((line, why))) => {
                let message = format!("{}:{line} is no point: {why}", path.display());
                self.reader.problem(
                    node.text,
                    message,
                    "write `x y z dx dy dz` in a line each; `#` begins a comment",
                );
                None
            }
            Err(error) => {
                let message = format!("cannot read the points of {}: {error}", path.display());
                self.reader.problem(node.text, message, example);
                None
            }
        }
    }

    fn grid(&mut self, node: Node<'a>) -> Option<Grid> {
        let text = node.text;
        let mut fields =
            self.reader.fields(node, "Grid", &["corner", "along", "across", "spacing", "direction"]);
        let corner = self.vector_of(&mut fields, "corner", "(0, 0.75, 2)");
        let along = self.vector_of(&mut fields, "along", "(2, 0, 0)");
        let across = self.vector_of(&mut fields, "across", "(0, 0, -1)");
        let spacing = self.spacing(&mut fields);
        let direction = match fields.take("direction") {
            Some(node) => self.reader.vector(&node, "direction", "(0, 1, 0)").map(|v| Some(DVec3::from(v))),
            None => Some(None),
        };
        let (corner, along, across, direction) = (corner?, along?, across?, direction?);
        let Some(normal) = along.cross(across).try_normalize() else {
            let help = "make `along` and `across` edges of different directions, each with a length";
            self.reader.problem(text, "this grid has no area", help);
            return None;
        };
        let Some(direction) = direction.unwrap_or(normal).try_normalize() else {
            self.no_direction(text);
            return None;
        };
        Some(Grid { corner, along, across, spacing: spacing?, direction })
    }

    fn plane(&mut self, node: Node<'a>) -> Option<Plane> {
        let text = node.text;
        let mut fields = self.reader.fields(node, "Plane", &["height", "spacing", "border", "up"]);
        let height = self.reader.required(&mut fields, "height", "0.75");
        let height = height.and_then(|node| self.reader.number(&node, "height", "0.75"));
        let spacing = self.spacing(&mut fields);
        let border = match fields.take("border") {
            Some(node) => self.reader.number(&node, "border", "0.5").and_then(|border| {
                if border >= 0.0 {
                    return Some(border);
                }
                let message = format!("`border` must not be negative, but it is {}", node.text);
                self.reader.problem(node.text, message, "write for instance `border: 0.5`");
                None
            }),
            None => Some(0.0),
        };
        let up = match fields.take("up") {
            Some(node) => self.reader.vector(&node, "up", "(0, 1, 0)").map(|v| Some(DVec3::from(v))),
            None => Some(None),
        }?;
        if up.is_some_and(|up| up.try_normalize().is_none()) {
            self.no_direction(text);
            return None;
        }
        Some(Plane { height: height?, spacing: spacing?, border: border?, up })
    }

    fn spacing(&mut self, fields: &mut Fields<'a>) -> Option<f64> {
        let node = self.reader.required(fields, "spacing", "0.25")?;
        self.reader.positive(&node, "spacing", "0.25")
    }

    fn vector_of(&mut self, fields: &mut Fields<'a>, name: &str, example: &str) -> Option<DVec3> {
        let node = self.reader.required(fields, name, example)?;
        self.reader.vector(&node, name, example).map(DVec3::from)
    }

    fn no_direction(&mut self, text: &str) {
        self.reader.problem(text, "a direction has no length", "write for instance `(0, 1, 0)`, which is up");
    }
}
