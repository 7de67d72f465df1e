//! Pictures and files of made-up light, without a solver: a room with an irradiance that fades with depth.
//!
//!     cargo run --release -p sir-view --example made_up_light -- FOLDER

use std::path::PathBuf;

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Camera, Material, Rgb, SceneBuilder};
use sir_mesh::{PatchMesh, PatchSize, Subdivision};
use sir_radiosity::build_accel;
use sir_view::{DisplayMesh, Exposure, PictureSettings, Table, render, write_exr, write_glb, write_png};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder =
        PathBuf::from(std::env::args().nth(1).ok_or("no output folder; pass it as the first argument")?);
    let mut builder = SceneBuilder::new();
    let white = builder.add_material(Material::diffuse("white", Rgb::splat(0.75)));
    let red = builder.add_material(Material::diffuse("red", Rgb::new(0.6, 0.1, 0.08)));
    let green = builder.add_material(Material::diffuse("green", Rgb::new(0.15, 0.5, 0.12)));
    let walls = [red, green, white, white, white, white];
    shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::new(4.0, 2.6, 5.0), walls, Facing::Inward);
    shapes::sphere(&mut builder, DVec3::new(2.4, 0.8, 1.6), 0.8, 3, Facing::Outward, |_| white);
    let scene = builder.build()?.scene;
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxEdge(0.3)))?;

    // A solver would compute these: one value for each side.
    let mut irradiance = Vec::with_capacity(mesh.side_count());
    mesh.for_each_side(|triangle, patch, _, _| {
        let center = mesh.center(&scene, triangle, patch);
        let upward = 0.6 + 0.4 * scene.normal(triangle).y;
        irradiance.push(Rgb::new(1.0, 0.95, 0.85) * upward * (-0.2 * center.z).exp());
    });
    let error = vec![Rgb::ZERO; mesh.side_count()];

    let display = DisplayMesh::new(&scene, &mesh, &irradiance);
    let camera = Camera::looking_at(DVec3::new(2.0, 1.5, 4.8), DVec3::new(2.0, 1.1, 0.0), DVec3::Y, 1.1)
        .ok_or("the camera looks along its up direction")?;
    let settings = PictureSettings { width: 800, height: 600, grid: 4, threads: 2 };
    let picture = render(&display, &build_accel(&scene)?, &camera, settings)?;
    write_png(&folder.join("view.png"), &picture, Exposure::Auto)?;
    write_exr(&folder.join("view.exr"), &picture, &[])?;
    write_glb(&folder.join("lit.glb"), &display, Exposure::Auto, &[camera], DVec3::Y)?;
    let table = Table::new(&scene, &mesh, &irradiance, &error);
    table.write_csv(&folder.join("patches.csv"))?;
    table.write_npy(&folder.join("patches.npy"))?;
    Ok(())
}
