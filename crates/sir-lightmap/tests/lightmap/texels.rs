//! Texels are means of the light, with errors.

use sir_geom::{Rgb, Side};
use sir_lightmap::{Lightmap, LightmapError, LightmapOptions, LightmapSides, Observer, Step};

use crate::scenes::{bake, light, options, patches, random, room, solution};

/// Sum of irradiance times area over texels, and over the sides of patches for which `counts` is true.
fn powers(lightmap: &Lightmap<'_>, expected: impl Iterator<Item = (f64, Rgb)>) -> ([f64; 3], Rgb) {
    let mut found = [0.0; 3];
    for (light, &area) in lightmap.irradiance().iter().zip(lightmap.areas()) {
        (0..3).for_each(|band| found[band] += f64::from(light[band]) * f64::from(area));
    }
    (found, expected.map(|(area, light)| area * light).sum())
}

#[test]
fn power_over_all_texels_is_that_of_the_patches() {
    let scene = room();
    for of_surfaces in [true, false] {
        for (count, size) in [(300, 256), (300, 900), (20_000, 128)] {
            let mesh = patches(&scene, count, of_surfaces);
            let light = light(&mesh);
            let errors = vec![Rgb::ZERO; light.len()];
            for sides in [LightmapSides::Split, LightmapSides::Front, LightmapSides::Mean] {
                let options = LightmapOptions { sides, ..options(size) };
                let lightmap = bake(&scene, &mesh, &light, &errors, options).unwrap();
                let mut all = Vec::new();
                mesh.for_each_side(|t, patch, side, id| {
                    if side == Side::Front || sides != LightmapSides::Front {
                        all.push((mesh.covered_area(t, patch), light[id.index()]));
                    }
                });
                let (found, expected) = powers(&lightmap, all.into_iter());
                for band in 0..3 {
                    let off = found[band] / expected[band] - 1.0;
                    // Power is exact over all sides.
                    let limit = if sides == LightmapSides::Front { 1e-3 } else { 2e-5 };
                    assert!(off.abs() < limit, "{of_surfaces} {count} {size} {sides:?}: {off}");
                }
            }
        }
    }
}

#[test]
fn equal_light_is_equal_in_all_texels() {
    let scene = room();
    let mesh = patches(&scene, 2_000, true);
    let light = vec![Rgb::new(1.0, 2.0, 3.0); mesh.side_count()];
    let errors = vec![Rgb::splat(0.1); light.len()];
    let lightmap =
        bake(&scene, &mesh, &light, &errors, LightmapOptions { seams: true, ..options(300) }).unwrap();
    let mut covered = 0;
    for (i, &area) in lightmap.areas().iter().enumerate() {
        if area > 0.0 {
            covered += 1;
            let found = lightmap.irradiance()[i];
            assert!(found.iter().zip([1.0, 2.0, 3.0]).all(|(x, y)| (x - y).abs() < 1e-5), "{found:?}");
            assert!(lightmap.errors()[i].iter().all(|&e| e > 0.0 && e < 0.1 + 1e-6));
        }
    }
    assert!(f64::from(covered) > 0.3 * lightmap.areas().len() as f64);
}

#[test]
fn a_linear_field_is_reproduced_inside_a_wall() {
    let scene = room();
    let mesh = patches(&scene, 8_000, true);
    let field = |p: glam::DVec3| 1.0 + 0.3 * p.x + 0.2 * p.y - 0.1 * p.z;
    let mut light = vec![Rgb::ZERO; mesh.side_count()];
    mesh.for_each_side(|t, patch, _, id| {
        light[id.index()] = Rgb::splat(field(mesh.center(&scene, t, patch)));
    });
    let errors = vec![Rgb::ZERO; light.len()];
    let lightmap = bake(&scene, &mesh, &light, &errors, options(1024)).unwrap();
    let ([width, height], _) = lightmap.size();
    let mut compared = 0;
    for t in scene.triangle_ids().take(12) {
        let (page, [a, b, c]) = lightmap.place(t, Side::Front).unwrap();
        let corners = scene.corners(t);
        for (v, w) in [(0.3, 0.3), (0.5, 0.2), (0.2, 0.6), (0.33, 0.34)] {
            // The texel at this place, and the point of the triangle in its middle.
            let texel = (a + v * (b - a) + w * (c - a)).floor();
            let inverse = glam::DMat2::from_cols(b - a, c - a).inverse();
            let at = inverse * (texel + 0.5 - a);
            let point = corners[0] + at.x * (corners[1] - corners[0]) + at.y * (corners[2] - corners[0]);
            let i = (page as usize * height as usize + texel.y as usize) * width as usize + texel.x as usize;
            let found = f64::from(lightmap.irradiance()[i][0]);
            assert!((found - field(point)).abs() < 2e-4, "{found} {} at {point}", field(point));
            compared += 1;
        }
    }
    assert_eq!(compared, 48);
}

#[test]
fn errors_of_texels_are_upper_limits_of_their_spread() {
    let scene = room();
    for (count, size) in [(2_000, 128), (600, 512)] {
        let mesh = patches(&scene, count, true);
        let errors: Vec<Rgb> = light(&mesh).iter().map(|e| 0.05 * (*e + Rgb::ONE)).collect();
        let runs = 60;
        let mut sums: Vec<[f64; 2]> = Vec::new();
        let mut stated: Vec<f64> = Vec::new();
        for seed in 0..runs {
            let mut next = random(seed + 1);
            let light: Vec<Rgb> = errors
                .iter()
                .map(|&error| {
                    // A sum of twelve uniform numbers has nearly a normal distribution.
                    let noise: f64 = (0..12).map(|_| next()).sum::<f64>() - 6.0;
                    Rgb::splat(10.0) + noise * error
                })
                .collect();
            let lightmap = bake(&scene, &mesh, &light, &errors, options(size)).unwrap();
            sums.resize(lightmap.irradiance().len(), [0.0; 2]);
            for (sum, texel) in sums.iter_mut().zip(lightmap.irradiance()) {
                let x = f64::from(texel[0]) - 10.0;
                *sum = [sum[0] + x, sum[1] + x * x];
            }
            if seed == 0 {
                let of =
                    |(error, area): (&[f32; 3], &f32)| if *area > 0.0 { f64::from(error[0]) } else { 0.0 };
                stated = lightmap.errors().iter().zip(lightmap.areas()).map(of).collect();
            }
        }
        let n = runs as f64;
        let (mut ratio, mut counted) = (0.0, 0.0);
        for ([sum, squares], error) in sums.iter().zip(&stated).filter(|(_, error)| **error > 0.0) {
            ratio += (squares - sum * sum / n) / (n - 1.0) / (error * error);
            counted += 1.0;
        }
        let ratio = (ratio / counted).sqrt();
        // Interpolation takes the mean of neighbors, which the stated errors leave out.
        assert!((0.4..1.02).contains(&ratio), "{count} patches, {size} texels: {ratio}");
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let scene = room();
    let mesh = patches(&scene, 5_000, true);
    let light = light(&mesh);
    let errors: Vec<Rgb> = light.iter().map(|e| 0.1 * *e).collect();
    let with = |threads| {
        let options = LightmapOptions { threads, seams: true, ..options(400) };
        let lightmap = bake(&scene, &mesh, &light, &errors, options).unwrap();
        let bits = |all: &[[f32; 3]]| all.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
        (bits(lightmap.irradiance()), bits(lightmap.errors()))
    };
    let one = with(1);
    assert!(one == with(3) && one == with(8));
}

#[test]
fn steps_at_the_edges_of_charts_become_as_small_as_inside() {
    let scene = {
        use sir_geom::shapes::{self, Facing};
        let mut b = sir_geom::SceneBuilder::new();
        let gray = b.add_material(sir_geom::Material::diffuse("gray", Rgb::splat(0.5)));
        shapes::sphere(&mut b, glam::DVec3::ZERO, 1.0, 4, Facing::Outward, |_| gray);
        b.build().unwrap().scene
    };
    let mesh = patches(&scene, 1_000, false);
    let mut next = random(3);
    let light: Vec<Rgb> = (0..mesh.side_count()).map(|_| Rgb::splat(1.0 + 0.2 * (next() - 0.5))).collect();
    let errors = vec![Rgb::splat(0.058); light.len()];
    let options = LightmapOptions { seams: true, ..options(256) };
    let steps = bake(&scene, &mesh, &light, &errors, options).unwrap().seam_steps().unwrap();
    assert!(steps.points > 300, "{steps:?}");
    assert!(steps.after < 1.1 * steps.inside && steps.after < steps.before, "{steps:?}");
}

#[test]
fn the_work_can_be_stopped_at_every_step() {
    struct StopAt(Step);
    impl Observer for StopAt {
        fn progress(&self, step: Step, _: u64, _: Option<u64>) -> bool {
            step != self.0
        }
    }
    let scene = room();
    let mesh = patches(&scene, 500, true);
    let light = light(&mesh);
    for step in [Step::Unwrapping, Step::Packing, Step::Filling, Step::Seams] {
        let options = LightmapOptions { seams: true, ..options(128) };
        let of = solution(&scene, &mesh, &light, &light, std::path::Path::new("room.obj"));
        let stopped = Lightmap::new(of, options, &StopAt(step));
        assert!(matches!(stopped, Err(LightmapError::Stopped)), "{step:?}");
    }
}
