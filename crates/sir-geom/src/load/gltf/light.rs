//! Punctual lights (`KHR_lights_punctual`).

use ::gltf::json::extensions::scene::khr_lights_punctual::{Light as Source, Type};
use ::gltf::json::scene::Node;
use ::gltf::json::validation::Checked;
use glam::{DAffine3, DVec3};

use crate::color::Rgb;
use crate::light::{Light, LightKind, Spread};
use crate::load::error::LoadError;
use crate::load::gltf::data::lookup;
use crate::load::gltf::reader::{Reader, label};

impl Reader<'_> {
    /// Adds the light of a node, if it has one.
    pub(super) fn light(&mut self, node: &Node, to_world: &DAffine3) -> Result<(), LoadError> {
        let Some(light) = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()) else {
            return Ok(());
        };
        let source = lookup(self.data.path, self.data.root, light.light, "a node: light")?;
        let name = source.name.as_deref().or(node.name.as_deref()).unwrap_or_default();
        let number = light.light.value();
        let label = label("light", number, name);
        let Checked::Valid(kind) = source.type_ else {
            self.notes.name("lights have an unknown type and were ignored", label);
            return Ok(());
        };
        if source.range.is_some() {
            self.notes.name(
                "lights have a range, which is ignored: light falls off with the square of the distance alone",
                label.clone(),
            );
        }
        let axis = to_world.transform_vector3(DVec3::NEG_Z).try_normalize();
        let Some(kind) = convert(source, kind, to_world.translation, axis) else {
            self.notes.name("lights have no valid direction or cone and were ignored", label);
            return Ok(());
        };
        if let Err((what, rule)) = kind.check() {
            let named = if name.is_empty() { label } else { format!("light {number} ({label})") };
            let what = format!("{named} has a bad {what}: {rule}");
            return Err(self.data.invalid(what));
        }
        self.builder.add_light(Light { name: name.to_owned(), kind });
        Ok(())
    }
}

/// Converts a light to world space. It shines along −z. Its intensity, in cd or lx, is taken as W/sr or W/m² in every
/// band, as emitted radiance in cd/m² is taken as W/(m² sr).
///
/// Returns `None` if it needs a direction and has none, or its cone is invalid.
fn convert(source: &Source, kind: Type, position: DVec3, axis: Option<DVec3>) -> Option<LightKind> {
    let strength = Rgb::from_array(source.color.map(f64::from)) * f64::from(source.intensity);
    let spread = match kind {
        Type::Directional => return Some(LightKind::Distant { direction: axis?, irradiance: strength }),
        Type::Point => Spread::Isotropic,
        Type::Spot => {
            let spot = source.spot.as_ref()?;
            Spread::spot(axis?, f64::from(spot.inner_cone_angle), f64::from(spot.outer_cone_angle))?
        }
    };
    Some(LightKind::Point { position, intensity: strength, spread })
}
