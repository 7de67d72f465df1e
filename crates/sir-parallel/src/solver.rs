//! High-level solver: from a scene to its light in ten lines of code.

use std::num::NonZeroUsize;

use sir_geom::{Rgb, Scene, Side, TriangleId};
use sir_lines::{Domain, LocalLines};
use sir_mesh::{PatchId, PatchSize, SideId, Subdivision};
use sir_radiosity::{
    BatchSettings, Batches, FirstShot, Model, ModelError, Received, SecondShot, ShotSettings, Solution,
};
use thiserror::Error;

use crate::driver::Start;
use crate::error::RunError;
use crate::executor::{Executor, cores};
use crate::threads::Threads;

/// Solver for the light in a scene: a first shot, an optional second shot, and multipath in batches. By default it uses
/// all cores of this machine.
///
/// The default settings are 10,000 patches, 1,000,000 lines in the first shot, 2,000,000 global lines through the
/// convex hull, and the seed 1. The same scene, settings and seed give bit-identical results with any number of
/// threads.
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

/// Error of the solver.
#[derive(Debug, Error)]
pub enum SolverError {
    /// The scene cannot be prepared.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A stage failed.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// Scene with its light.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The scene and its patches.
    pub model: Model,
    /// Irradiance of all sides of patches, with standard errors \[W/m²\].
    pub solution: Solution,
    /// Power received by each side, in quanta: the exact tallies, whose [hash](Received::hash) identifies the result.
    pub received: Received,
}

/// Light of one side of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideLight {
    /// A triangle of the surface to which the patch belongs.
    pub triangle: TriangleId,
    /// Patch.
    pub patch: PatchId,
    /// Side of the patch.
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
            subdivision: Subdivision::Surfaces(PatchSize::Count(10_000)),
            first: 1_000_000.into(),
            second: None,
            global: 2_000_000,
            domain: None,
            seed: 1,
            threads: cores(),
        }
    }

    /// Sets the approximate number of patches, of surfaces.
    #[must_use]
    pub fn patches(self, count: u64) -> Self {
        self.subdivision(Subdivision::Surfaces(PatchSize::Count(count)))
    }

    /// Sets the subdivision of the scene into patches.
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

    /// Adds a second shot with this number of lines.
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

    /// Sets the domain of the global lines. The default is the convex hull of the scene.
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

    /// Sets the number of threads. It does not change the result.
    #[must_use]
    pub fn threads(mut self, threads: NonZeroUsize) -> Self {
        self.threads = threads;
        self
    }

    /// Computes the light.
    ///
    /// # Errors
    ///
    /// If the scene cannot be cut into patches, nothing emits, or a tally overflows.
    pub fn solve(self) -> Result<Solved, SolverError> {
        let threads = self.threads;
        self.solve_with(&mut Executor::new(threads))
    }

    /// Computes the light with the given executor, for example with an observer or with the ranks of an MPI run. The
    /// number of threads is that of the executor.
    ///
    /// # Errors
    ///
    /// As for [`solve`](Self::solve), or if the observer asks to stop.
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
            let received = all.received(&model, &Threads(executor.threads));
            (Solution::new(&model, &received, all.unit), received)
        };
        Ok(Solved { model, solution, received })
    }
}

impl Solved {
    /// Calls `visit` with the light of every active side of every patch.
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
