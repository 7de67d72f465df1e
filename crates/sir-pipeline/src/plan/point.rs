//! Point lights.

use glam::DVec3;
use sir_geom::{LightKind, Rgb};

use crate::plan::light_group::group;
use crate::plan::scene_light::SceneLight;
use crate::text::field::{Format as _, OneOf};
use crate::text::formats::{Color, Direction, Vector, number};
use crate::text::reader::{Fields, Reader};
use crate::text::record::{choice, named, record};

record! {
    /// Point light.
    pub struct Point {
        /// Position of the light.
        pub position: DVec3 = Vector([1.0, 2.0, 3.0]).required().unit("m");
        /// Intensity or power.
        pub strength: PointStrength = strength();
        /// Angular distribution of the light, see below.
        pub spread: Spread = named("Isotropic").or(Spread::Isotropic);
        /// Light group, which `sir mix` can dim after the run.
        pub group: Option<String> = group();
    }
}

/// Intensity or power of a point light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointStrength {
    /// Radiant intensity per band in the direction where it is largest \[W/sr\].
    Intensity(Rgb),
    /// Power per band \[W\].
    Power(Rgb),
}

fn strength() -> OneOf<PointStrength> {
    OneOf::new()
        .field(
            "intensity",
            Color(100.0),
            "W/sr",
            "Intensity in the direction where it is largest.",
            PointStrength::Intensity,
            |strength| if let PointStrength::Intensity(color) = strength { Some(*color) } else { None },
        )
        .field("power", Color(100.0), "W", "Total power.", PointStrength::Power, |strength| {
            if let PointStrength::Power(color) = strength { Some(*color) } else { None }
        })
}

choice! {
    /// Angular distribution of a point light.
    pub enum Spread as "spread" {
        /// Equal intensity in all directions.
        Isotropic,
        /// Intensity proportional to the cosine of the angle to an axis, zero behind.
        Lambertian(Lambertian),
        /// Cone.
        Spot(Spot),
    }
}

record! {
    /// Angular distribution of a small diffuse surface.
    pub struct Lambertian {
        /// Direction of the largest intensity.
        pub axis: DVec3 = Direction([0.0, -1.0, 0.0]).required();
    }
}

record! {
    /// Cone of light. Between its two angles the intensity falls off as glTF recommends.
    pub struct Spot, check Spot::check {
        /// Axis of the cone.
        pub axis: DVec3 = Direction([0.0, -1.0, 0.0]).required();
        /// Angle from the axis up to which the intensity is full.
        pub inner: f64 = number(20.0).with_range(|x| x >= 0.0, "from 0").or(0.0).unit("degrees");
        /// Angle from the axis beyond which there is no light; not less than `inner`.
        pub outer: f64 =
            number(30.0).with_range(|x| (0.01..=180.0).contains(&x), "from 0.01 to 180").required().unit("degrees");
    }
}

impl Point {
    /// Converts the light for a scene. Returns `None` if its numbers contradict each other.
    pub(crate) fn to_scene(&self) -> Option<SceneLight> {
        let spread = self.spread.to_scene()?;
        let intensity = match self.strength {
            PointStrength::Intensity(intensity) => intensity,
            PointStrength::Power(power) => power / spread.solid_angle(),
        };
        let kind = LightKind::Point { position: self.position, intensity, spread };
        Some(SceneLight::Light(sir_geom::Light { name: String::new(), kind }))
    }
}

impl Spread {
    fn to_scene(&self) -> Option<sir_geom::Spread> {
        match self {
            Self::Isotropic => Some(sir_geom::Spread::Isotropic),
            Self::Lambertian(Lambertian { axis }) => {
                axis.try_normalize().map(|axis| sir_geom::Spread::Lambertian { axis })
            }
            Self::Spot(spot) => spot.to_scene(),
        }
    }
}

impl Spot {
    fn to_scene(&self) -> Option<sir_geom::Spread> {
        let Self { axis, inner, outer } = self;
        sir_geom::Spread::spot(axis.try_normalize()?, inner.to_radians(), outer.to_radians())
    }

    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        if self.to_scene().is_none() {
            let Self { inner, outer, .. } = self;
            let message =
                format!("the `inner` angle of the spot, {inner}°, exceeds its `outer` angle, {outer}°");
            reader.problem(fields.place, message, "choose an `outer` that is not less than `inner`");
        }
    }
}
