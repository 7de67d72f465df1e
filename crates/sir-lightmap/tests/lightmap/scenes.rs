//! Scenes and light for the tests.

use std::path::Path;

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, Scene, SceneBuilder, Sides};
use sir_lightmap::{Lightmap, LightmapError, LightmapOptions, Observer, Solution, Step};
use sir_mesh::{PatchMesh, PatchSize, Subdivision};

/// Observer that lets the work go on.
pub(crate) struct GoOn;

impl Observer for GoOn {
    fn progress(&self, _: Step, _: u64, _: Option<u64>) -> bool {
        true
    }
}

/// Returns a room with a two-sided table top and a sphere.
pub(crate) fn room() -> Scene {
    let mut b = SceneBuilder::new();
    let gray = b.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
    let both = b.add_material(Material::diffuse("both", Rgb::splat(0.5)).with_sides(Sides::Both));
    b.begin_group("room");
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::new(4.0, 2.5, 3.0), [gray; 6], Facing::Inward);
    b.begin_group("table");
    let corners =
        [[1.0, 1.0], [1.0, 2.0], [2.5, 2.0], [2.5, 1.0]].map(|[x, z]| b.add_vertex(DVec3::new(x, 0.75, z)));
    b.add_polygon(&corners, both);
    b.begin_group("sphere");
    shapes::sphere(&mut b, DVec3::new(3.2, 0.5, 2.2), 0.4, 2, Facing::Outward, |_| gray);
    b.build().unwrap().scene
}

/// Divides a scene into about this number of patches: parts of surfaces, or of triangles.
pub(crate) fn patches(scene: &Scene, count: u64, of_surfaces: bool) -> PatchMesh {
    let size = PatchSize::Count(count);
    let how = if of_surfaces { Subdivision::Surfaces(size) } else { Subdivision::Triangles(size) };
    PatchMesh::new(scene, how).unwrap()
}

/// Returns numbers between 0 and 1 that look random.
pub(crate) fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Returns irradiance of each side with different values in each band.
pub(crate) fn light(mesh: &PatchMesh) -> Vec<Rgb> {
    let mut next = random(7);
    (0..mesh.side_count()).map(|_| Rgb::new(next() + 0.5, 2.0 * next(), next() * next())).collect()
}

/// Makes a lightmap of a scene without a file.
pub(crate) fn bake<'a>(
    scene: &'a Scene,
    mesh: &'a PatchMesh,
    irradiance: &'a [Rgb],
    errors: &'a [Rgb],
    options: LightmapOptions,
) -> Result<Lightmap<'a>, LightmapError> {
    Lightmap::new(solution(scene, mesh, irradiance, errors, Path::new("room.obj")), options, &GoOn)
}

/// Returns the solution of a scene that was read from a file.
pub(crate) fn solution<'a>(
    scene: &'a Scene,
    mesh: &'a PatchMesh,
    irradiance: &'a [Rgb],
    errors: &'a [Rgb],
    source: &'a Path,
) -> Solution<'a> {
    let (up, scale) = (DVec3::Y, 1.0);
    Solution { scene, mesh, irradiance, errors, is_denoised: false, direct: None, source, scale, up }
}

pub(crate) fn options(size: u32) -> LightmapOptions {
    LightmapOptions { size, seams: false, ..LightmapOptions::default() }
}
