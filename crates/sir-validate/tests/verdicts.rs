//! A quick run of all cases, and the detection of wrong answers.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::num::NonZeroUsize;

use sir_validate::{Effort, Reference, Report, Settings, Verdict, Watcher, validate};

/// Watcher that stops after a number of progress reports.
struct StopAfter(u32);

impl Watcher for StopAfter {
    fn begin(&mut self, _case: &str, _title: &str) {}
    fn progress(&mut self, done: u64, total: u64) {
        assert!(done <= total);
        self.0 = self.0.saturating_sub(1);
    }
    fn should_stop(&self) -> bool {
        self.0 == 0
    }
}

fn settings(cases: &[&str], threads: usize) -> Settings {
    let cases = cases.iter().map(|&case| case.to_owned()).collect();
    let threads = NonZeroUsize::new(threads).unwrap();
    Settings { effort: Effort::Quick, seed: 1, threads, cases }
}

fn run(reference: &Reference, cases: &[&str], threads: usize) -> Report {
    validate(reference, &settings(cases, threads), &mut StopAfter(u32::MAX)).unwrap()
}

/// Returns the built-in answers with one of them changed.
fn changed(from: &str, to: &str) -> Reference {
    let texts = [
        include_str!("../data/view-factors.json"),
        include_str!("../data/radiosity-exact.json"),
        include_str!("../data/cie171.json"),
        include_str!("../data/luminaires.json"),
    ];
    assert_eq!(texts.iter().map(|text| text.matches(from).count()).sum::<usize>(), 1, "{from}");
    let texts = texts.map(|text| text.replace(from, to));
    Reference::parse([&texts[0], &texts[1], &texts[2], &texts[3]]).unwrap()
}

#[test]
fn all_cases_are_right() {
    let report = run(&Reference::built_in().unwrap(), &[], 2);
    assert!(report.passed(), "{}", report.markdown());
    let skipped: Vec<&str> =
        report.cases.iter().filter(|c| c.skipped.is_some()).map(|c| c.case.as_str()).collect();
    assert_eq!(skipped, ["RE-02"]);
    assert!(report.cases.iter().all(|case| case.skipped.is_some() == case.checks.is_empty()));
    // Answers that agree better than chance allows are as suspicious as wrong ones. The answers of a case are
    // correlated, so this checks only that the noise has about its stated size.
    let noisy: Vec<f64> = report.checks().filter(|c| c.sigma > 1e-6 * c.exact).map(|c| c.z).collect();
    let square = noisy.iter().map(|z| z * z).sum::<f64>() / noisy.len() as f64;
    assert!(noisy.len() > 500 && (0.5..1.6).contains(&square), "{square}");
}

#[test]
fn wrong_answers_are_found() {
    for (case, from, to) in [
        // The standard error is at most 0.5 %, so a mistake is found for certain if it is larger than about 4 %.
        ("VF-13", "\"F34\": 0.119405947891134", "\"F34\": 0.114"),
        ("RE-08", "\"ceiling\": 36.3491652215577", "\"ceiling\": 37.5"),
        ("CIE-5.3", "\"exact\": 32.6768980144", "\"exact\": 34.0"),
        // The answer has no noise, so even the smallest difference is found.
        ("CIE-5.2", "\"exact\": 105.186267348", "\"exact\": 105.186268"),
    ] {
        let report = run(&changed(from, to), &[case], 2);
        assert_eq!(report.count(Verdict::Wrong), 1, "{case}: {}", report.markdown());
        assert!(!report.passed() && report.markdown().contains("WRONG"));
    }
}

/// Small view factors get as many lines as they need for a verdict: squares of 1 m at a distance of 8 m. The factor is
/// from the closed form of case VF-01.
#[test]
fn small_view_factors_end_with_a_verdict() {
    let polygon = |name: &str, corners: &str| {
        format!(r#"{{"name": "{name}", "type": "polygon", "vertices": {corners}}}"#)
    };
    let surfaces = [
        polygon("1", "[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]"),
        polygon("2", "[[0, 1, 8], [1, 1, 8], [1, 0, 8], [0, 0, 8]]"),
    ]
    .join(", ");
    let (x, root) = (0.125f64, (1.0f64 + 0.125 * 0.125).sqrt());
    let exact = 2.0 / (std::f64::consts::PI * x * x)
        * (((1.0 + x * x) / (1.0 + 2.0 * x * x).sqrt()).ln() + 2.0 * x * root * (x / root).atan()
            - 2.0 * x * x.atan());
    assert!((exact - 0.0049).abs() < 1e-4, "{exact}");
    let file = |exact: f64| {
        let text = format!(
            r#"{{"cases": [{{"id": "VF-99", "title": "far squares", "geometry": {{"surfaces": [{surfaces}]}},
                "quantity": "view factor", "values": {{"F12": {exact}}}}}]}}"#
        );
        let none = r#"{"cases": []}"#;
        Reference::parse([&text, none, none, none]).unwrap()
    };
    let right = run(&file(exact), &[], 2);
    assert!(right.passed(), "{}", right.markdown());
    assert_eq!(run(&file(1.05 * exact), &[], 2).count(Verdict::Wrong), 1);
}

#[test]
fn threads_do_not_matter() {
    let reference = Reference::built_in().unwrap();
    let cases = ["VF-14", "RE-04", "RE-09", "CIE-5.4a", "CIE-5.9b"];
    let [one, three] = [1, 3].map(|threads| run(&reference, &cases, threads));
    assert_eq!(one, three);
    assert_eq!((one.cases.len(), one.json()), (cases.len(), three.json()));
}

#[test]
fn cases_are_chosen_by_their_names() {
    let reference = Reference::built_in().unwrap();
    let ids: Vec<String> = run(&reference, &["cie-5.6"], 1).cases.into_iter().map(|c| c.case).collect();
    assert_eq!(ids, ["CIE-5.6a", "CIE-5.6b"]);
    for unknown in ["XX-01", ""] {
        let error = validate(&reference, &settings(&["RE-02", unknown], 1), &mut StopAfter(9)).unwrap_err();
        assert!(error.is_usage() && error.to_string().contains("VF-01, "), "{error}");
    }
}

#[test]
fn it_can_be_stopped() {
    let error =
        validate(&Reference::built_in().unwrap(), &settings(&["VF"], 1), &mut StopAfter(1)).unwrap_err();
    assert!(error.is_interrupt(), "{error}");
}
