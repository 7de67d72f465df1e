//! Names, paths, and several mistakes at once.

use super::{parse, problems, stages};

#[test]
fn replicas_have_lines_before_their_tail() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"), FirstShot(lines: 10),"#,
        r#"Multipath(lines: 10, transport: Replicas(count: 20, tail: 1))"#,
    ]), @r"
    error: there are 20 replicas, but only 10 lines
     --> x.ron:3:33
      |
    3 | Multipath(lines: 10, transport: Replicas(count: 20, tail: 1))
      |                                 ^^^^^^^^^^^^^^^^^^^^^^^^^^^^
      |
      = help: each replica needs a line; use fewer replicas or more lines
    ");
}

#[test]
fn paths() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "Room.obj"), FirstShot(lines: 10),"#,
        r#"Save([Image(path: "a.jpg"), Table(path: "t.txt"), Gltf(path: "x.gltf")]),"#,
        r#"Save([Image(path: "/tmp/a.png"), Image(path: "../a.png"), Image(path: "b.png"), Image(path: "./B.png")]),"#,
    ]), @r#"
    error: the scene file Room.obj does not exist
     --> x.ron:2:12
      |
    2 | Load(path: "Room.obj"), FirstShot(lines: 10),
      |            ^^^^^^^^^^
      |
      = help: did you mean `room.obj`?

    error: the name of the output "a.jpg" does not end in .png or .exr
     --> x.ron:3:19
      |
    3 | Save([Image(path: "a.jpg"), Table(path: "t.txt"), Gltf(path: "x.gltf")]),
      |                   ^^^^^^^
      |
      = help: write for instance `path: "view.png"`

    error: the name of the output "t.txt" does not end in .csv or .npy
     --> x.ron:3:41
      |
    3 | Save([Image(path: "a.jpg"), Table(path: "t.txt"), Gltf(path: "x.gltf")]),
      |                                         ^^^^^^^
      |
      = help: write for instance `path: "patches.csv"`

    error: the name of the output "x.gltf" does not end in .glb
     --> x.ron:3:62
      |
    3 | Save([Image(path: "a.jpg"), Table(path: "t.txt"), Gltf(path: "x.gltf")]),
      |                                                              ^^^^^^^^
      |
      = help: write for instance `path: "result.glb"`

    error: the output path "/tmp/a.png" may lead out of the run directory
     --> x.ron:4:19
      |
    4 | Save([Image(path: "/tmp/a.png"), Image(path: "../a.png"), Image(path: "b.png"), Image(path: "./B.png")]),
      |                   ^^^^^^^^^^^^
      |
      = help: write a relative path without `..`; outputs are written into the run directory

    error: the output path "../a.png" may lead out of the run directory
     --> x.ron:4:46
      |
    4 | Save([Image(path: "/tmp/a.png"), Image(path: "../a.png"), Image(path: "b.png"), Image(path: "./B.png")]),
      |                                              ^^^^^^^^^^
      |
      = help: write a relative path without `..`; outputs are written into the run directory

    error: the output path "./B.png" is used twice
     --> x.ron:4:93
      |
    4 | Save([Image(path: "/tmp/a.png"), Image(path: "../a.png"), Image(path: "b.png"), Image(path: "./B.png")]),
      |                                                                                             ^^^^^^^^^
      |
      = help: choose another name; "b.png" is in line 4
    "#);
    insta::assert_snapshot!(stages(&[r#"Load(path: "garden/tree.glb"), FirstShot(lines: 10),"#]), @r#"
    error: the scene file garden/tree.glb does not exist
     --> x.ron:2:12
      |
    2 | Load(path: "garden/tree.glb"), FirstShot(lines: 10),
      |            ^^^^^^^^^^^^^^^^^
      |
      = help: paths are relative to the folder of the pipeline file
    "#);
    insta::assert_snapshot!(stages(&[r#"Load(path: "room.blend"), FirstShot(lines: 10),"#]), @r#"
    error: the extension of "room.blend" is not that of a scene file
     --> x.ron:2:12
      |
    2 | Load(path: "room.blend"), FirstShot(lines: 10),
      |            ^^^^^^^^^^^^
      |
      = help: use a .gltf, .glb or .obj file
    "#);
}

/// RON reads `\r` as a special character, refuses `\U`, and leaves back slashes of raw strings alone.
#[test]
fn paths_with_back_slashes_are_told_to_have_slashes() {
    for stage in [
        r#"Load(path: "models\room.obj"),"#,
        r#"Load(path: "models\\room.obj"),"#,
        r##"Load(path: r"models\room.obj"),"##,
        r#"Load(path: "C:\Users\me\room.obj"),"#,
        r#"Load(path: "C:\work\room.obj"),"#,
        r#"Load(path: "\x\room.obj"),"#,
        r#"Load(path: "room.obj"), FirstShot(lines: 10), Save([Image(path: "out\room.png")])"#,
        r#"Load(path: "room.obj"), FirstShot(lines: 10), Save([Image(path: "out\\room.png")])"#,
        r#"Load(path: "room.obj"), FirstShot(lines: 10), Save([Image(path: "out\room")])"#,
        r#"Load(path: "room.obj"), FirstShot(lines: 10), Sensors(name: "s", at: File("data\table.txt"))"#,
    ] {
        let shown = stages(&[stage]);
        assert!(shown.contains("help: write `/` in paths, also on Windows"), "{stage}: {shown}");
        assert!(!shown.contains('\r') && !shown.contains('\t'), "{stage}: {shown:?}");
    }
}

#[test]
fn the_new_form_of_a_field_is_told() {
    let shown = stages(&[
        r#"Save([Image(path: "a.png", calm: false)]),"#,
        r#"Multipath(lines: 10, replicas: 2, tail: 1),"#,
    ]);
    for told in ["is now called `denoise`", "`transport: Replicas(count: …, tail: …)` instead"] {
        assert!(shown.contains(told), "{shown}");
    }
}

#[test]
fn one_mistake_does_not_hide_others() {
    let shown = stages(&[
        r#"Load(path: "room.obj"), Light([Distant(directon: (0, -1, 0)), Point(positon: (0, 1, 0))]),"#,
        r#"FirstShot(lines: 10), Multipath(replicas: 8), Save([Image(calm: true)]),"#,
    ]);
    for told in [
        "did you mean `direction`?",
        "`Distant` lacks the field `irradiance`",
        "`Point` needs one of the fields `intensity` and `power`",
        "`Multipath` lacks the field `lines`",
        "`Image` lacks the field `path`",
    ] {
        assert!(shown.contains(told), "{told}: {shown}");
    }
    // A field is not missing if its misspelled name is there.
    assert!(
        !shown.contains("lacks the field `direction`") && !shown.contains("lacks the field `position`"),
        "{shown}"
    );
}

#[test]
fn names_stand_only_where_they_mean_something() {
    for wrong in [
        "Focus(min: Foo(0, 0, 0), max: (1, 1, 1))",
        "Light([Point(position: (1, 2, 3), power: Rgb(1, 2, 3))])",
        r#"Save([Image(path: "a.png", exposure: Auto(3))])"#,
        r#"Sensors(name: "a", at: Points([Foo(position: (1, 1, 1), direction: (0, 1, 0))]))"#,
    ] {
        let shown = stages(&[r#"Load(path: "room.obj"),"#, wrong]);
        assert!(shown.contains("x.ron:3:"), "{wrong}: {shown}");
    }
}

#[test]
fn output_names_can_be_written() {
    for (path, reason) in [
        ("result.json/b.png", "is reserved for the run itself"),
        ("Checkpoint/b.png", "is reserved for the run itself"),
        ("a\\u{0}b.png", "contains a control character"),
        ("\\u{1b}[31m.png", "contains a control character"),
        (&format!("{}.png", "x".repeat(300)), "has too long a name"),
    ] {
        let shown = stages(&[&format!(r#"Save([Image(path: "{path}")]),"#)]);
        assert!(shown.contains(reason) && !shown.contains('\u{1b}'), "{path}: {shown}");
    }
    for name in [".", "..", "a/", "a."] {
        let shown = stages(&[&format!(r#"Sensors(name: "{name}", at: Plane(height: 1, spacing: 1)),"#)]);
        assert!(shown.contains("must be the name of a file"), "{name}: {shown}");
    }
}

#[test]
fn numbers_may_begin_with_a_point_and_files_with_a_byte_order_mark() {
    let text = "\u{feff}(stages: [Load(path: \"room.obj\"), Focus(min: (0, 0, 0), max: (.5, 1, 1), share: .5), FirstShot(lines: 1)])";
    assert!(parse(text).is_ok());
    assert!(problems("\u{feff}(seed: x, stages: [])").contains("x.ron:1:9"), "columns count the mark");
}
