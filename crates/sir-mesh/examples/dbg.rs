//! x
#![allow(clippy::all, missing_docs, unused)]
use sir_geom::*;
use sir_mesh::*;
use std::time::Instant;
fn main() {
    for arg in std::env::args().skip(1) {
        let scene = load(std::path::Path::new(&arg), &LoadOptions::default()).unwrap().scene;
        println!("{arg}: {} triangles {:.1} m²", scene.triangles().len(), scene.total_area());
        let t = Instant::now();
        let mesh = PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::MaxEdge(1e4))).unwrap();
        println!("  infinite: {} patches, {:.2} s", mesh.patch_count(), t.elapsed().as_secs_f64());
        for n in [20_000, 50_000, 100_000, 200_000, 600_000] {
            let t = Instant::now();
            let mesh = PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::Count(n))).unwrap();
            let s = t.elapsed().as_secs_f64();
            println!(
                "  {n}: {} patches, {:.1} MB, {:.2} s",
                mesh.patch_count(),
                mesh.bytes() as f64 / 1e6,
                s
            );
        }
    }
}
