//! Which stage may follow which: every stage needs what an earlier one has made.

use crate::fields::Reader;

/// Notes a problem for every stage, given by name and place, whose inputs nothing before it has made. What has
/// been missed once is not reported again.
pub(crate) fn check_order(reader: &mut Reader<'_>, stages: &[(&'static str, &str)], list: &str) {
    let Some(&(_, last)) = stages.last() else {
        reader.problem(list, "the pipeline has no stages", "begin with `Load(path: \"scene.gltf\")`");
        return;
    };
    let (mut scene, mut first_shot, mut multipath) = (false, false, false);
    for (i, &(name, place)) in stages.iter().enumerate() {
        if !["Save", "Sensors"].contains(&name)
            && let Some((_, first)) = stages[..i].iter().find(|(n, _)| *n == name)
        {
            let line = reader.line(first);
            let help = match name {
                "Load" => "a pipeline has one scene: keep one `Load`",
                "Subdivide" => "keep one of the two",
                _ => "keep one, with all the lines",
            };
            reader.problem(place, format!("a second `{name}`; the first is in line {line}"), help);
            continue;
        }
        if !scene && name != "Load" {
            let help = "begin the stages with `Load(path: \"scene.gltf\")`";
            reader.problem(place, format!("`{name}` before `Load`: there is no scene yet"), help);
            scene = true;
            continue;
        }
        match name {
            "Load" => scene = true,
            "Subdivide" if first_shot => reader.problem(
                place,
                "`Subdivide` after `FirstShot`: light has been computed on the patches as they were",
                "move `Subdivide` to before `FirstShot`",
            ),
            "FirstShot" => first_shot = true,
            "SecondShot" if multipath => reader.problem(
                place,
                "`SecondShot` after `Multipath`: all light has been distributed",
                "move `SecondShot` to before `Multipath`",
            ),
            "SecondShot" | "Multipath" | "Save" | "Sensors" if !first_shot => {
                let why = match name {
                    "Save" | "Sensors" => "there is no result yet",
                    _ => "there is no light to distribute yet",
                };
                let help = format!("put `FirstShot(lines: 1_000_000)` before `{name}`");
                reader.problem(place, format!("`{name}` before `FirstShot`: {why}"), help);
                first_shot = true;
            }
            "Multipath" => multipath = true,
            _ => {}
        }
    }
    if !first_shot {
        reader.problem(
            last,
            "the pipeline ends without computing anything",
            "add `FirstShot(lines: 1_000_000)` and `Multipath(lines: 1_000_000)`",
        );
    }
}
