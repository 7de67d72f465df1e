//! The page of a run in a real browser.
//!
//! The tests need Chromium: `SIR_BROWSER` is its command. They are ignored unless they are asked for: `tests/all.sh` does
//! where there is a browser.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a step that fails is a test that fails"
)]

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use image::RgbImage;
use sir::geom::luminance;
use sir::pipeline::plan::Pipeline;
use sir::pipeline::run::{RunOptions, run_pipeline};
use sir::view::Table;

/// Size of the pictures.
const SIZE: (u32, u32) = (800, 600);

/// A page of the Cornell box, in a folder of its own.
struct Page {
    folder: tempfile::TempDir,
    /// Factor from radiance to screen values.
    exposure: f64,
}

impl Page {
    /// Returns a folder without a page.
    fn none() -> Self {
        Self { folder: tempfile::tempdir().unwrap(), exposure: 1.0 }
    }

    fn new() -> Self {
        let mut page = Self::none();
        page.run("page", "Report(path: \"report.html\"), Table(path: \"patches.csv\")");
        let text = fs::read_to_string(page.path("page/report.html")).unwrap();
        let facts = text.split_once("id=\"facts\">").unwrap().1.split_once("</script>").unwrap().0;
        let facts: serde_json::Value = serde_json::from_str(facts).unwrap();
        page.exposure = facts["cameras"][0]["exposure"].as_f64().unwrap();
        page
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs a pipeline with these outputs. The light is always the same.
    fn run(&self, name: &str, outputs: &str) {
        let stages = format!(
            "FirstShot(lines: 400_000), Multipath(lines: 400_000), \
             Sensors(name: \"floor\", at: Plane(height: 0.1, spacing: 0.1), rays: 256), Save([{outputs}])"
        );
        self.run_stages(name, "", &stages);
    }

    /// Runs stages in the Cornell box, with further fields of the pipeline.
    fn run_stages(&self, name: &str, fields: &str, stages: &str) {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box/cornell-box.gltf");
        let text = format!(
            "(seed: 1, {fields}stages: [Load(path: {scene:?}), Subdivide(patches: 3_000), {stages}])"
        );
        fs::write(self.path("x.ron"), text).unwrap();
        let pipeline = Pipeline::read(&self.path("x.ron")).unwrap_or_else(|e| panic!("{e}"));
        run_pipeline(&pipeline, &RunOptions { out: Some(self.path(name)), ..RunOptions::default() }).unwrap();
    }

    /// Opens the page with a state of its view, and returns what the browser printed. Fails if the page reports an error.
    fn open(&self, state: &str, arguments: &[String]) -> String {
        let mut command = Command::new(common::browser());
        command.args(common::BROWSER_ARGUMENTS).arg("--virtual-time-budget=30000");
        command.args(["--enable-logging=stderr", &format!("--window-size={},{}", SIZE.0, SIZE.1)]);
        command.arg(format!("--user-data-dir={}", self.path("profile").display())).args(arguments);
        let output = command
            .arg(format!("file://{}#{state}", self.path("page/report.html").display()))
            .output()
            .unwrap();
        let log = String::from_utf8_lossy(&output.stderr);
        let lines: Vec<&str> = log.lines().filter(|line| line.contains("CONSOLE")).collect();
        assert!(lines.is_empty(), "the page wrote to the console: {lines:#?}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    fn picture(&self, state: &str) -> RgbImage {
        let path = self.path("page.png");
        self.open(state, &[format!("--screenshot={}", path.display())]);
        image::open(path).unwrap().into_rgb8()
    }

    /// Returns the document of the page after its script has run.
    fn document(&self, state: &str) -> String {
        let document = self.open(state, &["--dump-dom".into()]);
        assert!(document.contains("data-ready=\"1\""), "the page is not ready");
        assert!(!document.contains("data-error"), "the page reports an error");
        document
    }
}

/// Returns the texts between `start` and `end`, without elements.
fn texts(document: &str, start: &str, end: &str) -> Vec<String> {
    let mut texts = Vec::new();
    let mut rest = document;
    while let Some((_, after)) = rest.split_once(start) {
        let (inside, after) = after.split_once(end).unwrap();
        let (_, inside) = inside.split_once('>').unwrap();
        let plain: String = inside.split('<').map(|part| part.rsplit('>').next().unwrap()).collect();
        texts.push(plain.trim().replace(['\u{2009}', '\u{202f}'], "").replace('\u{a0}', " "));
        rest = after;
    }
    texts
}

/// The page and our own renderer show the same picture, without silhouettes, where they sample pixels differently.
#[test]
#[ignore = "needs Chromium: set SIR_BROWSER to its command"]
fn pages_look_like_pictures_in_a_browser() {
    let page = Page::new();
    let image = format!(
        "Image(path: \"view.png\", width: {}, height: {}, samples: 4, denoise: false, exposure: {})",
        SIZE.0, SIZE.1, page.exposure
    );
    page.run("picture", &image);
    let ours = image::open(page.path("picture/view.png")).unwrap().into_rgb8();
    let theirs = page.picture("camera=1&full=1");
    assert_eq!(theirs.dimensions(), ours.dimensions());
    let is_edge = |x: u32, y: u32| {
        let at = ours.get_pixel(x, y).0;
        let around = [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)].map(|(x, y)| ours.get_pixel(x, y).0);
        around.iter().any(|other| (0..3).any(|k| other[k].abs_diff(at[k]) > 8))
    };
    let (mut sum, mut count, mut bright) = (0.0, 0.0, 0);
    for y in 1..SIZE.1 - 1 {
        for x in (1..SIZE.0 - 1).filter(|&x| !is_edge(x, y)) {
            let [a, b] = [&ours, &theirs].map(|picture| picture.get_pixel(x, y).0);
            sum += (0..3).map(|k| f64::from(a[k].abs_diff(b[k]))).sum::<f64>() / (3.0 * 255.0);
            count += 1.0;
            bright += u32::from(b[1] > 40);
        }
    }
    println!("mean difference {:.4} of white over {count} pixels", sum / count);
    assert!(
        count > 0.8 * f64::from(SIZE.0 * SIZE.1) && f64::from(bright) > 0.2 * count,
        "flat: {count} {bright}"
    );
    assert!(sum / count < 0.02, "{}", sum / count);
}

/// A value that is read in the view is that of the table.
#[test]
#[ignore = "needs Chromium: set SIR_BROWSER to its command"]
fn values_are_those_of_the_table_in_a_browser() {
    let page = Page::new();
    let table = Table::read(&page.path("page/patches.csv")).unwrap();
    let document = page.document("camera=1&full=1&pick=0.5,0.9;0.3,0.5;0.6,0.4");
    let (_, picks) = document.split_once("id=\"picks-table\"").unwrap();
    let (picks, _) = picks.split_once("</table>").unwrap();
    let head = texts(picks, "<th", "</th>");
    let rows = picks.split("<tr").skip(2);
    let mut checked = 0;
    for row in rows {
        // The first cell of a row is its header.
        let cells = texts(&row.replace("<th", "<td").replace("</th>", "</td>"), "<td", "</td>");
        let cell = |name: &str| {
            let place = head
                .iter()
                .position(|head| head.starts_with(name))
                .unwrap_or_else(|| panic!("{name}: {head:?}"));
            cells[place].clone()
        };
        let number: u32 = cell("Patch").parse().unwrap();
        let patch = table.rows.iter().find(|row| row.number == number).unwrap();
        // Half of the last of three digits, or of two, and the rounding of the page.
        for (name, exact, digits) in [
            ("E (", luminance(patch.irradiance), 5.3e-3),
            ("± ", luminance(patch.irradiance_error), 5.3e-2),
            ("B (", luminance(patch.radiosity), 5.3e-3),
            ("E red", patch.irradiance.x, 5.3e-3),
            ("E blue", patch.irradiance.z, 5.3e-3),
        ] {
            let shown: f64 = cell(name).parse().unwrap_or_else(|_| panic!("{name}: {}", cell(name)));
            assert!((shown / exact - 1.0).abs() < digits, "{name}: {shown}, {exact}");
        }
        checked += 1;
    }
    assert_eq!(checked, 3);
}

/// Every mode is drawn without an error on the console.
#[test]
#[ignore = "needs Chromium: set SIR_BROWSER to its command"]
fn all_modes_are_drawn_in_a_browser() {
    let page = Page::new();
    let lit = page.picture("camera=1&full=1");
    for mode in ["irradiance", "radiosity", "direct", "reflected", "error"] {
        let picture = page.picture(&format!("camera=1&full=1&mode={mode}&scale=log&mesh=1&flat=1"));
        let differs = picture.pixels().zip(lit.pixels()).filter(|(a, b)| a != b).count();
        assert!(differs > 50_000, "{mode}: {differs}");
    }
}

/// Light groups have a table with their flux and its share, and eyes their rating, with a mark where it is above the limit.
#[test]
#[ignore = "needs Chromium: set SIR_BROWSER to its command"]
fn groups_and_ratings_are_tables_in_a_browser() {
    let page = Page::none();
    let eye = |x: f64| format!("(position: (0.27, 0.2, 0.5), direction: ({x}, 0, -1))");
    let stages = format!(
        "Light([Panel(corner: (0.1, 0.5, 0.1), edges: ((0.05, 0, 0), (0, 0, 0.05)), power: (20, 40, 60), group: \"panel <b>\")]), \
         FirstShot(lines: 100_000), Multipath(lines: 100_000), \
         Sensors(name: \"eyes\", at: Points([{}, {}]), rays: 256, ugr: true, require: (ugr: 10)), \
         Save([Report(path: \"report.html\")])",
        eye(0.0),
        eye(-0.5)
    );
    page.run_stages("page", "units: Photometric, ", &stages);
    let document = page.document("camera=1");
    let table = |section: &str, number: usize| {
        let (_, rest) = document.split_once(&format!("<section id=\"{section}\"")).unwrap();
        let (section, _) = rest.split_once("</section>").unwrap();
        let table = section.split("<table").nth(number).unwrap().to_owned();
        table
            .split("<tr")
            .skip(1)
            .map(|row| texts(&row.replace("<th", "<td").replace("</th>", "</td>"), "<td", "</td>"))
            .collect::<Vec<_>>()
    };
    let groups = table("groups", 1);
    assert_eq!(groups[0][..7], ["Group", "Factor", "Flux (lm)", "Red", "Green", "Blue", "Share"]);
    let flux = luminance(sir::geom::Rgb::new(20.0, 40.0, 60.0));
    assert_eq!(groups[1][..2], ["panel &lt;b&gt;", "1"]);
    assert!((groups[1][2].parse::<f64>().unwrap() / flux - 1.0).abs() < 1e-3, "{groups:?}");
    assert_eq!(
        (groups[2][0].as_str(), groups[3][0].as_str(), groups[3][6].as_str()),
        ("other", "All", "100.0 %")
    );
    let eyes = table("sensors", 2);
    assert_eq!(eyes[0][7..], ["UGR (at most 10)", "± σ of UGR"]);
    assert!(eyes[1..].iter().all(|eye| eye[7].parse::<f64>().unwrap() > 10.0), "{eyes:?}");
    assert_eq!(document.matches("<td class=\"doubtful\">").count(), 2);
}

#[test]
#[ignore = "needs Chromium: set SIR_BROWSER to its command"]
fn a_page_prints_in_a_browser() {
    let page = Page::new();
    let path = page.path("page.pdf");
    page.open("camera=1", &[format!("--print-to-pdf={}", path.display())]);
    let pdf = fs::read(path).unwrap();
    let text = String::from_utf8_lossy(&pdf);
    let pages = text.matches("/Type /Page").count() - text.matches("/Type /Pages").count();
    assert!((2..=12).contains(&pages), "{pages} pages");
}
