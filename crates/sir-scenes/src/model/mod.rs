//! A small modeling kit: polygons that are put together into closed shapes.
//!
//! Rules that every shape keeps, so that a scene made of them has no light that leaks or is lost:
//!
//! * A solid is closed: every edge joins exactly two triangles, which run along it in opposite directions.
//! * Solids do not touch: [`GAP`] is left between a leg and the floor. A part inside another would get light on
//!   average with its whole patch, and lose it where it is hidden.
//! * Positions are multiples of 2⁻¹⁶ m (see [`Model::store`]).

mod carve;
pub(crate) mod furnish;
mod lathe;
mod loft;
pub(crate) mod pillow;
mod prism;
pub(crate) mod sheet;
pub(crate) mod wall;

use glam::{DAffine3, DVec3};
use sir_geom::{MaterialId, SceneBuilder};

/// Distance between things that stand on or lean against each other \[m\].
pub(crate) const GAP: f64 = 0.001;

/// Positions are whole multiples of one part in this many of a meter.
const STEPS_PER_METRE: f64 = 65536.0;

/// Polygons with materials, counterclockwise seen from their fronts.
#[derive(Clone, Debug, Default)]
pub(crate) struct Model {
    polygons: Vec<(Vec<DVec3>, MaterialId)>,
}

impl Model {
    /// Adds one convex planar polygon.
    pub(crate) fn polygon(&mut self, corners: &[DVec3], material: MaterialId) {
        self.polygons.push((corners.to_vec(), material));
    }

    /// Adds another model, moved by a rotation and a translation.
    pub(crate) fn add(&mut self, other: &Self, place: DAffine3) {
        self.polygons.extend(other.polygons.iter().map(|(corners, material)| {
            (corners.iter().map(|&p| place.transform_point3(p)).collect(), *material)
        }));
    }

    /// Adds another model, moved without a turn.
    pub(crate) fn add_at(&mut self, other: &Self, x: f64, y: f64, z: f64) {
        self.add(other, DAffine3::from_translation(DVec3::new(x, y, z)));
    }

    /// Adds the polygons to a scene, with all coordinates rounded to 2⁻¹⁶ m (15 µm).
    ///
    /// Rounded numbers are exact in 32-bit floats too, so that the scene and its file are the same, and they do not
    /// depend on the last bits of a machine's sine.
    pub(crate) fn store(&self, builder: &mut SceneBuilder) {
        for (corners, material) in &self.polygons {
            let corners: Vec<_> = corners
                .iter()
                .map(|&p| builder.add_vertex((p * STEPS_PER_METRE).round() / STEPS_PER_METRE))
                .collect();
            builder.add_polygon(&corners, *material);
        }
    }
}
