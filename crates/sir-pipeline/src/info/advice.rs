//! Notes about likely mistakes in a scene, and suggested pipeline settings. All of them follow from numbers in
//! [`Info`].

use glam::DVec3;

use crate::format::{dimensions, grouped, length, percent};
use crate::info::facts::{Info, Setting};
use crate::info::lines::{Fates, Lines};

/// Share of lines above which an effect is significant: more than what cracks between surfaces cause.
const SIGNIFICANT: f64 = 0.01;

/// Share of lines below which an effect is negligible. It is large enough that some of a hundred thousand lines find
/// it.
const NEGLIGIBLE: f64 = 0.0005;

/// Returns notes about likely mistakes, and about properties that make lighting difficult.
pub(super) fn findings(info: &Info) -> Vec<String> {
    [unit(info), far_away(info), dominated(info), twins(info), coincident(info), winding(info), lamps(info)]
        .into_iter()
        .flatten()
        .collect()
}

fn unit(info: &Info) -> Option<String> {
    let size = info.extent.size();
    let height = size.dot(info.up.into());
    // A room is about as high as it is wide; a landscape is flat.
    let room = info.dominant.is_none() && height > 0.05 * size.max_element();
    let lengths = "powers and distances of lights assume meters";
    match size.max_element() {
        _ if room && height > 100.0 => {
            let unit = if height > 1000.0 { "millimeters" } else { "centimeters" };
            Some(format!("a height of {} m looks like {unit}, if this is a room; {lengths}", length(height)))
        }
        most if most > 1000.0 => Some(format!("an extent of {} m; {lengths}", length(most))),
        most if most < 0.05 => {
            Some(format!("an extent of {} m looks like kilometers or a wrong scale; {lengths}", length(most)))
        }
        _ => None,
    }
}

fn far_away(info: &Info) -> Option<String> {
    let times = info.distance_from_origin / info.extent.size().length();
    // Most files store single-precision numbers, with a relative step of 2⁻²⁴.
    let step = info.distance_from_origin / f64::from(1 << 24);
    (times > 100.0).then(|| {
        format!(
            "the scene is far from the origin, {} times its size (single-precision coordinates have steps of {} m there); \
             move it to the origin",
            grouped(times as u64),
            length(step)
        )
    })
}

fn dominated(info: &Info) -> Option<String> {
    let dominant = info.dominant.as_ref()?;
    Some(format!(
        "{} has {} of the area, and everything else fits into {} (most global lines meet nothing else); leave it out of the \
         file, or set a `Focus` on the rest",
        dominant.what,
        percent(dominant.share),
        dimensions(dominant.rest.size())
    ))
}

fn twins(info: &Info) -> Option<String> {
    let twins = info.twins;
    (twins.alike > 0).then(|| {
        format!(
            "{} triangles lie on another one with the same corners and the same front; only the later one is visible",
            grouped(twins.alike as u64)
        )
    })
}

fn coincident(info: &Info) -> Option<String> {
    let share = info.lines.global.coincident;
    (share > SIGNIFICANT).then(|| {
        format!(
            "{} of the crossings coincide with another surface in the same plane; where both show their fronts, the later one in the \
             file is on top",
            percent(share)
        )
    })
}

fn winding(info: &Info) -> Option<String> {
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
    } else if fates.absorbed > 0.5 {
        Some(format!(
            "{} of the light of emitting surfaces falls on backs, which absorb it: are they turned the wrong way?",
            percent(fates.absorbed)
        ))
    } else {
        None
    }
}

/// Returns suggested pipeline settings.
pub(super) fn settings(info: &Info) -> Vec<Setting> {
    sides(info).into_iter().chain(light(info)).chain(focus(info)).chain(patches(info)).collect()
}

fn sides(info: &Info) -> Option<Setting> {
    let path = serde_json::Value::from(info.scene.as_str());
    let load = |sides, why| Some(Setting { set: format!("Load(path: {path}, sides: {sides})"), why });
    let fronts = info.lines.from_fronts;
    let [one_sided, two_sided] = [false, true].map(|is| info.materials.iter().any(|m| m.two_sided == is));
    if one_sided && looks_outward(info) {
        return load(
            "Both",
            "the fronts face outward; if this is a room, its inner sides would only absorb".into(),
        );
    }
    let absorbed = of_light(info, |fates| fates.absorbed);
    if absorbed > SIGNIFICANT {
        let why = format!("{} of the light falls on backs that would only absorb it", percent(absorbed));
        return load("Both", why);
    }
    let emitters = info.lines.from_emitters;
    // Lights without a surface may shine on backs.
    let only_surfaces = info.sources.len() == usize::from(emitters.is_some());
    let hidden = |fates: Fates| fates.back < NEGLIGIBLE && fates.absorbed < NEGLIGIBLE;
    let seldom = hidden(fronts) && emitters.is_none_or(hidden) && fronts.escaped < 0.5;
    if two_sided && only_surfaces && seldom {
        return load(
            "Front",
            "no light travels from a front to a back; half as many sides give the same result".into(),
        );
    }
    None
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
        let up = if DVec3::from(info.up) == DVec3::Z { "up: (0, 0, 1), " } else { "" };
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
    let rest = dominant.rest;
    // Rounded outward, to about a thousandth of the size.
    let digits = 3 - rest.size().max_element().log10().floor() as i32;
    let step = 10f64.powi(-digits);
    let corner = |corner: [f64; 3], round: fn(f64) -> f64| {
        let [x, y, z] = corner.map(|x| {
            let rounded = round(x / step) * step;
            format!("{:.*}", digits.max(0) as usize, if rounded == 0.0 { 0.0 } else { rounded })
        });
        format!("({x}, {y}, {z})")
    };
    let (min, max) = (corner(rest.min, f64::floor), corner(rest.max, f64::ceil));
    Some(Setting {
        set: format!("Focus(min: {min}, max: {max})"),
        why: format!("concentrates lines and patches on the rest of the scene, and not on {}", dominant.what),
    })
}

fn patches(info: &Info) -> Option<Setting> {
    if info.largest_triangle < 0.002 {
        return None;
    }
    let patches = (2 * info.triangles).max(20_000);
    // Rounded up to one digit, because it is only a suggestion.
    let unit = 10usize.pow(patches.ilog10());
    let patches = patches.div_ceil(unit) * unit;
    Some(Setting {
        set: format!("Subdivide(patches: {})", grouped(patches as u64)),
        why: format!(
            "the largest triangle has {} of the area, and light is constant on a patch; these patches have edges of about {} m",
            percent(info.largest_triangle),
            length((2.0 * info.area / patches as f64).sqrt())
        ),
    })
}
