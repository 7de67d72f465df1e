//! The Cornell box, as measured by the Cornell University Program of Computer Graphics.
//!
//! All data are from its page "Cornell Box Data" (<https://www.graphics.cornell.edu/online/box/data.html>, now at
//! <https://bowers.cornell.edu/computer-graphics/data>), which gives lengths in millimeters.
//!
//! # Colors
//!
//! The published colors are spectra. The reflectance in a band `c` is the measured reflectance averaged over the
//! wavelengths with the weight `S(λ) c̄(λ)`, where `S` is the spectrum of the lamp and `c̄` the color-matching function
//! of the band. With this weight, the first reflection of direct light is exact in every band. With a neutral light as
//! the weight, it would be exact in none.
//!
//! The lamp has almost no blue. Relative to an equal-energy light of the same luminance, its bands are
//! 1.39 : 0.93 : 0.25. An observer in the room would not see this orange, because the eye adapts to the lamp. The lamp
//! of the scene is half adapted: each band is the geometric mean of the band and the luminance. Because bands do not
//! mix, this only multiplies each band by a constant factor, like the white balance of a camera. The published emission
//! has no unit; it is taken as radiance in W/(m² sr).

use glam::DVec3;
use sir_geom::{Built, Camera, Material, MaterialId, Rgb, SceneBuilder, SceneError, shapes};

use crate::spectrum::{integrate, luminance, round_to, wavelengths};

/// Reflectance of the white surfaces from 400 to 700 nm in steps of 4 nm.
const WHITE: [f64; 76] = [
    0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.710, 0.745, 0.758, 0.739, 0.767, 0.777,
    0.765, 0.751, 0.745, 0.748, 0.729, 0.745, 0.757, 0.753, 0.750, 0.746, 0.747, 0.735, 0.732, 0.739, 0.734,
    0.725, 0.721, 0.733, 0.725, 0.732, 0.743, 0.744, 0.748, 0.728, 0.716, 0.733, 0.726, 0.713, 0.740, 0.754,
    0.764, 0.752, 0.736, 0.734, 0.741, 0.740, 0.732, 0.745, 0.755, 0.751, 0.744, 0.731, 0.733, 0.744, 0.731,
    0.712, 0.708, 0.729, 0.730, 0.727, 0.707, 0.703, 0.729, 0.750, 0.760, 0.751, 0.739, 0.724, 0.730, 0.740,
    0.737,
];

/// Reflectance of the green wall at the same wavelengths.
const GREEN: [f64; 76] = [
    0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097, 0.098, 0.096, 0.101, 0.103,
    0.104, 0.107, 0.109, 0.112, 0.115, 0.125, 0.140, 0.160, 0.187, 0.229, 0.285, 0.343, 0.390, 0.435, 0.464,
    0.472, 0.476, 0.481, 0.462, 0.447, 0.441, 0.426, 0.406, 0.373, 0.347, 0.337, 0.314, 0.285, 0.277, 0.266,
    0.250, 0.230, 0.207, 0.186, 0.171, 0.160, 0.148, 0.141, 0.136, 0.130, 0.126, 0.123, 0.121, 0.122, 0.119,
    0.114, 0.115, 0.117, 0.117, 0.118, 0.120, 0.122, 0.128, 0.132, 0.139, 0.144, 0.146, 0.150, 0.152, 0.157,
    0.159,
];

/// Reflectance of the red wall at the same wavelengths.
const RED: [f64; 76] = [
    0.040, 0.046, 0.048, 0.053, 0.049, 0.050, 0.053, 0.055, 0.057, 0.056, 0.059, 0.057, 0.061, 0.061, 0.060,
    0.062, 0.062, 0.062, 0.061, 0.062, 0.060, 0.059, 0.057, 0.058, 0.058, 0.058, 0.056, 0.055, 0.056, 0.059,
    0.057, 0.055, 0.059, 0.059, 0.058, 0.059, 0.061, 0.061, 0.063, 0.063, 0.067, 0.068, 0.072, 0.080, 0.090,
    0.099, 0.124, 0.154, 0.192, 0.255, 0.287, 0.349, 0.402, 0.443, 0.487, 0.513, 0.558, 0.584, 0.620, 0.606,
    0.609, 0.651, 0.612, 0.610, 0.650, 0.638, 0.627, 0.620, 0.630, 0.628, 0.642, 0.639, 0.657, 0.639, 0.635,
    0.642,
];

/// Emission of the lamp at 400, 500, 600 and 700 nm, interpolated linearly between them.
const LAMP: [f64; 4] = [0.0, 8.0, 15.6, 18.4];

/// Reflectance of the lamp: constant over the spectrum and only roughly known. Common renderings of the data use this
/// value.
const LAMP_REFLECTANCE: f64 = 0.78;

/// Corners of the lamp opening \[mm\], in the plane of the ceiling.
const OPENING: [[f64; 3]; 4] =
    [[343.0, 548.8, 227.0], [343.0, 548.8, 332.0], [213.0, 548.8, 332.0], [213.0, 548.8, 227.0]];

/// Corners of the ceiling \[mm\], in the same order as those of the opening.
const CEILING: [[f64; 3]; 4] =
    [[556.0, 548.8, 0.0], [556.0, 548.8, 559.2], [0.0, 548.8, 559.2], [0.0, 548.8, 0.0]];

/// Paint and corners \[mm\] of floor, back wall, right wall and left wall, as seen by the camera.
const WALLS: [(Paint, [[f64; 3]; 4]); 4] = [
    (Paint::White, [[552.8, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 559.2], [549.6, 0.0, 559.2]]),
    (Paint::White, [[549.6, 0.0, 559.2], [0.0, 0.0, 559.2], [0.0, 548.8, 559.2], [556.0, 548.8, 559.2]]),
    (Paint::Green, [[0.0, 0.0, 559.2], [0.0, 0.0, 0.0], [0.0, 548.8, 0.0], [0.0, 548.8, 559.2]]),
    (Paint::Red, [[552.8, 0.0, 0.0], [549.6, 0.0, 559.2], [556.0, 548.8, 559.2], [556.0, 548.8, 0.0]]),
];

/// Corners of the tops of the two blocks \[mm\]. The sides of the blocks reach down to the floor.
const BLOCKS: [[[f64; 3]; 4]; 2] = [
    [[130.0, 165.0, 65.0], [82.0, 165.0, 225.0], [240.0, 165.0, 272.0], [290.0, 165.0, 114.0]],
    [[423.0, 330.0, 247.0], [265.0, 330.0, 296.0], [314.0, 330.0, 456.0], [472.0, 330.0, 406.0]],
];

#[derive(Clone, Copy)]
enum Paint {
    White,
    Green,
    Red,
}

/// Returns the Cornell box with its two blocks, in meters, open at the front (`z = 0`), with the camera of the
/// published pictures. The red wall is on the left of the picture.
///
/// The lamp lies flush in an opening of the ceiling, so that no surface covers another. The materials are `white`,
/// `green`, `red` and `lamp`. The source of this module explains the origin of the colors.
///
/// # Errors
///
/// None that can occur with these data; the signature is the same for all scenes.
pub fn cornell_box() -> Result<Built, SceneError> {
    let mut b = SceneBuilder::new();
    let [white, green, red] = [("white", WHITE), ("green", GREEN), ("red", RED)]
        .map(|(name, spectrum)| b.add_material(Material::diffuse(name, reflectance(&spectrum))));
    let lamp = b.add_material(
        Material::diffuse("lamp", Rgb::splat(LAMP_REFLECTANCE))
            .emitting(std::f64::consts::PI * lamp_radiance()),
    );
    for (paint, corners) in WALLS {
        let material = match paint {
            Paint::White => white,
            Paint::Green => green,
            Paint::Red => red,
        };
        add_quad(&mut b, corners, material);
    }
    add_quad(&mut b, OPENING, lamp);
    for i in 0..4 {
        let next = (i + 1) % 4;
        add_quad(&mut b, [CEILING[i], CEILING[next], OPENING[next], OPENING[i]], white);
    }
    for top in BLOCKS {
        add_quad(&mut b, top, white);
        let foot = |p: [f64; 3]| [p[0], 0.0, p[2]];
        for i in 0..4 {
            let (left, right) = (top[(i + 1) % 4], top[i]);
            add_quad(&mut b, [left, right, foot(right), foot(left)], white);
        }
    }
    add_camera(&mut b);
    b.build()
}

fn add_quad(builder: &mut SceneBuilder, corners: [[f64; 3]; 4], material: MaterialId) {
    shapes::quad(builder, corners.map(|p| DVec3::from_array(p) / 1000.0), material);
}

/// Adds the published camera: position (278, 273, −800) mm, direction +z, focal length 0.035, film 0.025 by 0.025.
fn add_camera(builder: &mut SceneBuilder) {
    let eye = DVec3::new(0.278, 0.273, -0.8);
    let vertical_fov = 2.0 * (0.5 * 0.025 / 0.035f64).atan();
    if let Some(mut camera) = Camera::looking_at(eye, eye + DVec3::Z, DVec3::Y, vertical_fov) {
        camera.name = "published view".to_owned();
        camera.aspect = Some(1.0);
        builder.add_camera(camera);
    }
}

/// Returns the emission of the lamp at the wavelengths of the reflectances.
fn lamp() -> impl Iterator<Item = f64> {
    wavelengths().map(|nm| {
        let t = (nm - 400.0) / 100.0;
        let i = (t as usize).min(LAMP.len() - 2);
        LAMP[i] + (t - i as f64) * (LAMP[i + 1] - LAMP[i])
    })
}

/// Returns a measured reflectance per band, weighted with the spectrum of the lamp.
fn reflectance(spectrum: &[f64; 76]) -> Rgb {
    let reflected = integrate(lamp().zip(spectrum).map(|(s, r)| s * r));
    round_to(reflected / integrate(lamp()), 1e4).clamp(Rgb::ZERO, Rgb::ONE)
}

/// Returns the radiance of the lamp \[W/(m² sr)\], half adapted to its own color.
fn lamp_radiance() -> Rgb {
    let equal_energy = || wavelengths().map(|_| 1.0);
    let bands = integrate(lamp()) / integrate(equal_energy());
    let neutral = Rgb::splat(luminance(lamp()) / luminance(equal_energy()));
    round_to((bands * neutral).map(f64::sqrt), 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(name: &str) -> Material {
        let scene = cornell_box().unwrap().scene;
        scene.materials().iter().find(|m| m.name == name).unwrap().clone()
    }

    #[test]
    fn areas_are_the_published_ones() {
        let scene = cornell_box().unwrap().scene;
        let area = |name: &str| -> f64 {
            scene.triangle_ids().filter(|t| scene.material(*t).name == name).map(|t| scene.area(t)).sum()
        };
        assert!((area("lamp") - 0.130 * 0.105).abs() < 1e-12);
        assert!((area("green") - 0.5488 * 0.5592).abs() < 1e-12);
        let floor = 0.5 * (0.5528 + 0.5496) * 0.5592;
        let back = 0.5 * (0.5496 + 0.556) * 0.5488;
        let ceiling = 0.556 * 0.5592 - 0.130 * 0.105;
        let blocks: f64 = BLOCKS
            .iter()
            .map(|top| {
                let p = top.map(|p| DVec3::from_array(p) / 1000.0);
                let sides: f64 = (0..4).map(|i| p[i].distance(p[(i + 1) % 4]) * p[i].y).sum();
                sides + 0.5 * (p[2] - p[0]).cross(p[3] - p[1]).length()
            })
            .sum();
        assert!((area("white") - (floor + back + ceiling + blocks)).abs() < 1e-9);
    }

    #[test]
    fn walls_face_the_middle_and_blocks_face_away_from_theirs() {
        let scene = cornell_box().unwrap().scene;
        let middle = DVec3::new(0.278, 0.274, 0.28);
        for t in scene.triangle_ids() {
            let [a, b, c] = scene.corners(t);
            let centroid = (a + b + c) / 3.0;
            // The ten triangles of the short block and the ten of the tall block come last.
            let inside = match t.index() {
                0..18 => middle,
                18..28 => DVec3::new(0.186, 0.08, 0.169),
                _ => DVec3::new(0.3685, 0.165, 0.351),
            };
            let outward = scene.normal(t).dot(centroid - inside) > 0.0;
            assert_eq!(outward, t.index() >= 18, "triangle {t}");
        }
        assert_eq!(scene.triangles().len(), 38);
    }

    #[test]
    fn colors_are_what_they_are_called() {
        let [white, green, red] = ["white", "green", "red"].map(|n| material(n).reflectance);
        assert!(white.abs_diff_eq(Rgb::splat(0.74), 0.02), "{white}");
        assert!(green.y > 3.0 * green.x && green.x > green.z && green.z > 0.0, "{green}");
        assert!(red.x > 10.0 * red.y && red.y > red.z && red.z > 0.0, "{red}");
    }

    #[test]
    fn lamp_keeps_the_luminance_and_half_of_the_color() {
        let radiance = material("lamp").exitance / std::f64::consts::PI;
        assert!(radiance.abs_diff_eq(Rgb::new(14.59, 11.92, 6.15), 0.03), "{radiance}");
    }
}
