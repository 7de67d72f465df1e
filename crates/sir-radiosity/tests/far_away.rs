//! What lies far away, or where the scene lies, changes nothing here.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use common::{Estimate, factor, gray, radiosities, scene};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{BoundingBox, Material, Rgb, SceneBuilder};
use sir_lines::{Domain, Focus, GlobalLines, LocalLines};
use sir_mesh::Subdivision;
use sir_radiosity::{
    BatchSettings, Batches, FirstShot, Gatherer, Model, Sensor, SensorSettings, ShotSettings, Solution,
    run_stage,
};

const SIZE: DVec3 = DVec3::new(4.0, 3.0, 4.0);

/// Corners of a lamp one centimeter below the ceiling of the room, facing down.
fn lamp() -> [DVec3; 4] {
    [(1.5, 1.5), (2.5, 1.5), (2.5, 2.5), (1.5, 2.5)].map(|(x, z)| DVec3::new(x, 2.99, z))
}

/// What stands outside the room.
#[derive(Clone, Copy, Debug)]
enum Outside {
    Nothing,
    /// A terrain of this width, one centimeter below the floor.
    Terrain(f64),
    /// A triangle of 10 m at this distance.
    Triangle(f64),
}

/// Where the lamp is in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lamp {
    First,
    Last,
    Absent,
}

/// Returns a closed room with walls of this material and a lamp, moved by `offset`.
fn room(wall: Material, outside: Outside, offset: DVec3, lamp_place: Lamp) -> Model {
    let mut b = SceneBuilder::new();
    let lamp_material = Material { exitance: Rgb::splat(10.0), ..wall.clone() };
    let [wall, bright, dark] = [wall, lamp_material, gray(0.0, 0.5)].map(|material| b.add_material(material));
    let quad = |b: &mut SceneBuilder, corners: [DVec3; 4], material| {
        shapes::quad(b, corners.map(|p| p + offset), material);
    };
    if lamp_place == Lamp::First {
        quad(&mut b, lamp(), bright);
    }
    shapes::cuboid(&mut b, offset, offset + SIZE, [wall; 6], Facing::Inward);
    match outside {
        Outside::Nothing => {}
        Outside::Terrain(width) => {
            let r = 0.5 * width;
            quad(&mut b, [(-r, -r), (-r, r), (r, r), (r, -r)].map(|(x, z)| DVec3::new(x, -0.01, z)), dark);
        }
        Outside::Triangle(distance) => {
            let corners = [DVec3::ZERO, 10.0 * DVec3::Z, 10.0 * DVec3::Y];
            let corners = corners.map(|p| b.add_vertex(p + offset + distance * DVec3::X));
            b.add_polygon(&corners, dark);
        }
    }
    if lamp_place == Lamp::Last {
        quad(&mut b, lamp(), bright);
    }
    Model::new(scene(b), Subdivision::PerTriangle).unwrap()
}

#[test]
fn direct_light_does_not_depend_on_the_size_of_the_scene_or_its_place() {
    use Outside::{Nothing, Terrain, Triangle};
    let exact = 10.0 * factor(&Sensor::new(DVec3::new(2.0, 0.0, 2.0), DVec3::Y).unwrap(), &lamp());
    let moved = DVec3::new(1e6, 1e6, -1e6);
    for (outside, offset) in [
        (Nothing, DVec3::ZERO),
        (Terrain(5e3), DVec3::ZERO),
        (Terrain(2e4), DVec3::ZERO),
        (Triangle(1e3), DVec3::ZERO),
        (Triangle(1e5), DVec3::ZERO),
        (Nothing, moved),
        (Terrain(5e3), moved),
    ] {
        for place in [Lamp::First, Lamp::Last] {
            let model = room(gray(0.0, 0.0), outside, offset, place);
            let settings = SensorSettings::new(16_384, 0.0);
            let solution = Solution::dark(model.mesh.side_count());
            let sensor = Sensor::new(offset + DVec3::new(2.0, 0.0, 2.0), DVec3::Y).unwrap();
            let measured = Gatherer::new(&model, &solution, settings, 1).measure(0, &sensor);
            let (value, sigma) = (measured.irradiance.x, measured.error().x);
            println!("{outside:?} {offset} {place:?}: {value:.6} ± {sigma:.6}, exact {exact:.6}");
            assert!((value - exact).abs() <= 4.0 * sigma && sigma < 1e-3 * exact);
            // All the light of the lamp arrives in the room.
            let shot = run_stage::<FirstShot<'_>>(ShotSettings::new(&model, 100_000, 1), ()).unwrap();
            assert_eq!((shot.balance.blocked.0, shot.balance.escaped.0), ([0; 3], [0; 3]), "{outside:?}");
        }
    }
}

/// In a closed room in which everything emits and reflects, the radiosity is `M / (1 − ρ)`.
#[test]
fn reflected_light_in_a_focus_does_not_depend_on_the_size_of_the_scene() {
    const RHO: f64 = 0.6;
    for outside in [Outside::Nothing, Outside::Triangle(1e3), Outside::Triangle(1e5), Outside::Terrain(5e3)] {
        let model = room(gray(10.0, RHO), outside, DVec3::ZERO, Lamp::Absent);
        let bounds = BoundingBox { min: DVec3::ZERO, max: SIZE };
        let focus = Focus::new(bounds, 0.75, model.scene.bounding_box()).unwrap();
        let domain = GlobalLines::focused(Domain::hull(model.scene.vertices()), focus);
        println!(
            "{outside:?}: {:.3} of the lines through the focus, others weigh {}",
            domain.share(),
            domain.weight()
        );
        let of_seed = |seed: u64| {
            let lines = LocalLines { count: 20_000, focus: Some(focus) };
            let shot = run_stage::<FirstShot<'_>>(ShotSettings::new(&model, lines, seed), ()).unwrap();
            let settings = BatchSettings::new(&model, domain.clone(), 50_000, seed);
            radiosities(&model, &run_stage::<Batches<'_>>(settings, shot).unwrap())[0].x
        };
        Estimate::of((1..=16).map(of_seed)).assert_is(10.0 / (1.0 - RHO), &format!("{outside:?}"));
    }
}
