//! Scenes of named surfaces, and what falls on each of them.

use sir_geom::{Material, MaterialId, Rgb, Scene, SceneBuilder, Side};
use sir_lines::Domain;
use sir_mesh::Subdivision;
use sir_parallel::{Executor, RunError, Start};
use sir_radiosity::{BatchSettings, Batches, FirstShot, Model, SecondShot, ShotSettings, Solution};

use crate::data::Surface;
use crate::error::ValidateError;
use crate::shape;

/// What a surface emits (exitance `M`) and reflects, per band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Paint {
    pub(crate) exitance: Rgb,
    pub(crate) reflectance: Rgb,
}

impl Paint {
    /// The same in all bands.
    pub(crate) fn gray(exitance: f64, reflectance: f64) -> Self {
        Self { exitance: Rgb::splat(exitance), reflectance: Rgb::splat(reflectance) }
    }
}

/// A scene of these surfaces. The material of the surface of number `i` is that of number `i`.
pub(crate) fn scene(
    surfaces: &[&Surface],
    paint: impl Fn(usize) -> Paint,
    segments: u32,
) -> Result<Scene, ValidateError> {
    Ok(builder(surfaces, paint, segments).build()?.scene)
}

/// The same, before it is built.
pub(crate) fn builder(surfaces: &[&Surface], paint: impl Fn(usize) -> Paint, segments: u32) -> SceneBuilder {
    let mut builder = SceneBuilder::new();
    for (i, surface) in surfaces.iter().enumerate() {
        let Paint { exitance, reflectance } = paint(i);
        let material = Material::diffuse(&surface.name, reflectance).emitting(exitance);
        let material: MaterialId = builder.add_material(material);
        shape::add(&mut builder, &surface.shape, material, segments);
    }
    builder
}

/// A scene with one patch for each flat polygon.
pub(crate) fn per_face(scene: Scene) -> Result<Model, ValidateError> {
    Ok(Model::new(scene, Subdivision::PerFace)?)
}

/// The light of a scene.
pub(crate) struct Light {
    /// What comes straight from the sources.
    pub(crate) direct: Solution,
    /// All of it.
    pub(crate) all: Solution,
}

/// Lights a scene: a first and a second shot with 40 and 10 % of the lines, and the rest through the convex hull.
pub(crate) fn solve(
    model: &Model,
    lines: u64,
    seed: u64,
    executor: &mut Executor<'_>,
) -> Result<Light, RunError> {
    let first = ShotSettings::new(model, lines * 2 / 5, seed);
    let shot = executor.run::<FirstShot<'_>>(first, Start::Fresh(()))?.outcome;
    let direct = shot.solution(model);
    let second = ShotSettings::new(model, lines / 10, seed);
    let shot = executor.run::<SecondShot<'_>>(second, Start::Fresh(shot))?.outcome;
    let transport = BatchSettings::new(model, Domain::hull(model.scene.vertices()), lines / 2, seed);
    let all = executor.run::<Batches<'_>>(transport, Start::Fresh(shot))?.outcome.solution;
    Ok(Light { direct, all })
}

/// What falls on a surface and what leaves it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mean {
    /// Irradiance `E`, the mean over the area of the front.
    pub(crate) irradiance: Rgb,
    /// Radiosity `B`, likewise.
    pub(crate) radiosity: Rgb,
    /// Area of the front \[m²\].
    pub(crate) area: f64,
}

/// The mean light of the front of every material.
pub(crate) fn means(model: &Model, solution: &Solution) -> Vec<Mean> {
    let mut means = vec![Mean::default(); model.scene.materials().len()];
    model.mesh.for_each_side(|triangle, _, side, id| {
        if side == Side::Front {
            let area = model.area(triangle, id);
            let mean = &mut means[model.scene.triangle(triangle).material.index()];
            mean.irradiance += solution.irradiance[id.index()] * area;
            mean.radiosity += solution.radiosity(model, triangle, side, id) * area;
            mean.area += area;
        }
    });
    for mean in &mut means {
        mean.irradiance /= mean.area;
        mean.radiosity /= mean.area;
    }
    means
}
