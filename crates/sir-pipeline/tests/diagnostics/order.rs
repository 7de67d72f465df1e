//! Stages in a wrong order.

use super::stages;

#[test]
fn impossible_orders() {
    insta::assert_snapshot!(stages(&[
        r#"Save([Table(path: "a.csv")]),"#,
        r#"Load(path: "room.obj"),"#,
        r#"Load(path: "room.obj"),"#,
        r#"Multipath(lines: 10),"#,
        r#"FirstShot(lines: 10),"#,
        r#"Subdivide(patches: 10),"#,
        r#"Subdivide(patches: 10),"#,
        r#"FirstShot(lines: 10),"#,
        r#"Multipath(lines: 10),"#,
    ]), @r#"
    error: `Save` before `Load`: there is no scene yet
     --> x.ron:2:1
      |
    2 | Save([Table(path: "a.csv")]),
      | ^^^^
      |
      = help: begin the stages with `Load(path: "scene.gltf")`

    error: a second `Load`; the first is in line 3
     --> x.ron:4:1
      |
    4 | Load(path: "room.obj"),
      | ^^^^
      |
      = help: a pipeline has one scene: keep one `Load`

    error: `Multipath` before `FirstShot`: there is no light to distribute yet
     --> x.ron:5:1
      |
    5 | Multipath(lines: 10),
      | ^^^^^^^^^
      |
      = help: put `FirstShot(lines: 1_000_000)` before `Multipath`

    error: `Subdivide` after `FirstShot`: light has already been computed on the existing patches
     --> x.ron:7:1
      |
    7 | Subdivide(patches: 10),
      | ^^^^^^^^^
      |
      = help: move `Subdivide` to before `FirstShot`

    error: a second `Subdivide`; the first is in line 7
     --> x.ron:8:1
      |
    8 | Subdivide(patches: 10),
      | ^^^^^^^^^
      |
      = help: keep one of the two

    error: a second `FirstShot`; the first is in line 6
     --> x.ron:9:1
      |
    9 | FirstShot(lines: 10),
      | ^^^^^^^^^
      |
      = help: keep one, with all the lines

    error: a second `Multipath`; the first is in line 5
      --> x.ron:10:1
       |
    10 | Multipath(lines: 10),
       | ^^^^^^^^^
       |
       = help: keep one, with all the lines
    "#);
    insta::assert_snapshot!(stages(&[r#"Load(path: "room.obj"),"#]), @r#"
    error: the pipeline ends without computing anything
     --> x.ron:2:1
      |
    2 | Load(path: "room.obj"),
      | ^^^^
      |
      = help: add `Solve(lines: 1_000_000)`
    "#);
}

#[test]
fn a_focus_that_cannot_be() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"),"#,
        r#"Focus(min: (0, 0, 0), max: (1, -1, 1), share: 1),"#,
        r#"FirstShot(lines: 10),"#,
        r#"Focus(min: (0, 0, 0)),"#,
        r#"Multipath(lines: 10, transport: Replicas),"#,
    ]), @r"
    error: `share` must be a number from 0 to 0.95, but it is the number 1
     --> x.ron:3:47
      |
    3 | Focus(min: (0, 0, 0), max: (1, -1, 1), share: 1),
      |                                               ^
      |
      = help: write for instance `share: 0.75`

    error: `Focus` lacks the field `max`
     --> x.ron:5:1
      |
    5 | Focus(min: (0, 0, 0)),
      | ^^^^^
      |
      = help: write `Focus(max: (5, 3, 4), …)`

    error: a second `Focus`; the first is in line 3
     --> x.ron:5:1
      |
    5 | Focus(min: (0, 0, 0)),
      | ^^^^^
      |
      = help: keep one, with a box around everything of interest

    error: the transport `Replicas` cannot be combined with a `Focus`: each line takes all unshot power of a surface, so the density of lines must be uniform
     --> x.ron:6:1
      |
    6 | Multipath(lines: 10, transport: Replicas),
      | ^^^^^^^^^
      |
      = help: write `transport: Batches`, or leave `Focus` out
    ");
}

#[test]
fn second_shots_out_of_place() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"),"#,
        r#"SecondShot(lines: 10),"#,
        r#"Multipath(lines: 10),"#,
        r#"Save([Table(path: "a.csv")]),"#,
    ]), @r"
    error: `SecondShot` before `FirstShot`: there is no light to distribute yet
     --> x.ron:3:1
      |
    3 | SecondShot(lines: 10),
      | ^^^^^^^^^^
      |
      = help: put `FirstShot(lines: 1_000_000)` before `SecondShot`
    ");
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"),"#,
        r#"FirstShot(lines: 10),"#,
        r#"Multipath(lines: 10),"#,
        r#"SecondShot(lines: 10),"#,
        r#"Save([Table(path: "a.csv")]),"#,
    ]), @r"
    error: `SecondShot` after `Multipath`: all light has been distributed
     --> x.ron:5:1
      |
    5 | SecondShot(lines: 10),
      | ^^^^^^^^^^
      |
      = help: move `SecondShot` to before `Multipath`
    ");
}

/// Returns the problems of a `Repeat` with these fields.
fn repeat(fields: &str) -> String {
    stages(&[r#"Load(path: "room.obj"),"#, &format!("Repeat({fields}),"), r#"Save([Table(path: "a.csv")]),"#])
}

#[test]
fn repeats_that_do_not_say_how_often() {
    insta::assert_snapshot!(repeat("stages: [FirstShot(lines: 9)]"), @r"
    error: `Repeat` needs one of the fields `times` and `until`
     --> x.ron:3:1
      |
    3 | Repeat(stages: [FirstShot(lines: 9)]),
      | ^^^^^^
      |
      = help: write `times: 16` or `until: RelativeError(0.01)`
    ");
    insta::assert_snapshot!(
        repeat("times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]"), @r"
    error: `times` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number 0
     --> x.ron:3:15
      |
    3 | Repeat(times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]),
      |               ^
      |
      = help: write for instance `times: 16`

    error: `Repeat` has both `times` and `until`
     --> x.ron:3:25
      |
    3 | Repeat(times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]),
      |                         ^^^^^^^^^^
      |
      = help: keep one of them

    error: `at_most` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number 0
     --> x.ron:3:46
      |
    3 | Repeat(times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]),
      |                                              ^
      |
      = help: write for instance `at_most: 100`
    ");
    insta::assert_snapshot!(repeat("until: Second(1), stages: 5"), @r"
    error: unknown target `Second`
     --> x.ron:3:15
      |
    3 | Repeat(until: Second(1), stages: 5),
      |               ^^^^^^
      |
      = help: did you mean `Seconds`?

    error: `stages` must be a list, but it is the number 5
     --> x.ron:3:34
      |
    3 | Repeat(until: Second(1), stages: 5),
      |                                  ^
      |
      = help: write `stages: [FirstShot(lines: 1_000_000), …]`
    ");
    insta::assert_snapshot!(repeat("until: RelativeError(0), stages: [FirstShot(lines: 9)]"), @r"
    error: `RelativeError` must have a number above 0, but it has the number 0
     --> x.ron:3:29
      |
    3 | Repeat(until: RelativeError(0), stages: [FirstShot(lines: 9)]),
      |                             ^
      |
      = help: write `until: RelativeError(0.01)`
    ");
    insta::assert_snapshot!(repeat("until: Seconds(1, 2), time: 5, stages: [FirstShot(lines: 9)]"), @r"
    error: `Seconds` takes one number, but this is `Seconds(…)`
     --> x.ron:3:15
      |
    3 | Repeat(until: Seconds(1, 2), time: 5, stages: [FirstShot(lines: 9)]),
      |               ^^^^^^^^^^^^^
      |
      = help: write `until: Seconds(60)`

    error: unknown field `time` in `Repeat`
     --> x.ron:3:30
      |
    3 | Repeat(until: Seconds(1, 2), time: 5, stages: [FirstShot(lines: 9)]),
      |                              ^^^^
      |
      = help: did you mean `times`?
    ");
}

#[test]
fn what_cannot_be_repeated() {
    insta::assert_snapshot!(repeat("times: 2, stages: []"), @r"
    error: `Repeat` has no stages
     --> x.ron:3:26
      |
    3 | Repeat(times: 2, stages: []),
      |                          ^^
      |
      = help: write `stages: [Solve(lines: 1_000_000)]`
    ");
    insta::assert_snapshot!(repeat("times: 2, stages: [Multipath(lines: 9), FirstShot(lines: 9)]"), @r"
    error: `Multipath` before `FirstShot`: there is no light to distribute yet
     --> x.ron:3:27
      |
    3 | Repeat(times: 2, stages: [Multipath(lines: 9), FirstShot(lines: 9)]),
      |                           ^^^^^^^^^
      |
      = help: begin the `stages` of `Repeat` with `FirstShot(lines: 1_000_000)`

    error: `FirstShot` after `Multipath`
     --> x.ron:3:48
      |
    3 | Repeat(times: 2, stages: [Multipath(lines: 9), FirstShot(lines: 9)]),
      |                                                ^^^^^^^^^
      |
      = help: the order is `FirstShot`, `ShadowRays`, `SecondShot`, `Multipath`, each of them once
    ");
    insta::assert_snapshot!(
        repeat("times: 2, stages: [FirstShot(lines: 9), FirstShot(lines: 9), Save([Table(path: \"b.csv\")])]"), @r#"
    error: `FirstShot` after `FirstShot`
     --> x.ron:3:48
      |
    3 | Repeat(times: 2, stages: [FirstShot(lines: 9), FirstShot(lines: 9), Save([Table(path: "b.csv")])]),
      |                                                ^^^^^^^^^
      |
      = help: the order is `FirstShot`, `ShadowRays`, `SecondShot`, `Multipath`, each of them once

    error: `Save` inside of `Repeat`
     --> x.ron:3:69
      |
    3 | Repeat(times: 2, stages: [FirstShot(lines: 9), FirstShot(lines: 9), Save([Table(path: "b.csv")])]),
      |                                                                     ^^^^
      |
      = help: move `Save` out of `Repeat`
    "#);
    insta::assert_snapshot!(repeat("times: 2, stages: [Repeat(times: 2, stages: [FirstShot(lines: 9)])]"), @r"
    error: `Repeat` inside of `Repeat`
     --> x.ron:3:27
      |
    3 | Repeat(times: 2, stages: [Repeat(times: 2, stages: [FirstShot(lines: 9)])]),
      |                           ^^^^^^
      |
      = help: move `Repeat` out of `Repeat`
    ");
}

#[test]
fn solve_stands_alone() {
    let load = r#"Load(path: "room.obj"),"#;
    let solve = "Solve(lines: 10),";
    insta::assert_snapshot!(stages(&[load, solve, "Multipath(lines: 10),"]), @r#"
    error: `Multipath` beside the `Solve` in line 3, which computes all light
     --> x.ron:4:1
      |
    4 | Multipath(lines: 10),
      | ^^^^^^^^^
      |
      = help: leave out `Multipath` or `Solve`
    "#);
    insta::assert_snapshot!(stages(&[load, solve, "Repeat(times: 2, stages: [FirstShot(lines: 10)]),"]), @r#"
    error: `Repeat` beside the `Solve` in line 3, which computes all light
     --> x.ron:4:1
      |
    4 | Repeat(times: 2, stages: [FirstShot(lines: 10)]),
      | ^^^^^^
      |
      = help: leave out `Repeat` or `Solve`
    "#);
    insta::assert_snapshot!(stages(&[load, solve, solve, "Subdivide(patches: 9),"]), @r#"
    error: a second `Solve`; the first is in line 3
     --> x.ron:4:1
      |
    4 | Solve(lines: 10),
      | ^^^^^
      |
      = help: keep one, with all the lines

    error: `Subdivide` after `Solve`: light has already been computed on the existing patches
     --> x.ron:5:1
      |
    5 | Subdivide(patches: 9),
      | ^^^^^^^^^
      |
      = help: move `Subdivide` to before `Solve`
    "#);
    insta::assert_snapshot!(stages(&[load, "Repeat(times: 2, stages: [Solve(lines: 10), Multipath(lines: 10)]),"]), @r#"
    error: `Multipath` after `Solve`
     --> x.ron:3:45
      |
    3 | Repeat(times: 2, stages: [Solve(lines: 10), Multipath(lines: 10)]),
      |                                             ^^^^^^^^^
      |
      = help: `Solve` computes all light: leave out the other stages, or `Solve`
    "#);
    insta::assert_snapshot!(stages(&[load, "SecondShot(lines: 10, share: 1.5),", solve]), @r#"
    error: `SecondShot` beside the `Solve` in line 4, which computes all light
     --> x.ron:3:1
      |
    3 | SecondShot(lines: 10, share: 1.5),
      | ^^^^^^^^^^
      |
      = help: leave out `SecondShot` or `Solve`

    error: `share` must be a number above 0, at most 1, but it is the number 1.5
     --> x.ron:3:30
      |
    3 | SecondShot(lines: 10, share: 1.5),
      |                              ^^^
      |
      = help: write for instance `share: 1`
    "#);
}

#[test]
fn repeats_out_of_place() {
    let repeat = "Repeat(times: 2, stages: [FirstShot(lines: 10)]),";
    let load = r#"Load(path: "room.obj"),"#;
    insta::assert_snapshot!(stages(&[repeat]), @r#"
    error: `Repeat` before `Load`: there is no scene yet
     --> x.ron:2:1
      |
    2 | Repeat(times: 2, stages: [FirstShot(lines: 10)]),
      | ^^^^^^
      |
      = help: begin the stages with `Load(path: "scene.gltf")`
    "#);
    insta::assert_snapshot!(stages(&[load, "FirstShot(lines: 10),", repeat, "Multipath(lines: 10),"]), @r"
    error: `FirstShot` outside of the `Repeat` in line 4
     --> x.ron:3:1
      |
    3 | FirstShot(lines: 10),
      | ^^^^^^^^^
      |
      = help: move `FirstShot` into the `stages` of `Repeat`

    error: `Multipath` outside of the `Repeat` in line 4
     --> x.ron:5:1
      |
    5 | Multipath(lines: 10),
      | ^^^^^^^^^
      |
      = help: move `Multipath` into the `stages` of `Repeat`
    ");
    insta::assert_snapshot!(stages(&[load, repeat, repeat, "Subdivide(patches: 9),"]), @r"
    error: a second `Repeat`; the first is in line 3
     --> x.ron:4:1
      |
    4 | Repeat(times: 2, stages: [FirstShot(lines: 10)]),
      | ^^^^^^
      |
      = help: keep one, with the repeats of both

    error: `Subdivide` after `Repeat`: light has already been computed on the existing patches
     --> x.ron:5:1
      |
    5 | Subdivide(patches: 9),
      | ^^^^^^^^^
      |
      = help: move `Subdivide` to before `Repeat`
    ");
}

#[test]
fn a_missing_load_is_the_only_problem() {
    for stages in [
        "FirstShot(lines: 9), Multipath(lines: 9), Save([Table(path: \"a.csv\")])",
        "Repeat(times: 2, stages: [FirstShot(lines: 9)]), Save([Table(path: \"a.csv\")])",
    ] {
        let shown = super::problems(&format!("(stages: [{stages}])"));
        assert!(shown.matches("error: ").count() == 1 && shown.contains("before `Load`"), "{shown}");
    }
}

#[test]
fn what_follows_a_mistake_is_checked() {
    let shown = stages(&[r#"Load(path: "room.obj"), Multipath(lines: 9), SecondShot(lines: 9),"#]);
    assert!(
        shown.contains("`Multipath` before `FirstShot`") && shown.contains("`SecondShot` after `Multipath`"),
        "{shown}"
    );
    let shown =
        stages(&[r#"Load(path: "room.obj"), Repeat(times: 2, stages: [FirstShot(lines: 9), Save([])]),"#]);
    assert!(
        shown.contains("`Save` inside of `Repeat`") && shown.contains("move `Save` out of `Repeat`"),
        "{shown}"
    );
}
