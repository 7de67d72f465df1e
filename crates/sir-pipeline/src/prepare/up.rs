//! The up direction of a scene, and where it comes from.

use std::path::Path;

use glam::DVec3;
use sir_geom::{Scene, SceneBuilder};
use sir_view::{more_faces_along_z, up_clues};

/// Reason for the up direction if nothing shows it.
pub(crate) const UNKNOWN: &str = "as usual in OBJ; nothing in the scene shows it";

/// Up direction of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Up {
    /// Direction, of unit length.
    pub direction: DVec3,
    /// Reason for it, such as "lamps shine along −z".
    pub why: String,
    /// Warning, if something in the scene speaks against it.
    pub doubt: Option<String>,
}

impl Up {
    /// Returns the up direction of the scene in a file, before the lamps of a pipeline are added to its builder.
    pub(crate) fn before_lamps(path: &Path, builder: &SceneBuilder, stated: Option<DVec3>) -> DVec3 {
        if let Some(direction) = stated.and_then(DVec3::try_normalize) {
            return direction;
        }
        if !is_obj(path) {
            return DVec3::Y;
        }
        // What is wrong with the scene is reported when it is built.
        builder.clone().build().map_or(DVec3::Y, |built| Self::of(path, &built.scene, None).direction)
    }

    /// Returns the up direction of the scene in a file. In this order it is: the one that the pipeline states, +y in
    /// glTF, what the scene shows, or +y as usual in OBJ.
    pub(crate) fn of(path: &Path, scene: &Scene, stated: Option<DVec3>) -> Self {
        let without_doubt = |direction, why: &str| Self { direction, why: why.into(), doubt: None };
        if let Some(direction) = stated.and_then(DVec3::try_normalize) {
            return without_doubt(direction, "as `Load` states");
        }
        let clues = up_clues(scene);
        let against = |up: DVec3| clues.iter().filter(move |clue| clue.up != up);
        let why_not = |up: DVec3| against(up).map(|clue| clue.why).collect::<Vec<_>>().join(" and ");
        // OBJ does not define the up direction.
        if !is_obj(path) {
            let up = without_doubt(DVec3::Y, "as glTF defines it");
            // A single lamp or camera may be turned; the format is more reliable.
            let is_doubtful = clues.len() > 1 && against(DVec3::Y).count() == clues.len();
            return Self { doubt: is_doubtful.then(|| doubt(&up, &why_not(DVec3::Y))), ..up };
        }
        let Some(first) = clues.first() else {
            return without_doubt(DVec3::Y, UNKNOWN);
        };
        let up = without_doubt(first.up, first.why);
        let mut objections = why_not(up.direction);
        if objections.is_empty() && up.direction == DVec3::Z {
            if !more_faces_along_z(scene) {
                objections = "more area faces along y, as floors and ceilings do".into();
            } else if clues.len() == 1 && first.is_ground {
                objections = "it may be the wall of a building".into();
            }
        }
        Self { doubt: (!objections.is_empty()).then(|| doubt(&up, &objections)), ..up }
    }
}

/// True for a format that does not define the up direction.
fn is_obj(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"))
}

/// Returns a warning if the sky of a scene has another zenith than the scene has up.
pub(crate) fn sky_doubt(scene: &Scene, up: DVec3) -> Option<String> {
    let sky = scene.sky()?;
    let is_tilted = sky.up().dot(up) < 0.9;
    // An environment is the same in all directions.
    let is_even = sky.radiance(sky.up()) == sky.ground();
    let [x, y, z] = up.to_array();
    (is_tilted && !is_even).then(|| {
        format!(
            "the zenith of the sky is {}, but the scene has {} up; set `up: ({x}, {y}, {z})` in `Sky`, or the same direction in \
             `Load`",
            name(sky.up()),
            name(up)
        )
    })
}

fn doubt(up: &Up, objections: &str) -> String {
    format!(
        "up is taken to be {} ({}), but {objections}; state it as `Load(up: (0, 1, 0))` or `Load(up: (0, 0, 1))`",
        name(up.direction),
        up.why
    )
}

/// Returns the name of a direction: `+y`, or its coordinates.
#[must_use]
pub fn name(direction: DVec3) -> String {
    let axes = [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)];
    let signed = axes.iter().flat_map(|(name, axis)| [("+", name, *axis), ("−", name, -*axis)]);
    let named = signed.into_iter().find(|(_, _, axis)| direction.distance(*axis) < 1e-9);
    match named {
        Some((sign, name, _)) => format!("{sign}{name}"),
        None => format!("({:.4}, {:.4}, {:.4})", direction.x, direction.y, direction.z),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_geom::shapes::{self, Facing};
    use sir_geom::{Material, Rgb, SceneBuilder};

    /// A room of the given size with a lamp of 1 m² in its middle that faces along `lamp`, if that is not zero.
    fn up(path: &str, size: [f64; 3], lamp: DVec3) -> Up {
        let mut b = SceneBuilder::new();
        let gray = b.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
        shapes::cuboid(&mut b, DVec3::ZERO, DVec3::from(size), [gray; 6], Facing::Inward);
        if lamp != DVec3::ZERO {
            let lit = b.add_material(Material::diffuse("lamp", Rgb::ZERO).emitting(Rgb::ONE));
            let (corner, a) = (0.5 * DVec3::from(size), lamp.any_orthonormal_vector());
            let b_ = lamp.cross(a);
            shapes::quad(&mut b, [corner, corner + a, corner + a + b_, corner + b_], lit);
        }
        Up::of(Path::new(path), &b.build().unwrap().scene, None)
    }

    #[test]
    fn proportions_do_not_turn_a_scene() {
        for size in [[4.0, 9.0, 4.0], [4.0, 9.0, 3.0], [9.0, 4.0, 3.0], [4.0, 3.0, 4.0]] {
            for lamp in [DVec3::ZERO, DVec3::NEG_Y, DVec3::X] {
                let up = up("a.obj", size, lamp);
                assert_eq!((up.direction, up.doubt), (DVec3::Y, None), "{size:?} {lamp}");
            }
        }
    }

    #[test]
    fn lamps_turn_an_obj_scene_but_not_a_gltf_scene() {
        let turned = up("a.OBJ", [4.0, 5.0, 3.0], DVec3::NEG_Z);
        assert_eq!((turned.direction, turned.doubt), (DVec3::Z, None));
        assert_eq!(turned.why, "lamps shine along −z");
        let gltf = up("a.gltf", [4.0, 5.0, 3.0], DVec3::NEG_Z);
        assert_eq!((gltf.direction, gltf.doubt), (DVec3::Y, None));
    }

    #[test]
    fn a_lit_window_in_the_end_of_a_hall_raises_doubt() {
        let doubt = up("a.obj", [4.0, 3.0, 9.0], DVec3::NEG_Z).doubt.unwrap();
        assert!(doubt.starts_with("up is taken to be +z (lamps shine along −z), but more area"), "{doubt}");
    }

    #[test]
    fn what_the_pipeline_states_is_taken() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("", Rgb::splat(0.5)));
        shapes::quad(&mut b, [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y], m);
        let scene = b.build().unwrap().scene;
        let of = |stated| Up::of(Path::new("a.gltf"), &scene, stated).direction;
        assert_eq!((of(None), of(Some(2.0 * DVec3::X))), (DVec3::Y, DVec3::X));
        assert_eq!([DVec3::Y, DVec3::NEG_Z].map(name), ["+y", "−z"]);
    }
}
