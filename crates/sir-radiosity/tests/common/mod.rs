//! Solves scenes with a known answer, and checks the result.
#![allow(dead_code, reason = "each test uses some of it")]
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

use std::f64::consts::PI;

use glam::DVec3;
use serde_json::Value;
use sir_geom::shapes::Facing;
use sir_geom::{Material, MaterialId, Rgb, Scene, SceneBuilder, Side};
use sir_lines::Domain;
use sir_mesh::Subdivision;
use sir_radiosity::{
    AnyOrder, BatchSettings, Batches, FirstShot, Job, Model, ReplicaSettings, Replicas, SecondShot, Sensor,
    Shot, ShotSettings, Stage, StageTotals, Transported, Workers, run_stage,
};

/// Returns the exact answers of a file: see `data/README.md` in `sir-validate`.
pub(crate) fn reference(file: &str) -> Value {
    let path = format!("{}/../sir-validate/data/{file}", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Returns the case with this number.
pub(crate) fn case(file: &Value, id: &str) -> Value {
    let cases = file["cases"].as_array().unwrap();
    cases.iter().find(|c| c["id"] == id).unwrap().clone()
}

pub(crate) fn vector(v: &Value) -> DVec3 {
    let x = |i: usize| v[i].as_f64().unwrap();
    DVec3::new(x(0), x(1), x(2))
}

/// Adds a polygon of a reference file.
pub(crate) fn add_polygon(builder: &mut SceneBuilder, surface: &Value, material: MaterialId) {
    let corners = surface["vertices"].as_array().unwrap().iter().map(|p| builder.add_vertex(vector(p)));
    let corners: Vec<_> = corners.collect();
    builder.add_polygon(&corners, material);
}

/// Adds a sphere of flat quadrilaterals: 36 rings five degrees wide, times `finer`, so that polar angles in multiples
/// of five degrees are edges. `zones` are the polar angles (degrees) where one zone ends and the next begins, with the
/// material of each.
pub(crate) fn add_sphere(
    builder: &mut SceneBuilder,
    radius: f64,
    finer: u32,
    facing: Facing,
    zones: &[(u32, MaterialId)],
) {
    let (rings, segments) = (36 * finer, 72 * finer);
    let at = |ring: u32, segment: u32| {
        let (theta, phi) =
            (PI * f64::from(ring) / f64::from(rings), 2.0 * PI * f64::from(segment) / f64::from(segments));
        let rho = if ring == 0 || ring == rings { 0.0 } else { theta.sin() };
        radius * DVec3::new(rho * phi.cos(), rho * phi.sin(), theta.cos())
    };
    for ring in 0..rings {
        let &(_, material) = zones.iter().find(|&&(end, _)| 5 * ring < finer * end).unwrap();
        for segment in 0..segments {
            let next = (segment + 1) % segments;
            let mut corners =
                vec![at(ring, segment), at(ring + 1, segment), at(ring + 1, next), at(ring, next)];
            // At the poles two corners coincide.
            corners.dedup();
            if corners.first() == corners.last() {
                corners.pop();
            }
            if facing == Facing::Inward {
                corners.reverse();
            }
            let corners: Vec<_> = corners.into_iter().map(|p| builder.add_vertex(p)).collect();
            builder.add_polygon(&corners, material);
        }
    }
}

/// Returns a gray material with exitance `m` and reflectance `rho`.
pub(crate) fn gray(m: f64, rho: f64) -> Material {
    Material::diffuse("", Rgb::splat(rho)).emitting(Rgb::splat(m))
}

/// Returns a first shot whose lines are shared by two workers.
pub(crate) fn shoot(model: &Model, lines: u64, seed: u64) -> Shot {
    let mut stage = FirstShot::begin(ShotSettings::new(model, lines, seed), (), &TwoWorkers).unwrap();
    let mut totals = StageTotals::default();
    stage.trace(0, &mut AnyOrder, 0..lines / 2, &mut totals);
    stage.trace(1, &mut AnyOrder, lines / 2..lines, &mut totals);
    assert!(!stage.advance(&TwoWorkers));
    stage.finish(totals, &TwoWorkers).unwrap()
}

/// Two workers: tallies are allocated for both, jobs are run one after the other.
struct TwoWorkers;

impl Workers for TwoWorkers {
    fn count(&self) -> usize {
        2
    }

    fn run(&self, jobs: Vec<Job<'_>>) {
        jobs.into_iter().rev().for_each(|job| job());
    }
}

/// Returns a second shot after a first one.
pub(crate) fn shoot_again(model: &Model, shot: &Shot, lines: u64, seed: u64) -> Shot {
    run_stage::<SecondShot<'_>>(ShotSettings::new(model, lines, seed), shot.clone()).unwrap()
}

/// Transports the light of a first shot, with a number of lines and a seed.
pub(crate) type Transport = fn(&Model, Shot, u64, u64) -> Transported;

/// Both transports with their names.
pub(crate) const TRANSPORTS: [(&str, Transport); 2] = [("batches", batches), ("multipath", multipath)];

/// Transports light in frozen batches.
pub(crate) fn batches(model: &Model, shot: Shot, lines: u64, seed: u64) -> Transported {
    batches_in(Domain::hull(model.scene.vertices()), model, shot, lines, seed)
}

/// Transports light in frozen batches with lines of a given domain.
pub(crate) fn batches_in(domain: Domain, model: &Model, shot: Shot, lines: u64, seed: u64) -> Transported {
    run_stage::<Batches<'_>>(BatchSettings::new(model, domain, lines, seed), shot).unwrap()
}

/// Transports light by multipath in one replica.
pub(crate) fn multipath(model: &Model, shot: Shot, lines: u64, seed: u64) -> Transported {
    multipath_in(Domain::hull(model.scene.vertices()), model, shot, lines, seed)
}

/// Transports light by multipath in one replica with lines of a given domain.
pub(crate) fn multipath_in(domain: Domain, model: &Model, shot: Shot, lines: u64, seed: u64) -> Transported {
    // A long tail: the power left unshot must be far below standard errors of about 0.01 %.
    let settings = ReplicaSettings::new(model, domain, lines, seed);
    replicas(shot, ReplicaSettings { tail: 3 * (lines / 10), ..settings })
}

/// Transports light by multipath in any number of replicas.
pub(crate) fn replicas(shot: Shot, settings: ReplicaSettings<'_>) -> Transported {
    run_stage::<Replicas<'_>>(settings, shot).unwrap()
}

/// Returns all domains around the scene of a model.
pub(crate) fn domains(model: &Model) -> [Domain; 3] {
    let scene = &model.scene;
    [
        Domain::Sphere(scene.bounding_sphere()),
        Domain::Box(scene.bounding_box()),
        Domain::hull(scene.vertices()),
    ]
}

/// Returns the radiosity of every material: the area-weighted mean of its fronts.
pub(crate) fn radiosities(model: &Model, run: &Transported) -> Vec<Rgb> {
    let materials = model.scene.materials().len();
    let (mut sums, mut areas) = (vec![Rgb::ZERO; materials], vec![0.0; materials]);
    let solution = run.solution(model);
    model.mesh.for_each_side(|triangle, patch, side, id| {
        if side == Side::Front {
            let (m, area) =
                (model.scene.triangle(triangle).material.index(), model.mesh.patch_area(triangle, patch));
            sums[m] += solution.radiosity(model, triangle, side, id) * area;
            areas[m] += area;
        }
    });
    sums.iter().zip(&areas).map(|(s, a)| *s / *a).collect()
}

/// Returns the power that each material receives in the first band \[W\].
pub(crate) fn received(model: &Model, shot: &Shot) -> Vec<f64> {
    let mut sums = vec![0.0; model.scene.materials().len()];
    model.mesh.for_each_side(|triangle, _, _, side| {
        let power = shot.unit.watts(shot.received.power[side.index()]).x;
        sums[model.scene.triangle(triangle).material.index()] += power;
    });
    sums
}

/// Mean of a number from independent runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Estimate {
    pub(crate) mean: f64,
    /// Standard error of the mean.
    pub(crate) sigma: f64,
    /// Degrees of freedom: number of runs minus one.
    freedom: f64,
}

impl Estimate {
    pub(crate) fn of(samples: impl IntoIterator<Item = f64>) -> Self {
        let samples: Vec<f64> = samples.into_iter().collect();
        let n = samples.len() as f64;
        let mean = samples.iter().sum::<f64>() / n;
        let variance = samples.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
        Self { mean, sigma: (variance / n).sqrt(), freedom: n - 1.0 }
    }

    /// Returns the number of standard errors that corresponds to four of a normal variable. It is larger, because the
    /// standard error of a few runs is itself uncertain (Student's t, by the expansion of Cornish and Fisher 1938): 5.4
    /// for 16 runs.
    fn limit(self) -> f64 {
        let (z, n) = (4.0_f64, self.freedom);
        z + (z.powi(3) + z) / (4.0 * n) + (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * n * n)
    }

    /// Asserts that the mean is exact except for chance, with a standard error of at most 0.3 %.
    #[track_caller]
    pub(crate) fn assert_is(self, exact: f64, what: &str) {
        let z = (self.mean - exact) / self.sigma;
        let relative = self.sigma / exact;
        println!("{what}: {:.5} ± {:.3} %, exact {exact:.5}, z = {z:+.2}", self.mean, 100.0 * relative);
        assert!(relative <= 0.003, "{what}: the standard error is {:.2} %", 100.0 * relative);
        // Where power is conserved and all surfaces are alike, chance plays no part, but power comes in whole quanta.
        let rounding = 1e-9 * exact;
        let limit = self.limit() * self.sigma + rounding;
        assert!(
            (self.mean - exact).abs() <= limit,
            "{what}: {:.6} ± {:.6}, exact {exact:.6}",
            self.mean,
            self.sigma
        );
    }
}

/// Returns the radiosities of the materials in independent runs, with this number of lines in both stages.
pub(crate) fn runs(model: &Model, transport: Transport, lines: u64, count: u64) -> Vec<Vec<Rgb>> {
    let one = |seed| radiosities(model, &transport(model, shoot(model, lines, seed), lines, seed));
    (1..=count).map(one).collect()
}

/// Returns a model with one patch per face.
pub(crate) fn per_face(builder: SceneBuilder) -> Model {
    Model::new(scene(builder), Subdivision::PerFace).unwrap()
}

pub(crate) fn scene(builder: SceneBuilder) -> Scene {
    builder.build().unwrap().scene
}

/// Returns the cosine-weighted share of the hemisphere of a sensor that a polygon takes, as a sum over its edges
/// (Lambert 1760). The polygon must be completely in front of the sensor.
pub(crate) fn factor(sensor: &Sensor, corners: &[DVec3]) -> f64 {
    let to = |i: usize| (corners[i % corners.len()] - sensor.position()).normalize();
    let edge = |i: usize| {
        let cross = to(i).cross(to(i + 1));
        cross.normalize().dot(sensor.direction()) * to(i).angle_between(to(i + 1))
    };
    ((0..corners.len()).map(edge).sum::<f64>() / (2.0 * PI)).abs()
}
