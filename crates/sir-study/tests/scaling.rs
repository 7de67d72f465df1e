//! Measurement of speed-ups, with synthetic reports of runs.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::num::NonZeroUsize;

use sir_pipeline::report::{
    BalanceReport, ErrorsFrom, ErrorsReport, LightReport, LinesReport, PipelineReport, Report, SceneReport,
    StageReport, Time, VERSION,
};
use sir_pipeline::{ErrorKind, NoProgress};
use sir_study::StudyError;
use sir_study::scaling::{Plan, ScalingError, Study, Workers, csv, json, markdown, measure, text, write};

/// Returns a stage with these times for tracing lines, sequential work and communication \[s\].
fn stage(name: &str, tracing: f64, sequential: f64, communication: f64) -> StageReport {
    let balance = BalanceReport {
        emitted: [3.0; 3],
        absorbed: [2.0; 3],
        blocked: [0.0; 3],
        escaped: [0.0; 3],
        unshot: [1.0; 3],
    };
    let lines = LinesReport {
        lines: 1000,
        domain: None,
        empty_share: 0.5,
        odd_lines: 0,
        crossings: 4000,
        batches: 1,
        balance,
        walks: 0,
        walked: [0.0; 3],
    };
    let errors = ErrorsReport { from: ErrorsFrom::Lines, samples: 1000 };
    let light = LightReport { relative_error: [0.1; 3], errors, tally_hash: format!("hash of {name}") };
    let time = Time {
        seconds: tracing + sequential + communication,
        lines_per_second: None,
        sequential: Some(sequential),
        communication: Some(communication),
        peak_memory: None,
    };
    StageReport { lines: Some(lines), light: Some(light), ..StageReport::of(name, time) }
}

/// Returns the report of a run that obeys Amdahl's law: 20 s of lines, shared by the workers, and 2 s of everything
/// else. Ranks add time for communication.
fn report(workers: Workers) -> Report {
    let p = workers.count() as f64;
    let talk = 0.25 * (workers.ranks.get() - 1) as f64;
    let stages = vec![
        StageReport::of("Load", Time::of(0.5)),
        stage("FirstShot", 8.0 / p, 0.5, talk),
        stage("Multipath", 12.0 / p, 0.5, talk),
        StageReport::of("Save", Time::of(0.5)),
    ];
    let scene = SceneReport {
        path: "room.obj".into(),
        triangles: 12,
        patches: 100,
        sides: 100,
        area: 24.0,
        power: [3.0; 3],
        up: [0.0, 1.0, 0.0],
        up_from: String::new(),
        luminaires: Vec::new(),
        warnings: Vec::new(),
    };
    Report {
        version: VERSION,
        program: "sir".into(),
        pipeline: PipelineReport { path: "room.ron".into(), text: "()".into(), absolute: None },
        units: sir_pipeline::Units::default(),
        seed: 1,
        scene,
        time: Time::of(stages.iter().map(|s| s.time.seconds).sum()),
        stages,
        groups: Vec::new(),
        mixed_from: None,
        warnings: Vec::new(),
        outputs: Vec::new(),
    }
}

fn plan(ranks: &[usize], threads: &[usize], repeats: usize) -> Plan {
    let numbers =
        |list: &[usize]| -> Vec<_> { list.iter().map(|&n| NonZeroUsize::new(n).unwrap()).collect() };
    Plan::new(&numbers(ranks), &numbers(threads), NonZeroUsize::new(repeats).unwrap())
}

/// Measures runs whose reports `change` modifies; it also gets the number of the run, from 0.
fn study(plan: &Plan, change: impl Fn(usize, &mut Report)) -> Result<Study, StudyError> {
    let mut count = 0;
    measure("room", 2, plan, &NoProgress, &mut |workers| {
        let mut report = report(workers);
        change(count, &mut report);
        count += 1;
        Ok(report)
    })
}

fn unchanged(_: usize, _: &mut Report) {}

#[test]
fn tables_have_a_row_for_every_combination() {
    let study = study(&plan(&[1, 2], &[1, 2], 3), unchanged).unwrap();
    insta::assert_snapshot!(text(&study), @r"
                             first shot ──────  multipath ───────  whole run ───────  sequential ─  communication ─
    workers  ranks  threads  T [s]     S     E  T [s]     S     E  T [s]     S     E     [s]     %         [s]    %
         1       1        1  8.500  1.00  1.00  12.50  1.00  1.00  22.00  1.00  1.00   1.000   4.5      0.0000  0.0
         2       1        2  4.500  1.89  0.94  6.500  1.92  0.96  12.00  1.83  0.92   1.000   8.3      0.0000  0.0
         2       2        1  4.750  1.79  0.89  6.750  1.85  0.93  12.50  1.76  0.88   1.000   8.0      0.5000  4.0
         4*      2        2  2.750  3.09  0.77  3.750  3.33  0.83  7.500  2.93  0.73   1.000  13.3      0.5000  6.7

    T: median of 3 runs. S = T(1)/T(p), E = S/p, where T(1) is that of 1 rank × 1 thread.
    Sequential and communication: seconds of the stages with lines, and their share of the whole run.
    The results of all runs (12) are the same.
    This machine has 2 cores.
    * more workers than cores: E is limited by the cores, unless other machines took part.
    ");
    insta::assert_snapshot!(markdown(&study), @r"
    | workers | ranks | threads | first shot T [s] | first shot S | first shot E | multipath T [s] | multipath S | multipath E | whole run T [s] | whole run S | whole run E | sequential [s] | sequential % | communication [s] | communication % |
    |---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|
    | 1 | 1 | 1 | 8.500 | 1.00 | 1.00 | 12.50 | 1.00 | 1.00 | 22.00 | 1.00 | 1.00 | 1.000 | 4.5 | 0.0000 | 0.0 |
    | 2 | 1 | 2 | 4.500 | 1.89 | 0.94 | 6.500 | 1.92 | 0.96 | 12.00 | 1.83 | 0.92 | 1.000 | 8.3 | 0.0000 | 0.0 |
    | 2 | 2 | 1 | 4.750 | 1.79 | 0.89 | 6.750 | 1.85 | 0.93 | 12.50 | 1.76 | 0.88 | 1.000 | 8.0 | 0.5000 | 4.0 |
    | 4\* | 2 | 2 | 2.750 | 3.09 | 0.77 | 3.750 | 3.33 | 0.83 | 7.500 | 2.93 | 0.73 | 1.000 | 13.3 | 0.5000 | 6.7 |

    T: median of 3 runs. S = T(1)/T(p), E = S/p, where T(1) is that of 1 rank × 1 thread.

    Sequential and communication: seconds of the stages with lines, and their share of the whole run.

    The results of all runs (12) are the same.

    This machine has 2 cores.

    \* more workers than cores: E is limited by the cores, unless other machines took part.
    ");
}

#[test]
fn without_multipath_there_are_no_columns_for_it() {
    let shorter = |_: usize, report: &mut Report| {
        report.stages.remove(2);
    };
    let study = study(&plan(&[1], &[4], 1), shorter).unwrap();
    insta::assert_snapshot!(text(&study), @r"
                             first shot ──────  whole run ───────  sequential ─  communication ─
    workers  ranks  threads  T [s]     S     E  T [s]     S     E      [s]    %         [s]    %
         1       1        1  8.500  1.00  1.00  22.00  1.00  1.00   0.5000  2.3      0.0000  0.0
         4*      1        4  2.500  3.40  0.85  7.000  3.14  0.79   0.5000  7.1      0.0000  0.0

    T: time of one run. S = T(1)/T(p), E = S/p, where T(1) is that of 1 rank × 1 thread, which was added for this.
    Sequential and communication: seconds of the stages with lines, and their share of the whole run.
    The results of all runs (2) are the same.
    This machine has 2 cores.
    * more workers than cores: E is limited by the cores, unless other machines took part.
    ");
    assert!(csv(&study).lines().nth(1).unwrap().contains(",,,,,,"));
    assert!(!json(&study).contains("multipath"));
}

#[test]
fn runs_are_interleaved_and_medians_count() {
    let plan = plan(&[1], &[2], 3);
    let mut seen = Vec::new();
    // The machine becomes slower with every run.
    let study = measure("room", 2, &plan, &NoProgress, &mut |workers| {
        let mut report = report(workers);
        report.time.seconds = (seen.len() + 1) as f64;
        seen.push(workers.count());
        Ok(report)
    })
    .unwrap();
    assert_eq!(seen, [1, 2, 1, 2, 1, 2]);
    assert!(study.baseline_added);
    let [one, two] = [0, 1].map(|row| study.rows[row].whole);
    assert_eq!((one.seconds.min, one.seconds.median, one.seconds.max), (1.0, 3.0, 5.0));
    assert_eq!((two.speed_up, two.efficiency), (3.0 / 4.0, 3.0 / 8.0));
}

#[test]
fn results_that_differ_are_an_error() {
    let last_differs = |change: fn(&mut Report)| {
        let changed = move |count: usize, report: &mut Report| {
            if count == 3 {
                change(report);
            }
        };
        study(&plan(&[1, 2], &[1], 2), changed).unwrap_err()
    };
    let error = last_differs(|report| report.stages[2].light.as_mut().unwrap().tally_hash = "other".into());
    assert_eq!(error.kind(), ErrorKind::Failed);
    assert_eq!(
        sir_pipeline::chain(&error),
        "2 ranks × 1 thread (repeat 2) gave a different result from 1 rank × 1 thread (repeat 1): `Multipath` has \
         tally_hash other instead of hash of Multipath; results must not depend on the workers: this is a bug \
         of SIR, please report it with the pipeline"
    );
    let error = last_differs(|report| report.stages[1].lines.as_mut().unwrap().balance.unshot[0] = 0.5);
    assert!(
        sir_pipeline::chain(&error).contains("`FirstShot` has balance"),
        "{}",
        sir_pipeline::chain(&error)
    );
    let error = last_differs(|report| report.stages[1].lines.as_mut().unwrap().crossings = 1);
    assert!(sir_pipeline::chain(&error).contains("different counts"), "{}", sir_pipeline::chain(&error));
    let error = last_differs(|report| report.stages[1].lines = None);
    assert!(matches!(error, StudyError::Scaling(ScalingError::DifferentResults { .. })));
    let error = last_differs(|report| report.pipeline.text = "edited".into());
    assert!(matches!(error, StudyError::Scaling(ScalingError::Changed)));
}

#[test]
fn a_run_that_fails_ends_the_measurement() {
    let plan = plan(&[1], &[1, 2], 3);
    let mut runs = 0;
    let failed = measure("room", 2, &plan, &NoProgress, &mut |workers| {
        runs += 1;
        let (status, stderr) = ("exit status: 2".into(), "no".into());
        let failure = ScalingError::Run { workers, status, kind: ErrorKind::Usage, stderr };
        if runs == 2 { Err(failure.into()) } else { Ok(report(workers)) }
    });
    assert_eq!((failed.unwrap_err().kind(), runs), (ErrorKind::Usage, 2));
}

#[test]
fn four_files_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let study = study(&plan(&[1, 2], &[1, 2], 1), unchanged).unwrap();
    write(&study, folder.path()).unwrap();
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4);
    assert_eq!(read("scaling.md"), markdown(&study));

    let numbers: serde_json::Value = serde_json::from_str(&read("scaling.json")).unwrap();
    let row = &numbers["rows"][3];
    assert_eq!((&row["p"], &row["ranks"], &row["threads"]), (&4.into(), &2.into(), &2.into()));
    assert_eq!(row["more_than_cores"], true);
    assert_eq!(row["first_shot"]["seconds"]["median"], 2.75);

    let csv = read("scaling.csv");
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 5);
    assert!(lines.iter().all(|line| line.len() == lines[0].len()));
    let column = lines[0].iter().position(|&name| name == "whole_speed_up").unwrap();
    assert_eq!(lines[4][column].parse::<f64>().unwrap(), study.rows[3].whole.speed_up);

    let svg = read("scaling.svg");
    for part in
        ["speed-up S(p)", "efficiency E(p)", "first shot", "ranks of 2 threads", "2 cores", "room, one run"]
    {
        assert!(svg.contains(part), "{part}");
    }
}
