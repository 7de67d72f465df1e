//! A pipeline as the text of a file.

use std::path::Path;

use sir_geom::{Camera, Projection};
use sir_mesh::Subdivision;
use sir_view::Exposure;

use sir_pipeline::plan::Transport;
use sir_pipeline::plan::{Action, Pipeline, Repeat, Until};
use sir_pipeline::plan::{CameraChoice, Content, Image, Output};

/// The text of a file that says the same as the pipeline, whatever its own text is.
pub(crate) fn text(pipeline: &Pipeline) -> String {
    let stages: String =
        pipeline.stages.iter().filter_map(|s| action(&s.action)).map(|s| format!("        {s},\n")).collect();
    let Pipeline { seed, units, .. } = pipeline;
    format!("Pipeline(\n    seed: {seed},\n    units: {units:?},\n    stages: [\n{stages}    ],\n)\n")
}

fn action(action: &Action) -> Option<String> {
    Some(match action {
        // The names of these choices in a file are those in the program.
        Action::Load { path, sides } => format!("Load(path: {}, sides: {sides:?})", path_text(path)),
        Action::Light { text, .. } => text.clone(),
        // The paper knows of none, and replicas cannot have it.
        Action::Focus { .. } => return None,
        Action::Subdivide(how) => match how {
            // This is what happens without the stage.
            Subdivision::PerTriangle => return None,
            Subdivision::PerFace => "Subdivide(per_face: true)".into(),
            Subdivision::MaxArea(area) => format!("Subdivide(max_area: {area:?})"),
            Subdivision::MaxEdge(edge) => format!("Subdivide(max_edge: {edge:?})"),
            Subdivision::Patches(count) => format!("Subdivide(patches: {count})"),
        },
        Action::FirstShot { lines } => format!("FirstShot(lines: {lines})"),
        Action::SecondShot { lines } => format!("SecondShot(lines: {lines})"),
        Action::Multipath { lines, transport, domain } => {
            let transport = match transport {
                Transport::Batches => "Batches".into(),
                Transport::Replicas { replicas, tail } => {
                    format!("Replicas, replicas: {replicas}, tail: {tail}")
                }
            };
            format!("Multipath(lines: {lines}, transport: {transport}, domain: {domain:?})")
        }
        Action::Repeat(Repeat { until, at_most, stages }) => {
            let until = match until {
                Until::Times(times) => format!("times: {times}"),
                Until::RelativeError(error) => format!("until: RelativeError({error:?})"),
                Until::Seconds(seconds) => format!("until: Seconds({seconds:?})"),
            };
            let at_most = at_most.map_or(String::new(), |most| format!(", at_most: {most}"));
            let stages: Vec<String> = stages.iter().filter_map(|stage| self::action(&stage.action)).collect();
            format!("Repeat({until}{at_most}, stages: [{}])", stages.join(", "))
        }
        // The experiment measures patches.
        Action::Sensors(_) => return None,
        Action::Save(outputs) => {
            let outputs: Vec<String> = outputs.iter().map(output).collect();
            format!("Save([{}])", outputs.join(", "))
        }
    })
}

fn output(output: &Output) -> String {
    let path = path_text(&output.path);
    match &output.content {
        Content::Gltf => format!("Gltf(path: {path})"),
        Content::Table => format!("Table(path: {path})"),
        Content::Image(image) => format!("Image(path: {path}, {})", image_fields(image)),
    }
}

fn image_fields(image: &Image) -> String {
    let Image { width, height, samples, exposure, denoise, camera } = image;
    let height = height.map_or(String::new(), |height| format!("height: {height}, "));
    let exposure = match exposure {
        Exposure::Auto => "Auto".into(),
        Exposure::Factor(factor) => format!("{factor:?}"),
    };
    let camera = match camera {
        CameraChoice::Default => "None".into(),
        CameraChoice::Number { number, .. } => number.to_string(),
        CameraChoice::Name { name, .. } => quoted(name),
        CameraChoice::Own(camera) => own_camera(camera),
    };
    format!(
        "width: {width}, {height}samples: {samples}, exposure: {exposure}, denoise: {denoise}, camera: {camera}"
    )
}

fn own_camera(camera: &Camera) -> String {
    let vector = |v: glam::DVec3| format!("({:?}, {:?}, {:?})", v.x, v.y, v.z);
    let (eye, target, up) = (camera.eye, camera.eye + camera.forward, camera.up);
    let fov = match camera.projection {
        Projection::Perspective { vertical_fov } => format!(", fov: {:?}", vertical_fov.to_degrees()),
        // Pipelines cannot describe such a camera.
        Projection::Orthographic { .. } => String::new(),
    };
    format!("Camera(eye: {}, target: {}, up: {}{fov})", vector(eye), vector(target), vector(up))
}

fn path_text(path: &Path) -> String {
    quoted(&path.to_string_lossy())
}

/// A text in quotes, with escapes as RON has them. Writing a text cannot fail.
fn quoted(text: &str) -> String {
    ron::to_string(text).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_pipeline::Units;

    const ALL: &str = r#"Pipeline(seed: 7, units: Photometric, stages: [
        Load(path: "room \"1\".obj", sides: Both),
        Light([Point(position: (1, 2, 3), power: 60, spread: Spot(axis: (0, -2, 0), outer: 30)), Sky(horizontal: 1)]), // lamps
        Subdivide(max_area: 1.5e-7),
        FirstShot(lines: 1e6),
        Save([Table(path: "direct.npy")]),
        Multipath(lines: 3_000, transport: Replicas, replicas: 8, tail: 30, domain: Sphere),
        Save([
            Image(path: "a/view.png", width: 320, height: 200, samples: 2, exposure: 1.6, camera: "b\\c"),
            Image(path: "two.exr", camera: 1),
            Image(path: "three.png", camera: Camera(eye: (0, 0, 4), target: (0, 0, 1), fov: 60)),
            Gltf(path: "x.glb"), Table(path: "t.csv"),
        ]),
    ])"#;

    /// What it does, without places in the text.
    fn meaning(pipeline: &Pipeline) -> (u64, Units, Vec<Action>) {
        let mut actions: Vec<Action> = pipeline.stages.iter().map(|s| s.action.clone()).collect();
        for action in &mut actions {
            let Action::Save(outputs) = action else { continue };
            for output in outputs {
                let Content::Image(image) = &mut output.content else { continue };
                if let CameraChoice::Name { span, .. } | CameraChoice::Number { span, .. } = &mut image.camera
                {
                    *span = 0..0;
                }
            }
        }
        (pipeline.seed, pipeline.units, actions)
    }

    #[test]
    fn the_text_says_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("room.ron");
        std::fs::write(folder.path().join("room \"1\".obj"), "").unwrap();
        for change in ["max_area: 1.5e-7", "max_edge: 0.25", "patches: 20_000", "per_face: true"] {
            let source = ALL.replace("max_area: 1.5e-7", change);
            let pipeline = Pipeline::parse(&source, &file).unwrap();
            let again = Pipeline::parse(&text(&pipeline), Path::new("/elsewhere/x.ron")).unwrap();
            assert_eq!(meaning(&again), meaning(&pipeline));
        }
        let short = r#"(stages: [Load(path: "room \"1\".obj"), FirstShot(lines: 1), Multipath(lines: 1)])"#;
        let pipeline = Pipeline::parse(short, &file).unwrap();
        assert_eq!(meaning(&Pipeline::parse(&text(&pipeline), &file).unwrap()), meaning(&pipeline));
    }
}
