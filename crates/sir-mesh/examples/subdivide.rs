//! Prints the number and the areas of patches for several subdivisions of a room:
//! `cargo run -p sir-mesh --example subdivide`.
#![allow(clippy::print_stdout, reason = "an example prints its results")]

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_mesh::{PatchMesh, PatchSize, Subdivision};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut builder = SceneBuilder::new();
    let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
    shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::new(4.0, 3.0, 5.0), [gray; 6], Facing::Inward);
    shapes::sphere(&mut builder, DVec3::new(2.0, 1.0, 2.0), 0.8, 3, Facing::Outward, |_| gray);
    let scene = builder.build()?.scene;
    println!("{} triangles, {:.2} m²", scene.triangles().len(), scene.total_area());
    for subdivision in [
        Subdivision::PerTriangle,
        Subdivision::PerFace,
        Subdivision::Triangles(PatchSize::MaxArea(0.01)),
        Subdivision::Triangles(PatchSize::MaxEdge(0.1)),
        Subdivision::Triangles(PatchSize::Count(614_778)),
        Subdivision::Surfaces(PatchSize::MaxEdge(0.1)),
        Subdivision::Surfaces(PatchSize::Count(1000)),
    ] {
        let mesh = PatchMesh::new(&scene, subdivision)?;
        let (mut least, mut most) = (f64::INFINITY, 0.0f64);
        mesh.for_each_side(|triangle, patch, _, _| {
            let area = mesh.patch_area(triangle, patch);
            (least, most) = (least.min(area), most.max(area));
        });
        println!("{subdivision:?}: {} patches of {least:.2e} to {most:.2e} m²", mesh.patch_count());
    }
    Ok(())
}
