//! Which of several surfaces in one plane is on top.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use common::{gray, scene};
use glam::DVec3;
use sir_geom::SceneBuilder;
use sir_geom::shapes;
use sir_mesh::Subdivision;
use sir_radiosity::{FirstShot, Model, ShotSettings, run_stage};

/// Squares of this width in one plane that face up, with exitance and reflectance, under a black lid.
fn squares(squares: &[(f64, f64, f64)]) -> Model {
    let mut b = SceneBuilder::new();
    let square = |r: f64, z: f64| [(-r, -r), (r, -r), (r, r), (-r, r)].map(|(x, y)| DVec3::new(x, y, z));
    for &(width, m, rho) in squares {
        let material = b.add_material(gray(m, rho));
        // Turned, so that rounding affects the corners.
        let turn = glam::DQuat::from_axis_angle(DVec3::Z, 0.3);
        shapes::quad(&mut b, square(0.5 * width, 0.7).map(|p| turn * p), material);
    }
    let lid = b.add_material(gray(0.0, 0.0));
    let mut corners = square(50.0, 1.0);
    corners.reverse();
    shapes::quad(&mut b, corners, lid);
    Model::new(scene(b), Subdivision::PerTriangle).unwrap()
}

/// Returns the face that is seen from above near the middle.
fn seen(model: &Model) -> u32 {
    let line = sir_geom::Line { origin: DVec3::new(0.013, 0.021, 0.9), direction: DVec3::NEG_Z };
    let hit = model.accel.tracer().closest(&line.into()).unwrap();
    model.scene.triangle(hit.triangle).face.0
}

#[test]
fn a_lamp_is_on_top_whatever_its_size_and_its_place_in_the_file() {
    for (list, lamp) in [
        ([(2.0, 10.0, 0.5), (3.0, 0.0, 0.5), (1.0, 0.0, 0.5)], 0),
        ([(1.0, 0.0, 0.5), (2.0, 10.0, 0.5), (3.0, 0.0, 0.5)], 1),
        ([(3.0, 0.0, 0.5), (1.0, 0.0, 0.5), (2.0, 10.0, 0.5)], 2),
    ] {
        let model = squares(&list);
        assert_eq!(seen(&model), lamp);
        let shot = run_stage::<FirstShot<'_>>(ShotSettings::new(&model, 10_000, 1), ()).unwrap();
        let own: i64 = model
            .scene
            .triangle_ids()
            .filter(|&t| model.scene.triangle(t).face.0 < 3)
            .map(|t| {
                let side =
                    model.mesh.side_at(t, sir_geom::Barycentric { v: 0.3, w: 0.3 }, sir_geom::Side::Front);
                shot.received.power[side.unwrap().index()].0[0]
            })
            .sum();
        assert_eq!((own, shot.balance.blocked.0[0]), (0, 0), "all light of the lamp leaves it upwards");
    }
}

#[test]
fn a_small_polygon_lies_on_a_large_one() {
    assert_eq!(seen(&squares(&[(1.0, 0.0, 0.5), (2.0, 0.0, 0.5)])), 0);
    assert_eq!(seen(&squares(&[(2.0, 0.0, 0.5), (1.0, 0.0, 0.5)])), 1);
    // Of equal ones, the later.
    assert_eq!(seen(&squares(&[(1.0, 0.0, 0.5), (1.0, 0.0, 0.4)])), 1);
    assert_eq!(seen(&squares(&[(1.0, 0.0, 0.4), (1.0, 0.0, 0.5)])), 1);
}
