//! The contents of a scene as text for terminals.

use sir_pipeline::format::{dimensions, grouped, length, percent};
use sir_pipeline::info::{Fates, Info, MaterialInfo, Textures};
use sir_pipeline::prepare::direction_name;

/// Maximum number of materials in the table. Of parts and cameras, a quarter as many are named.
const MAX_LISTED: usize = 20;

/// Maximum length of a name, in characters.
const MAX_NAME: usize = 32;

/// Returns all numbers, notes about likely mistakes, and suggested settings.
pub(super) fn text(info: &Info) -> String {
    let parts = [overview(info), materials(info), light(info), lines(info), conclusions(info)];
    let mut text = parts.join("\n");
    // Names in files may contain control characters, which would change the terminal's state.
    text = text.replace(|c: char| c.is_control() && c != '\n', "\u{fffd}");
    text
}

fn overview(info: &Info) -> String {
    let count = |n: usize| grouped(n as u64);
    let dropped = match info.dropped_triangles {
        0 => String::new(),
        n => format!(", and {} without an area", grouped(n)),
    };
    let [min, max] = [info.extent.min, info.extent.max].map(|v| v.map(length).join(", "));
    let names = info.groups.iter().map(|group| group.name.as_str());
    let up = direction_name(info.up.into());
    [
        row("scene", &info.scene),
        row("triangles", &format!("{}{dropped}", count(info.triangles))),
        row("vertices", &count(info.vertices)),
        row("polygons", &count(info.polygons)),
        row("parts", &listed(names)),
        row("textures", &textures(info)),
        row(
            "area",
            &format!("{} m²; the largest triangle has {}", length(info.area), percent(info.largest_triangle)),
        ),
        row("extent", &format!("{}, up is {up} ({})", dimensions(info.extent.size()), info.up_from)),
        row(
            "place",
            &format!(
                "({min}) to ({max}), its center {} m from the origin",
                length(info.distance_from_origin)
            ),
        ),
        row("cameras", &listed(info.cameras.iter().map(String::as_str))),
    ]
    .concat()
}

fn textures(info: &Info) -> String {
    let Textures { images, texels, triangles } = info.textures;
    if triangles == 0 {
        return "none".into();
    }
    let [images, texels, triangles] = [images, texels, triangles].map(|n| grouped(n as u64));
    format!("{images} images with {texels} texels; {triangles} triangles have textures or vertex colors")
}

fn row(what: &str, value: &str) -> String {
    format!("{what:<10} {value}\n")
}

/// Returns the number of names, and the first ones.
fn listed<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    let count = names.len();
    if count == 0 {
        return "none".into();
    }
    let shown: Vec<String> = names.take(MAX_LISTED / 4).map(|name| format!("\"{}\"", cut(name))).collect();
    let more = if count > shown.len() { ", …" } else { "" };
    format!("{}: {}{more}", grouped(count as u64), shown.join(", "))
}

fn cut(name: &str) -> String {
    match name.char_indices().nth(MAX_NAME) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    }
}

fn materials(info: &Info) -> String {
    let shown = &info.materials[..info.materials.len().min(MAX_LISTED)];
    let wide = shown.iter().map(|m| cut(&m.name).chars().count()).max().unwrap_or(0).max("material".len());
    let mut text = format!(
        "{:<wide$} {:>9} {:>11} {:>5}  {:<17} emitted power, W\n",
        "material", "triangles", "area, m²", "sides", "reflectance"
    );
    for material in shown {
        let MaterialInfo { name, triangles, area, reflectance: [r, g, b], power, two_sided, .. } = material;
        let power = if power == &[0.0; 3] { String::new() } else { power.map(length).join(" + ") };
        let line = format!(
            "{:<wide$} {:>9} {:>11} {:>5}  {r:.3} {g:.3} {b:.3}  {power}",
            cut(name),
            grouped(*triangles as u64),
            length(*area),
            1 + u8::from(*two_sided),
        );
        text += &format!("{}\n", line.trim_end());
    }
    match info.materials.len() - shown.len() {
        0 => {}
        more => text += &format!("and {} more\n", grouped(more as u64)),
    }
    text
}

fn light(info: &Info) -> String {
    if info.sources.is_empty() {
        return row("light", "none");
    }
    let lights = info.sources.iter().map(|lights| {
        let power = lights.power.map(length).join(" + ");
        row("light", &format!("{}, {power} W (red, green, blue)", lights.what))
    });
    lights.collect()
}

fn lines(info: &Info) -> String {
    let lines = &info.lines;
    let mut text = format!(
        "{:<26} {:>9} {:>9} {:>12} {:>11}\n",
        format!("{} lines each", grouped(lines.lines_of_each_kind)),
        "to fronts",
        "to backs",
        "to absorbing",
        "out of the"
    );
    text += &format!("{:<26} {:>9} {:>9} {:>12} {:>11}\n", "", "", "", "backs", "scene");
    let kinds = [
        ("from fronts", Some(lines.from_fronts)),
        ("from backs", Some(lines.from_backs)),
        ("from emitting surfaces", lines.from_emitters),
        ("after one reflection", lines.reflected),
    ];
    for (name, fates) in kinds {
        if let Some(Fates { front, back, absorbed, escaped }) = fates {
            let [front, back, absorbed, escaped] = [front, back, absorbed, escaped].map(percent);
            text += &format!("{name:<26} {front:>9} {back:>9} {absorbed:>12} {escaped:>11}\n");
        }
    }
    let global = &lines.global;
    text += &format!(
        "global lines: {} cross an odd number of triangles (holes, sheets), {} of the segments lie between a front and a back\n",
        percent(global.odd),
        percent(global.mixed)
    );
    let twins = info.twins;
    text += &format!(
        "{} triangles have the same corners as another one; {} of the crossings coincide with another one\n",
        grouped(twins.twins as u64),
        percent(global.coincident)
    );
    text
}

fn conclusions(info: &Info) -> String {
    let mut text = String::new();
    for warning in &info.warnings {
        text += &row("warning", warning);
    }
    for finding in &info.findings {
        text += &row("note", finding);
    }
    if info.settings.is_empty() {
        text += &row("set", "nothing special");
    }
    for setting in &info.settings {
        text += &row("set", &setting.set);
        text += &row("", &setting.why);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let shown = [0.0, -0.0, 1.0, 2.5, 0.123_456, -12.999_9, 123_456.7, 1e12, 3e-9].map(length);
        assert_eq!(shown, ["0", "0", "1", "2.5", "0.1235", "-13", "123457", "1.000e12", "3.000e-9"]);
        assert_eq!([0.0, 0.000_1, 0.123_45, 1.0].map(percent), ["0 %", "<0.1 %", "12.3 %", "100.0 %"]);
    }
}
