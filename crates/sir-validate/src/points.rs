//! Cases of CIE 171 about the light at points: 5.2, 5.3, 5.6, 5.7, 5.9.

use glam::DVec3;
use sir_geom::{Rgb, Scene};
use sir_mesh::Subdivision;
use sir_parallel::{Executor, RunError, Start};
use sir_radiosity::{Measurement, Model, Sensor, SensorSettings, SensorStage, SensorTask, Solution};

use crate::data::{Case, Point, Surface};
use crate::effort::Effort;
use crate::error::ValidateError;
use crate::room::{add_point, black, exitance, flux, open_to_sky};
use crate::trial::{Quantity, Sample, Trial};

/// Number of rays over the hemisphere of a point if only surfaces emit, at which further rays are aimed.
const RAYS: u64 = 2_000;

/// Number of rays per point if the light comes from the sky through an opening, which rays find only by chance.
const RAYS_TO_SKY: u64 = 200_000;

/// Returns sensors at points.
pub(crate) fn sensors<'p>(
    case: &Case,
    points: impl IntoIterator<Item = &'p Point>,
) -> Result<Vec<Sensor>, ValidateError> {
    let sensor =
        |point: &Point| Sensor::new(DVec3::from_array(point.position), DVec3::from_array(point.normal));
    let points = points.into_iter();
    points.map(|point| Ok(*case.need("normal of a point", sensor(point).as_ref())?)).collect()
}

/// Returns the light at each sensor, measured with `rays` rays.
pub(crate) fn measurements(
    model: &Model,
    solution: &Solution,
    sensors: &[Sensor],
    rays: u64,
    seed: u64,
    executor: &mut Executor<'_>,
) -> Result<Vec<Measurement>, RunError> {
    let settings = SensorSettings::new(rays, 0.0);
    let task = SensorTask { model, solution, sensors, settings, seed };
    Ok(executor.run::<SensorStage<'_>>(task, Start::Fresh(()))?.outcome)
}

/// Returns the irradiance at each sensor, measured with `rays` rays.
pub(crate) fn irradiances(
    model: &Model,
    solution: &Solution,
    sensors: &[Sensor],
    rays: u64,
    seed: u64,
    executor: &mut Executor<'_>,
) -> Result<Vec<Rgb>, RunError> {
    let measured = measurements(model, solution, sensors, rays, seed, executor)?;
    Ok(measured.iter().map(|measurement| measurement.irradiance).collect())
}

/// Light source of a case, the surfaces that are built, and the unit of the answers.
pub(crate) enum Lighting {
    /// A point light.
    PointLight,
    /// A lamp, the surface `source`.
    Lamp,
    /// A surface `S2` with an exitance of 1; measuring planes are not built. Answers are in percent.
    Reflector,
    /// A uniform sky, seen through an opening, that gives the open ground an irradiance of 1. Answers are in percent.
    Sky,
}

impl Lighting {
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
                // Measuring planes "do not block"; the points lie where the planes would be.
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

    /// Returns the factor from irradiance to the unit of the answers.
    fn unit(&self) -> f64 {
        match self {
            Self::PointLight | Self::Lamp => 1.0,
            Self::Reflector | Self::Sky => 100.0,
        }
    }
}

/// Creates the trial for the light at the points of a case.
pub(crate) fn points(case: &Case, lighting: Lighting) -> Result<Vec<Trial<'_>>, ValidateError> {
    let quantity =
        |p: &Point| Quantity { published: p.cie_published, ..Quantity::new(p.name.clone(), p.exact) };
    let quantities: Vec<Quantity> = case.points.iter().map(quantity).collect();
    let sensors = sensors(case, &case.points)?;
    let count = sensors.len() as u64;
    let rays = if matches!(lighting, Lighting::Sky) { RAYS_TO_SKY } else { RAYS };
    let prepare = move |_: Effort| -> Result<Sample<'_>, ValidateError> {
        let model = Model::new(lighting.scene(case)?, Subdivision::PerTriangle)?;
        let (sensors, unit) = (sensors.clone(), lighting.unit());
        Ok(Box::new(move |lines, seed, executor| {
            // All surfaces are black, so the light that they receive is not needed.
            let solution = Solution::dark(model.mesh.side_count());
            let found = irradiances(&model, &solution, &sensors, lines / count, seed, executor)?;
            Ok(found.iter().map(|irradiance| irradiance.x * unit).collect())
        }))
    };
    Ok(vec![Trial { quantities, lines: rays * count, prepare: Box::new(prepare) }])
}
