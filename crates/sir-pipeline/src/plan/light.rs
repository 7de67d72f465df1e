//! The stage `Light`.

use glam::DVec3;
use sir_geom::{LightKind, Rgb};

use crate::format::grouped;
use crate::plan::light_group::{FileLights, group};
use crate::plan::luminaire::Luminaire;
use crate::plan::panel::Panel;
use crate::plan::point::Point;
use crate::plan::scene_light::SceneLight;
use crate::plan::sky::{Environment, Sky};
use crate::text::field::Format as _;
use crate::text::formats::{Color, Direction};
use crate::text::reader::Reader;
use crate::text::record::{Body, Choose as _, choice, list_items, record, write_list};
use crate::text::ron_tree::Node;

/// Largest number of luminaires of a pipeline.
const MAX_LUMINAIRES: u64 = 1_000_000;

/// Stage that adds lights to the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Lights and light groups: at least one, of which at most one is a sky.
    pub lamps: Vec<Lamp>,
}

choice! {
    /// Light that a pipeline adds to its scene, or a light group of those that the scene has.
    pub enum Lamp as "light" {
        /// Point light.
        Point(Point),
        /// Parallel light.
        Distant(Distant),
        /// Emitting parallelogram.
        Panel(Panel),
        /// Luminaire with a photometric file.
        Luminaire(Luminaire),
        /// Sky above a ground.
        Sky(Sky),
        /// Uniform light from all directions.
        Environment(Environment),
        /// Lights of the scene file that are in a light group.
        Group(FileLights),
    }
}

record! {
    /// Parallel light.
    pub struct Distant {
        /// Direction in which the light travels. That of sunlight has a negative `y`, if `y` is up.
        pub direction: DVec3 = Direction([0.0, -1.0, 0.0]).required();
        /// Irradiance of a surface that faces the light.
        pub irradiance: Rgb = Color(1000.0).required().unit("W/m²");
        /// Light group, which `sir mix` can dim after the run.
        pub group: Option<String> = group();
    }
}

impl Lamp {
    /// Returns the light group that the light names.
    #[must_use]
    pub fn group(&self) -> Option<&str> {
        match self {
            Self::Point(Point { group, .. })
            | Self::Distant(Distant { group, .. })
            | Self::Panel(Panel { group, .. })
            | Self::Luminaire(Luminaire { group, .. })
            | Self::Sky(Sky { group, .. })
            | Self::Environment(Environment { group, .. }) => group.as_deref(),
            Self::Group(group) => Some(&group.name),
        }
    }

    /// Converts the light for a scene with this up direction, of unit length. Returns nothing for a group, whose lights are in
    /// the scene file, and `None` if its numbers contradict each other; those read from a file do not.
    #[must_use]
    pub fn to_scene(&self, up: DVec3) -> Option<Vec<SceneLight>> {
        let light = match self {
            Self::Luminaire(luminaire) => return luminaire.to_scene(up),
            Self::Point(point) => point.to_scene(),
            Self::Distant(Distant { direction, irradiance, .. }) => {
                let direction = direction.try_normalize()?;
                let kind = LightKind::Distant { direction, irradiance: *irradiance };
                Some(SceneLight::Light(sir_geom::Light { name: String::new(), kind }))
            }
            Self::Panel(panel) => Some(panel.to_scene()),
            Self::Sky(sky) => sky.to_scene().map(SceneLight::Sky),
            Self::Environment(Environment { radiance, .. }) => {
                sir_geom::Sky::everywhere(*radiance).map(SceneLight::Sky)
            }
            Self::Group(_) => return Some(Vec::new()),
        };
        light.map(|light| vec![light])
    }

    /// Returns true if it is placed by the up direction of the scene.
    #[must_use]
    pub fn needs_up(&self) -> bool {
        matches!(self, Self::Luminaire(_))
    }
}

impl Body for Light {
    fn read<'a>(reader: &mut Reader<'a>, node: &Node<'a>) -> Option<Self> {
        let items = list_items(reader, node, "lights", "Point(position: (1, 2, 3), intensity: 100)")?;
        let lamps: Vec<_> = items.iter().map(|item| Lamp::read(reader, item)).collect();
        let mut skies = items.iter().filter(|item| ["Sky", "Environment"].contains(&item.name()));
        if let Some(first) = skies.next() {
            for other in skies {
                let message = format!("a second sky; the first is in line {}", reader.line(first.text));
                reader.problem(other.name(), message, "keep one `Sky` or `Environment`");
            }
        }
        let (mut count, mut is_reported) = (0u64, false);
        for (lamp, item) in lamps.iter().zip(items) {
            let Some(Lamp::Luminaire(luminaire)) = lamp else { continue };
            count += luminaire.count();
            if count > MAX_LUMINAIRES && !is_reported {
                let message = format!(
                    "the pipeline has {} luminaires up to this one (at most {} are possible)",
                    grouped(count),
                    grouped(MAX_LUMINAIRES)
                );
                reader.problem(item.name(), message, "choose fewer `columns` or `rows`");
                is_reported = true;
            }
        }
        lamps.into_iter().collect::<Option<_>>().map(|lamps| Self { lamps })
    }

    fn write(&self, name: &str) -> String {
        write_list(name, &self.lamps)
    }
}
