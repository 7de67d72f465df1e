//! Cases of CIE 171 that ask for the light at points: 5.2, 5.3, 5.6, 5.7, 5.9.

use glam::DVec3;
use sir_geom::{Rgb, Scene};
use sir_mesh::Subdivision;
use sir_parallel::{Executor, RunError, Start};
use sir_radiosity::{Model, SENSOR_OFFSET, Sensor, SensorSettings, SensorStage, SensorTask, Solution};

use crate::data::{Case, Point, Surface};
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::room::{add_point, black, exitance, flux, open_to_sky};
use crate::trial::{Quantity, Sample, Trial};

/// Rays over the hemisphere of a point where only emitting surfaces shine, which are aimed at besides.
const RAYS: u64 = 2_000;

/// Rays where the sky shines through an opening that they have to find by chance.
const RAYS_TO_SKY: u64 = 200_000;

/// Sensors at points.
pub(crate) fn sensors<'p>(
    case: &Case,
    points: impl IntoIterator<Item = &'p Point>,
) -> Result<Vec<Sensor>, ValidateError> {
    let sensor =
        |point: &Point| Sensor::new(DVec3::from_array(point.position), DVec3::from_array(point.normal));
    let points = points.into_iter();
    points.map(|point| Ok(*case.need("normal of a point", sensor(point).as_ref())?)).collect()
}

/// The irradiance at sensors, by so many rays at each.
pub(crate) fn irradiances(
    model: &Model,
    solution: &Solution,
    sensors: &[Sensor],
    rays: u64,
    seed: u64,
    executor: &mut Executor<'_>,
) -> Result<Vec<Rgb>, RunError> {
    let settings = SensorSettings { rays, error: 0.0 };
    let task = SensorTask { model, solution, sensors, settings, seed };
    let measured = executor.run::<SensorStage<'_>>(task, Start::Fresh(()))?.outcome;
    Ok(measured.iter().map(|measurement| measurement.irradiance).collect())
}

/// What lights the scene of a case, what of it is built, and in which unit its answers are.
pub(crate) enum Setting {
    /// A point light.
    PointLight,
    /// A lamp with the name `source`.
    Lamp,
    /// A surface `S2` that sends out an exitance of 1, seen without measuring planes; answers in percent.
    Reflector,
    /// A uniform sky that lights the open ground with 1, through an opening; answers in percent.
    Sky,
}

impl Setting {
    fn scene(&self, case: &Case) -> Result<Scene, ValidateError> {
        let surfaces: Vec<&Surface> = case.geometry.surfaces.iter().collect();
        let builder = match self {
            Self::PointLight => {
                let mut builder = black(&surfaces, |_| 0.0);
                add_point(&mut builder, case.need("source", case.geometry.source.as_ref())?, flux(case)?);
                builder
            }
            Self::Lamp => {
                let exitance = exitance(case)?;
                black(&surfaces, |surface| if surface.name == "source" { exitance } else { 0.0 })
            }
            Self::Reflector => {
                // Measuring planes "do not block"; the points are where they would be.
                let built = |surface: &&&Surface| !surface.role.starts_with("measuring plane");
                let surfaces: Vec<&Surface> = surfaces.iter().filter(built).copied().collect();
                black(&surfaces, |surface| if surface.name == "S2" { 1.0 } else { 0.0 })
            }
            Self::Sky => {
                let mut builder = black(&surfaces, |_| 0.0);
                open_to_sky(&mut builder, case, case.need("opening", case.geometry.opening.as_ref())?)?;
                builder
            }
        };
        Ok(builder.build()?.scene)
    }

    /// Where a sensor has to be to look from a point of the scene. Sensors look from a little above their position, for them not to be
    /// below the surface that they lie on. Where that is left out, they need not, and some points see just nothing.
    fn place(&self, sensor: Sensor, scene: &Scene) -> Sensor {
        let lift = SENSOR_OFFSET * scene.bounding_sphere().radius;
        let lowered = Sensor::new(sensor.position() - lift * sensor.direction(), sensor.direction());
        match self {
            Self::Reflector => lowered.unwrap_or(sensor),
            _ => sensor,
        }
    }

    /// What irradiances are multiplied with.
    fn unit(&self) -> f64 {
        match self {
            Self::PointLight | Self::Lamp => 1.0,
            Self::Reflector | Self::Sky => 100.0,
        }
    }
}

/// The light at the points of a case, measured from there.
pub(crate) fn points(case: &Case, setting: Setting) -> Result<Vec<Trial<'_>>, ValidateError> {
    let quantity =
        |p: &Point| Quantity { published: p.cie_published, ..Quantity::new(p.name.clone(), p.exact) };
    let quantities: Vec<Quantity> = case.points.iter().map(quantity).collect();
    let sensors = sensors(case, &case.points)?;
    let count = sensors.len() as u64;
    let rays = if matches!(setting, Setting::Sky) { RAYS_TO_SKY } else { RAYS };
    let prepare = move |_: Effort| -> Result<Sample<'_>, ValidateError> {
        let model = Model::new(setting.scene(case)?, Subdivision::PerTriangle)?;
        let place = |&sensor: &Sensor| setting.place(sensor, &model.scene);
        let (sensors, unit): (Vec<_>, _) = (sensors.iter().map(place).collect(), setting.unit());
        Ok(Box::new(move |lines, seed, executor| {
            // All surfaces are black: what they receive is seen by nobody.
            let solution = Solution::dark(model.mesh.side_count());
            let found = irradiances(&model, &solution, &sensors, lines / count, seed, executor)?;
            Ok(found.iter().map(|irradiance| irradiance.x * unit).collect())
        }))
    };
    Ok(vec![Trial { quantities, lines: rays * count, prepare: Box::new(prepare) }])
}
