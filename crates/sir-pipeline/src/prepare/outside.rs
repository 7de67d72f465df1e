//! Luminaires and sensors that are outside of the scene.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use sir_accel::{Line, Ray, Tracer};
use sir_geom::{BoundingBox, MaterialId, Scene};
use sir_radiosity::{Model, Sensor};

use crate::format::grouped;
use crate::plan::scene_light::Added;
use crate::plan::{Action, Luminaire, Pipeline, Place};
use crate::prepare::layout::{Placed, is_inside};

/// Distance from the scene file's own surfaces up to which a luminaire is not outside \[m\].
const MARGIN: f64 = 0.01;

/// Height of a scene above which it may be a room \[m\].
const LOW: f64 = 0.5;

/// Distance by which a ray continues behind the opening of a luminaire \[m\].
const STEP: f64 = 1e-6;

/// Distance from a sensor to the point that is tested \[m\].
const LIFT: f64 = 1e-3;

/// Largest number of faces of openings that a ray crosses.
const MAX_OPENINGS: usize = 8;

/// Returns a warning for each luminaire of a pipeline that is outside of the surfaces of the scene file and does not light
/// them. `added` is what the lamps have added to the scene.
///
/// A luminaire outside may be intended, like a floodlight before a facade. So a ray along its aim decides: it must meet a side
/// that reflects. From above, it must meet the lower half of the scene, as below a street lamp; a luminaire above a ceiling
/// meets the upper half.
pub(super) fn luminaires(pipeline: &Pipeline, model: &Model, up: DVec3, added: &[Vec<Added>]) -> Vec<String> {
    let Some(bounds) = bounds_without(&model.scene, added) else { return Vec::new() };
    let mut tracer = model.accel.tracer();
    pipeline
        .luminaires()
        .filter_map(|luminaire| outside(luminaire, &bounds, model, up, &mut tracer))
        .collect()
}

/// Returns a warning if luminaires of an array are outside and do not light the scene.
fn outside(
    luminaire: &Luminaire,
    bounds: &BoundingBox,
    model: &Model,
    up: DVec3,
    tracer: &mut Tracer<'_>,
) -> Option<String> {
    let mut is_outside = |position: DVec3| {
        let near = DVec3::splat(MARGIN);
        let around = BoundingBox { min: bounds.min - near, max: bounds.max + near };
        !around.contains(position)
            && luminaire
                .aim_at(position, up)
                .is_some_and(|aim| !lights(position, aim, bounds, model, up, tracer))
    };
    let mut positions = luminaire.positions().filter(|position| is_outside(*position));
    let first = positions.next()?;
    let [x, y, z] = first.to_array().map(|x| (1000.0 * x).round() / 1000.0);
    let name = luminaire.label();
    let which = match (1 + positions.count() as u64, luminaire.count()) {
        (_, 1) => format!("the luminaire {name:?} at ({x}, {y}, {z})"),
        (1, all) => format!("1 of {} luminaires {name:?}, at ({x}, {y}, {z}),", grouped(all)),
        (some, all) => format!(
            "{} of {} luminaires {name:?}, the first at ({x}, {y}, {z}),",
            grouped(some),
            grouped(all)
        ),
    };
    let [min, max] = [bounds.min, bounds.max].map(|p| p.to_array().map(|x| (1000.0 * x).round() / 1000.0));
    let verb = if which.contains("luminaires") && !which.starts_with("1 of") { "are" } else { "is" };
    Some(format!(
        "{which} {verb} outside of the scene, which extends from ({}, {}, {}) to ({}, {}, {}); is the position right?",
        min[0], min[1], min[2], max[0], max[1], max[2]
    ))
}

/// Returns true if a ray from a luminaire outside of the scene along its aim meets a side that reflects.
fn lights(
    position: DVec3,
    aim: DVec3,
    bounds: &BoundingBox,
    Model { scene, .. }: &Model,
    up: DVec3,
    tracer: &mut Tracer<'_>,
) -> bool {
    let mut origin = position;
    for _ in 0..MAX_OPENINGS {
        let Some(hit) = tracer.closest(&Ray::new(Line { origin, direction: aim })) else { return false };
        let place = origin + hit.t * aim;
        if scene.material(hit.triangle).beam.is_some() {
            origin = place + STEP * aim;
            continue;
        }
        let heights = [bounds.min, bounds.max].map(|corner| corner.dot(up));
        let [low, high] = [heights[0].min(heights[1]), heights[0].max(heights[1])];
        let is_above = position.dot(up) > high + MARGIN;
        let is_on_top = is_above && high - low > LOW && place.dot(up) > 0.5 * (low + high);
        return scene.is_active(hit.triangle, hit.side) && !is_on_top;
    }
    false
}

/// Returns the box around the surfaces of a scene that lamps of the pipeline have not added; `None` if there are none.
fn bounds_without(scene: &Scene, added: &[Vec<Added>]) -> Option<BoundingBox> {
    let of_lamps: BTreeSet<MaterialId> = added
        .iter()
        .flatten()
        .filter_map(|added| if let Added::Material(material) = added { Some(*material) } else { None })
        .collect();
    let own = scene.triangle_ids().filter(|&id| !of_lamps.contains(&scene.triangle(id).material));
    BoundingBox::of(own.flat_map(|id| scene.corners(id)))
}

/// Returns a point in front of a sensor, which may lie on a surface.
fn tested(sensor: &Sensor) -> DVec3 {
    sensor.position() + LIFT * sensor.direction()
}

/// Returns a warning for each `Grid` with sensors outside of the scene. A `Plane` leaves those out.
pub(super) fn grids(
    pipeline: &Pipeline,
    placed: &BTreeMap<usize, Placed>,
    model: &Model,
    up: DVec3,
) -> Vec<String> {
    let mut tracer = model.accel.tracer();
    let mut warnings = Vec::new();
    for (number, stage) in pipeline.stages.iter().enumerate() {
        let Action::Sensors(sensors) = &stage.action else { continue };
        let (Place::Grid(_), Some(Placed::Sensors(layout))) = (&sensors.at.value, placed.get(&number)) else {
            continue;
        };
        let outside =
            layout.sensors.iter().filter(|sensor| !is_inside(tested(sensor), up, model, &mut tracer)).count();
        if outside > 0 {
            warnings.push(format!(
                "{} of {} points of the `Grid` {:?} are outside of the scene or inside of an object, and count in its mean and \
                 minimum; move the grid, or use `Plane`, which leaves such points out",
                grouped(outside as u64),
                grouped(layout.sensors.len() as u64),
                sensors.name
            ));
        }
    }
    warnings
}
