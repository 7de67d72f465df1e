//! Stated errors agree with true ones. Over 200 seeds of scenes with an exact answer, the deviation over the standard
//! error has a root mean square of 1, and a 95 % interval contains the answer in 95 % of all cases.
//!
//! The numbers of lines and patches are chosen such that only noise matters. About a hundred lines meet a patch,
//! because with few lines the stated error is itself uncertain, and correlated with the value.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

use std::sync::Arc;

mod common;

use common::{batches, gray, replicas, scene, shoot, shoot_again};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_lines::{Domain, seed_of_repeat};
use sir_mesh::{PatchSize, Per, SideSums, Subdivision};
use sir_radiosity::{
    FocusSides, MIN_REPEATS, Model, OneWorker, PowerUnit, Received, Repeats, ReplicaSettings, Solution,
    Transported,
};

const SEEDS: u64 = 200;

/// Quantile of the normal distribution: 5 % of all deviates exceed it in magnitude.
const NORMAL: f64 = 1.959_964;

/// The same quantile of Student's t with seven degrees of freedom, and its root mean square: `√(7/5)`.
const STUDENT: (f64, f64) = (2.364_624, 1.183_216);

/// The same quantile with six degrees of freedom: the first repeat is not among the deviations of sums.
const STUDENT_OF_SIX: f64 = 2.446_912;

/// A model with the exact irradiance of all its patches: by the sources alone, and in total.
struct Exact {
    name: &'static str,
    model: Model,
    direct: Rgb,
    all: Rgb,
    /// Mean number of lines of each stage that meet a patch.
    per_patch: u64,
}

/// Result of a run: power with its variance, and the unit of the power.
type Outcome = (Received, PowerUnit);

/// Returns a closed cube whose faces all emit 1 W/m². Its irradiance is a geometric series.
fn furnace() -> Exact {
    let reflectance = Rgb::new(0.5, 0.8, 0.9);
    let mut b = SceneBuilder::new();
    let wall = b.add_material(Material::diffuse("", reflectance).emitting(Rgb::ONE));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::ONE, [wall; 6], Facing::Inward);
    let model = Model::new(scene(b), Subdivision::Triangles(PatchSize::Count(150))).unwrap();
    Exact {
        name: "furnace",
        model,
        direct: Rgb::ONE,
        all: Rgb::ONE / (Rgb::ONE - reflectance),
        per_patch: 100,
    }
}

/// Returns the inside of a sphere, a cap of which emits. Light from anywhere is distributed uniformly over the sphere,
/// so the irradiance is the same geometric series. The facets of 5° change it by less than a percent, a tenth of the
/// noise.
fn lamp_in_a_sphere() -> Exact {
    let reflectance = 0.6;
    let mut b = SceneBuilder::new();
    let [wall, lamp] = [0.0, 10.0].map(|exitance| b.add_material(gray(exitance, reflectance)));
    shapes::sphere(&mut b, DVec3::ZERO, 1.0, 3, Facing::Inward, |to| if to.z > 0.9 { lamp } else { wall });
    let model = Model::new(scene(b), Subdivision::PerTriangle).unwrap();
    let power: Rgb =
        sir_radiosity::sources(&model.scene, &model.mesh).iter().map(|source| source.power).sum();
    let direct = power / model.scene.total_area();
    Exact { name: "lamp in a sphere", model, direct, all: direct / (1.0 - reflectance), per_patch: 60 }
}

/// Returns a cube with one bright face. Its exact answer is not needed.
fn lamp_in_a_cube() -> Exact {
    let mut b = SceneBuilder::new();
    let [wall, lamp] = [0.0, 1.0].map(|exitance| b.add_material(gray(exitance, 0.8)));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::ONE, [wall, wall, wall, wall, wall, lamp], Facing::Inward);
    let model = Model::new(scene(b), Subdivision::Surfaces(PatchSize::Count(150))).unwrap();
    Exact { name: "lamp in a cube", model, direct: Rgb::ZERO, all: Rgb::ZERO, per_patch: 100 }
}

impl Exact {
    /// Returns the number of lines for which each patch is met by `per_patch` lines on average.
    fn lines(&self, per_patch: u64, ends: u64) -> u64 {
        per_patch * self.model.mesh.side_count() as u64 / ends
    }

    fn first_shot(&self, seed: u64) -> Outcome {
        let shot = shoot(&self.model, self.lines(self.per_patch, 1), seed);
        (shot.received, shot.unit)
    }

    fn batches(&self, per_patch: u64, seed: u64) -> Outcome {
        let all = self.transported(per_patch, seed);
        (all.received(&self.model, &OneWorker), all.unit)
    }

    fn transported(&self, per_patch: u64, seed: u64) -> Transported {
        let first = shoot(&self.model, self.lines(per_patch, 1), seed);
        let shot = shoot_again(&self.model, &first, self.lines(per_patch / 4, 1), seed);
        batches(&self.model, shot, self.lines(per_patch, 2), seed)
    }

    fn replicas(&self, seed: u64) -> Outcome {
        let first = shoot(&self.model, self.lines(self.per_patch, 1), seed);
        let shot = shoot_again(&self.model, &first, self.lines(self.per_patch / 4, 1), seed);
        let lines = self.lines(2 * self.per_patch, 2);
        // With a tail of this length, the missing power is negligible.
        let settings = ReplicaSettings {
            replicas: 2,
            tail: lines / 2,
            ..ReplicaSettings::new(&self.model, Domain::hull(self.model.scene.vertices()), lines, seed)
        };
        let all = replicas(shot, settings);
        (all.uncounted, all.unit)
    }

    /// Returns the smallest number of repeats for which errors are computed from their spread, and the unit of the power.
    fn repeated(&self, seed: u64, sums: &[Arc<SideSums>]) -> (Repeats, PowerUnit) {
        let mut repeats = Repeats::new(self.model.mesh.side_count()).with_sums(sums);
        let mut unit = None;
        for repeat in 0..MIN_REPEATS {
            let all = self.transported(24, seed_of_repeat(seed, repeat));
            repeats.add(&self.model, &all.uncounted, all.counted.as_ref(), &OneWorker);
            unit = Some(all.unit);
        }
        assert!(repeats.have_spread());
        (repeats, unit.unwrap())
    }

    /// Returns the mean of repeats.
    fn repeats(&self, seed: u64) -> Outcome {
        let (repeats, unit) = self.repeated(seed, &[]);
        (repeats.mean(&self.model, &FocusSides::all(), &OneWorker), unit)
    }

    /// Checks the errors of the mean irradiance of parts of the scene against the deviations from the mean of all seeds.
    /// Prints how large these are over the errors that follow if patches are independent, too.
    fn assert_honest_sums(&self, per: Per) {
        let Model { scene, mesh, .. } = &self.model;
        let sums = Arc::new(SideSums::new(scene, mesh, per));
        let parts = sums.parts().len();
        let (mut means, mut errors) = (vec![Vec::new(); parts], vec![Vec::new(); parts]);
        let mut independent = 0.0;
        for seed in 1..=SEEDS {
            let (repeats, unit) = self.repeated(seed, std::slice::from_ref(&sums));
            let mean = repeats.mean(&self.model, &FocusSides::all(), &OneWorker);
            let Solution { irradiance, error } = Solution::new(&self.model, &mean, unit);
            let of_parts = repeats.errors_of_sums(0, &self.model, &FocusSides::all(), unit).unwrap();
            let mut totals = vec![(Rgb::ZERO, Rgb::ZERO, 0.0); parts];
            mesh.for_each_side(|t, patch, _, side| {
                let (area, e, se) =
                    (mesh.covered_area(t, patch), irradiance[side.index()], error[side.index()]);
                for (part, share) in sums.shares(side) {
                    let (sum, squares, all) = &mut totals[part];
                    *sum += share * area * e;
                    *squares += (share * area * se) * (share * area * se);
                    *all += share * area;
                }
            });
            for (part, (sum, squares, area)) in totals.into_iter().enumerate() {
                means[part].push(sum / area);
                errors[part].push(of_parts[part][0]);
                independent += (squares / (area * area)).element_sum();
            }
        }
        let (mut within, mut deviations, mut stated) = (0.0, 0.0, 0.0);
        for (means, errors) in means.iter().zip(&errors) {
            let mean = means.iter().sum::<Rgb>() / SEEDS as f64;
            for (value, error) in means.iter().zip(errors) {
                deviations += ((value - mean) * (value - mean)).element_sum();
                stated += (error * error).element_sum();
                let z = (value - mean) / error;
                within += z.to_array().iter().filter(|z| z.abs() <= STUDENT_OF_SIX).count() as f64;
            }
        }
        let (spread, within) =
            (f64::sqrt(deviations / stated), 100.0 * within / (3 * SEEDS as usize * parts) as f64);
        let independent = f64::sqrt(deviations / independent);
        println!(
            "{}, {per:?}: {spread:.3} of the stated error, within {within:.1} %, independent {independent:.3}",
            self.name
        );
        assert!((0.9..1.1).contains(&spread), "{}, {per:?}: {spread}", self.name);
        assert!((93.0..97.5).contains(&within), "{}, {per:?}: {within} %", self.name);
    }

    /// Checks one way to light the scene. If the stated errors are correct, 5 % of the deviations exceed `quantile`,
    /// and `rms` is their root mean square.
    #[track_caller]
    fn assert_honest(
        &self,
        way: &str,
        answer: Rgb,
        (quantile, rms): (f64, f64),
        run: impl Fn(&Self, u64) -> Outcome,
    ) {
        let (mut squares, mut within, mut sum, mut count) = (Rgb::ZERO, Rgb::ZERO, Rgb::ZERO, 0.0);
        for seed in 1..=SEEDS {
            let (received, unit) = run(self, seed);
            let Solution { irradiance, error } = Solution::new(&self.model, &received, unit);
            for (value, error) in irradiance.into_iter().zip(error) {
                let z = (value - answer) / error;
                squares += z * z;
                within += z.map(|z| f64::from(u8::from(z.abs() <= quantile)));
                sum += z;
                count += 1.0;
            }
        }
        let (spread, within, mean) =
            ((squares / count).map(f64::sqrt) / rms, 100.0 * within / count, sum / count);
        println!("{}, {way}: rms {spread:.3}, within {within:.1} %, mean {mean:+.3}", self.name);
        assert!(
            spread.min_element() >= 0.9 && spread.max_element() <= 1.1,
            "{}, {way}: rms {spread}",
            self.name
        );
        assert!(
            within.min_element() >= 93.0 && within.max_element() <= 97.0,
            "{}, {way}: {within} %",
            self.name
        );
    }
}

#[test]
fn errors_of_a_first_shot() {
    for exact in [furnace(), lamp_in_a_sphere()] {
        exact.assert_honest("first shot", exact.direct, (NORMAL, 1.0), Exact::first_shot);
    }
}

#[test]
fn errors_of_batches() {
    for exact in [furnace(), lamp_in_a_sphere()] {
        exact.assert_honest("batches", exact.all, (NORMAL, 1.0), |exact, seed| {
            exact.batches(exact.per_patch, seed)
        });
    }
}

#[test]
fn errors_of_replicas() {
    let exact = furnace();
    exact.assert_honest("replicas", exact.all, (NORMAL, 1.0), Exact::replicas);
}

#[test]
fn errors_of_sums() {
    furnace().assert_honest_sums(Per::Face);
    lamp_in_a_cube().assert_honest_sums(Per::Material);
}

#[test]
fn errors_from_the_spread_of_repeats() {
    let exact = furnace();
    exact.assert_honest("spread of repeats", exact.all, STUDENT, Exact::repeats);
}
