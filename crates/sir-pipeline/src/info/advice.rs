//! Notes about likely mistakes in a scene, and suggested pipeline settings. All of them follow from numbers in
//! [`Info`].

use glam::DVec3;

use crate::format::{grouped, length, percent};
use crate::info::facts::{Info, Setting};
use crate::info::lines::{Fates, Lines};
use crate::info::survey::Survey;

/// Share of lines above which an effect is significant: more than what cracks between surfaces cause.
const SIGNIFICANT: f64 = 0.01;

/// Share of lines below which an effect is negligible. It is large enough that some of a hundred thousand lines find
/// it.
const NEGLIGIBLE: f64 = 0.0005;

/// Returns notes about likely mistakes, and about properties that make lighting difficult: those that every command
/// mentions, and those that follow from many lines.
pub(super) fn findings(info: &Info, survey: &Survey) -> Vec<String> {
    let others = [twins(info), coincident(info), winding(info, survey), lamps(info)];
    survey.suspicions(false).into_iter().chain(others.into_iter().flatten()).collect()
}

fn twins(info: &Info) -> Option<String> {
    let twins = info.twins;
    (twins.alike > 0).then(|| {
        format!(
            "{} triangles lie on another one with the same corners and the same front; only one of them is visible",
            grouped(twins.alike as u64)
        )
    })
}

fn coincident(info: &Info) -> Option<String> {
    let share = info.lines.global.coincident;
    (share > SIGNIFICANT).then(|| {
        format!(
            "{} of the crossings coincide with another surface in the same plane; where both show their fronts, one that emits is \
             on top, or else the smaller one",
            percent(share)
        )
    })
}

fn winding(info: &Info, survey: &Survey) -> Option<String> {
    if survey.are_lamps_covered() {
        // Their light falls on backs for that reason.
        return None;
    }
    let fronts = info.lines.from_fronts;
    let backs = of_light(info, |fates| fates.back + fates.absorbed);
    if looks_outward(info) {
        Some(format!(
            "{} of the lines from fronts leave the scene, but only {} of those from backs: an object seen from outside, or a room turned \
             inside out",
            percent(fronts.escaped),
            percent(info.lines.from_backs.escaped)
        ))
    } else if backs > SIGNIFICANT {
        Some(format!(
            "{} of the light falls on backs: the winding of triangles is inconsistent, or surfaces are visible from both sides",
            percent(backs)
        ))
    } else {
        None
    }
}

/// Returns a share of the light: of the light from emitting surfaces before or after its first reflection, whichever is
/// larger. Without emitting surfaces, returns the share of lines from all fronts, including hidden ones.
fn of_light(info: &Info, share: fn(Fates) -> f64) -> f64 {
    let Lines { from_fronts, from_emitters, reflected, .. } = info.lines;
    from_emitters.map_or(share(from_fronts), |emitted| share(emitted).max(reflected.map_or(0.0, share)))
}

/// Returns true if fronts face the outside. (In a room with thick walls, about half of the fronts do.)
fn looks_outward(info: &Info) -> bool {
    let [fronts, backs] = [info.lines.from_fronts.escaped, info.lines.from_backs.escaped];
    fronts > 0.7 && backs < 0.5 * fronts
}

fn lamps(info: &Info) -> Option<String> {
    let fates = info.lines.from_emitters?;
    if fates.escaped > 0.5 && info.lines.from_fronts.escaped < 0.7 {
        Some(format!(
            "{} of the light of emitting surfaces leaves the scene directly: are they turned the wrong way? OBJ and one-sided glTF \
             materials emit from their fronts",
            percent(fates.escaped)
        ))
    } else {
        None
    }
}

/// Returns suggested pipeline settings.
pub(super) fn settings(info: &Info, survey: &Survey) -> Vec<Setting> {
    load(info, survey).into_iter().chain(light(info)).chain(focus(info)).chain(patches(info)).collect()
}

/// Returns a stage `Load` with the suggested scale and sides.
fn load(info: &Info, survey: &Survey) -> Option<Setting> {
    let path = serde_json::Value::from(info.scene.as_str());
    let unit = survey.likely_unit();
    let scale =
        unit.map(|unit| (format!("scale: {}", unit.scale), format!("the size looks like {}", unit.name)));
    let sides = sides(info, survey).map(|(sides, why)| (format!("sides: {sides}"), why));
    let (fields, reasons): (Vec<_>, Vec<_>) = [scale, sides].into_iter().flatten().unzip();
    (!fields.is_empty()).then(|| Setting {
        set: format!("Load(path: {path}, {})", fields.join(", ")),
        why: reasons.join("; "),
    })
}

/// Returns the suggested sides, and the reason.
fn sides(info: &Info, survey: &Survey) -> Option<(&'static str, String)> {
    let fronts = info.lines.from_fronts;
    let [one_sided, two_sided] = [false, true].map(|is| info.materials.iter().any(|m| m.two_sided == is));
    if one_sided && looks_outward(info) {
        let why = "the fronts face outward; if this is a room, its inner sides would only absorb";
        return Some(("Both", why.into()));
    }
    let absorbed = of_light(info, |fates| fates.absorbed);
    // The light of covered lamps falls on backs, but reflecting it would not help.
    if absorbed > SIGNIFICANT && !survey.are_lamps_covered() {
        let why = format!("{} of the light falls on backs that would only absorb it", percent(absorbed));
        return Some(("Both", why));
    }
    let emitters = info.lines.from_emitters;
    // Lights without a surface may shine on backs.
    let only_surfaces = info.sources.len() == usize::from(emitters.is_some());
    let hidden = |fates: Fates| fates.back < NEGLIGIBLE && fates.absorbed < NEGLIGIBLE;
    let seldom = hidden(fronts) && emitters.is_none_or(hidden) && fronts.escaped < 0.5;
    let why = "no light travels from a front to a back; half as many sides give the same result";
    (two_sided && only_surfaces && seldom).then(|| ("Front", why.into()))
}

fn light(info: &Info) -> Vec<Setting> {
    if !info.sources.is_empty() {
        return Vec::new();
    }
    // The outer sides of walls do not count, so the light of interest is the light after its first hit.
    let escaped = info.lines.reflected.unwrap_or(info.lines.from_fronts).escaped;
    let outward = looks_outward(info);
    let mut lights = Vec::new();
    if escaped > SIGNIFICANT {
        let [x, y, z] = info.up.map(length);
        let up =
            if DVec3::from(info.up) == DVec3::Y { String::new() } else { format!("up: ({x}, {y}, {z}), ") };
        lights.push(Setting {
            set: format!("Light([Sky({up}model: Overcast, horizontal: 10_000, ground: 500)])"),
            why: match escaped {
                _ if outward => {
                    "nothing emits; daylight, if this is an object or its openings are windows".into()
                }
                share if share > 0.5 => {
                    "nothing emits, and most of the light leaves the scene: daylight".into()
                }
                share => format!(
                    "nothing emits, and {} of reflected light leaves through openings: windows?",
                    percent(share)
                ),
            },
        });
    }
    if escaped <= SIGNIFICANT || outward {
        lights.push(Setting {
            set: panel(info),
            why: match outward {
                true => "nothing emits; a lamp below the ceiling, if this is a room".into(),
                false => "nothing emits, and there are no openings: a lamp below the ceiling".into(),
            },
        });
    }
    lights
}

/// Returns a `Light` stage with a panel of a quarter of the room's length and width, at nine tenths of its height.
fn panel(info: &Info) -> String {
    let room = info.dominant.as_ref().map_or(info.extent, |dominant| dominant.rest);
    let (size, up) = (room.size(), DVec3::from(info.up));
    // The cross product of `a` and `b` points down.
    let (a, b) = if up == DVec3::Z { (DVec3::Y, DVec3::X) } else { (DVec3::X, DVec3::Z) };
    let (a, b) = (0.25 * a * size, 0.25 * b * size);
    let corner = room.center() + 0.4 * up * size - 0.5 * (a + b);
    let [corner, a, b] =
        [corner, a, b].map(|v| format!("({}, {}, {})", length(v.x), length(v.y), length(v.z)));
    format!("Light([Panel(corner: {corner}, edges: ({a}, {b}), power: 1000)])")
}

/// Returns a focus on the box around everything except the dominant part.
fn focus(info: &Info) -> Option<Setting> {
    let dominant = info.dominant.as_ref()?;
    Some(Setting {
        set: dominant.rest.focus(),
        why: format!("concentrates lines and patches on the rest of the scene, and not on {}", dominant.what),
    })
}

fn patches(info: &Info) -> Option<Setting> {
    if info.largest_triangle < 0.002 {
        return None;
    }
    // Flat surfaces need few, however many triangles they have.
    let patches = info.triangles.clamp(20_000, 200_000);
    // Rounded up to one digit, because it is only a suggestion.
    let unit = 10usize.pow(patches.ilog10());
    let patches = patches.div_ceil(unit) * unit;
    Some(Setting {
        set: format!("Subdivide(patches: {})", grouped(patches as u64)),
        why: format!(
            "the largest triangle has {} of the area, and light is constant on a patch; these patches are about {} m wide",
            percent(info.largest_triangle),
            length((info.area / patches as f64).sqrt())
        ),
    })
}
