//! The lights of a `Light` stage.

use glam::DVec3;
use sir_geom::{Light, LightKind, Rgb, Sky, SkyModel, Spread};

use crate::plan::lights::Lamp;
use crate::plan::pipeline::Action;
use crate::text::decode::Decoder;
use crate::text::reader::{Fields, Reader};
use crate::text::ron_tree::{Node, Value};

const LAMPS: [&str; 5] = ["Point", "Distant", "Panel", "Sky", "Environment"];

/// The narrowest spot \[degrees\].
const NARROWEST: f64 = 0.01;

impl<'a> Decoder<'a> {
    pub(crate) fn light(&mut self, node: Node<'a>) -> Option<Action> {
        let text = node.text.to_owned();
        let items = match node.value {
            Value::Items(mut items) if items.len() == 1 => match items.remove(0) {
                Node { value: Value::List(lamps), .. } => lamps,
                single => vec![single],
            },
            _ => Vec::new(),
        };
        if items.is_empty() {
            let help = "write `Light([Point(position: (1, 2, 3), intensity: 100)])`";
            self.reader.problem(node.text, "`Light` must have a list of lights", help);
            return None;
        }
        let (mut lamps, mut sky) = (Vec::new(), None);
        for item in items {
            let place = item.name();
            let lamp = self.lamp(item);
            if let Some(Lamp::Sky(_)) = lamp
                && let Some(first) = sky.replace(place)
            {
                let line = self.reader.line(first);
                let message = format!("a second sky; the first is in line {line}");
                self.reader.problem(place, message, "keep one `Sky` or `Environment`");
            }
            lamps.push(lamp);
        }
        let lamps = lamps.into_iter().collect::<Option<_>>()?;
        Some(Action::Light { lamps, text })
    }

    fn lamp(&mut self, node: Node<'a>) -> Option<Lamp> {
        match self.name_of(&node, "light", &LAMPS)? {
            "Point" => self.point(node),
            "Distant" => {
                let mut fields = self.reader.fields(node, "Distant", &["direction", "irradiance"]);
                let direction = self.unit(&mut fields, "direction", "(0, -1, 0)", None);
                let irradiance = self.reader.required(&mut fields, "irradiance", "1000");
                let irradiance = colour(&mut self.reader, &irradiance?, "irradiance")?;
                Some(nameless(LightKind::Distant { direction: direction?, irradiance }))
            }
            "Panel" => self.panel(node),
            "Sky" => self.sky(node),
            _ => {
                let mut fields = self.reader.fields(node, "Environment", &["radiance"]);
                let radiance = self.reader.required(&mut fields, "radiance", "100")?;
                let radiance = colour(&mut self.reader, &radiance, "radiance")?;
                Sky::everywhere(radiance).map(Lamp::Sky)
            }
        }
    }

    fn point(&mut self, node: Node<'a>) -> Option<Lamp> {
        let place = node.name();
        let mut fields = self.reader.fields(node, "Point", &["position", "intensity", "power", "spread"]);
        let position = self.reader.required(&mut fields, "position", "(1, 2, 3)");
        let position = position.and_then(|node| self.reader.vector(&node, "position", "(1, 2, 3)"));
        let spread = match fields.take("spread") {
            Some(node) => self.spread(node),
            None => Some(Spread::Isotropic),
        };
        let strength = self.either(&mut fields, place, ["intensity", "power"]);
        let (spread, (is_power, strength)) = (spread?, strength?);
        let intensity = if is_power { strength / spread.solid_angle() } else { strength };
        let position = DVec3::from(position?);
        Some(nameless(LightKind::Point { position, intensity, spread }))
    }

    fn spread(&mut self, node: Node<'a>) -> Option<Spread> {
        let text = node.text;
        match self.name_of(&node, "spread", &["Isotropic", "Lambertian", "Spot"])? {
            "Isotropic" => {
                self.reader.fields(node, "Isotropic", &[]);
                Some(Spread::Isotropic)
            }
            "Lambertian" => {
                let mut fields = self.reader.fields(node, "Lambertian", &["axis"]);
                let axis = self.unit(&mut fields, "axis", "(0, -1, 0)", None)?;
                Some(Spread::Lambertian { axis })
            }
            _ => {
                let mut fields = self.reader.fields(node, "Spot", &["axis", "inner", "outer"]);
                let axis = self.unit(&mut fields, "axis", "(0, -1, 0)", None);
                let inner = match fields.take("inner") {
                    Some(node) => self.reader.number(&node, "inner", "20"),
                    None => Some(0.0),
                };
                let outer = self.reader.required(&mut fields, "outer", "30");
                let outer = outer.and_then(|node| self.reader.number(&node, "outer", "30"));
                let (axis, inner, outer) = (axis?, inner?, outer?);
                let spot = Spread::spot(axis, inner.to_radians(), outer.to_radians());
                if spot.is_none() {
                    self.reader.problem(
                        text,
                        format!(
                            "a spot cannot be full up to {inner} and end at {outer} degrees from its axis"
                        ),
                        format!(
                            "choose `inner` from 0, and `outer` not below it, from {NARROWEST} to 180 degrees"
                        ),
                    );
                }
                spot
            }
        }
    }

    fn panel(&mut self, node: Node<'a>) -> Option<Lamp> {
        const EDGES: &str = "((1, 0, 0), (0, 0, 1))";
        let place = node.name();
        let mut fields = self.reader.fields(node, "Panel", &["corner", "edges", "exitance", "power"]);
        let corner = self.reader.required(&mut fields, "corner", "(1, 3, 2)");
        let corner = corner.and_then(|node| self.reader.vector(&node, "corner", "(1, 3, 2)"));
        let edges =
            self.reader.required(&mut fields, "edges", EDGES).and_then(|node| self.edges(&node, EDGES));
        let strength = self.either(&mut fields, place, ["exitance", "power"]);
        let (edges, (is_power, strength)) = (edges?, strength?);
        let area = edges[0].cross(edges[1]).length();
        let exitance = if is_power { strength / area } else { strength };
        Some(Lamp::Panel { corner: DVec3::from(corner?), edges, exitance })
    }

    /// Two vectors that span an area.
    fn edges(&mut self, node: &Node<'a>, example: &str) -> Option<[DVec3; 2]> {
        let help = format!("write for instance `edges: {example}`");
        let (Value::Items(items) | Value::List(items)) = &node.value else {
            let message = format!("`edges` must be two vectors, but it is {}", node.kind());
            self.reader.problem(node.text, message, help);
            return None;
        };
        let [a, b] = items.as_slice() else {
            let message = format!("`edges` must be two vectors, but there are {}", items.len());
            self.reader.problem(node.text, message, help);
            return None;
        };
        let [a, b] = [a, b].map(|n| self.reader.vector(n, "edges", example).map(DVec3::from));
        let (a, b) = (a?, b?);
        if a.cross(b).length() > 1e-9 * a.length() * b.length() {
            return Some([a, b]);
        }
        self.reader.problem(node.text, "the `edges` of a panel span no area", help);
        None
    }

    fn sky(&mut self, node: Node<'a>) -> Option<Lamp> {
        let mut fields = self.reader.fields(node, "Sky", &["model", "up", "horizontal", "ground"]);
        let up = self.unit(&mut fields, "up", "(0, 1, 0)", Some(DVec3::Y));
        let model = match fields.take("model") {
            Some(node) => self.sky_model(node, up),
            None => Some(SkyModel::Uniform),
        };
        let horizontal = self.reader.required(&mut fields, "horizontal", "10_000");
        let horizontal = horizontal.and_then(|node| colour(&mut self.reader, &node, "horizontal"));
        let ground = match fields.take("ground") {
            Some(node) => colour(&mut self.reader, &node, "ground"),
            None => Some(Rgb::ZERO),
        };
        Sky::new(up?, model?, horizontal?, ground?).map(Lamp::Sky)
    }

    /// A model that is possible under a zenith, if that is known.
    fn sky_model(&mut self, node: Node<'a>, up: Option<DVec3>) -> Option<SkyModel> {
        match self.name_of(&node, "sky model", &["Uniform", "Overcast", "Cie"])? {
            "Uniform" => {
                self.reader.fields(node, "Uniform", &[]);
                Some(SkyModel::Uniform)
            }
            "Overcast" => {
                self.reader.fields(node, "Overcast", &[]);
                Some(SkyModel::Overcast)
            }
            _ => {
                let text = node.text;
                let mut fields = self.reader.fields(node, "Cie", &["type", "sun"]);
                let kind = self.reader.required(&mut fields, "type", "12");
                let kind = kind.and_then(|node| self.reader.count(&node, "type", (1, 15), "12"));
                let sun = self.unit(&mut fields, "sun", "(1, 2, 1)", None);
                let (kind, sun, up) = (kind?, sun?, up?);
                if sun.dot(up) < 0.0 {
                    let help = "let `sun` point towards the sun, from the ground";
                    self.reader.problem(text, "the sun of this sky is below the horizon", help);
                    return None;
                }
                Some(SkyModel::General { kind: kind as u8, sun })
            }
        }
    }

    /// The one of two fields that is given, and whether it is the second.
    fn either(&mut self, fields: &mut Fields<'a>, place: &str, names: [&str; 2]) -> Option<(bool, Rgb)> {
        let [first, second] = names;
        match (fields.take(first), fields.take(second)) {
            (Some(node), None) => colour(&mut self.reader, &node, first).map(|colour| (false, colour)),
            (None, Some(node)) => colour(&mut self.reader, &node, second).map(|colour| (true, colour)),
            (None, None) if fields.is_excused() => None,
            (None, None) => {
                let message = format!("`{place}` has neither `{first}` nor `{second}`");
                self.reader.problem(place, message, format!("write for instance `{first}: 100`"));
                None
            }
            (Some(_), Some(node)) => {
                let message = format!("`{place}` has both `{first}` and `{second}`");
                self.reader.problem(node.text, message, "keep one of them");
                None
            }
        }
    }

    /// A direction, made of unit length; required if there is no default.
    fn unit(
        &mut self,
        fields: &mut Fields<'a>,
        name: &str,
        example: &str,
        default: Option<DVec3>,
    ) -> Option<DVec3> {
        let node = match default {
            None => self.reader.required(fields, name, example)?,
            Some(default) => match fields.take(name) {
                Some(node) => node,
                None => return Some(default),
            },
        };
        let direction = DVec3::from(self.reader.vector(&node, name, example)?).try_normalize();
        if direction.is_none() {
            let help = format!("write for instance `{name}: {example}`");
            self.reader.problem(
                node.text,
                format!("`{name}` must be a direction, but it has no length"),
                help,
            );
        }
        direction
    }
}

fn nameless(kind: LightKind) -> Lamp {
    Lamp::Light(Light { name: String::new(), kind })
}

/// Red, green and blue, none below zero; or one number for all three.
fn colour<'a>(reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<Rgb> {
    let numbers: Vec<Option<f64>> = match &node.value {
        Value::Number => vec![reader.number(node, name, "100"); 3],
        Value::Items(items) | Value::List(items) if items.len() == 3 => {
            items.iter().map(|n| reader.number(n, name, "(100, 90, 80)")).collect()
        }
        _ => {
            let message = format!("`{name}` must be a number or three, but it is {}", node.kind());
            reader.problem(node.text, message, format!("write for instance `{name}: (100, 90, 80)`"));
            return None;
        }
    };
    let numbers: Vec<f64> = numbers.into_iter().collect::<Option<_>>()?;
    let colour = Rgb::from_slice(&numbers);
    if colour.min_element() < 0.0 {
        let message = format!("`{name}` must not be below zero, but it is {}", node.text);
        reader.problem(node.text, message, format!("write for instance `{name}: (100, 90, 80)`"));
        return None;
    }
    Some(colour)
}
