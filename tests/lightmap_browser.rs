//! Lightmaps in three.js, in a real browser: the page of `examples/three`.
//!
//! The tests need Chromium (`SIR_BROWSER` is its command), Node, and three.js (`npm ci` in `examples/three`). They are
//! ignored unless they are asked for: `tests/all.sh` does where these are there.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a step that fails is a test that fails"
)]

mod common;

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use image::RgbImage;
use serde_json::Value;
use sir::pipeline::plan::Pipeline;
use sir::pipeline::run::{RunOptions, run_pipeline};

/// Width and height of the pictures.
const SIZE: u32 = 600;

/// Width and height of the blocks whose means are compared \[pixels\]: several patches.
const BLOCK: u32 = 30;

/// Exposure of the pictures.
const EXPOSURE: f64 = 3.0;

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Folder with a lightmap and a picture of a scene.
struct Lit {
    folder: tempfile::TempDir,
}

impl Lit {
    /// Solves a scene with this number of patches and lines, and writes `lit.glb` and `view.png`.
    fn new(scene: &Value, patches: u32, lines: u32) -> Self {
        let lit = Self { folder: tempfile::tempdir().unwrap() };
        let path = lit.path("scene.gltf");
        fs::write(&path, scene.to_string()).unwrap();
        let text = format!(
            "(seed: 1, stages: [Load(path: {path:?}), Subdivide(patches: {patches}), FirstShot(lines: {lines}), \
             Multipath(lines: {lines}), Save([Lightmap(path: \"lit.glb\", size: 1024), \
             Image(path: \"view.png\", width: {SIZE}, height: {SIZE}, denoise: false, exposure: {EXPOSURE})])])"
        );
        fs::write(lit.path("x.ron"), text).unwrap();
        let pipeline = Pipeline::read(&lit.path("x.ron")).unwrap_or_else(|e| panic!("{e}"));
        run_pipeline(&pipeline, &RunOptions { out: Some(lit.path("out")), ..RunOptions::default() }).unwrap();
        lit
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn manifest(&self) -> Value {
        serde_json::from_str(&fs::read_to_string(self.path("out/lit.json")).unwrap()).unwrap()
    }

    /// Returns the picture of our own renderer.
    fn ours(&self) -> RgbImage {
        image::open(self.path("out/view.png")).unwrap().into_rgb8()
    }

    /// Returns the picture of the page, with the same exposure and tone curve. Fails if the page writes to the console.
    fn theirs(&self) -> RgbImage {
        let stops = (EXPOSURE / self.manifest()["exposure"].as_f64().unwrap()).log2();
        let server = Server::new(&self.path("out/lit.glb"));
        let path = self.path("page.png");
        let output = Command::new("node")
            .arg(repository("tests/common/screenshot.mjs"))
            .arg(format!("{}#camera=0&panel=0&tone=sir&exposure={stops}", server.address))
            .arg(&path)
            .args([SIZE.to_string(), SIZE.to_string()])
            .arg("window.sirReady || document.documentElement.dataset.error")
            .arg(common::browser())
            .args(common::BROWSER_ARGUMENTS)
            .arg(format!("--user-data-dir={}", self.path("profile").display()))
            .output()
            .expect("Node is installed");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{errors}");
        let console = String::from_utf8_lossy(&output.stdout);
        assert!(console.is_empty(), "the page wrote to the console: {console}");
        image::open(path).unwrap().into_rgb8()
    }
}

/// The server of the example.
struct Server {
    process: Child,
    /// Such as `http://127.0.0.1:8000/`.
    address: String,
}

impl Server {
    fn new(scene: &Path) -> Self {
        let mut process = Command::new("node")
            .arg(repository("examples/three/serve.mjs"))
            .arg(scene)
            .stdout(Stdio::piped())
            .spawn()
            .expect("Node is installed");
        let mut address = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut address).unwrap();
        let server = Self { process, address: address.trim().to_owned() };
        assert!(server.address.starts_with("http://127.0.0.1:"), "three.js is not installed");
        server
    }

    /// Returns the status of the answer for a path, which is sent as it is.
    fn status(&self, path: &str) -> u32 {
        let host = self.address.trim_start_matches("http://").trim_end_matches('/');
        let mut stream = TcpStream::connect(host).unwrap();
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        String::from_utf8_lossy(&answer).split(' ').nth(1).unwrap().parse().unwrap()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// Returns the means of the linear values of each block.
fn blocks(picture: &RgbImage) -> Vec<[f64; 3]> {
    let linear = |code: u8| {
        let x = f64::from(code) / 255.0;
        if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
    };
    let across = SIZE / BLOCK;
    let mut sums = vec![[0.0; 3]; (across * across) as usize];
    for (x, y, pixel) in picture.enumerate_pixels() {
        let sum = &mut sums[(y / BLOCK * across + x / BLOCK) as usize];
        (0..3).for_each(|k| sum[k] += linear(pixel.0[k]) / f64::from(BLOCK * BLOCK));
    }
    sums
}

/// Compares the pictures of a scene, which both have the tone curve of SIR.
///
/// The light is the same, but not within patches: texels keep the mean of each patch, pictures interpolate. With the noise
/// of these runs, blocks of linear values differ by 0.001 in the mean and by up to 0.013; most of all at silhouettes, where
/// the browser blends colors after the tone curve. The limits are about twice that. Pictures are 0.155 in the mean, so that
/// the limit of their difference, 0.0015, stands for one per cent of brightness. If both instances read the same rectangle,
/// blocks differ by up to 0.05.
fn compare(lit: &Lit) {
    let (ours, theirs) = (lit.ours(), lit.theirs());
    assert_eq!(theirs.dimensions(), ours.dimensions());
    let (ours, theirs) = (blocks(&ours), blocks(&theirs));
    let count = 3.0 * ours.len() as f64;
    let level = ours.iter().flatten().sum::<f64>() / count;
    let differences: Vec<f64> =
        ours.iter().flatten().zip(theirs.iter().flatten()).map(|(a, b)| b - a).collect();
    let bias = differences.iter().sum::<f64>() / count;
    let mean = differences.iter().map(|d| d.abs()).sum::<f64>() / count;
    let most = differences.iter().fold(0.0, |most: f64, d| most.max(d.abs()));
    println!("level {level:.4}, bias {bias:.5}, mean difference {mean:.5}, largest {most:.4}");
    assert!((0.1..0.5).contains(&level), "{level}");
    assert!(bias.abs() < 0.0015, "{bias}");
    assert!(mean < 0.002, "{mean}");
    assert!(most < 0.03, "{most}");
}

fn cornell_box() -> Value {
    let text = fs::read_to_string(repository("scenes/cornell-box/cornell-box.gltf")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Materials refer to the lightmap.
#[test]
#[ignore = "needs Chromium (set SIR_BROWSER to its command) and `npm ci` in examples/three"]
fn lightmaps_look_like_pictures_in_a_browser() {
    compare(&Lit::new(&cornell_box(), 20_000, 1_000_000));
}

/// Two nodes share the mesh, so each has its rectangle of the page.
#[test]
#[ignore = "needs Chromium (set SIR_BROWSER to its command) and `npm ci` in examples/three"]
fn instances_have_their_own_light_in_a_browser() {
    let mut scene = cornell_box();
    let nodes = scene["nodes"].as_array_mut().unwrap();
    let place = nodes.iter().position(|node| node["mesh"].is_u64()).unwrap();
    let copy = nodes[place].clone();
    nodes[place]["translation"] = serde_json::json!([0.6, 0.0, 0.0]);
    nodes.push(copy);
    let last = nodes.len() - 1;
    scene["scenes"][0]["nodes"].as_array_mut().unwrap().push(last.into());
    let lit = Lit::new(&scene, 40_000, 2_000_000);
    let manifest = lit.manifest();
    let objects = manifest["objects"].as_array().unwrap();
    assert!(objects.len() == 2 && objects[0]["uv_rect"] != objects[1]["uv_rect"], "{objects:?}");
    compare(&lit);
}

/// The server has the page, three.js and the scene, and nothing else.
#[test]
#[ignore = "needs Chromium (set SIR_BROWSER to its command) and `npm ci` in examples/three"]
fn nothing_but_the_page_is_served_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("lit.glb");
    fs::write(&scene, "glTF").unwrap();
    let server = Server::new(&scene);
    for path in ["/", "/viewer.js", "/node_modules/three/build/three.module.js", "/scene.glb"] {
        assert_eq!(server.status(path), 200, "{path}");
    }
    for path in [
        "/../../Cargo.toml",
        "/%2e%2e/%2e%2e/Cargo.toml",
        "/..%2f..%2fCargo.toml",
        "/node_modules/../viewer.js",
        "//etc/passwd",
        "/node_modules/",
        "/node_modules/.package-lock.json",
        "/node_modules/three",
        "/.gitignore",
        "/serve.mjs",
    ] {
        assert_eq!(server.status(path), 404, "{path}");
    }
}
