//! Texts with syntax errors.

use std::path::Path;

use proptest::prelude::*;
use sir_pipeline::plan::Pipeline;

use super::{VALID, problems};

#[test]
fn syntax() {
    insta::assert_snapshot!(problems("Pipeline(\n    seed: 1\n    stages: [],\n)"), @r"
    error: not valid RON: expected comma
     --> x.ron:3:5
      |
    3 |     stages: [],
      |     ^
      |
      = help: put a comma between two values, and close every `(` with `)` and every `[` with `]`
    ");
    insta::assert_snapshot!(problems("Pipeline(\n    stages: [\n        Load(path: \"room.obj),\n    ],\n)"), @r#"
    error: not valid RON: expected end of string
     --> x.ron:3:20
      |
    3 |         Load(path: "room.obj),
      |                    ^
      |
      = help: end the string with `"`
    "#);
    insta::assert_snapshot!(problems("Pipeline(stages: [Load(path: \"room.obj\")]"), @r#"
    error: not valid RON: expected comma
     --> x.ron:1:42
      |
    1 | Pipeline(stages: [Load(path: "room.obj")]
      |                                          ^
      |
      = help: put a comma between two values, and close every `(` with `)` and every `[` with `]`
    "#);
    insta::assert_snapshot!(problems(""), @r#"
    error: not valid RON: unexpected end of RON
     --> x.ron:1:1
      |
    1 |
      | ^
      |
      = help: the file ends within a value; close every `(`, `[` and `"`
    "#);
}

/// Generates valid pipelines with a few pieces removed or replaced by others.
fn mutated() -> impl Strategy<Value = String> {
    let pieces = prop::sample::select(vec![
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        ",",
        ":",
        "\"",
        "'",
        "r#",
        "//",
        "/*",
        "*/",
        "\n",
        "-1",
        "1e400",
        "NaN",
        "Some(",
        "None",
        "Load",
        "lines",
        "ß",
        "\t",
        "\\",
        "#![enable(implicit_some)]",
        "0x",
        "1..2",
        "true",
        "_",
        "\0",
    ]);
    let mutation = (0..VALID.len(), 0usize..12, pieces);
    prop::collection::vec(mutation, 1..4).prop_map(|mutations| {
        let mut bytes = VALID.as_bytes().to_vec();
        for (at, cut, piece) in mutations {
            let at = at.min(bytes.len());
            let end = (at + cut).min(bytes.len());
            bytes.splice(at..end, piece.bytes());
        }
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Every text is handled, and every problem lies inside the file.
    #[test]
    fn no_text_is_too_strange(text in mutated()) {
        if let Err(all) = Pipeline::parse(&text, Path::new("no-such-folder/x.ron")) {
            prop_assert!(!all.list().is_empty());
            let lines = text.split('\n').count();
            for problem in all.list() {
                prop_assert!(problem.span.start <= text.len(), "{problem:?} of {}", text.len());
                prop_assert!(problem.span.start <= problem.span.end);
                let at = all.position(problem);
                prop_assert!((1..=lines).contains(&at.line));
                let width = text.split('\n').nth(at.line - 1).unwrap().chars().count();
                prop_assert!((1..=width + 1).contains(&at.column), "{at:?} in a line of {width}");
                prop_assert!(!problem.message.is_empty() && !problem.help.is_empty());
            }
            prop_assert!(all.to_string().starts_with("error: "));
        }
    }
}
