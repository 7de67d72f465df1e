//! A solver in ten lines.

use std::num::NonZeroUsize;

use sir_geom::{Rgb, Scene, Side, TriangleId};
use sir_lines::{Domain, LocalLines};
use sir_mesh::{PatchId, SideId, Subdivision};
use sir_radiosity::{
    BatchSettings, Batches, FirstShot, Model, ModelError, Received, SecondShot, ShotSettings, Solution,
};
use thiserror::Error;

use crate::driver::Start;
use crate::error::RunError;
use crate::executor::{Executor, cores};

/// Computes the light in a scene, on all cores of this machine: a first shot, an optional second shot, and multipath in batches.
///
/// Without other settings it uses 10,000 patches, 1,000,000 lines in the first shot, 2,000,000 global lines through the
/// convex hull, and the seed 1. One scene, one set of settings and one seed give the same bits on any number of threads.
///
/// ```
/// use sir_geom::{Material, Rgb, SceneBuilder, shapes::{self, Facing}};
/// use glam::DVec3;
/// use sir_parallel::Solver;
///
/// // A closed box whose faces emit M = 1 W/m² and reflect ρ = 0.5: its radiosity is M / (1 − ρ) = 2 W/m² everywhere.
/// let mut builder = SceneBuilder::new();
/// let gray = Material::diffuse("gray", Rgb::splat(0.5)).emitting(Rgb::splat(1.0));
/// let gray = builder.add_material(gray);
/// shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
///
/// let solved = Solver::new(builder.build()?.scene).patches(100).first_shot(50_000).multipath(100_000).seed(1).solve()?;
/// solved.for_each_side(|side| {
///     assert!((side.radiosity - 2.0).abs().cmplt(5.0 * side.error).all(), "{} ± {}", side.radiosity, side.error);
/// });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Solver {
    scene: Scene,
    subdivision: Subdivision,
    first: LocalLines,
    second: Option<LocalLines>,
    global: u64,
    domain: Option<Domain>,
    seed: u64,
    threads: NonZeroUsize,
}

/// Why the light was not computed.
#[derive(Debug, Error)]
pub enum SolverError {
    /// The scene cannot be prepared.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A stage failed.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// A scene with its light.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The scene and its patches.
    pub model: Model,
    /// Irradiance of all sides of patches, with standard errors \[W/m²\].
    pub solution: Solution,
    /// Power received by each side: the exact tallies, whose [hash](Received::hash) identifies the result.
    pub received: Received,
}

/// The light of one side of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideLight {
    /// The triangle that the patch is a part of.
    pub triangle: TriangleId,
    /// The patch.
    pub patch: PatchId,
    /// Which side of it.
    pub side: Side,
    /// Irradiance per band \[W/m²\].
    pub irradiance: Rgb,
    /// Radiosity per band: emitted and reflected light \[W/m²\].
    pub radiosity: Rgb,
    /// Standard error of the radiosity per band \[W/m²\].
    pub error: Rgb,
}

impl Solver {
    /// Returns a solver for a scene.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        Self {
            scene,
            subdivision: Subdivision::Patches(10_000),
            first: 1_000_000.into(),
            second: None,
            global: 2_000_000,
            domain: None,
            seed: 1,
            threads: cores(),
        }
    }

    /// Sets about how many patches the scene is cut into.
    #[must_use]
    pub fn patches(self, count: u64) -> Self {
        self.subdivision(Subdivision::Patches(count))
    }

    /// Sets how the scene is cut into patches.
    #[must_use]
    pub fn subdivision(mut self, subdivision: Subdivision) -> Self {
        self.subdivision = subdivision;
        self
    }

    /// Sets the number of lines of the first shot.
    #[must_use]
    pub fn first_shot(mut self, lines: impl Into<LocalLines>) -> Self {
        self.first = lines.into();
        self
    }

    /// Adds a second shot of so many lines.
    #[must_use]
    pub fn second_shot(mut self, lines: impl Into<LocalLines>) -> Self {
        self.second = Some(lines.into());
        self
    }

    /// Sets the number of global lines; 0 for direct light only.
    #[must_use]
    pub fn multipath(mut self, lines: u64) -> Self {
        self.global = lines;
        self
    }

    /// Sets what global lines are drawn through instead of the convex hull of the scene.
    #[must_use]
    pub fn domain(mut self, domain: Domain) -> Self {
        self.domain = Some(domain);
        self
    }

    /// Sets the seed of the random numbers.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Sets the number of threads, which does not change the result.
    #[must_use]
    pub fn threads(mut self, threads: NonZeroUsize) -> Self {
        self.threads = threads;
        self
    }

    /// Computes the light.
    ///
    /// # Errors
    ///
    /// If the scene cannot be cut into patches, nothing emits, or a tally overflowed.
    pub fn solve(self) -> Result<Solved, SolverError> {
        let threads = self.threads;
        self.solve_with(&mut Executor::new(threads))
    }

    /// Computes the light with an executor: with an observer, or with the other processes of an MPI run.
    ///
    /// # Errors
    ///
    /// As [`solve`](Self::solve), or if the observer wants to stop.
    pub fn solve_with(self, executor: &mut Executor<'_>) -> Result<Solved, SolverError> {
        let Self { scene, subdivision, first, second, global, domain, seed, .. } = self;
        let model = Model::new(scene, subdivision)?;
        let settings = ShotSettings::new(&model, first, seed);
        let mut shot = executor.run::<FirstShot<'_>>(settings, Start::Fresh(()))?.outcome;
        if let Some(lines) = second {
            let settings = ShotSettings::new(&model, lines, seed);
            shot = executor.run::<SecondShot<'_>>(settings, Start::Fresh(shot))?.outcome;
        }
        let (solution, received) = if global == 0 {
            (shot.solution(&model), shot.received)
        } else {
            let domain = domain.unwrap_or_else(|| Domain::hull(model.scene.vertices()));
            let settings = BatchSettings::new(&model, domain, global, seed);
            let all = executor.run::<Batches<'_>>(settings, Start::Fresh(shot))?.outcome;
            (all.solution, all.received)
        };
        Ok(Solved { model, solution, received })
    }
}

impl Solved {
    /// Calls a function with the light of every active side of every patch.
    pub fn for_each_side(&self, mut visit: impl FnMut(SideLight)) {
        let Self { model, solution, .. } = self;
        model.mesh.for_each_side(|triangle, patch, side, id: SideId| {
            visit(SideLight {
                triangle,
                patch,
                side,
                irradiance: solution.irradiance[id.index()],
                radiosity: solution.radiosity(model, triangle, side, id),
                error: solution.standard_error(model, triangle, id),
            });
        });
    }
}
