//! Computes the radiosity of single triangles by path tracing, without patches:
//! `cargo run --release -p sir-radiosity --example path_traced SCENE PATHS [TRIANGLE…]`.
//!
//! An independent check of the solver, with which it shares only the scene and the search for the closest hit. Paths
//! start on the front of a triangle and are reflected until a surface absorbs them. Emitters are sampled at each vertex
//! (Kajiya 1986). Prints CSV: number of the triangle in the file, material, area, radiosity, and its standard error.
#![allow(clippy::print_stdout, reason = "an example prints its results")]

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;
use sir_accel::{Hit, Ray, Tracer};
use sir_geom::{Line, LoadOptions, Rgb, Side, TriangleId, load};
use sir_lines::{Purpose, Stream, Streams, cosine_direction, point_on_triangle};
use sir_mesh::Subdivision;
use sir_radiosity::{Emitter, Model, Source, sources};

/// Number of paths that are traced concurrently.
const WAVE: u64 = 4096;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(path), Some(paths)) = (arguments.next(), arguments.next()) else {
        return Err("usage: path_traced SCENE PATHS [TRIANGLE…]".into());
    };
    let paths: u64 = paths.parse()?;
    let wanted: Vec<u32> = arguments.map(|number| number.parse()).collect::<Result<_, _>>()?;
    let model = Model::new(load(Path::new(&path), &LoadOptions::default())?.scene, Subdivision::PerTriangle)?;
    let sources = sources(&model.scene, &model.mesh);
    if sources.iter().any(|source| !matches!(source.emitter, Emitter::Surface { .. })) {
        return Err(
            "the scene has lights without a surface (only emitting surfaces are supported); remove them"
                .into(),
        );
    }
    let emitters = Emitters::new(&sources);
    let mut tracer = model.accel.tracer();
    println!("triangle,material,area,B_r,B_g,B_b,se_r,se_g,se_b");
    for id in model.scene.triangle_ids() {
        let number = model.scene.triangle(id).source;
        if !wanted.is_empty() && !wanted.contains(&number) {
            continue;
        }
        let streams = Streams::new(u64::from(number), Purpose::PROBE);
        let (mut sum, mut squares) = (Rgb::ZERO, Rgb::ZERO);
        for first in (0..paths).step_by(WAVE as usize) {
            let lines = (first..paths.min(first + WAVE)).map(|i| streams.line(i)).collect();
            for irradiance in wave(&model, &emitters, &mut tracer, id, lines) {
                sum += irradiance;
                squares += irradiance * irradiance;
            }
        }
        let n = paths as f64;
        let mean = sum / n;
        let error = ((squares / n - mean * mean) / n).map(|variance| variance.max(0.0).sqrt());
        let material = model.scene.material(id);
        let [b, se] = [material.exitance + material.reflectance * mean, material.reflectance * error];
        let area = model.scene.area(id);
        println!("{number},{},{area},{},{},{},{},{},{}", material.name, b.x, b.y, b.z, se.x, se.y, se.z);
    }
    Ok(())
}

/// Emitters, sampled in proportion to their power.
struct Emitters<'a> {
    sources: &'a [Source],
    /// Running sums of the power of the sources, summed over bands.
    up_to: Vec<f64>,
    total: f64,
}

impl<'a> Emitters<'a> {
    fn new(sources: &'a [Source]) -> Self {
        let mut total = 0.0;
        let up_to = sources.iter().map(|source| {
            total += source.power.element_sum();
            total
        });
        Self { up_to: up_to.collect(), sources, total }
    }

    /// Samples a point of an emitter: the ray to it, its source, and the irradiance by all emitters that it represents.
    fn sample(&self, from: &Vertex, stream: &mut Stream) -> Option<(Ray, &'a Source, Rgb)> {
        let chosen = stream.unit() * self.total;
        let source = self.sources.get(self.up_to.partition_point(|&sum| sum <= chosen))?;
        let Emitter::Surface { corners, normal, .. } = source.emitter else { return None };
        let away = point_on_triangle(stream.point()).point(corners) - from.point;
        let direction = away.try_normalize()?;
        let cosines = direction.dot(from.normal).max(0.0) * -direction.dot(normal).min(0.0);
        let power = source.power * (self.total / source.power.element_sum());
        let irradiance = power * (cosines / (PI * away.length_squared()));
        (cosines > 0.0).then(|| (from.ray(direction), source, irradiance))
    }
}

/// A vertex of a path, on a surface.
struct Vertex {
    triangle: TriangleId,
    point: DVec3,
    normal: DVec3,
}

impl Vertex {
    fn of_hit(model: &Model, hit: &Hit) -> Self {
        let normal = model.scene.normal(hit.triangle);
        let normal = if hit.side == Side::Front { normal } else { -normal };
        let point = hit.point.point(model.scene.corners(hit.triangle));
        Self { triangle: hit.triangle, point, normal }
    }

    fn ray(&self, direction: DVec3) -> Ray {
        Ray::leaving(Line { origin: self.point, direction }, self.triangle)
    }
}

/// A path: its last vertex, the throughput from there to its start, and its number in the wave.
struct Walk {
    end: Vertex,
    weight: Rgb,
    number: usize,
    stream: Stream,
}

/// Returns one estimate per path of the irradiance of the front of a triangle.
fn wave(
    model: &Model,
    emitters: &Emitters<'_>,
    tracer: &mut Tracer<'_>,
    triangle: TriangleId,
    lines: Vec<Stream>,
) -> Vec<Rgb> {
    let (corners, normal) = (model.scene.corners(triangle), model.scene.normal(triangle));
    let mut irradiance = vec![Rgb::ZERO; lines.len()];
    let mut walks: Vec<Walk> = lines
        .into_iter()
        .enumerate()
        .map(|(number, mut stream)| {
            let point = point_on_triangle(stream.point()).point(corners);
            Walk { end: Vertex { triangle, point, normal }, weight: Rgb::ONE, number, stream }
        })
        .collect();
    while !walks.is_empty() {
        let (mut rays, mut asked) = (Vec::new(), Vec::new());
        for walk in &mut walks {
            if let Some((ray, source, light)) = emitters.sample(&walk.end, &mut walk.stream) {
                rays.push(ray);
                asked.push((walk.number, source, walk.weight * light));
            }
        }
        tracer.closest_each(&rays, |i, hit| {
            let (number, source, light) = asked[i];
            let Emitter::Surface { triangle, side, .. } = source.emitter else { return };
            if hit.is_some_and(|hit| hit.triangle == triangle && hit.side == side) {
                irradiance[number] += light;
            }
        });
        let rays: Vec<_> = walks
            .iter_mut()
            .map(|walk| {
                let direction = cosine_direction(walk.end.normal, walk.stream.point());
                walk.end.ray(direction)
            })
            .collect();
        let mut hits = vec![None; rays.len()];
        tracer.closest_each(&rays, |i, hit| hits[i] = hit);
        let mut reflected = Vec::new();
        for (mut walk, hit) in walks.into_iter().zip(hits) {
            let Some(hit) = hit.filter(|hit| model.scene.is_active(hit.triangle, hit.side)) else { continue };
            let reflectance = model.scene.reflectance_at(hit.triangle, hit.point);
            // Russian roulette with the largest band.
            let survival = reflectance.max_element();
            if walk.stream.unit() < survival {
                walk.weight *= reflectance / survival;
                walk.end = Vertex::of_hit(model, &hit);
                reflected.push(walk);
            }
        }
        walks = reflected;
    }
    irradiance
}
