//! glTF: punctual lights.

use std::f64::consts::FRAC_PI_3;

use glam::DVec3;
use serde_json::{Value, json};
use sir_geom::{Built, Light, LightKind, LoadError, Rgb, Spread};

use crate::files::{Gltf, chain, warnings};

/// Half of the square root of two, as in the quaternion of a quarter turn.
const R: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Returns a file with these lights, and nodes besides that of the mesh.
fn load(lights: Value, nodes: &[Value]) -> Result<Built, LoadError> {
    let mut gltf = Gltf::triangle();
    gltf.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    gltf.json["extensionsRequired"] = json!(["KHR_lights_punctual"]);
    gltf.json["extensions"] = json!({"KHR_lights_punctual": {"lights": lights}});
    for node in nodes {
        let all = gltf.json["nodes"].as_array_mut().unwrap();
        all.push(node.clone());
        let index = all.len() - 1;
        gltf.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(index));
    }
    gltf.load()
}

/// Returns a node with a light and other members.
fn node(light: usize, more: Value) -> Value {
    let mut node = more;
    node["extensions"] = json!({"KHR_lights_punctual": {"light": light}});
    node
}

#[test]
fn lights_stand_where_their_nodes_are() {
    let built = load(
        json!([
            {"type": "point", "name": "bulb", "color": [1, 0.5, 0.25], "intensity": 60, "range": 9},
            {"type": "directional", "intensity": 1000},
            {"type": "spot", "intensity": 5, "spot": {"innerConeAngle": 0, "outerConeAngle": FRAC_PI_3}},
            {"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.5}},
        ]),
        &[
            node(0, json!({"translation": [1, 2, 3]})),
            node(1, json!({"name": "sun", "rotation": [-R, 0, 0, R], "scale": [2, 2, 2]})),
            node(2, json!({"rotation": [0, R, 0, R], "translation": [4, 0, 0]})),
            node(3, json!({})),
        ],
    )
    .unwrap();
    let [bulb, sun, spot, sharp] = built.scene.lights() else { panic!("{:?}", built.scene.lights()) };
    let kind = LightKind::Point {
        position: DVec3::new(1.0, 2.0, 3.0),
        intensity: Rgb::new(60.0, 30.0, 15.0),
        spread: Spread::Isotropic,
    };
    assert_eq!(*bulb, Light { name: "bulb".into(), kind });
    let LightKind::Distant { direction, irradiance } = sun.kind else { panic!("{sun:?}") };
    assert!(direction.abs_diff_eq(-DVec3::Y, 1e-7) && irradiance == Rgb::splat(1000.0), "{direction}");
    assert_eq!(sun.name, "sun");
    let LightKind::Point { position, spread: Spread::Spot { axis, inner, outer }, .. } = spot.kind else {
        panic!("{spot:?}")
    };
    assert!(axis.abs_diff_eq(-DVec3::X, 1e-7) && position == DVec3::X * 4.0, "{axis}");
    assert!(inner == 1.0 && (outer - 0.5).abs() < 1e-7, "{outer}");
    let LightKind::Point { intensity, spread: Spread::Spot { inner, outer, .. }, .. } = sharp.kind else {
        panic!("{sharp:?}")
    };
    assert!(inner > outer && inner - outer < 1e-6 && intensity == Rgb::ONE);
    let range = "1 lights have a range, which is ignored: light falls off with the square of the distance alone: \"bulb\"";
    assert!(warnings(&built).contains(&range.to_owned()), "{:?}", warnings(&built));
}

#[test]
fn lights_that_shine_nowhere_are_left_out() {
    let built = load(
        json!([
            {"type": "laser", "name": "a"},
            {"type": "spot", "name": "b"},
            {"type": "spot", "name": "c", "spot": {"innerConeAngle": 2, "outerConeAngle": 1}},
            {"type": "directional", "name": "d"},
        ]),
        &[node(0, json!({})), node(1, json!({})), node(2, json!({})), node(3, json!({"scale": [0, 0, 0]}))],
    )
    .unwrap();
    assert_eq!(built.scene.lights(), []);
    let all = warnings(&built);
    assert!(all.contains(&"1 lights have an unknown type and were ignored: \"a\"".to_owned()), "{all:?}");
    let none = "3 lights have no valid direction or cone and were ignored: \"b\", \"c\", \"d\"";
    assert!(all.contains(&none.to_owned()), "{all:?}");
}

#[test]
fn impossible_lights_are_errors() {
    let point = |intensity: Value| json!([{"type": "point", "name": "lamp", "intensity": intensity}]);
    let error = |lights, light| chain(&load(lights, &[node(light, json!({}))]).unwrap_err());
    let message = error(point(json!(1)), 1);
    assert!(message.contains("a node: light 1 does not exist"), "{message}");
    let message = error(point(json!(-1)), 0);
    assert!(
        message.contains("light 0 (\"lamp\") has a bad intensity: it must be finite and not"),
        "{message}"
    );
    let message = error(point(json!("much")), 0);
    assert!(message.contains("lights[0].intensity: found the text \"much\", expected a number"), "{message}");
}

/// A photometric file of a lamp with 100 cd at the polar angle 0, 50 cd at 90° in the half plane of the horizontal angle 0, and
/// none at 90° in that of 90°, between which and the other half planes it is symmetric.
const IES: &str =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 3 1 2 0 0 0\n1 1 0\n0 90\n0 90 180\n100 50\n100 0\n100 25\n";

/// Returns the error, or the warnings and lights, of a file with a photometric file and a node that has it.
fn load_profile(profile: Value, node: Value, rotation: Value) -> Result<Built, LoadError> {
    let mut gltf = Gltf::triangle();
    gltf.json["extensionsUsed"] = json!(["EXT_lights_ies"]);
    gltf.json["extensionsRequired"] = json!(["EXT_lights_ies"]);
    gltf.json["extensions"] = json!({"EXT_lights_ies": {"lights": [profile]}});
    let all = gltf.json["nodes"].as_array_mut().unwrap();
    let extensions = json!({"EXT_lights_ies": node});
    all.push(json!({
        "name": "lamp", "translation": [1, 2, 3], "rotation": rotation, "scale": [2, 2, 2], "extensions": extensions,
    }));
    let index = all.len() - 1;
    gltf.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(index));
    gltf.load()
}

fn data_uri(text: &str) -> String {
    let encoded: String = text.bytes().map(|byte| format!("%{byte:02x}")).collect();
    format!("data:application/x-ies-lm-63,{encoded}")
}

#[test]
fn photometric_files_shine_along_minus_z() {
    let profile = json!({"uri": data_uri(IES)});
    let node = json!({"light": 0, "multiplier": 2, "color": [1, 0.5, 7]});
    let upright = load_profile(profile.clone(), node.clone(), json!([0, 0, 0, 1])).unwrap();
    // About y by a quarter turn: −z goes to −x, and +x to −z.
    let turned = load_profile(profile, node, json!([0, R, 0, R])).unwrap();
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
    for (built, [aim, zero, quarter]) in [(upright, [-z, x, y]), (turned, [-x, -z, y])] {
        let [light] = built.scene.lights() else { panic!("{:?}", built.scene.lights()) };
        assert_eq!(light.name, "lamp");
        let LightKind::Point { position, intensity, ref spread } = light.kind else { panic!("{light:?}") };
        assert_eq!((position, intensity), (DVec3::new(1.0, 2.0, 3.0), Rgb::new(200.0, 100.0, 200.0)));
        for (direction, share) in
            [(aim, 1.0), (zero, 0.5), (quarter, 0.0), (-quarter, 0.0), (-zero, 0.25), (-aim, 0.0)]
        {
            assert!(
                (spread.share(direction) - share).abs() < 1e-6,
                "{direction} {}",
                spread.share(direction)
            );
        }
    }
}

#[test]
fn photometric_files_that_cannot_be_read_are_errors() {
    let node = json!({"light": 0});
    let good = json!({"uri": data_uri(IES)});
    let upright = json!([0, 0, 0, 1]);
    for (profile, node, why) in [
        (json!({}), node.clone(), "neither a `uri` nor a `bufferView`"),
        (json!({"uri": "absent.ies"}), node.clone(), "absent.ies"),
        (json!({"uri": "../absent.ies"}), node.clone(), "outside the scene's folder"),
        (json!({"bufferView": 99}), node.clone(), "99"),
        (json!({"uri": data_uri("nonsense")}), node.clone(), "light profile 0"),
        (good.clone(), json!({"light": 1}), "it does not exist"),
        (good.clone(), json!({}), "needs the index of a `light`"),
        (good.clone(), json!({"light": 0, "multiplier": -1}), "`multiplier` that is not negative"),
        (good, json!({"light": 0, "color": [1, 1]}), "three numbers"),
    ] {
        let error = load_profile(profile, node, upright.clone()).unwrap_err().to_string();
        assert!(error.contains(why), "{why}: {error}");
    }
}
