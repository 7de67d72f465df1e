//! The facts on the page of a run: figures of all stages, also of those after the `Save` of the page.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a step that fails is a test that fails")]

use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex};

use serde_json::Value;
use sir_pipeline::Watcher;
use sir_pipeline::plan::Pipeline;
use sir_pipeline::run::{RunOptions, run_pipeline};
use sir_report::View;

/// Runs stages in the furnace, whose irradiance is 2, 5 and 10 W/m², 1 W/m² of it direct. Returns the contents of a page,
/// and of `result.json`.
fn run(stages: &str) -> (Vec<String>, Value) {
    watched("", stages, None)
}

/// The same with further fields of the pipeline, and a watcher.
fn watched(fields: &str, stages: &str, watcher: Option<Arc<dyn Watcher>>) -> (Vec<String>, Value) {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/furnace/furnace.gltf");
    fs::copy(scene, folder.path().join("a \"b\".gltf")).unwrap();
    let text =
        format!("({fields}stages: [Load(path: \"a \\\"b\\\".gltf\"), Subdivide(patches: 200), {stages}])");
    fs::write(folder.path().join("x.ron"), text).unwrap();
    let pipeline = Pipeline::read(&folder.path().join("x.ron")).unwrap_or_else(|e| panic!("{e}"));
    let out = folder.path().join("out");
    let done =
        run_pipeline(&pipeline, &RunOptions { out: Some(out.clone()), watcher, ..RunOptions::default() })
            .unwrap();
    let pages = done.report.outputs.iter().filter(|output| output.kind == "report");
    let pages = pages.map(|page| {
        assert_eq!(page.bytes, None, "the size depends on times");
        fs::read_to_string(out.join(&page.path)).unwrap()
    });
    let result = serde_json::from_str(&fs::read_to_string(out.join("result.json")).unwrap()).unwrap();
    (pages.collect(), result)
}

fn facts(page: &str) -> Value {
    let text = page.split_once("id=\"facts\">").unwrap().1.split_once("</script>").unwrap().0;
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_page_has_the_figures_of_all_stages() {
    let (pages, result) = run(
        "FirstShot(lines: 20_000), Save([Report(path: \"direct/page.html\")]), Multipath(lines: 60_000), \
         Save([Report(path: \"all.html\")]), \
         Sensors(name: \"s\", at: Grid(corner: (0.2, 0.5, 0.2), along: (0, 0, 0.6), across: (0.6, 0, 0), spacing: 0.3), rays: 256)",
    );
    assert_eq!(pages.len(), 2);
    for page in &pages {
        let facts = facts(page);
        assert_eq!(facts["title"], "a \"b\".gltf");
        assert_eq!(facts["report"]["stages"].as_array().unwrap().len(), 7);
        assert_eq!(facts["report"]["stages"], result["stages"], "as in result.json");
        let [sensors] = &facts["sensors"].as_array().unwrap()[..] else { panic!("one stage of sensors") };
        assert_eq!(sensors["points"].as_array().unwrap().len(), 4);
        assert_eq!(sensors["map"]["cells"].as_array().unwrap().len(), 4);
        assert_eq!(sensors["ratings"], Value::Null, "not asked for");
        assert_eq!(facts["units"]["irradiance"], "W/m²");
        let cameras = facts["cameras"].as_array().unwrap();
        assert!(
            !cameras.is_empty() && cameras.iter().all(|camera| camera["exposure"].as_f64().unwrap() > 0.0)
        );
    }
}

/// A page has the light groups, and the rating of each eye or `null` where nothing glares: the furnace glares everywhere, but
/// not for an eye outside that looks away.
#[test]
fn a_page_has_light_groups_and_ratings() {
    let (pages, result) = watched(
        "units: Photometric, ",
        "Light([Panel(corner: (0.45, 0.98, 0.4), edges: ((0.1, 0, 0), (0, 0, 0.1)), exitance: 500, group: \"lamp\")]), \
         FirstShot(lines: 20_000), Multipath(lines: 20_000), \
         Sensors(name: \"eyes\", at: Points([(position: (0.5, 0.7, 0.9), direction: (0, 0, -1)), \
         (position: (0.5, 0.7, 5), direction: (0, 0, 1))]), rays: 256, ugr: true, require: (ugr: 10)), \
         Save([Report(path: \"page.html\")])",
        None,
    );
    let facts = facts(&pages[0]);
    let names: Vec<_> = facts["report"]["groups"].as_array().unwrap().iter().map(|g| &g["name"]).collect();
    assert_eq!(names, ["lamp", "other"]);
    assert_eq!(facts["report"]["groups"], result["groups"]);
    let sensors = &facts["sensors"][0];
    let [first, second] = &sensors["ratings"].as_array().unwrap()[..] else { panic!("two eyes") };
    let glare = &sensors["report"]["glare"];
    assert_eq!((glare["rated"].as_u64(), second), (Some(1), &Value::Null), "{sensors}");
    let largest = glare["maximum"].as_f64().unwrap();
    assert!(
        (first[0].as_f64().unwrap() - largest).abs() < 1e-3 && first[1].as_f64().unwrap() > 0.0,
        "{first}"
    );
    assert_eq!(sensors["report"]["requirements"][0]["required"], 10.0);
}

/// Watcher that ends the run after a number of updates.
#[derive(Debug)]
struct Patience {
    most: usize,
    seen: Mutex<Vec<(String, Value)>>,
    last: Mutex<Option<(bool, Value)>>,
}

impl Watcher for Patience {
    fn wants_light(&self) -> bool {
        true
    }

    fn show(&self, title: &str, _: View, facts: Value, status: &str) {
        assert_eq!(title, "a \"b\".gltf");
        self.seen.lock().unwrap().push((status.into(), facts));
    }

    fn end(&self, _: &str, view: Option<View>, facts: Value) {
        *self.last.lock().unwrap() = Some((view.is_some(), facts));
    }

    fn wants_end(&self) -> bool {
        self.seen.lock().unwrap().len() >= self.most
    }
}

#[test]
fn a_watcher_sees_each_repeat_and_can_end_the_run() {
    for (stages, is_page) in [
        (
            "Repeat(times: 20, stages: [FirstShot(lines: 5_000), Multipath(lines: 5_000)]), Save([Report(path: \"a.html\")])",
            true,
        ),
        ("Repeat(times: 20, stages: [FirstShot(lines: 5_000)]), Save([Table(path: \"a.csv\")])", false),
    ] {
        let watcher = Arc::new(Patience { most: 9, seen: Mutex::default(), last: Mutex::default() });
        let (pages, result) = watched("", stages, Some(Arc::clone(&watcher) as Arc<dyn Watcher>));
        assert_eq!(pages.len(), usize::from(is_page));
        let seen = watcher.seen.lock().unwrap();
        assert_eq!(seen.len(), 9);
        assert!(seen[0].0.starts_with("Repeat 2 of 20"), "{}", seen[0].0);
        let repeat =
            result["stages"].as_array().unwrap().iter().find(|stage| stage["name"] == "Repeat").unwrap();
        assert_eq!(repeat["repeats"], 10);
        let warnings = result["warnings"].to_string();
        assert!(warnings.contains("after 10 repeats") && !warnings.contains("at_most"), "{warnings}");
        let last = watcher.last.lock().unwrap();
        let (has_view, facts) = last.as_ref().unwrap();
        assert_eq!((*has_view, &facts["report"]["stages"]), (is_page, &result["stages"]));
    }
}

#[test]
fn a_page_of_an_earlier_stage_says_so() {
    let (pages, _) =
        run("FirstShot(lines: 20_000), Save([Report(path: \"direct.html\")]), Multipath(lines: 60_000), \
         Save([Report(path: \"all.html\")])");
    let says = pages.iter().map(|page| facts(page)["notes"].to_string().contains("after FirstShot"));
    assert_eq!(says.collect::<Vec<_>>(), [true, false]);
}

#[test]
fn pages_do_not_change_the_light() {
    let stages = "Solve(lines: 80_000)";
    let hash = |result: &Value| {
        let stages = result["stages"].as_array().unwrap();
        stages.iter().find_map(|stage| stage["tally_hash"].as_str()).unwrap().to_owned()
    };
    let (_, with) = run(&format!("{stages}, Save([Report(path: \"page.html\"), Table(path: \"a.csv\")])"));
    let (_, without) = run(&format!("{stages}, Save([Table(path: \"a.csv\")])"));
    assert_eq!(hash(&with), hash(&without));
}
