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
