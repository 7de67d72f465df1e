//! A small modeling kit that assembles polygons into closed solids.
//!
//! Every solid follows these rules, so that light neither leaks nor gets lost:
//!
//! * A solid is closed: every edge joins exactly two triangles, which run along it in opposite directions.
//! * Solids do not touch: for example, [`GAP`] separates a leg from the floor. If one solid reached into another, the
//!   radiosity of a partly hidden patch would be a mean over its whole area, and the power of its hidden part would be
//!   lost.
//! * Positions are multiples of 2⁻¹⁶ m (see [`Model::store`]).

mod carve;
mod cells;
pub(crate) mod furnish;
mod lathe;
mod loft;
pub(crate) mod pillow;
mod prism;
pub(crate) mod sheet;
pub(crate) mod wall;

use glam::{DAffine3, DVec3};
use sir_geom::{MaterialId, SceneBuilder};

/// Distance between solids that stand on or lean against each other \[m\].
pub(crate) const GAP: f64 = 0.001;

/// Number of position steps per meter. Positions are integer multiples of a step.
const STEPS_PER_METER: f64 = 65536.0;

/// Polygons with materials. Corners are counterclockwise seen from the front.
#[derive(Clone, Debug, Default)]
pub(crate) struct Model {
    polygons: Vec<(Vec<DVec3>, MaterialId)>,
}

impl Model {
    /// Adds one convex planar polygon.
    pub(crate) fn polygon(&mut self, corners: &[DVec3], material: MaterialId) {
        self.polygons.push((corners.to_vec(), material));
    }

    /// Adds another model, transformed by `place`.
    pub(crate) fn add(&mut self, other: &Self, place: DAffine3) {
        self.polygons.extend(other.polygons.iter().map(|(corners, material)| {
            (corners.iter().map(|&p| place.transform_point3(p)).collect(), *material)
        }));
    }

    /// Adds another model, translated by (`x`, `y`, `z`).
    pub(crate) fn add_at(&mut self, other: &Self, x: f64, y: f64, z: f64) {
        self.add(other, DAffine3::from_translation(DVec3::new(x, y, z)));
    }

    /// Adds the polygons to a scene, with all coordinates rounded to multiples of 2⁻¹⁶ m (15 µm).
    ///
    /// Rounded coordinates are exact in 32-bit floats, so that the scene equals its file. They also do not depend on
    /// the last bits of a machine's sine.
    pub(crate) fn store(&self, builder: &mut SceneBuilder) {
        for (corners, material) in &self.polygons {
            let corners: Vec<_> = corners
                .iter()
                .map(|&p| builder.add_vertex((p * STEPS_PER_METER).round() / STEPS_PER_METER))
                .collect();
            builder.add_polygon(&corners, *material);
        }
    }
}
