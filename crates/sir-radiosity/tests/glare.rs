//! The unified glare rating of a case that is worked by hand in `docs/method.md`.

#![allow(clippy::unwrap_used, reason = "a failure is a failed test")]

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_mesh::Subdivision;
use sir_radiosity::{GlareSources, Model, unified_glare_rating};

/// Radius of the room and of its lamp [m], and the luminance of the lamp [cd/m²].
const ROOM: f64 = 3.0;
const LAMP: f64 = 0.1;
const LUMINANCE: f64 = 10_000.0;

/// A disc of 64 corners that faces the center of the room from 30° above the horizon along +x.
fn lamp() -> Model {
    let mut builder = SceneBuilder::new();
    let lit = Material::diffuse("lamp", Rgb::ZERO).emitting(Rgb::splat(PI * LUMINANCE));
    let lit = builder.add_material(lit);
    let axis = DVec3::new(0.75f64.sqrt(), 0.5, 0.0);
    let (up, side) = (DVec3::new(-0.5, 0.75f64.sqrt(), 0.0), DVec3::Z);
    let corners: Vec<_> = (0..64)
        .map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / 64.0).sin_cos();
            // The polygon has the area of the disc.
            let radius = LAMP * ((TAU / 64.0) / (TAU / 64.0).sin()).sqrt();
            builder.add_vertex(ROOM * axis + radius * (cos * up - sin * side))
        })
        .collect();
    builder.add_polygon(&corners, lit);
    Model::new(builder.build().unwrap().scene, Subdivision::PerTriangle).unwrap()
}

#[test]
fn the_rating_of_the_case_by_hand() {
    let model = lamp();
    let sources = GlareSources::of(&model, DVec3::Y);
    let sum = sources.sum(DVec3::ZERO, DVec3::X, &mut model.accel.tracer());
    // In a sphere all walls receive the same: Φ/(4πR² (1 − ρ)), of which half is reflected.
    let flux = PI * LUMINANCE * PI * LAMP * LAMP;
    let reflected = 0.5 * flux / (4.0 * PI * ROOM * ROOM * 0.5);
    let rating = unified_glare_rating(sum, reflected / PI).unwrap();
    assert!((rating - 27.58).abs() < 0.02, "{rating}");
    assert_eq!(sources.sum(DVec3::ZERO, -DVec3::X, &mut model.accel.tracer()), 0.0);
}
