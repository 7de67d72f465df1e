//! Facts of a page: the figures of a run, as JSON for its script.

use glam::DVec3;
use serde_json::{Value, json};
use sir_geom::{Camera, Projection, Scene};
use sir_radiosity::Measurement;

use crate::prepare::layout::Layout;
use crate::report::result::Report;
use crate::report::sensors::SensorsReport;
use crate::report::uncertain::Uncertain;
use crate::units::Units;

/// Largest number of points of sensors that a page lists. Maps have all.
const MAX_POINTS: usize = 20_000;

/// What a page shows of a scene.
pub(crate) struct Shown {
    /// Cameras, at least one, each with its exposure: the factor from radiance to screen values.
    pub(crate) cameras: Vec<(Camera, f64)>,
    /// Name of the stage after which the light is, if a later stage changes it.
    pub(crate) not_final: Option<&'static str>,
    /// Number of patches that the page shows, if these are fewer than those of the solution.
    pub(crate) simplified: Option<usize>,
}

/// Returns the facts of a finished run.
pub(crate) fn facts(report: &Report, scene: &Scene, shown: &Shown, sensors: &[Value]) -> Value {
    let units = report.units;
    json!({
        "title": title(report),
        "program": report.program,
        "units": { "power": units.power(), "irradiance": units.irradiance(), "name": units.irradiance_name() },
        "report": report,
        "up": report.scene.up,
        "sky": sky(scene),
        "cameras": shown.cameras.iter().map(camera).collect::<Vec<_>>(),
        "sensors": sensors,
        "notes": notes(scene, shown),
        "repeat": commands(report),
    })
}

/// Returns the commands that give the same result again.
fn commands(report: &Report) -> Vec<String> {
    let quoted = |text: &str| match text.contains([' ', '\'', '"', '$']) {
        true => format!("{text:?}"),
        false => text.to_owned(),
    };
    let mut commands = vec![format!("sir run {} --seed {}", quoted(&report.pipeline.path), report.seed)];
    commands.extend(report.mixed_from.as_ref().map(|run| {
        let dimmed = report.groups.iter().filter(|group| group.factor != [1.0; 3]);
        let factors = dimmed.map(|group| {
            let [r, g, b] = group.factor;
            format!(" --set {}", quoted(&format!("{}={r},{g},{b}", group.name)))
        });
        format!("sir mix {}{}", quoted(run), factors.collect::<String>())
    }));
    commands
}

/// Returns the title of a page: the name of the scene's file.
pub(crate) fn title(report: &Report) -> &str {
    let path = &report.scene.path;
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// Rounds a number to the digits that are not noise.
fn rounded(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

/// Returns what the measurements of a stage `Sensors` contribute to the facts.
pub(crate) fn of_sensors(
    layout: &Layout,
    measured: &[Measurement],
    ratings: Option<&[Option<Uncertain>]>,
    summary: &SensorsReport,
    units: Units,
) -> Value {
    let points = layout.sensors.iter().zip(measured).take(MAX_POINTS).map(|(sensor, m)| {
        let places = [sensor.position(), sensor.direction()].map(|v| v.to_array());
        let light = [m.luminance(), sir_geom::luminance(m.direct), m.luminance_error()];
        places.into_iter().flatten().chain(light).map(rounded).collect::<Vec<_>>()
    });
    let map = layout.cells.as_ref().filter(|_| measured.len() <= MAX_POINTS).map(|cells| {
        let counts = [cells.columns as f64, cells.rows as f64];
        let size = cells.size.to_array();
        json!({
            "columns": cells.columns,
            "rows": cells.rows,
            "size": [size[0] / counts[0], size[1] / counts[1]],
            "cells": cells.of,
        })
    });
    json!({
        "name": summary.name,
        "summary": summary.in_short(units),
        "report": summary,
        "map": map,
        "points": points.collect::<Vec<_>>(),
        "ratings": ratings.map(of_ratings),
    })
}

/// Returns the unified glare ratings of sensors with their standard errors, `null` where nothing glares.
fn of_ratings(ratings: &[Option<Uncertain>]) -> Vec<Option<[f64; 2]>> {
    let of_sensor = |rating: &Option<Uncertain>| rating.map(|r| [r.value, r.error].map(rounded));
    ratings.iter().take(MAX_POINTS).map(of_sensor).collect()
}

/// Returns what the measurements at probes contribute to the facts: their means over all directions.
pub(crate) fn of_probes(
    positions: &[DVec3],
    means: &[Measurement],
    summary: &SensorsReport,
    units: Units,
) -> Value {
    let points = positions.iter().zip(means).take(MAX_POINTS).map(|(position, m)| {
        let light = [m.luminance(), sir_geom::luminance(m.direct), m.luminance_error()];
        // The mean over all directions has none.
        let numbers = position.to_array().into_iter().chain([0.0; 3]).chain(light);
        numbers.map(rounded).collect::<Vec<_>>()
    });
    json!({
        "name": summary.name,
        "summary": format!("Means over all directions at probes: {}", summary.in_short(units)),
        "report": summary,
        "map": None::<Value>,
        "points": points.collect::<Vec<_>>(),
        "ratings": None::<Value>,
    })
}

fn camera((camera, exposure): &(Camera, f64)) -> Value {
    let (fov, height) = match camera.projection {
        Projection::Perspective { vertical_fov } => (Some(vertical_fov), None),
        Projection::Orthographic { height } => (None, Some(height)),
    };
    json!({
        "name": camera.name,
        "eye": camera.eye.to_array(),
        "forward": camera.forward.to_array(),
        "up": camera.up.to_array(),
        "fov": fov,
        "height": height,
        "aspect": camera.aspect,
        "exposure": exposure,
    })
}

/// Returns the mean radiance of the sky around the horizon and above, for the background.
fn sky(scene: &Scene) -> Option<[f64; 3]> {
    let sky = scene.sky()?;
    let directions = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(glam::DVec3::from_array);
    let all = directions.into_iter().flat_map(|d| [d, -d]).map(|d| sky.radiance(d));
    Some((all.sum::<sir_geom::Rgb>() / 6.0).to_array())
}

/// Returns what the page leaves out or approximates.
fn notes(scene: &Scene, shown: &Shown) -> Vec<String> {
    let mut notes = vec![
        "Colors in the view are interpolated between patches. Values read are those of whole patches.".into(),
    ];
    if let Some(stage) = shown.not_final {
        notes.push(format!(
            "The light in the view is that after {stage}, not the final one. The figures below are those of the whole run."
        ));
    }
    if !scene.textures().is_empty() {
        notes.push("Textures are shown as the mean color of each patch.".into());
    }
    if scene.triangle_ids().any(|t| scene.is_transparent(t)) {
        notes.push("Surfaces with gaps (alpha masks, partial opacity) are shown without their gaps.".into());
    }
    if scene.sky().is_some() {
        notes.push("The background is the mean color of the sky.".into());
    }
    if let Some(patches) = shown.simplified {
        notes.push(format!(
            "The view has {} patches, fewer than the solution; their light is the mean of its patches, their errors are upper bounds, and \
             their numbers differ from those in tables.",
            crate::format::grouped(patches as u64)
        ));
    }
    notes
}
