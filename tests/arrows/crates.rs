//! Dependencies between crates point downward, and only as the design allows.

use std::process::Command;

use serde_json::Value;

/// Crates of the workspace, from the bottom to the top, each with the crates that it may use.
const LAYERS: [(&str, &[&str]); 17] = [
    ("sir-types", &[]),
    ("sir-photometry", &[]),
    ("sir-geom", &["sir-types", "sir-photometry"]),
    ("sir-mesh", &["sir-geom"]),
    ("sir-lines", &["sir-types"]),
    ("sir-scenes", &["sir-geom"]),
    // The ray tracer does not depend on scenes.
    ("sir-accel", &["sir-types"]),
    ("sir-radiosity", &["sir-types", "sir-geom", "sir-mesh", "sir-lines", "sir-accel"]),
    ("sir-parallel", &["sir-geom", "sir-mesh", "sir-lines", "sir-accel", "sir-radiosity"]),
    // Validation depends on the solver, but not on pipelines or files.
    (
        "sir-validate",
        &[
            "sir-photometry",
            "sir-geom",
            "sir-mesh",
            "sir-lines",
            "sir-accel",
            "sir-radiosity",
            "sir-parallel",
        ],
    ),
    ("sir-view", &["sir-geom", "sir-mesh", "sir-lines", "sir-accel", "sir-radiosity"]),
    ("sir-report", &["sir-geom", "sir-mesh", "sir-view"]),
    ("sir-lightmap", &["sir-geom", "sir-mesh", "sir-view"]),
    // Pipelines do not depend on validation.
    (
        "sir-pipeline",
        &[
            "sir-photometry",
            "sir-geom",
            "sir-mesh",
            "sir-lines",
            "sir-accel",
            "sir-radiosity",
            "sir-parallel",
            "sir-view",
            "sir-report",
            "sir-lightmap",
        ],
    ),
    (
        "sir-study",
        &[
            "sir-geom",
            "sir-mesh",
            "sir-lines",
            "sir-accel",
            "sir-radiosity",
            "sir-parallel",
            "sir-view",
            "sir-pipeline",
        ],
    ),
    (
        "sir-cli",
        &[
            "sir-geom",
            "sir-mesh",
            "sir-lines",
            "sir-accel",
            "sir-radiosity",
            "sir-parallel",
            "sir-validate",
            "sir-view",
            "sir-report",
            "sir-pipeline",
            "sir-study",
        ],
    ),
    (
        "sir",
        &[
            "sir-geom",
            "sir-mesh",
            "sir-lines",
            "sir-accel",
            "sir-radiosity",
            "sir-parallel",
            "sir-scenes",
            "sir-validate",
            "sir-view",
            "sir-report",
            "sir-pipeline",
            "sir-cli",
        ],
    ),
];

/// Third-party crates that only one crate may use.
const HIDDEN: [(&str, &str); 2] = [("obvhs", "sir-accel"), ("mpi", "sir-parallel")];

/// Crates with their dependencies, except dev-dependencies: tests may use crates above.
type Arrows = Vec<(String, Vec<String>)>;

/// Returns the violations, one sentence each.
fn problems(arrows: &Arrows) -> Vec<String> {
    let mut problems = Vec::new();
    for (name, _) in LAYERS {
        if !arrows.iter().any(|(found, _)| found == name) {
            problems.push(format!("{name} is in the list of layers, but not in the workspace; remove it"));
        }
    }
    for (name, dependencies) in arrows {
        let Some((_, allowed)) = LAYERS.iter().find(|(listed, _)| listed == name) else {
            problems.push(format!("{name} is not in the list of layers; add it there"));
            continue;
        };
        for dependency in dependencies {
            let ours = dependency == "sir" || dependency.starts_with("sir-");
            if ours && !allowed.contains(&dependency.as_str()) {
                problems.push(format!("{name} must not depend on {dependency}"));
            }
            for (hidden, owner) in HIDDEN {
                if dependency == hidden && name != owner {
                    problems.push(format!("{name} must not depend on {hidden}, which only {owner} may use"));
                }
            }
        }
    }
    problems
}

/// Returns the dependencies between the crates of the workspace, from `cargo metadata`.
fn workspace() -> Arrows {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1", "--manifest-path"])
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let used = |package: &Value| {
        let all = package["dependencies"].as_array().unwrap();
        all.iter().filter(|d| d["kind"] != "dev").map(|d| text(&d["name"])).collect()
    };
    metadata["packages"].as_array().unwrap().iter().map(|p| (text(&p["name"]), used(p))).collect()
}

#[test]
fn crates_depend_only_on_those_below() {
    let arrows = workspace();
    assert!(arrows.iter().any(|(name, used)| name == "sir" && used.contains(&"sir-cli".to_owned())));
    let problems = problems(&arrows);
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn layers_are_listed_from_the_bottom_to_the_top() {
    for (i, (name, allowed)) in LAYERS.iter().enumerate() {
        for dependency in *allowed {
            assert!(LAYERS[..i].iter().any(|(below, _)| below == dependency), "{name} → {dependency}");
        }
    }
}

#[test]
fn wrong_arrows_are_found() {
    let made_up = |changes: &[(&str, &[&str])]| -> Vec<String> {
        let mut arrows: Arrows = LAYERS.iter().map(|(name, _)| ((*name).to_owned(), Vec::new())).collect();
        for (name, used) in changes {
            arrows.retain(|(known, _)| known != name);
            arrows.push(((*name).to_owned(), used.iter().map(|&d| d.to_owned()).collect()));
        }
        problems(&arrows)
    };
    assert_eq!(made_up(&[("sir-radiosity", &["glam", "sir-accel"]), ("sir-accel", &["obvhs"])]), [""; 0]);
    for (name, used, expected) in [
        ("sir-geom", "sir-mesh", "sir-geom must not depend on sir-mesh"),
        ("sir-accel", "sir-geom", "sir-accel must not depend on sir-geom"),
        ("sir-radiosity", "sir-parallel", "sir-radiosity must not depend on sir-parallel"),
        ("sir-pipeline", "sir-validate", "sir-pipeline must not depend on sir-validate"),
        ("sir-pipeline", "sir-study", "sir-pipeline must not depend on sir-study"),
        ("sir-cli", "sir", "sir-cli must not depend on sir"),
        ("sir-cli", "sir-new", "sir-cli must not depend on sir-new"),
        ("sir-view", "obvhs", "sir-view must not depend on obvhs, which only sir-accel may use"),
        ("sir-new", "glam", "sir-new is not in the list of layers; add it there"),
    ] {
        assert_eq!(made_up(&[(name, &[used])]), [expected]);
    }
    let all_but_one: Arrows = LAYERS[1..].iter().map(|(name, _)| ((*name).to_owned(), Vec::new())).collect();
    let missing = "sir-types is in the list of layers, but not in the workspace; remove it";
    assert_eq!(problems(&all_but_one), [missing]);
}
