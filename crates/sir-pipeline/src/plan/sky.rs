//! Light from the sky.

use glam::DVec3;
use sir_geom::Rgb;

use crate::plan::light_group::group;
use crate::text::field::Format as _;
use crate::text::formats::{Color, Direction, count};
use crate::text::reader::{Fields, Reader};
use crate::text::record::{choice, named, record};

record! {
    /// Luminous hemisphere above a ground.
    pub struct Sky, check Sky::check {
        /// Dependence of the radiance on the direction, see below.
        pub model: SkyModel = named("Uniform").or(SkyModel::Uniform);
        /// Direction of the zenith.
        pub up: DVec3 = Direction([0.0, 1.0, 0.0]).or(DVec3::Y);
        /// Irradiance of an unobstructed horizontal surface.
        pub horizontal: Rgb = Color(10_000.0).required().unit("W/m²");
        /// Radiance of the ground: of all directions below the horizon.
        pub ground: Rgb = Color(1000.0).or(Rgb::ZERO).unit("W/(m² sr)");
        /// Light group, which `sir mix` can dim after the run.
        pub group: Option<String> = group();
    }
}

choice! {
    /// Dependence of the radiance of a sky on the direction.
    pub enum SkyModel as "sky model" {
        /// Constant radiance.
        Uniform,
        /// Overcast sky of Moon and Spencer: three times as bright at the zenith as at the horizon.
        Overcast,
        /// CIE general sky.
        Cie(Cie),
    }
}

record! {
    /// One of the fifteen types of the CIE general sky, without the sun itself.
    pub struct Cie {
        /// Type of the sky: 1 to 5 are overcast, 6 to 10 partly cloudy, 11 to 15 clear.
        pub kind as "type": u8 = count(1, 15, 12).required();
        /// Direction towards the sun, not below the horizon.
        pub sun: DVec3 = Direction([1.0, 2.0, 1.0]).required();
    }
}

record! {
    /// Uniform light from all directions.
    pub struct Environment {
        /// Radiance from all directions, below the horizon as above.
        pub radiance: Rgb = Color(100.0).required().unit("W/(m² sr)");
        /// Light group, which `sir mix` can dim after the run.
        pub group: Option<String> = group();
    }
}

impl Sky {
    /// Converts the sky for a scene. Returns `None` if its numbers contradict each other.
    pub(crate) fn to_scene(&self) -> Option<sir_geom::Sky> {
        let model = match self.model {
            SkyModel::Uniform => sir_geom::SkyModel::Uniform,
            SkyModel::Overcast => sir_geom::SkyModel::Overcast,
            // Directions are normalized before they are compared.
            SkyModel::Cie(Cie { kind, sun }) => {
                sir_geom::SkyModel::General { kind, sun: sun.try_normalize()? }
            }
        };
        sir_geom::Sky::new(self.up.try_normalize()?, model, self.horizontal, self.ground)
    }

    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        let SkyModel::Cie(Cie { sun, .. }) = self.model else { return };
        if sun.normalize().dot(self.up.normalize()) < 0.0 {
            let help = "choose a `sun` that points from the ground towards the sun";
            reader.problem(fields.place_of("model"), "the sun of this sky is below the horizon", help);
        }
    }
}
