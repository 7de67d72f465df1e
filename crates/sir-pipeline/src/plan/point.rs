//! Light from a point.

use glam::DVec3;
use sir_geom::{LightKind, Rgb};

use crate::plan::scene_light::SceneLight;
use crate::text::field::{Format as _, OneOf};
use crate::text::formats::{Color, Direction, Vector, number};
use crate::text::reader::{Fields, Reader};
use crate::text::record::{choice, named, record};

record! {
    /// Light from a point.
    pub struct Point {
        /// Where it is.
        pub position: DVec3 = Vector([1.0, 2.0, 3.0]).required().unit("m");
        /// How much light it sends.
        pub strength: PointStrength = strength();
        /// Where the light goes, see below.
        pub spread: Spread = named("Isotropic").or(Spread::Isotropic);
    }
}

/// How much light a point sends.
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
            "In the direction where it is largest.",
            PointStrength::Intensity,
            |strength| if let PointStrength::Intensity(color) = strength { Some(*color) } else { None },
        )
        .field("power", Color(100.0), "W", "In all directions together.", PointStrength::Power, |strength| {
            if let PointStrength::Power(color) = strength { Some(*color) } else { None }
        })
}

choice! {
    /// Where the light of a point goes.
    pub enum Spread as "spread" {
        /// Everywhere alike.
        Isotropic,
        /// As the cosine of the angle to an axis, nothing behind.
        Lambertian(Lambertian),
        /// In a cone.
        Spot(Spot),
    }
}

record! {
    /// Light as that of a small diffuse surface.
    pub struct Lambertian {
        /// Where most of the light goes.
        pub axis: DVec3 = Direction([0.0, -1.0, 0.0]).required();
    }
}

record! {
    /// A cone of light. Between its two angles light falls off as glTF recommends.
    pub struct Spot, check Spot::check {
        /// The middle of the cone.
        pub axis: DVec3 = Direction([0.0, -1.0, 0.0]).required();
        /// Full up to this angle from the axis.
        pub inner: f64 = number(20.0).with_range(|x| x >= 0.0, "from 0").or(0.0).unit("degrees");
        /// Nothing beyond this angle, which is not below `inner`.
        pub outer: f64 =
            number(30.0).with_range(|x| (0.01..=180.0).contains(&x), "from 0.01 to 180").required().unit("degrees");
    }
}

impl Point {
    /// Returns the light as a scene takes it; `None` if its numbers are impossible together.
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
                format!("a spot cannot be full up to {inner} and end at {outer} degrees from its axis");
            reader.problem(fields.place, message, "choose an `outer` that is not below `inner`");
        }
    }
}
