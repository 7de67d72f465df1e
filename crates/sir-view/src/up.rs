//! What the contents of a scene say about its up direction.

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::{LightKind, Scene, Side, Spread, luminance};

/// Something in a scene that shows which direction is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UpClue {
    /// Direction that is up according to the clue: +y or +z.
    pub up: DVec3,
    /// The clue, as a clause such as "lamps shine along −z".
    pub why: &'static str,
    /// True if the clue is a ground, which may be the wall of a building instead.
    pub is_ground: bool,
}

/// The two directions that files have up, with the words for each clue.
const AXES: [(DVec3, [&str; 5]); 2] = [
    (
        DVec3::Y,
        [
            "+y is the zenith of the sky",
            "cameras have +y up",
            "lamps shine along −y",
            "sunlight falls along −y",
            "most of the area is a ground that faces along y",
        ],
    ),
    (
        DVec3::Z,
        [
            "+z is the zenith of the sky",
            "cameras have +z up",
            "lamps shine along −z",
            "sunlight falls along −z",
            "most of the area is a ground that faces along z",
        ],
    ),
];

/// Cosine of the largest angle between a direction and an axis along which it counts.
const ALONG: f64 = 0.9;

/// Share of the light of all lamps that must fall along one direction, and of the cameras that must agree.
const MOST: f64 = 2.0 / 3.0;

/// Share of the area that must be left when opposite directions cancel, for a scene to be a ground.
const GROUND: f64 = 0.5;

/// Returns what in a scene shows its up direction, the most reliable clue first. Proportions are no clue, because rooms
/// may be higher than long.
///
/// The clues are: the zenith of the sky, unless it is the usual +y; the up directions of cameras; lamps, two thirds of
/// whose light falls along −y or −z; sunlight, which falls from above; and a ground, if the sum of all normals weighted
/// by area has more than half of the length that it would have if all surfaces faced the same way.
#[must_use]
pub fn up_clues(scene: &Scene) -> Vec<UpClue> {
    let clues = [sky(scene), cameras(scene), lamps(scene), sun(scene), ground(scene)];
    let last = clues.len() - 1;
    let found = clues.into_iter().enumerate().filter_map(|(clue, axis)| {
        let (up, words) = AXES[axis?];
        Some(UpClue { up, why: words[clue], is_ground: clue == last })
    });
    found.collect()
}

/// Returns true if more area faces along ±z than along ±y: floors, ceilings and tables outweigh the walls of most rooms.
#[must_use]
pub fn more_faces_along_z(scene: &Scene) -> bool {
    let [y, z] = AXES.map(|(axis, _)| {
        let facing = scene.triangle_ids().filter(|&id| scene.normal(id).dot(axis).abs() > 0.99);
        facing.map(|id| scene.area(id)).sum::<f64>()
    });
    z > y
}

fn sky(scene: &Scene) -> Option<usize> {
    // A zenith of +y may be there by default, and says nothing.
    (scene.sky()?.up().z > ALONG).then_some(1)
}

fn cameras(scene: &Scene) -> Option<usize> {
    let cameras = scene.cameras();
    AXES.iter().position(|(axis, _)| {
        let agree = cameras.iter().filter(|camera| camera.up.dot(*axis) > 0.5).count();
        agree > 0 && agree as f64 >= MOST * cameras.len() as f64
    })
}

fn lamps(scene: &Scene) -> Option<usize> {
    let (mut all, mut down) = (0.0, [0.0; 2]);
    let mut add = |power: f64, direction: DVec3| {
        all += power;
        for ((axis, _), down) in AXES.iter().zip(&mut down) {
            *down += if direction.dot(*axis) < -ALONG { power } else { 0.0 };
        }
    };
    for id in scene.triangle_ids() {
        for (side, sign) in [(Side::Front, 1.0), (Side::Back, -1.0)] {
            let exitance = luminance(scene.exitance(id, side));
            if exitance > 0.0 {
                add(exitance * scene.area(id), sign * scene.normal(id));
            }
        }
    }
    for light in scene.lights() {
        if let LightKind::Point { intensity, ref spread, .. } = light.kind {
            match *spread {
                // The same in all directions: no clue.
                Spread::Isotropic => {}
                Spread::Lambertian { axis } => add(PI * luminance(intensity), axis),
                Spread::Spot { axis, .. } => add(spread.solid_angle() * luminance(intensity), axis),
                Spread::Tabulated(ref tabulated) => {
                    add(spread.solid_angle() * luminance(intensity), -tabulated.frame().z_axis);
                }
            }
        }
    }
    down.iter().position(|&power| power > 0.0 && power >= MOST * all)
}

fn sun(scene: &Scene) -> Option<usize> {
    let mut light = DVec3::ZERO;
    for source in scene.lights() {
        if let LightKind::Distant { direction, irradiance } = source.kind {
            light += luminance(irradiance) * direction;
        }
    }
    let from = -light.normalize_or_zero();
    let [y, z] = AXES.map(|(axis, _)| from.dot(axis));
    // A low sun shines along the ground; that it is not below the horizon tells the axes apart.
    match (y > 0.1, z > 0.1) {
        (true, false) if z < 0.25 * y => Some(0),
        (false, true) if y < 0.25 * z => Some(1),
        _ => None,
    }
}

fn ground(scene: &Scene) -> Option<usize> {
    let net: DVec3 = scene.triangle_ids().map(|id| scene.area(id) * scene.normal(id)).sum();
    let least = GROUND * scene.total_area();
    AXES.iter().position(|(axis, _)| net.dot(*axis).abs() > least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_geom::shapes::{self, Facing};
    use sir_geom::{Camera, Light, Material, Rgb, SceneBuilder, Sky, SkyModel};

    /// A closed room with a lamp that faces along `lamp`, if it is not zero, and what `add` adds.
    fn clues(lamp: DVec3, add: impl FnOnce(&mut SceneBuilder)) -> Vec<&'static str> {
        let mut b = SceneBuilder::new();
        let gray = b.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
        shapes::cuboid(&mut b, DVec3::ZERO, DVec3::new(4.0, 9.0, 4.0), [gray; 6], Facing::Inward);
        if lamp != DVec3::ZERO {
            let lit = b.add_material(Material::diffuse("lamp", Rgb::ZERO).emitting(Rgb::ONE));
            let across = lamp.any_orthonormal_vector();
            let [p, q] = [DVec3::splat(2.0), DVec3::splat(2.0) + across];
            shapes::quad(&mut b, [p, q, q + lamp.cross(across), p + lamp.cross(across)], lit);
        }
        add(&mut b);
        up_clues(&b.build().unwrap().scene).iter().map(|clue| clue.why).collect()
    }

    #[test]
    fn lamps_shine_down() {
        assert_eq!(clues(DVec3::NEG_Y, |_| {}), ["lamps shine along −y"]);
        assert_eq!(clues(DVec3::NEG_Z, |_| {}), ["lamps shine along −z"]);
        for no_clue in [DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::Z] {
            assert_eq!(clues(no_clue, |_| {}), [""; 0], "{no_clue}");
        }
    }

    #[test]
    fn light_of_points_and_the_sun_falls_from_above() {
        let point = |spread| LightKind::Point { position: DVec3::ONE, intensity: Rgb::ONE, spread };
        let sun = |x: f64, y: f64, z: f64| LightKind::Distant {
            direction: DVec3::new(x, y, z).normalize(),
            irradiance: Rgb::ONE,
        };
        for (kind, expected) in [
            (point(Spread::Isotropic), None),
            (point(Spread::Lambertian { axis: DVec3::NEG_Z }), Some("lamps shine along −z")),
            (sun(0.0, -0.5, 0.87), Some("sunlight falls along −y")),
            (sun(0.5, 0.3, -0.4), Some("sunlight falls along −z")),
            (sun(0.5, -0.4, -0.4), None),
            (sun(1.0, 0.0, 0.0), None),
        ] {
            let found =
                clues(DVec3::ZERO, |b| b.add_light(Light { name: String::new(), kind: kind.clone() }));
            assert_eq!(found.first().copied(), expected, "{kind:?}");
        }
    }

    #[test]
    fn skies_cameras_and_grounds_are_clues() {
        let sky = |up| Sky::new(up, SkyModel::Uniform, Rgb::ONE, Rgb::ZERO).unwrap();
        assert_eq!(clues(DVec3::NEG_Y, |b| b.set_sky(sky(DVec3::Z))).len(), 2);
        assert_eq!(clues(DVec3::ZERO, |b| b.set_sky(sky(DVec3::Y))), [""; 0]);
        let camera = |up| Camera::looking_at(DVec3::ZERO, DVec3::X, up, 1.0).unwrap();
        assert_eq!(clues(DVec3::ZERO, |b| b.add_camera(camera(DVec3::Z))), ["cameras have +z up"]);
        let ground = |b: &mut SceneBuilder| {
            let m = b.add_material(Material::diffuse("", Rgb::splat(0.5)));
            let corners = [(-99.0, -99.0), (99.0, -99.0), (99.0, 99.0), (-99.0, 99.0)];
            shapes::quad(b, corners.map(|(x, y)| DVec3::new(x, y, -1.0)), m);
        };
        assert_eq!(clues(DVec3::ZERO, ground), ["most of the area is a ground that faces along z"]);
    }
}
