//! Checks the order of stages: every stage needs the output of earlier ones.

use crate::text::reader::Reader;

/// Name of a stage, and its text in the file.
pub(crate) type Named<'a> = (&'static str, &'a str);

/// Stages that compute all light.
const WHOLE: [&str; 2] = ["Repeat", "Solve"];

/// Stages that send light, in their order.
const LIGHT: [&str; 4] = ["FirstShot", "ShadowRays", "SecondShot", "Multipath"];

/// Reports every stage, given by name and text, whose input no earlier stage provides. A missing input is reported
/// once.
pub(crate) fn check_order(reader: &mut Reader<'_>, stages: &[Named<'_>], list: &str) {
    let Some(&(_, last)) = stages.last() else {
        reader.problem(list, "the pipeline has no stages", "begin with `Load(path: \"scene.gltf\")`");
        return;
    };
    let (mut scene, mut first_shot, mut multipath) = (false, false, false);
    // The stage that computes all light, beside which there is no other one with lines.
    let whole = stages.iter().find(|(name, _)| WHOLE.contains(name));
    for (i, &(name, place)) in stages.iter().enumerate() {
        if !["Save", "Sensors"].contains(&name)
            && let Some((_, first)) = stages[..i].iter().find(|(n, _)| *n == name)
        {
            let line = reader.line(first);
            let help = match name {
                "Load" => "a pipeline has one scene: keep one `Load`",
                "Light" => "keep one, with all the lights",
                "Focus" => "keep one, with a box around everything of interest",
                "Subdivide" => "keep one of the two",
                "Repeat" => "keep one, with the repeats of both",
                _ => "keep one, with all the lines",
            };
            reader.problem(place, format!("a second `{name}`; the first is in line {line}"), help);
            continue;
        }
        if !scene && name != "Load" {
            let help = "begin the stages with `Load(path: \"scene.gltf\")`";
            reader.problem(place, format!("`{name}` before `Load`: there is no scene yet"), help);
            scene = true;
            first_shot |= name == "FirstShot" || WHOLE.contains(&name);
            multipath |= name == "Multipath" || WHOLE.contains(&name);
            continue;
        }
        if let Some(&(whole, of_whole)) = whole
            && (LIGHT.contains(&name) || WHOLE.contains(&name))
            && !std::ptr::eq(place, of_whole)
        {
            let line = reader.line(of_whole);
            let (message, help) = match (whole, name) {
                ("Repeat", _) if name != "Repeat" => (
                    format!("`{name}` outside of the `Repeat` in line {line}"),
                    format!("move `{name}` into the `stages` of `Repeat`"),
                ),
                _ => (
                    format!("`{name}` beside the `{whole}` in line {line}, which computes all light"),
                    format!("leave out `{name}` or `{whole}`"),
                ),
            };
            reader.problem(place, message, help);
            continue;
        }
        match name {
            "Load" => scene = true,
            "Light" | "Subdivide" | "Focus" if first_shot => {
                let light = whole.map_or("FirstShot", |(name, _)| name);
                let why = match name {
                    "Light" | "Focus" => "light has already been sent without it",
                    _ => "light has already been computed on the existing patches",
                };
                reader.problem(
                    place,
                    format!("`{name}` after `{light}`: {why}"),
                    format!("move `{name}` to before `{light}`"),
                );
            }
            "FirstShot" => first_shot = true,
            "Repeat" | "Solve" => (first_shot, multipath) = (true, true),
            "ShadowRays" | "SecondShot" if multipath => reader.problem(
                place,
                format!("`{name}` after `Multipath`: all light has been distributed"),
                format!("move `{name}` to before `Multipath`"),
            ),
            "ShadowRays" if stages[..i].iter().any(|(before, _)| *before == "SecondShot") => reader.problem(
                place,
                "`ShadowRays` after `SecondShot`: there is reflected light already",
                "move `ShadowRays` to before `SecondShot`",
            ),
            "ShadowRays" | "SecondShot" | "Multipath" | "Save" | "Sensors" if !first_shot => {
                let why = match name {
                    "Save" | "Sensors" => "there is no result yet",
                    _ => "there is no light to distribute yet",
                };
                let help = match name {
                    "Save" | "Sensors" => format!("put `Solve(lines: 1_000_000)` before `{name}`"),
                    _ => format!("put `FirstShot(lines: 1_000_000)` before `{name}`"),
                };
                reader.problem(place, format!("`{name}` before `FirstShot`: {why}"), help);
                first_shot = true;
                multipath |= name == "Multipath";
            }
            "Multipath" => multipath = true,
            _ => {}
        }
    }
    if !first_shot {
        reader.problem(last, "the pipeline ends without computing anything", "add `Solve(lines: 1_000_000)`");
    }
}

/// Reports every stage of a `Repeat`, given by name and text, that is out of order. The order is that of stages outside
/// of a `Repeat`.
pub(crate) fn check_repeated(reader: &mut Reader<'_>, stages: &[Named<'_>], list: &str) {
    let help = "begin the `stages` of `Repeat` with `FirstShot(lines: 1_000_000)`";
    match stages.first() {
        None => {
            reader.problem(list, "`Repeat` has no stages", "write `stages: [Solve(lines: 1_000_000)]`");
        }
        Some(("FirstShot" | "Solve", _)) => {}
        Some((name, place)) => reader.problem(
            place,
            format!("`{name}` before `FirstShot`: there is no light to distribute yet"),
            help,
        ),
    }
    for (&(before, _), &(name, place)) in stages.iter().zip(stages.iter().skip(1)) {
        let rank = |name| LIGHT.iter().position(|n| *n == name);
        if [before, name].contains(&"Solve") {
            let message = format!("`{name}` after `{before}`");
            reader.problem(
                place,
                message,
                "`Solve` computes all light: leave out the other stages, or `Solve`",
            );
        } else if rank(before) >= rank(name) {
            let message = format!("`{name}` after `{before}`");
            reader.problem(
                place,
                message,
                "the order is `FirstShot`, `ShadowRays`, `SecondShot`, `Multipath`, each of them once",
            );
        }
    }
}
