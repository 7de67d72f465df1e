//! Fields of stages: names, types, ranges.

use super::{problems, stages};

#[test]
fn unknown_names_and_fields() {
    insta::assert_snapshot!(stages(&[
        r#"Laod(path: "room.obj"),"#,
        r#"Load(path: "room.obj", side: Front, color: 1),"#,
        r#"Firstshot(lines: 10),"#,
        r#"FirstShot(line: 10),"#,
        r#"Render,"#,
        r#"Save([Picture(path: "a.png"), Imgae(path: "b.png"), "c.png"]),"#,
    ]), @r#"
    error: unknown stage `Laod`
     --> x.ron:2:1
      |
    2 | Laod(path: "room.obj"),
      | ^^^^
      |
      = help: did you mean `Load`?

    error: unknown field `side` in `Load`
     --> x.ron:3:24
      |
    3 | Load(path: "room.obj", side: Front, color: 1),
      |                        ^^^^
      |
      = help: did you mean `sides`?

    error: unknown field `color` in `Load`
     --> x.ron:3:37
      |
    3 | Load(path: "room.obj", side: Front, color: 1),
      |                                     ^^^^^
      |
      = help: `Load` has the fields `path`, `sides`, `scale` and `up`

    error: unknown stage `Firstshot`
     --> x.ron:4:1
      |
    4 | Firstshot(lines: 10),
      | ^^^^^^^^^
      |
      = help: did you mean `FirstShot`?

    error: unknown field `line` in `FirstShot`
     --> x.ron:5:11
      |
    5 | FirstShot(line: 10),
      |           ^^^^
      |
      = help: did you mean `lines`?

    error: unknown stage `Render`
     --> x.ron:6:1
      |
    6 | Render,
      | ^^^^^^
      |
      = help: stages are `Load`, `Light`, `Subdivide`, `Focus`, `Solve`, `FirstShot`, `ShadowRays`, `SecondShot`, `Multipath`, `Repeat`, `Sensors` and `Save`

    error: unknown output `Picture`
     --> x.ron:7:7
      |
    7 | Save([Picture(path: "a.png"), Imgae(path: "b.png"), "c.png"]),
      |       ^^^^^^^
      |
      = help: outputs are `Image`, `Gltf`, `Table`, `Report` and `Lightmap`

    error: unknown output `Imgae`
     --> x.ron:7:31
      |
    7 | Save([Picture(path: "a.png"), Imgae(path: "b.png"), "c.png"]),
      |                               ^^^^^
      |
      = help: did you mean `Image`?

    error: expected one of the outputs, but this is a string
     --> x.ron:7:53
      |
    7 | Save([Picture(path: "a.png"), Imgae(path: "b.png"), "c.png"]),
      |                                                     ^^^^^^^
      |
      = help: outputs are `Image`, `Gltf`, `Table`, `Report` and `Lightmap`
    "#);
    insta::assert_snapshot!(problems("Pipelin(stages: [])"), @r"
    error: the file must contain `Pipeline(…)`, but it contains `Pipelin(…)`
     --> x.ron:1:1
      |
    1 | Pipelin(stages: [])
      | ^^^^^^^^^^^^^^^^^^^
      |
      = help: write `Pipeline(stages: […])`
    ");
    insta::assert_snapshot!(problems("[1]"), @r"
    error: the file must contain `Pipeline(…)`, but it contains a list
     --> x.ron:1:1
      |
    1 | [1]
      | ^^^
      |
      = help: write `Pipeline(stages: […])`
    ");
}

#[test]
fn missing_and_repeated_fields() {
    insta::assert_snapshot!(stages(&[
        r#"Load(sides: Both),"#,
        r#"Subdivide,"#,
        r#"FirstShot(lines: 10, lines: 20),"#,
        r#"Multipath(),"#,
        r#"Save([Image(width: 10), Gltf(), Table(path: "")]),"#,
    ]), @r#"
    error: `Load` lacks the field `path`
     --> x.ron:2:1
      |
    2 | Load(sides: Both),
      | ^^^^
      |
      = help: write `Load(path: "scene.gltf", …)`

    error: `Subdivide` needs one of the fields `patches`, `max_area`, `max_edge` and `per_face`
     --> x.ron:3:1
      |
    3 | Subdivide,
      | ^^^^^^^^^
      |
      = help: write `patches: 20_000`, `max_area: 0.01`, `max_edge: 0.1` or `per_face: true`

    error: the field `lines` is given twice
     --> x.ron:4:22
      |
    4 | FirstShot(lines: 10, lines: 20),
      |                      ^^^^^
      |
      = help: remove one of the two; the first is in line 4

    error: `Multipath` lacks the field `lines`
     --> x.ron:5:1
      |
    5 | Multipath(),
      | ^^^^^^^^^
      |
      = help: write `Multipath(lines: 1_000_000, …)`

    error: `Image` lacks the field `path`
     --> x.ron:6:7
      |
    6 | Save([Image(width: 10), Gltf(), Table(path: "")]),
      |       ^^^^^
      |
      = help: write `Image(path: "view.png", …)`

    error: `Gltf` lacks the field `path`
     --> x.ron:6:25
      |
    6 | Save([Image(width: 10), Gltf(), Table(path: "")]),
      |                         ^^^^
      |
      = help: write `Gltf(path: "result.glb", …)`

    error: `path` must be a string in quotes, but it is empty
     --> x.ron:6:45
      |
    6 | Save([Image(width: 10), Gltf(), Table(path: "")]),
      |                                             ^^
      |
      = help: write for instance `path: "patches.csv"`
    "#);
    insta::assert_snapshot!(problems("(seed: 1)"), @r#"
    error: `Pipeline` lacks the field `stages`
     --> x.ron:1:1
      |
    1 | (seed: 1)
      | ^
      |
      = help: write `Pipeline(stages: [Load(path: "scene.gltf"), …], …)`
    "#);
    insta::assert_snapshot!(problems("(seed: 1, stages: [])"), @r#"
    error: the pipeline has no stages
     --> x.ron:1:19
      |
    1 | (seed: 1, stages: [])
      |                   ^^
      |
      = help: begin with `Load(path: "scene.gltf")`
    "#);
}

#[test]
fn wrong_types() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: 3, sides: "Both"),"#,
        r#"Subdivide(per_face: 4),"#,
        r#"FirstShot(10),"#,
        r#"Multipath(lines: "many", domain: Spher, transport: Replicas(count: 1.5)),"#,
        r#"Save([Image(path: "a.png", exposure: Automatic, camera: true)]),"#,
        r#"Save(path: "b.png"),"#,
        r#"Save([Image(path: "c.png", camera: Camera(eye: 1, target: (1, 2, up), fov: "wide"))]),"#,
    ]), @r#"
    error: `path` must be a string in quotes, but it is the number 3
     --> x.ron:2:12
      |
    2 | Load(path: 3, sides: "Both"),
      |            ^
      |
      = help: write for instance `path: "scene.gltf"`

    error: `sides` must be `AsAuthored`, `Both` or `Front`, but it is a string
     --> x.ron:2:22
      |
    2 | Load(path: 3, sides: "Both"),
      |                      ^^^^^^
      |
      = help: write `AsAuthored`, `Both` or `Front`

    error: `per_face` can only be `true`, but it is the number 4
     --> x.ron:3:21
      |
    3 | Subdivide(per_face: 4),
      |                     ^
      |
      = help: write `per_face: true`, or leave it out

    error: `FirstShot` takes named fields, but this is `FirstShot(…)`
     --> x.ron:4:1
      |
    4 | FirstShot(10),
      | ^^^^^^^^^^^^^
      |
      = help: write `FirstShot(lines: …)`

    error: `lines` must be a whole number from 1 to 1_000_000_000_000_000, but it is a string
     --> x.ron:5:18
      |
    5 | Multipath(lines: "many", domain: Spher, transport: Replicas(count: 1.5)),
      |                  ^^^^^^
      |
      = help: write for instance `lines: 1_000_000`

    error: `domain` must be `Hull`, `Box` or `Sphere`, but it is `Spher`
     --> x.ron:5:34
      |
    5 | Multipath(lines: "many", domain: Spher, transport: Replicas(count: 1.5)),
      |                                  ^^^^^
      |
      = help: did you mean `Sphere`?

    error: `count` must be a whole number from 1 to 1_000_000, but it is the number 1.5
     --> x.ron:5:68
      |
    5 | Multipath(lines: "many", domain: Spher, transport: Replicas(count: 1.5)),
      |                                                                    ^^^
      |
      = help: write for instance `count: 8`

    error: `exposure` must be `Auto` or a number, but it is `Automatic`
     --> x.ron:6:38
      |
    6 | Save([Image(path: "a.png", exposure: Automatic, camera: true)]),
      |                                      ^^^^^^^^^
      |
      = help: write `exposure: Auto` or for instance `exposure: 1.5`

    error: `camera` must be a `Camera(…)`, or the number or name of one, but it is `true`
     --> x.ron:6:57
      |
    6 | Save([Image(path: "a.png", exposure: Automatic, camera: true)]),
      |                                                         ^^^^
      |
      = help: write for instance `camera: 0` or `camera: Camera(eye: (1, 2, 5), target: (1, 1, 0))`

    error: `Save` must have a list of outputs
     --> x.ron:7:1
      |
    7 | Save(path: "b.png"),
      | ^^^^^^^^^^^^^^^^^^^
      |
      = help: write `Save([Image(path: "view.png")])`

    error: `eye` must be three numbers, but it is the number 1
     --> x.ron:8:48
      |
    8 | Save([Image(path: "c.png", camera: Camera(eye: 1, target: (1, 2, up), fov: "wide"))]),
      |                                                ^
      |
      = help: write for instance `eye: (1, 2, 5)`

    error: `target` must be a finite number, but it is `up`
     --> x.ron:8:66
      |
    8 | Save([Image(path: "c.png", camera: Camera(eye: 1, target: (1, 2, up), fov: "wide"))]),
      |                                                                  ^^
      |
      = help: write for instance `target: (1, 1, 0)`

    error: `fov` must be a finite number above 0 and below 180, but it is a string
     --> x.ron:8:76
      |
    8 | Save([Image(path: "c.png", camera: Camera(eye: 1, target: (1, 2, up), fov: "wide"))]),
      |                                                                            ^^^^^^
      |
      = help: write for instance `fov: 45`
    "#);
    insta::assert_snapshot!(problems("(seed: -1, stages: Load)"), @r#"
    error: `seed` must be a whole number from 0 to 18_446_744_073_709_551_615, but it is the number -1
     --> x.ron:1:8
      |
    1 | (seed: -1, stages: Load)
      |        ^^
      |
      = help: write for instance `seed: 1`

    error: `stages` must be a list, but it is `Load`
     --> x.ron:1:20
      |
    1 | (seed: -1, stages: Load)
      |                    ^^^^
      |
      = help: write `stages: [Load(path: "scene.gltf"), …]`
    "#);
}

#[test]
fn numbers_out_of_range() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"),"#,
        r#"Subdivide(patches: 1e15),"#,
        r#"FirstShot(lines: 0),"#,
        r#"Multipath(lines: -5),"#,
        r#"Save([Image(path: "a.png", width: 0, height: 100_000, samples: 1.5, exposure: -1)]),"#,
        r#"Save([Image(path: "b.png", exposure: NaN, camera: Camera(eye: (0, 0, 0), target: (0, 0, inf), fov: 200))]),"#,
        r#"Save([Image(path: "c.png", camera: Camera(eye: (0, 0, 0), target: (0, 1, 0), up: (0, 1, 0)))]),"#,
    ]), @r#"
    error: `patches` must be a whole number from 1 to 4_294_967_295, but it is the number 1e15
     --> x.ron:3:20
      |
    3 | Subdivide(patches: 1e15),
      |                    ^^^^
      |
      = help: write for instance `patches: 20_000`

    error: `lines` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number 0
     --> x.ron:4:18
      |
    4 | FirstShot(lines: 0),
      |                  ^
      |
      = help: write for instance `lines: 1_000_000`

    error: `lines` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number -5
     --> x.ron:5:18
      |
    5 | Multipath(lines: -5),
      |                  ^^
      |
      = help: write for instance `lines: 1_000_000`

    error: `width` must be a whole number from 1 to 16_384, but it is the number 0
     --> x.ron:6:35
      |
    6 | Save([Image(path: "a.png", width: 0, height: 100_000, samples: 1.5, exposure: -1)]),
      |                                   ^
      |
      = help: write for instance `width: 800`

    error: `height` must be a whole number from 1 to 16_384, but it is the number 100_000
     --> x.ron:6:46
      |
    6 | Save([Image(path: "a.png", width: 0, height: 100_000, samples: 1.5, exposure: -1)]),
      |                                              ^^^^^^^
      |
      = help: write for instance `height: 600`

    error: `samples` must be a whole number from 1 to 64, but it is the number 1.5
     --> x.ron:6:64
      |
    6 | Save([Image(path: "a.png", width: 0, height: 100_000, samples: 1.5, exposure: -1)]),
      |                                                                ^^^
      |
      = help: write for instance `samples: 4`

    error: `exposure` must be a number above 0, but it is the number -1
     --> x.ron:6:79
      |
    6 | Save([Image(path: "a.png", width: 0, height: 100_000, samples: 1.5, exposure: -1)]),
      |                                                                               ^^
      |
      = help: write for instance `exposure: 1.5`

    error: `exposure` must be a finite number above 0, but it is the number NaN
     --> x.ron:7:38
      |
    7 | Save([Image(path: "b.png", exposure: NaN, camera: Camera(eye: (0, 0, 0), target: (0, 0, inf), fov: 200))]),
      |                                      ^^^
      |
      = help: write for instance `exposure: 1.5`

    error: `target` must be a finite number, but it is the number inf
     --> x.ron:7:89
      |
    7 | Save([Image(path: "b.png", exposure: NaN, camera: Camera(eye: (0, 0, 0), target: (0, 0, inf), fov: 200))]),
      |                                                                                         ^^^
      |
      = help: write for instance `target: (1, 1, 0)`

    error: `fov` must be a number above 0 and below 180, but it is the number 200
     --> x.ron:7:100
      |
    7 | Save([Image(path: "b.png", exposure: NaN, camera: Camera(eye: (0, 0, 0), target: (0, 0, inf), fov: 200))]),
      |                                                                                                    ^^^
      |
      = help: write for instance `fov: 45`

    error: this camera has no direction: `eye` and `target` coincide, or `up` points along the view
     --> x.ron:8:36
      |
    8 | Save([Image(path: "c.png", camera: Camera(eye: (0, 0, 0), target: (0, 1, 0), up: (0, 1, 0)))]),
      |                                    ^^^^^^
      |
      = help: move `target` away from `eye`, and choose an `up` that is not parallel to the view
    "#);
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"), Subdivide(max_area: 0), FirstShot(lines: 1e16), Multipath(lines: 9, transport: Replicas(tail: 9))"#,
    ]), @r#"
    error: `max_area` must be a number above 0, but it is the number 0
     --> x.ron:2:45
      |
    2 | Load(path: "room.obj"), Subdivide(max_area: 0), FirstShot(lines: 1e16), Multipath(lines: 9, transport: Replicas(tail: 9))
      |                                             ^
      |
      = help: write for instance `max_area: 0.01`

    error: `lines` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number 1e16
     --> x.ron:2:66
      |
    2 | Load(path: "room.obj"), Subdivide(max_area: 0), FirstShot(lines: 1e16), Multipath(lines: 9, transport: Replicas(tail: 9))
      |                                                                  ^^^^
      |
      = help: write for instance `lines: 1_000_000`

    error: all of the 9 lines are in the `tail`
     --> x.ron:2:104
      |
    2 | Load(path: "room.obj"), Subdivide(max_area: 0), FirstShot(lines: 1e16), Multipath(lines: 9, transport: Replicas(tail: 9))
      |                                                                                                        ^^^^^^^^^^^^^^^^^
      |
      = help: leave `tail` out, or make it smaller; only lines before the tail send the light of the sources
    "#);
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"), Subdivide(max_edge: NaN, patches: 10), FirstShot(lines: 10),"#,
    ]), @r#"
    error: `Subdivide` has both `patches` and `max_edge`
     --> x.ron:2:45
      |
    2 | Load(path: "room.obj"), Subdivide(max_edge: NaN, patches: 10), FirstShot(lines: 10),
      |                                             ^^^
      |
      = help: keep one of them

    error: `max_edge` must be a finite number above 0, but it is the number NaN
     --> x.ron:2:45
      |
    2 | Load(path: "room.obj"), Subdivide(max_edge: NaN, patches: 10), FirstShot(lines: 10),
      |                                             ^^^
      |
      = help: write for instance `max_edge: 0.1`
    "#);
}
