//! Stages that cannot stand where they stand.

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
    x.ron:2:1: error: `Save` before `Load`: there is no scene yet
    2 | Save([Table(path: "a.csv")]),
      | ^^^^
      = help: begin the stages with `Load(path: "scene.gltf")`

    x.ron:4:1: error: a second `Load`; the first is in line 3
    4 | Load(path: "room.obj"),
      | ^^^^
      = help: a pipeline has one scene: keep one `Load`

    x.ron:5:1: error: `Multipath` before `FirstShot`: there is no light to distribute yet
    5 | Multipath(lines: 10),
      | ^^^^^^^^^
      = help: put `FirstShot(lines: 1_000_000)` before `Multipath`

    x.ron:7:1: error: `Subdivide` after `FirstShot`: light has been computed on the patches as they were
    7 | Subdivide(patches: 10),
      | ^^^^^^^^^
      = help: move `Subdivide` to before `FirstShot`

    x.ron:8:1: error: a second `Subdivide`; the first is in line 7
    8 | Subdivide(patches: 10),
      | ^^^^^^^^^
      = help: keep one of the two

    x.ron:9:1: error: a second `FirstShot`; the first is in line 6
    9 | FirstShot(lines: 10),
      | ^^^^^^^^^
      = help: keep one, with all the lines

    x.ron:10:1: error: a second `Multipath`; the first is in line 5
    10 | Multipath(lines: 10),
       | ^^^^^^^^^
       = help: keep one, with all the lines
    "#);
    insta::assert_snapshot!(stages(&[r#"Load(path: "room.obj"),"#]), @r#"
    x.ron:2:1: error: the pipeline ends without computing anything
    2 | Load(path: "room.obj"),
      | ^^^^
      = help: add `FirstShot(lines: 1_000_000)` and `Multipath(lines: 1_000_000)`
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
    x.ron:3:47: error: `share` must be a number from 0 to 0.95, but it is the number 1
    3 | Focus(min: (0, 0, 0), max: (1, -1, 1), share: 1),
      |                                               ^
      = help: write for instance `share: 0.75`

    x.ron:5:1: error: `Focus` lacks the field `max`
    5 | Focus(min: (0, 0, 0)),
      | ^^^^^
      = help: write `Focus(max: (5, 3, 4), …)`

    x.ron:5:1: error: a second `Focus`; the first is in line 3
    5 | Focus(min: (0, 0, 0)),
      | ^^^^^
      = help: keep one, with a box around all that matters

    x.ron:6:1: error: the transport `Replicas` cannot have a `Focus`: each line takes along all that a surface holds, so lines must be the same everywhere
    6 | Multipath(lines: 10, transport: Replicas),
      | ^^^^^^^^^
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
    ]), @"
    x.ron:3:1: error: `SecondShot` before `FirstShot`: there is no light to distribute yet
    3 | SecondShot(lines: 10),
      | ^^^^^^^^^^
      = help: put `FirstShot(lines: 1_000_000)` before `SecondShot`
    ");
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"),"#,
        r#"FirstShot(lines: 10),"#,
        r#"Multipath(lines: 10),"#,
        r#"SecondShot(lines: 10),"#,
        r#"Save([Table(path: "a.csv")]),"#,
    ]), @"
    x.ron:5:1: error: `SecondShot` after `Multipath`: all light has been distributed
    5 | SecondShot(lines: 10),
      | ^^^^^^^^^^
      = help: move `SecondShot` to before `Multipath`
    ");
}

/// A `Repeat` with these fields.
fn repeat(fields: &str) -> String {
    stages(&[r#"Load(path: "room.obj"),"#, &format!("Repeat({fields}),"), r#"Save([Table(path: "a.csv")]),"#])
}

#[test]
fn repeats_that_do_not_say_how_often() {
    insta::assert_snapshot!(repeat("stages: [FirstShot(lines: 9)]"), @r"
    x.ron:3:1: error: `Repeat` needs one of the fields `times` and `until`
    3 | Repeat(stages: [FirstShot(lines: 9)]),
      | ^^^^^^
      = help: write `times: 16` or `until: RelativeError(0.01)`
    ");
    insta::assert_snapshot!(
        repeat("times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]"), @r"
    x.ron:3:1: error: `Repeat` has both `times` and `until`
    3 | Repeat(times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]),
      | ^^^^^^
      = help: keep one of them

    x.ron:3:15: error: `times` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number 0
    3 | Repeat(times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]),
      |               ^
      = help: write for instance `times: 16`

    x.ron:3:46: error: `at_most` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number 0
    3 | Repeat(times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]),
      |                                              ^
      = help: write for instance `at_most: 100`
    ");
    insta::assert_snapshot!(repeat("until: Second(1), stages: 5"), @r"
    x.ron:3:15: error: unknown target `Second`
    3 | Repeat(until: Second(1), stages: 5),
      |               ^^^^^^
      = help: did you mean `Seconds`?

    x.ron:3:34: error: `stages` must be a list, but it is the number 5
    3 | Repeat(until: Second(1), stages: 5),
      |                                  ^
      = help: write `stages: [FirstShot(lines: 1_000_000), …]`
    ");
    insta::assert_snapshot!(repeat("until: RelativeError(0), stages: [FirstShot(lines: 9)]"), @r"
    x.ron:3:29: error: `RelativeError` must have a number above 0, but it has the number 0
    3 | Repeat(until: RelativeError(0), stages: [FirstShot(lines: 9)]),
      |                             ^
      = help: write `until: RelativeError(0.01)`
    ");
    insta::assert_snapshot!(repeat("until: Seconds(1, 2), time: 5, stages: [FirstShot(lines: 9)]"), @"
    x.ron:3:15: error: `Seconds` takes one number, but this is `Seconds(…)`
    3 | Repeat(until: Seconds(1, 2), time: 5, stages: [FirstShot(lines: 9)]),
      |               ^^^^^^^^^^^^^
      = help: write `until: Seconds(60)`

    x.ron:3:30: error: unknown field `time` in `Repeat`
    3 | Repeat(until: Seconds(1, 2), time: 5, stages: [FirstShot(lines: 9)]),
      |                              ^^^^
      = help: did you mean `times`?
    ");
}

#[test]
fn what_cannot_be_repeated() {
    insta::assert_snapshot!(repeat("times: 2, stages: []"), @"
    x.ron:3:26: error: `Repeat` has no stages
    3 | Repeat(times: 2, stages: []),
      |                          ^^
      = help: begin the `stages` of `Repeat` with `FirstShot(lines: 1_000_000)`
    ");
    insta::assert_snapshot!(repeat("times: 2, stages: [Multipath(lines: 9), FirstShot(lines: 9)]"), @"
    x.ron:3:27: error: `Multipath` before `FirstShot`: there is no light to distribute yet
    3 | Repeat(times: 2, stages: [Multipath(lines: 9), FirstShot(lines: 9)]),
      |                           ^^^^^^^^^
      = help: begin the `stages` of `Repeat` with `FirstShot(lines: 1_000_000)`

    x.ron:3:48: error: `FirstShot` after `Multipath`
    3 | Repeat(times: 2, stages: [Multipath(lines: 9), FirstShot(lines: 9)]),
      |                                                ^^^^^^^^^
      = help: the order is `FirstShot`, `SecondShot`, `Multipath`, each of them once
    ");
    insta::assert_snapshot!(
        repeat("times: 2, stages: [FirstShot(lines: 9), FirstShot(lines: 9), Save([Table(path: \"b.csv\")])]"), @r#"
    x.ron:3:69: error: unknown repeated stage `Save`
    3 | Repeat(times: 2, stages: [FirstShot(lines: 9), FirstShot(lines: 9), Save([Table(path: "b.csv")])]),
      |                                                                     ^^^^
      = help: repeated stages are `FirstShot`, `SecondShot` and `Multipath`
    "#);
    insta::assert_snapshot!(repeat("times: 2, stages: [Repeat(times: 2, stages: [FirstShot(lines: 9)])]"), @"
    x.ron:3:27: error: unknown repeated stage `Repeat`
    3 | Repeat(times: 2, stages: [Repeat(times: 2, stages: [FirstShot(lines: 9)])]),
      |                           ^^^^^^
      = help: repeated stages are `FirstShot`, `SecondShot` and `Multipath`
    ");
}

#[test]
fn repeats_out_of_place() {
    let repeat = "Repeat(times: 2, stages: [FirstShot(lines: 10)]),";
    let load = r#"Load(path: "room.obj"),"#;
    insta::assert_snapshot!(stages(&[repeat]), @r#"
    x.ron:2:1: error: `Repeat` before `Load`: there is no scene yet
    2 | Repeat(times: 2, stages: [FirstShot(lines: 10)]),
      | ^^^^^^
      = help: begin the stages with `Load(path: "scene.gltf")`

    x.ron:2:1: error: the pipeline ends without computing anything
    2 | Repeat(times: 2, stages: [FirstShot(lines: 10)]),
      | ^^^^^^
      = help: add `FirstShot(lines: 1_000_000)` and `Multipath(lines: 1_000_000)`
    "#);
    insta::assert_snapshot!(stages(&[load, "FirstShot(lines: 10),", repeat, "Multipath(lines: 10),"]), @"
    x.ron:3:1: error: `FirstShot` beside the `Repeat` in line 4
    3 | FirstShot(lines: 10),
      | ^^^^^^^^^
      = help: move `FirstShot` into the `stages` of `Repeat`

    x.ron:5:1: error: `Multipath` beside the `Repeat` in line 4
    5 | Multipath(lines: 10),
      | ^^^^^^^^^
      = help: move `Multipath` into the `stages` of `Repeat`
    ");
    insta::assert_snapshot!(stages(&[load, repeat, repeat, "Subdivide(patches: 9),"]), @"
    x.ron:4:1: error: a second `Repeat`; the first is in line 3
    4 | Repeat(times: 2, stages: [FirstShot(lines: 10)]),
      | ^^^^^^
      = help: keep one, with as many repeats as both together

    x.ron:5:1: error: `Subdivide` after `Repeat`: light has been computed on the patches as they were
    5 | Subdivide(patches: 9),
      | ^^^^^^^^^
      = help: move `Subdivide` to before `Repeat`
    ");
}
