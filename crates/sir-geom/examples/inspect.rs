//! Prints the contents of a scene file: `cargo run -p sir-geom --example inspect -- room.glb`.
#![allow(clippy::print_stdout, reason = "this is a program for the terminal")]

use std::error::Error;
use std::path::Path;

use sir_geom::{LoadOptions, load};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: inspect SCENE.gltf|SCENE.glb|SCENE.obj")?;
    let built = load(Path::new(&path), &LoadOptions::default())?;
    let scene = built.scene;
    println!("{} triangles, {} vertices", scene.triangles().len(), scene.vertices().len());
    let size = scene.bounding_box();
    println!("from {} to {}, area {:.4}", size.min, size.max, scene.total_area());
    for material in scene.materials() {
        let (name, reflectance, exitance) = (&material.name, material.reflectance, material.exitance);
        println!(
            "material \"{name}\": reflects {reflectance:.3}, emits {exitance:.3} W/m², {:?}",
            material.sides
        );
    }
    for camera in scene.cameras() {
        println!("camera \"{}\" at {:.3} looks along {:.3}", camera.name, camera.eye, camera.forward);
    }
    for warning in built.warnings {
        println!("warning: {warning}");
    }
    Ok(())
}
