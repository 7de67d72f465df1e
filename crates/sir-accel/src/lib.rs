//! Closest hit and all hits along lines, watertight without exception.
//!
//! # Design
//!
//! A global line needs *every* surface that it crosses, in order, and with the right parity: a closed surface must
//! be crossed an even number of times, or power leaks. Floating-point tests lose or double hits on edges and
//! corners. This crate avoids that by construction instead of by tolerance:
//!
//! * Corners are rounded to an integer grid of 2³¹ steps across the scene's bounding sphere, lines to one 256 times
//!   finer. From there on a crossing is a question about integers, with one right answer. Whether a line passes an
//!   edge on the left or on the right is decided in double precision when that is certain, and otherwise in 128-bit
//!   integers.
//! * A line that meets an edge or a corner *exactly* is treated as shifted by an infinitesimal `(ε, ε², ε³)`
//!   (a symbolic perturbation after Edelsbrunner and Mücke 1990). One shift for the whole line: neighbouring
//!   triangles cannot disagree. A line therefore crosses every closed triangle mesh an even number of times.
//! * Surfaces in contact (a decal on a wall, two sheets back to back) are put in order by a rule that is the same
//!   in both directions of the line, not by rounding: see [`Hit`].
//!
//! # Surfaces with gaps
//!
//! A triangle of opacity `α` stops a line with the probability `α`, and a texture may say that `α` differs from place to
//! place ([`Opacity`](sir_geom::Opacity)). A hash of line and triangle decides, so that a line is a function of nothing
//! but itself. A line that passes goes straight on, as if the triangle were not there. What closed surfaces promise holds for
//! what is crossed, and no longer for what is hit: a line may pass the front of a leaf and meet its back. Neighbouring hits
//! face each other all the same. [`Tracer::all_crossings_each`] passes over nothing, for those who want no chance in it.
//!
//! # Speed
//!
//! The tree comes from `obvhs` and is cut into nodes of sixteen boxes. It holds the input triangles only, however finely
//! they are cut into patches. A line visits few nodes and few leaves, but would wait for the memory of each: so many lines
//! are under way at once ([`Tracer::all_hits_each`], [`Tracer::closest_each`]), each a step at a time, and ask for
//! what they need some time before. Boxes and triangles are sorted out in single precision, with a margin for rounding; what
//! is left is crossed in double precision, eight crossings at a time. All of it is written once, for any set of vector
//! instructions, and compiled for AVX-512, for AVX2 and for none; the processor decides at run time, and the hits are the
//! same bit for bit.
//!
//! # Example
//!
//! ```
//! use glam::DVec3;
//! use sir_accel::Accel;
//! use sir_geom::{Line, Material, Rgb, SceneBuilder, Side, shapes::{self, Facing}};
//!
//! let mut builder = SceneBuilder::new();
//! let grey = builder.add_material(Material::diffuse("grey", Rgb::splat(0.5)));
//! shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [grey; 6], Facing::Inward);
//! let scene = builder.build()?.scene;
//! let accel = Accel::new(&scene);
//! let mut tracer = accel.tracer();
//!
//! // Along a diagonal of the cube, through two corners where six triangles meet:
//! let line = Line { origin: DVec3::splat(-1.0), direction: DVec3::ONE.normalize() };
//! let sides: Vec<Side> = tracer.all_hits(&line).iter().map(|hit| hit.side).collect();
//! assert_eq!(sides, [Side::Back, Side::Front]);
//! # Ok::<(), sir_geom::SceneError>(())
//! ```

mod build;
mod grid;
mod hit;
mod kits;
mod lanes;
mod leaf;
mod memory;
mod search;
mod tracer;
mod tree;
mod triangle;
mod veil;

pub use hit::Hit;
pub use memory::{collect_in_large_pages, prefetch};
pub use tracer::{LineHits, Ray, Tracer};

use sir_geom::Scene;

use crate::grid::Grid;
use crate::kits::Kits;
use crate::tree::Tree;
use crate::veil::Veil;

/// The triangles of a scene, arranged for lines to be traced.
#[derive(Clone, Debug)]
pub struct Accel {
    grid: Grid,
    tree: Tree,
    /// `None` if all surfaces are opaque.
    veil: Option<Veil>,
}

impl Accel {
    /// Arranges the triangles of a scene. Takes about a second per million triangles.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let grid = Grid::new(scene.bounding_sphere());
        let tree = Tree::new(scene, &grid);
        Self { grid, tree, veil: Veil::of(scene) }
    }

    /// Something to trace lines with; make one per thread.
    #[must_use]
    pub fn tracer(&self) -> Tracer<'_> {
        Tracer::new(self, Kits::best())
    }

    /// Memory in use, without textures \[bytes\].
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + self.veil.as_ref().map_or(0, Veil::bytes)
    }
}
