//! Pictures, meshes and tables of textured and partly transparent surfaces with known appearance.

#![allow(clippy::unwrap_used, reason = "a step that fails is a test that fails")]

use std::f64::consts::PI;

use glam::{DVec3, Vec2, Vec4};
use sir_geom::{
    Camera, ColorMap, Material, MaterialId, Opacity, Projection, Rgb, Scene, SceneBuilder, Sky, Texture,
    TextureId, TextureMap, Wrap,
};
use sir_mesh::{PatchMesh, PatchSize, Subdivision};
use sir_radiosity::build_accel;
use sir_view::{DisplayMesh, Exposure, Picture, PictureSettings, Table, render, write_glb};

/// Adds the square `[0, 1]² × z` that faces +z, with texture coordinates `repeats` times `x` and `1 − y`.
fn square(b: &mut SceneBuilder, z: f64, m: MaterialId, repeats: f32) {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let v = corners.map(|(x, y)| b.add_vertex(DVec3::new(x, y, z)));
    let places = corners.map(|(x, y)| repeats * Vec2::new(x as f32, 1.0 - y as f32));
    for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
        b.add_polygon(&[v[i], v[j], v[k]], m);
        b.set_corners(&[[places[i], places[j], places[k]]], None);
    }
}

fn map(texture: TextureId) -> TextureMap {
    TextureMap { texture, wrap: [Wrap::Repeat; 2], coordinates: 0 }
}

/// Adds a texture with two columns and one row.
fn two(b: &mut SceneBuilder, left: [u8; 4], right: [u8; 4]) -> TextureMap {
    map(b.add_texture(Texture::new(2, 1, vec![left, right]).unwrap()))
}

const BLACK: [u8; 4] = [0, 0, 0, 255];
const WHITE: [u8; 4] = [255; 4];

/// Renders the unit square under the irradiance π, seen from the front so that it fills the picture.
fn picture(scene: &Scene, subdivision: Subdivision, size: u32, grid: u32, of_errors: bool) -> Picture {
    let mesh = PatchMesh::new(scene, subdivision).unwrap();
    let irradiance = vec![Rgb::splat(PI); mesh.side_count()];
    let display = if of_errors {
        DisplayMesh::of_errors(scene, &mesh, &irradiance)
    } else {
        DisplayMesh::new(scene, &mesh, &irradiance)
    };
    let camera = Camera {
        name: String::new(),
        eye: DVec3::new(0.5, 0.5, 5.0),
        forward: -DVec3::Z,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 1.0 },
        aspect: None,
    };
    let settings = PictureSettings { width: size, height: size, grid, threads: 2 };
    render(&display, &build_accel(scene).unwrap(), &camera, settings).unwrap()
}

fn assert_near(found: impl IntoIterator<Item = f32>, expected: [f64; 3], tolerance: f64) {
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((f64::from(found) - expected).abs() <= tolerance, "{found} instead of {expected}");
    }
}

/// Two patches show the stripes of their textures, emitted and reflected.
#[test]
fn a_texture_is_seen_within_a_patch() {
    let mut b = SceneBuilder::new();
    let stripes = two(&mut b, BLACK, WHITE);
    let lamps = two(&mut b, WHITE, BLACK);
    let material = Material {
        reflectance: Rgb::splat(0.25),
        reflectance_map: Some(ColorMap { map: stripes, factor: Rgb::new(0.5, 0.4, 0.2) }),
        exitance: Rgb::splat(3.0 * PI),
        exitance_map: Some(ColorMap { map: lamps, factor: Rgb::splat(6.0 * PI) }),
        ..Material::diffuse("m", Rgb::splat(0.25))
    };
    let m = b.add_material(material);
    square(&mut b, 0.0, m, 1.0);
    let scene = b.build().unwrap().scene;
    for (of_errors, lamp) in [(false, 6.0), (true, 0.0)] {
        let picture = picture(&scene, Subdivision::PerFace, 16, 1, of_errors);
        for row in picture.radiance.chunks(16) {
            // Colors are interpolated between the middles of texels, and beyond them with the repeated image. In the
            // middles of the stripes, columns 3 and 4, 11 and 12, they are nearly pure.
            assert_near(row[4], [lamp; 3], 0.13 * (lamp + 1.0));
            assert_near(row[12], [0.5, 0.4, 0.2], 0.13 * (lamp + 1.0));
            let sum: f32 = row.iter().map(|pixel| pixel[0]).sum();
            assert_near([sum / 16.0], [0.25 + 0.5 * lamp; 3], 0.05 * (lamp + 1.0));
        }
    }
}

/// Stripes far finer than a pixel give an even gray, without speckles.
#[test]
fn fine_textures_are_blurred() {
    let mut b = SceneBuilder::new();
    let stripes = two(&mut b, BLACK, WHITE);
    let reflectance_map = Some(ColorMap { map: stripes, factor: Rgb::splat(0.8) });
    let m = b.add_material(Material { reflectance_map, ..Material::diffuse("m", Rgb::splat(0.4)) });
    square(&mut b, 0.0, m, 100.0);
    let scene = b.build().unwrap().scene;
    for (size, grid) in [(16, 1), (8, 2)] {
        for pixel in picture(&scene, Subdivision::PerFace, size, grid, false).radiance {
            // The sRGB value 188 is linear 0.5029.
            assert_near(pixel, [0.4; 3], 0.003);
        }
    }
}

#[test]
fn gaps_show_what_is_behind_in_proportion() {
    let mut b = SceneBuilder::new();
    b.set_sky(Sky::everywhere(Rgb::splat(7.0)).unwrap());
    let wall = b.add_material(Material::diffuse("wall", Rgb::new(0.9, 0.6, 0.3)));
    let opacity = Opacity { factor: 0.25, ..Opacity::default() };
    let veil = b.add_material(Material { opacity, ..Material::diffuse("veil", Rgb::splat(0.5)) });
    let image = two(&mut b, [255, 0, 0, 0], WHITE);
    let mask = Opacity { factor: 1.0, map: Some(image), cutoff: Some(0.5) };
    let leaf = Material { opacity: mask, ..Material::diffuse("leaf", Rgb::new(0.1, 0.2, 0.1)) };
    let leaf = b.add_material(leaf);
    for z in [1.0, 2.0] {
        square(&mut b, z, veil, 1.0);
    }
    square(&mut b, 0.0, leaf, 1.0);
    let bare = b.clone().build().unwrap().scene;
    square(&mut b, -1.0, wall, 1.0);
    let walled = b.build().unwrap().scene;
    let front = 0.5 * (0.25 + 0.75 * 0.25);
    let behind = 0.75 * 0.75;
    for of_errors in [false, true] {
        let picture = picture(&walled, Subdivision::Triangles(PatchSize::MaxArea(0.1)), 16, 2, of_errors);
        assert_eq!(picture.surface, [1.0; 256]);
        for (i, &pixel) in picture.radiance.iter().enumerate() {
            let last = if i % 16 < 8 { [0.9, 0.6, 0.3] } else { [0.1, 0.2, 0.1] };
            assert_near(pixel, last.map(|last| front + behind * last), 1e-6);
        }
    }
    let picture = picture(&bare, Subdivision::Triangles(PatchSize::MaxArea(0.1)), 16, 2, false);
    for (i, (&pixel, &surface)) in picture.radiance.iter().zip(&picture.surface).enumerate() {
        let is_open = i % 16 < 8;
        let last = if is_open { [7.0; 3] } else { [0.1, 0.2, 0.1] };
        assert_near(pixel, last.map(|last| front + behind * last), 1e-6);
        assert_near([surface], [if is_open { 1.0 - behind } else { 1.0 }; 3], 1e-6);
    }
}

/// A square of eight patches, four on each half; reflectance 0 on the left, and exitance 0 on the right.
#[test]
fn tables_have_the_means_of_patches() {
    let mut b = SceneBuilder::new();
    let factor = Rgb::new(0.5, 0.4, 0.2);
    let reflectance_map = Some(ColorMap { map: two(&mut b, BLACK, WHITE), factor });
    let exitance_map = Some(ColorMap { map: two(&mut b, WHITE, BLACK), factor: Rgb::splat(6.0) });
    let m = Material::diffuse("m", 0.5 * factor).emitting(Rgb::splat(3.0));
    let m = b.add_material(Material { reflectance_map, exitance_map, ..m });
    square(&mut b, 0.0, m, 1.0);
    let scene = b.build().unwrap().scene;
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(0.13))).unwrap();
    let e = Rgb::new(1.0, 2.0, 3.0);
    let table = Table::new(&scene, &mesh, &[e; 8], &[0.1 * e; 8]);
    for row in &table.rows {
        let (radiosity, error) =
            if row.center.x < 0.5 { (Rgb::splat(6.0), Rgb::ZERO) } else { (factor * e, 0.1 * factor * e) };
        assert!(
            (row.radiosity - radiosity).length() < 1e-6 && (row.error - error).length() < 1e-6,
            "{row:?}"
        );
        assert!((row.area - 0.125).abs() < 1e-12);
    }
    assert_eq!(table.rows.iter().filter(|row| row.center.x < 0.5).count(), 4);
}

/// Half of the square is open. In a table, the other half has its own color, and the mesh lacks patches that are all
/// gap.
#[test]
fn gaps_have_no_color() {
    let mut b = SceneBuilder::new();
    let image = two(&mut b, WHITE, [0, 0, 0, 0]);
    let reflectance_map = Some(ColorMap { map: image, factor: Rgb::splat(0.6) });
    let opacity = Opacity { factor: 1.0, map: Some(image), cutoff: Some(0.5) };
    let leaf = Material { reflectance_map, opacity, ..Material::diffuse("leaf", Rgb::splat(0.3)) };
    let m = b.add_material(leaf);
    square(&mut b, 0.0, m, 1.0);
    let scene = b.build().unwrap().scene;
    let whole = PatchMesh::new(&scene, Subdivision::PerTriangle).unwrap();
    for row in Table::new(&scene, &whole, &[Rgb::ONE; 2], &[Rgb::ZERO; 2]).rows {
        assert!((row.radiosity - Rgb::splat(0.6)).length() < 1e-6 && row.area == 0.5, "{row:?}");
    }
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(0.13))).unwrap();
    let vertices = exported(&DisplayMesh::new(&scene, &mesh, &[Rgb::ONE; 8]));
    assert!(vertices.len() >= 4 && vertices.iter().all(|(position, _)| position.x <= 0.5), "{vertices:?}");
}

/// Returns positions and radiosities of the vertices in a GLB file.
fn exported(display: &DisplayMesh<'_>) -> Vec<(DVec3, Rgb)> {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("lit.glb");
    write_glb(&path, display, Exposure::Factor(1.0), &[], DVec3::Y).unwrap();
    let read = gltf::Gltf::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    let blob = read.blob.as_deref().unwrap();
    let mut vertices = Vec::new();
    for primitive in read.meshes().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>()) {
        let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
        let positions = primitive.reader(|_| Some(blob)).read_positions().unwrap().map(vector);
        let view = primitive.get(&gltf::Semantic::Extras("RADIOSITY".to_owned())).unwrap().view().unwrap();
        let numbers = blob[view.offset()..view.offset() + view.length()].chunks_exact(4);
        let numbers: Vec<f32> = numbers.map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
        let radiosities = numbers.chunks_exact(3).map(|b| vector(b.try_into().unwrap()));
        vertices.extend(positions.zip(radiosities));
    }
    vertices
}

/// Vertex colors increase along x and differ between the two triangles where they meet.
#[test]
fn vertices_of_a_mesh_have_the_color_of_their_place() {
    let mut b = SceneBuilder::new();
    let m = b.add_material(Material::diffuse("m", Rgb::splat(0.8)));
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let v = corners.map(|(x, y)| b.add_vertex(DVec3::new(x, y, 0.0)));
    for (green, fan) in [(0.25, [0, 1, 2]), (0.5, [0, 2, 3])] {
        b.add_polygon(&fan.map(|i| v[i]), m);
        b.set_corners(&[], Some(fan.map(|i| Vec4::new(corners[i].0 as f32, green, 0.0, 1.0))));
    }
    let scene = b.build().unwrap().scene;
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(0.02))).unwrap();
    let irradiance = vec![Rgb::splat(10.0); mesh.side_count()];
    let vertices = exported(&DisplayMesh::new(&scene, &mesh, &irradiance));
    let (mut lower, mut upper) = (0, 0);
    for (position, radiosity) in &vertices {
        assert!((radiosity.x - 8.0 * position.x).abs() < 1e-5, "{position} {radiosity}");
        let above = position.y - position.x;
        let is_lower = (radiosity.y - 2.0).abs() < 1e-5;
        assert!(is_lower || (radiosity.y - 4.0).abs() < 1e-5, "{radiosity}");
        assert!(if is_lower { above < 1e-6 } else { above > -1e-6 }, "{position} {radiosity}");
        (lower, upper) = (lower + usize::from(is_lower), upper + usize::from(!is_lower));
    }
    assert_eq!(lower, upper, "both have vertices of their own on the diagonal");
}
