//! Pictures of scenes with known appearance.

#![allow(clippy::unwrap_used, reason = "a step that fails is a test that fails")]

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Camera, Material, MaterialId, Projection, Rgb, Scene, SceneBuilder, Sides, Sky, SkyModel};
use sir_mesh::{PatchMesh, PatchSize, Subdivision};
use sir_radiosity::build_accel;
use sir_view::{DisplayMesh, Exposure, Picture, PictureSettings, default_camera, render};

const SIZE: DVec3 = DVec3::new(4.0, 2.5, 3.0);

/// Returns a room with a box in it, all of one material.
fn room(sides: Sides) -> Scene {
    let mut builder = SceneBuilder::new();
    let m = builder.add_material(Material::diffuse("m", Rgb::new(0.5, 0.4, 0.3)).with_sides(sides));
    shapes::cuboid(&mut builder, DVec3::ZERO, SIZE, [m; 6], Facing::Inward);
    shapes::cuboid(&mut builder, DVec3::ONE, DVec3::new(1.5, 1.4, 1.3), [m; 6], Facing::Outward);
    builder.build().unwrap().scene
}

fn settings(threads: usize) -> PictureSettings {
    PictureSettings { width: 160, height: 120, grid: 2, threads }
}

/// Asserts that all pixels lie between two colors in every band, as any weighted mean of rays does.
fn assert_between(picture: &Picture, ends: [[f32; 3]; 2]) {
    for pixel in &picture.shown {
        for band in 0..3 {
            let (low, high) = (ends[0][band].min(ends[1][band]), ends[0][band].max(ends[1][band]));
            assert!((low - 1e-6..=high + 1e-6).contains(&pixel[band]), "{pixel:?}");
        }
    }
}

/// Renders the room with an irradiance of π everywhere.
fn uniform(scene: &Scene, camera: &Camera, threads: usize) -> Picture {
    let mesh = PatchMesh::new(scene, Subdivision::Triangles(PatchSize::MaxArea(0.07))).unwrap();
    let irradiance = vec![Rgb::splat(std::f64::consts::PI); mesh.side_count()];
    let display = DisplayMesh::new(scene, &mesh, &irradiance);
    render(&display, &build_accel(scene).unwrap(), camera, settings(threads)).unwrap()
}

#[test]
fn a_picture_of_errors_is_without_what_surfaces_emit() {
    let mut builder = SceneBuilder::new();
    let lamp = Material::diffuse("", Rgb::new(0.5, 0.4, 0.3)).emitting(Rgb::splat(70.0));
    let lamp = builder.add_material(lamp);
    shapes::cuboid(&mut builder, DVec3::ZERO, SIZE, [lamp; 6], Facing::Inward);
    let scene = builder.build().unwrap().scene;
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(0.07))).unwrap();
    let errors = vec![Rgb::splat(std::f64::consts::PI); mesh.side_count()];
    let camera = Camera::looking_at(DVec3::new(3.7, 2.0, 0.2), DVec3::ONE, DVec3::Y, 1.2).unwrap();
    let display = DisplayMesh::of_errors(&scene, &mesh, &errors);
    assert_even(&render(&display, &build_accel(&scene).unwrap(), &camera, settings(2)).unwrap());
}

#[test]
fn a_picture_of_errors_is_black_where_it_shows_the_sky() {
    let mut builder = SceneBuilder::new();
    let m = builder.add_material(Material::diffuse("m", Rgb::splat(0.5)));
    shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [m; 6], Facing::Outward);
    builder.set_sky(Sky::everywhere(Rgb::splat(7.0)).unwrap());
    let scene = builder.build().unwrap().scene;
    let mesh = PatchMesh::new(&scene, Subdivision::PerTriangle).unwrap();
    let errors = vec![Rgb::ONE; mesh.side_count()];
    let camera =
        Camera::looking_at(DVec3::new(0.0, 0.0, 9.0), DVec3::new(0.0, 0.0, 10.0), DVec3::Y, 1.2).unwrap();
    let accel = build_accel(&scene).unwrap();
    let looks = |display: DisplayMesh<'_>| render(&display, &accel, &camera, settings(1)).unwrap();
    let light = looks(DisplayMesh::new(&scene, &mesh, &errors));
    let error = looks(DisplayMesh::of_errors(&scene, &mesh, &errors));
    assert!(light.radiance.iter().all(|pixel| pixel[0] > 2.0));
    assert!(error.radiance.iter().all(|pixel| *pixel == [0.0; 3]));
}

/// Surfaces that no light reaches, such as the outer sides of a room, do not affect exposure, however large they are.
#[test]
fn what_is_dark_does_not_change_the_automatic_exposure_of_a_mesh() {
    let factor = |dark: f64| {
        let mut builder = SceneBuilder::new();
        let m = builder.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        shapes::cuboid(&mut builder, DVec3::ZERO, SIZE, [m; 6], Facing::Inward);
        shapes::cuboid(&mut builder, -dark * DVec3::ONE, dark * SIZE, [m; 6], Facing::Outward);
        let scene = builder.build().unwrap().scene;
        let mesh = PatchMesh::new(&scene, Subdivision::PerTriangle).unwrap();
        let mut irradiance = vec![Rgb::splat(1e-9); mesh.side_count()];
        irradiance[..12].fill(Rgb::splat(3.0));
        Exposure::Auto.factor_for_mesh(&DisplayMesh::new(&scene, &mesh, &irradiance))
    };
    let (small, large) = (factor(2.0), factor(100.0));
    assert!((small / large - 1.0).abs() < 1e-2, "{small} {large}");
}

fn assert_even(picture: &Picture) {
    for (i, pixel) in picture.radiance.iter().enumerate() {
        for (got, expected) in pixel.iter().zip([0.5, 0.4, 0.3]) {
            assert!((got - expected).abs() < 1e-5, "pixel {i}: {pixel:?}");
        }
    }
}

#[test]
fn even_light_gives_an_even_picture_without_cracks() {
    let scene = room(Sides::Front);
    let inside = Camera::looking_at(DVec3::new(3.7, 2.0, 0.2), DVec3::ONE, DVec3::Y, 1.2).unwrap();
    assert_even(&uniform(&scene, &inside, 1));
}

#[test]
fn one_looks_through_the_backs_of_walls() {
    let scene = room(Sides::Front);
    // The field of view is narrow enough for the room to fill the picture.
    let outside = Camera::looking_at(DVec3::new(-9.0, 4.0, -8.0), 0.5 * SIZE, DVec3::Y, 0.1).unwrap();
    assert_even(&uniform(&scene, &outside, 1));
    let parallel = Camera { projection: Projection::Orthographic { height: 1.5 }, ..outside };
    assert_even(&uniform(&scene, &parallel, 1));
}

#[test]
fn where_there_is_no_surface_one_sees_the_sky() {
    let mut builder = SceneBuilder::new();
    let floor = builder.add_material(Material::diffuse("floor", Rgb::splat(0.5)));
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let corners = [corner(-9.0, -9.0), corner(-9.0, 9.0), corner(9.0, 9.0), corner(9.0, -9.0)];
    shapes::quad(&mut builder, corners, floor);
    let sky = Sky::new(DVec3::Y, SkyModel::Overcast, Rgb::new(5.0, 6.0, 9.0), Rgb::splat(0.25)).unwrap();
    builder.set_sky(sky.clone());
    let scene = builder.build().unwrap().scene;
    let camera =
        Camera::looking_at(DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.0, 1.0, -1.0), DVec3::Y, 1.0).unwrap();
    let picture = uniform(&scene, &camera, 2);
    let at = |x: usize, y: usize| (picture.radiance[160 * y + x], picture.surface[160 * y + x]);
    // The middle of the top row: half of the field of view above the horizon, less half a pixel.
    let slope = (0.5f64).tan() * (1.0 - 0.5 / 60.0);
    let expected = sky.radiance(DVec3::new(0.0, slope, -1.0).normalize());
    let (found, surface) = at(80, 0);
    assert_eq!(surface, 0.0);
    assert!((Rgb::from_array(found.map(f64::from)) / expected - 1.0).abs().max_element() < 3e-3, "{found:?}");
    // The ground is seen between the edge of the floor and the horizon, and the floor below.
    assert_eq!(at(80, 61), ([0.25; 3], 0.0));
    let (floor, surface) = at(80, 119);
    assert!((floor[0] - 0.5).abs() < 1e-5 && surface == 1.0, "{floor:?}");
    // The exposure is that for the floor.
    let factor = Exposure::Auto.factor_for_picture(&picture);
    assert!((factor * 0.5 / 0.26 - 1.0).abs() < 0.05, "{factor}");
}

#[test]
fn the_edge_of_a_lamp_is_soft_on_the_screen_and_exact_in_numbers() {
    let mut builder = SceneBuilder::new();
    let wall = builder.add_material(Material::diffuse("wall", Rgb::splat(0.5)));
    let lamp = builder.add_material(Material::diffuse("lamp", Rgb::ZERO).emitting(Rgb::splat(1000.0)));
    // Most of the wall lies to the left of the picture.
    let picture = picture_of_strips(builder, &[(-20.0, 4.25, wall), (4.25, 9.0, lamp)]);
    let lamp = 1000.0 / std::f32::consts::PI;
    for row in 0..9 {
        let at = |x: usize| (picture.radiance[9 * row + x][0], picture.shown[9 * row + x][0]);
        for (x, expected) in [(3, 0.5), (5, lamp)] {
            let (radiance, shown) = at(x);
            assert!((radiance / expected - 1.0).abs() < 1e-5 && (shown / expected - 1.0).abs() < 1e-3);
        }
        // The edge lies a quarter into this pixel: three of four columns of rays meet the lamp.
        let (radiance, shown) = at(4);
        assert!((radiance / (0.25 * 0.5 + 0.75 * lamp) - 1.0).abs() < 1e-5);
        assert!(shown > 1.0 && shown < 0.1 * lamp, "{shown}");
    }
}

/// Renders `[0, 9]²` with nine by nine pixels: upright strips from `left` to `right` under the irradiance π.
fn picture_of_strips(mut builder: SceneBuilder, strips: &[(f64, f64, MaterialId)]) -> Picture {
    for &(left, right, material) in strips {
        let (corner, right) = (left * DVec3::X, right * DVec3::X);
        shapes::quad(
            &mut builder,
            [corner, right, right + 9.0 * DVec3::Y, corner + 9.0 * DVec3::Y],
            material,
        );
    }
    let scene = builder.build().unwrap().scene;
    let mesh = PatchMesh::new(&scene, Subdivision::PerTriangle).unwrap();
    let irradiance = vec![Rgb::splat(std::f64::consts::PI); mesh.side_count()];
    let display = DisplayMesh::new(&scene, &mesh, &irradiance);
    let camera = Camera {
        projection: Projection::Orthographic { height: 9.0 },
        ..Camera::looking_at(DVec3::new(4.5, 4.5, 1.0), DVec3::new(4.5, 4.5, 0.0), DVec3::Y, 1.0).unwrap()
    };
    let settings = PictureSettings { width: 9, height: 9, grid: 4, threads: 1 };
    render(&display, &build_accel(&scene).unwrap(), &camera, settings).unwrap()
}

#[test]
fn edges_between_colors_are_neither_darker_nor_brighter_than_both() {
    let mut builder = SceneBuilder::new();
    let paints = [Rgb::new(0.6, 0.3, 0.1), Rgb::new(0.5, 0.6, 0.7), Rgb::splat(0.001)];
    let paints = paints.map(|p| builder.add_material(Material::diffuse("paint", p)));
    // The third one, dark and outside of the picture, covers most of the scene.
    let strips = [(0.0, 4.3, paints[0]), (4.3, 9.0, paints[1]), (9.0, 900.0, paints[2])];
    let picture = picture_of_strips(builder, &strips);
    assert_between(&picture, [[0.6, 0.3, 0.1], [0.5, 0.6, 0.7]]);
}

#[test]
fn rays_that_meet_nothing_are_black() {
    let scene = room(Sides::Front);
    let away = Camera::looking_at(DVec3::splat(-1.0), DVec3::splat(-2.0), DVec3::Y, 1.0).unwrap();
    assert!(uniform(&scene, &away, 1).radiance.iter().all(|p| *p == [0.0; 3]));
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let scene = room(Sides::Both);
    let camera = Camera::looking_at(DVec3::new(3.0, 5.0, -4.0), DVec3::ONE, DVec3::Y, 1.5).unwrap();
    assert_eq!(uniform(&scene, &camera, 1), uniform(&scene, &camera, 5));
}

#[test]
fn an_empty_picture_is_refused() {
    let scene = room(Sides::Front);
    let mesh = PatchMesh::new(&scene, Subdivision::PerTriangle).unwrap();
    let irradiance = vec![Rgb::ONE; mesh.side_count()];
    let display = DisplayMesh::new(&scene, &mesh, &irradiance);
    let camera = Camera::looking_at(DVec3::ONE, DVec3::ZERO, DVec3::Y, 1.0).unwrap();
    let none = PictureSettings { width: 0, ..settings(1) };
    let error = render(&display, &build_accel(&scene).unwrap(), &camera, none).unwrap_err().to_string();
    assert!(error.contains("0 × 120"), "{error}");
}

#[test]
fn the_default_camera_stands_in_a_lit_closed_room() {
    for sides in [Sides::Front, Sides::Both] {
        let scene = room(sides);
        let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(0.5))).unwrap();
        let mut irradiance = Vec::new();
        // Dark outside of the room and inside of the box, as computed by the solver.
        mesh.for_each_side(|_, _, side, _| {
            irradiance.push(if side == sir_geom::Side::Front { Rgb::ONE } else { Rgb::ZERO });
        });
        let display = DisplayMesh::new(&scene, &mesh, &irradiance);
        let accel = build_accel(&scene).unwrap();
        let camera = default_camera(&display, &accel, DVec3::Y, scene.bounding_box());
        let inside = |p: DVec3| p.cmpgt(DVec3::ZERO).all() && p.cmplt(SIZE).all();
        assert!(inside(camera.eye), "{camera:?}");
        let picture = render(&display, &accel, &camera, settings(1)).unwrap();
        assert!(picture.radiance.iter().all(|p| p[0] > 0.1), "all that is seen is lit");
    }
}
