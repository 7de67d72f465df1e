//! Emitting parallelograms.

use glam::DVec3;
use sir_geom::Rgb;

use crate::plan::light_group::group;
use crate::plan::scene_light::SceneLight;
use crate::text::field::{Format, OneOf};
use crate::text::formats::{Color, Vector};
use crate::text::reader::Reader;
use crate::text::record::record;
use crate::text::ron_tree::Node;

record! {
    /// Black parallelogram that emits on the side from which its edges, in their order, run counterclockwise.
    pub struct Panel {
        /// One of its corners.
        pub corner: DVec3 = Vector([1.0, 3.0, 2.0]).required().unit("m");
        /// Vectors from the corner to the two adjacent ones.
        pub edges: [DVec3; 2] = Edges.required().unit("m");
        /// Emitted exitance or power.
        pub strength: PanelStrength = strength();
        /// Light group, which `sir mix` can dim after the run.
        pub group: Option<String> = group();
    }
}

/// Emitted exitance or power of a panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PanelStrength {
    /// Emitted exitance per band \[W/m²\].
    Exitance(Rgb),
    /// Emitted power per band \[W\].
    Power(Rgb),
}

fn strength() -> OneOf<PanelStrength> {
    OneOf::new()
        .field(
            "exitance",
            Color(100.0),
            "W/m²",
            "Emitted power per area.",
            PanelStrength::Exitance,
            |strength| {
                if let PanelStrength::Exitance(color) = strength { Some(*color) } else { None }
            },
        )
        .field("power", Color(100.0), "W", "Total emitted power.", PanelStrength::Power, |strength| {
            if let PanelStrength::Power(color) = strength { Some(*color) } else { None }
        })
}

impl Panel {
    /// Converts the panel for a scene.
    pub(crate) fn to_scene(&self) -> SceneLight {
        let Self { corner, edges, strength, .. } = *self;
        let exitance = match strength {
            PanelStrength::Exitance(exitance) => exitance,
            PanelStrength::Power(power) => power / edges[0].cross(edges[1]).length(),
        };
        SceneLight::Panel { corner, edges, exitance }
    }
}

/// Format of two vectors that span an area.
#[derive(Clone, Copy)]
struct Edges;

impl Format for Edges {
    type Value = [DVec3; 2];

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<[DVec3; 2]> {
        let Some(items) = node.elements() else {
            reader.wrong_value(node, name, "two vectors", self.example());
            return None;
        };
        let [a, b] = items else {
            let message = format!("`{name}` must be two vectors, but there are {}", items.len());
            reader.invalid_value(node, name, message, self.example());
            return None;
        };
        for vector in [a, b] {
            if vector.elements().is_none_or(|numbers| numbers.len() != 3) {
                let message = format!("`{name}` must be two vectors of three numbers");
                reader.invalid_value(vector, name, message, self.example());
                return None;
            }
        }
        let [a, b] = [a, b].map(|vector| Vector([1.0, 0.0, 0.0]).read(reader, vector, name));
        let (a, b) = (a?, b?);
        if a.cross(b).length() > 1e-9 * a.length() * b.length() {
            return Some([a, b]);
        }
        reader.invalid_value(node, name, format!("the `{name}` of a panel span no area"), self.example());
        None
    }

    fn write(&self, value: &[DVec3; 2]) -> String {
        let [a, b] = value.map(|vector| Vector([0.0; 3]).write(&vector));
        format!("({a}, {b})")
    }

    fn describe(&self) -> String {
        "`((x, y, z), (x, y, z))`".into()
    }

    fn example(&self) -> String {
        "((1, 0, 0), (0, 0, 1))".into()
    }
}
