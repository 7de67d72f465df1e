//! Light from the sky.

use glam::DVec3;
use sir_geom::Rgb;

use crate::text::field::Format as _;
use crate::text::formats::{Color, Direction, count};
use crate::text::reader::{Fields, Reader};
use crate::text::record::{choice, named, record};

record! {
    /// A hemisphere of light above a ground.
    pub struct Sky, check Sky::check {
        /// How its radiance depends on the direction, see below.
        pub model: SkyModel = named("Uniform").or(SkyModel::Uniform);
        /// To the zenith.
        pub up: DVec3 = Direction([0.0, 1.0, 0.0]).or(DVec3::Y);
        /// Irradiance of a horizontal surface with nothing around it.
        pub horizontal: Rgb = Color(10_000.0).required().unit("W/m²");
        /// Radiance of everything below the horizon.
        pub ground: Rgb = Color(1000.0).or(Rgb::ZERO).unit("W/(m² sr)");
    }
}

choice! {
    /// How the radiance of a sky depends on the direction.
    pub enum SkyModel as "sky model" {
        /// Not at all.
        Uniform,
        /// That of Moon and Spencer: three times as bright in the zenith as at the horizon.
        Overcast,
        /// One of the types of the CIE general sky.
        Cie(Cie),
    }
}

record! {
    /// One of the fifteen types of the CIE general sky, without the sun itself.
    pub struct Cie {
        /// 1 to 5 are overcast, 6 to 10 partly cloudy, 11 to 15 clear.
        pub kind as "type": u8 = count(1, 15, 12).required();
        /// Towards the sun, not below the horizon.
        pub sun: DVec3 = Direction([1.0, 2.0, 1.0]).required();
    }
}

record! {
    /// The same light from everywhere.
    pub struct Environment {
        /// From all directions, from below as from above.
        pub radiance: Rgb = Color(100.0).required().unit("W/(m² sr)");
    }
}

impl Sky {
    /// Returns the sky as a scene takes it; `None` if its numbers are impossible together.
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
            let help = "let `sun` point towards the sun, from the ground";
            reader.problem(fields.place_of("model"), "the sun of this sky is below the horizon", help);
        }
    }
}
