//! The pipeline that a scene suggests: each choice with its reason, and with what is doubtful about it.
//!
//! All choices follow from numbers in [`Info`], so the same file gives the same choices.

use glam::DVec3;

use crate::format::{grouped, length, percent, rounded_up};
use crate::info::advice::{NEGLIGIBLE, SIGNIFICANT, looks_outward, of_light};
use crate::info::facts::{Info, Setting};
use crate::info::lines::Fates;
use crate::info::survey::Survey;
use crate::prepare::up::UNKNOWN;

/// Share of the reflected light that leaves a scene, above which the scene is open.
const OPEN: f64 = 0.5;

/// Fewest and most patches that are suggested.
const PATCHES: (usize, usize) = (20_000, 200_000);

/// Width of patches for which there are enough of them, unless the scene has more triangles \[m\].
const PATCH_WIDTH: f64 = 0.1;

/// Luminous flux of a lamp for each square meter of the floor \[lm/m²\].
const FLUX_PER_AREA: f64 = 500.0;

/// Illuminance of an unobstructed horizontal surface by the sky \[lx\], and luminance of the ground that reflects a sixth
/// of it \[cd/m²\].
const SKY: (f64, f64) = (10_000.0, 500.0);

/// Lines of a repeat for each patch, and fewest of them.
const LINES_PER_PATCH: usize = 20;
const FEWEST_LINES: usize = 1_000_000;

/// Choices of a pipeline, in its order.
#[derive(Clone, Debug)]
pub(crate) struct Choices {
    pub units: Setting,
    pub load: Setting,
    /// Its text is empty if the scene has light.
    pub light: Setting,
    pub focus: Option<Setting>,
    pub subdivide: Setting,
    /// Number of lines of a repeat.
    pub lines: u64,
}

impl Choices {
    /// Returns the choices for a scene, which a pipeline finds at `path`.
    pub(crate) fn new(info: &Info, survey: &Survey, path: &str) -> Self {
        let scale = survey.likely_unit().map_or(1.0, |unit| unit.scale);
        let (subdivide, patches) = patches(info, scale);
        let sides = sides(info, survey);
        let has_both = sides.as_ref().is_some_and(|(sides, _)| *sides == "Both");
        Self {
            units: units(info),
            load: load(info, survey, path, sides),
            light: light(info, survey, scale, has_both),
            focus: focus(info),
            subdivide,
            lines: rounded_up((LINES_PER_PATCH * patches).max(FEWEST_LINES) as f64),
        }
    }

    /// Returns the choices that are not what any pipeline has.
    pub(crate) fn special(self) -> Vec<Setting> {
        let Self { units, load, light, focus, subdivide, .. } = self;
        let all = [Some(units), Some(load), Some(light), focus, Some(subdivide)];
        all.into_iter().flatten().filter(|setting| !setting.is_usual).collect()
    }
}

/// Returns the units: photometric for glTF, which defines them, and for the lights suggested here.
fn units(info: &Info) -> Setting {
    let is_gltf = !info.scene.to_lowercase().ends_with(".obj");
    let (units, why) = match (info.sources.is_empty(), is_gltf) {
        (true, _) => ("Photometric", "the light is stated in lux and lumens"),
        (false, true) => {
            ("Photometric", "luminous intensities in cd and luminances in cd/m², as glTF states them")
        }
        (false, false) => ("Radiometric", "watts and W/m², as OBJ states no units of light"),
    };
    Setting {
        set: format!("units: {units}"),
        why: why.into(),
        doubt: None,
        is_usual: !info.sources.is_empty(),
    }
}

/// Returns the stage `Load` with the suggested scale and sides.
fn load(info: &Info, survey: &Survey, path: &str, sides: Option<(&'static str, String)>) -> Setting {
    let mut fields = vec![format!("path: {}", serde_json::Value::from(path))];
    let (mut reasons, mut doubts) = (Vec::new(), Vec::new());
    if let Some(unit) = survey.likely_unit() {
        fields.push(format!("scale: {}", unit.scale));
        reasons.push(format!("the size looks like {}", unit.name));
        doubts.push(format!(
            "the file is taken to be in {}, because its height is {} units; if a unit is a meter, leave out `scale`",
            unit.name,
            length(info.extent.size().dot(DVec3::from(info.up).abs()))
        ));
    } else {
        doubts.extend(survey.unit());
    }
    if let Some((sides, why)) = sides {
        fields.push(format!("sides: {sides}"));
        if sides == "Both" {
            doubts.push(format!(
                "{why}, so both sides are taken to reflect; `sides: AsAuthored` is what the file says"
            ));
        }
        reasons.push(why);
    }
    let is_usual = reasons.is_empty();
    doubts.extend(info.doubt_of_up.clone());
    if info.up_from == UNKNOWN {
        doubts.push(
            "nothing shows which direction is up; if it is z, write `up: (0, 0, 1)`, and place lights anew"
                .into(),
        );
    }
    Setting {
        set: format!("Load({})", fields.join(", ")),
        why: reasons.join("; "),
        doubt: joined(doubts),
        is_usual,
    }
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

/// Returns the stage `Light`: none if the scene has light, the sky if it is open, or else a lamp.
fn light(info: &Info, survey: &Survey, scale: f64, has_both: bool) -> Setting {
    // The outer sides of walls do not count, so the light of interest is the light after its first hit.
    let escaped = info.lines.reflected.unwrap_or(info.lines.from_fronts).escaped;
    if !info.sources.is_empty() {
        let lost = (escaped > OPEN).then(|| {
            format!(
                "{} of the reflected light leaves the scene; if it is a room, walls are missing; `{}` would add daylight",
                percent(escaped),
                sky(info)
            )
        });
        let lamps = info.sources.iter().map(|lights| {
            let [r, g, b] = lights.power.map(length);
            format!("{} (red {r}, green {g}, blue {b})", lights.what)
        });
        let lamps: Vec<String> = lamps.collect();
        return Setting {
            set: String::new(),
            why: format!("the light sources are those of the file: {}", lamps.join(", ")),
            doubt: joined(survey.lamp_suspicions(has_both).chain(lost).collect()),
            is_usual: true,
        };
    }
    let outward = looks_outward(info);
    let has_ground = info.dominant.is_some();
    let open = escaped > SIGNIFICANT || outward || has_ground;
    let why = match escaped {
        _ if outward => "nothing emits; daylight, if this is an object or its openings are windows".into(),
        _ if has_ground => {
            "nothing emits, and the rest is small beside one part, such as a ground: daylight".into()
        }
        share if share > OPEN => "nothing emits, and most of the light leaves the scene: daylight".into(),
        share if open => format!(
            "nothing emits, and {} of reflected light leaves through openings: windows?",
            percent(share)
        ),
        _ => "nothing emits, and there are no openings: a lamp below the ceiling".into(),
    };
    let (sky, panel) = (sky(info), panel(survey, scale));
    let (set, doubt) = match (open, panel) {
        (false, Some(panel)) => (panel, "the file has no light and no openings, so a lamp was added".into()),
        (_, panel) => {
            let lamp = panel
                .map_or(String::new(), |panel| format!("; if this is a room, a lamp would be `{panel}`"));
            (sky, format!("the file has no light, so an overcast sky was added{lamp}"))
        }
    };
    Setting { set, why, doubt: Some(doubt), is_usual: false }
}

/// Returns a `Light` stage with an overcast sky.
fn sky(info: &Info) -> String {
    let [x, y, z] = info.up.map(length);
    let is_usual = DVec3::from(info.up) == DVec3::Y;
    let up = if is_usual { String::new() } else { format!("up: ({x}, {y}, {z}), ") };
    let (horizontal, ground) = SKY;
    format!("Light([Sky({up}model: Overcast, horizontal: {}, ground: {ground})])", grouped(horizontal as u64))
}

/// Returns a `Light` stage with a panel in free space, whose power lights the floor.
fn panel(survey: &Survey, scale: f64) -> Option<String> {
    let place = survey.lamp_place.filter(|place| place.edges.iter().all(|edge| edge.length() > 0.0))?;
    let power = rounded_up((FLUX_PER_AREA * scale * scale * place.floor).ceil());
    let point = |v: DVec3| {
        let [x, y, z] = (scale * v).to_array().map(length);
        format!("({x}, {y}, {z})")
    };
    let [a, b] = place.edges.map(point);
    Some(format!(
        "Light([Panel(corner: {}, edges: ({a}, {b}), power: {})])",
        point(place.corner),
        grouped(power)
    ))
}

/// Returns a focus on the box around everything except the dominant part.
fn focus(info: &Info) -> Option<Setting> {
    let dominant = info.dominant.as_ref()?;
    Some(Setting {
        set: dominant.rest.focus(),
        why: format!("concentrates lines and patches on the rest of the scene, and not on {}", dominant.what),
        doubt: Some(format!(
            "{} has {} of the area; lines and patches are concentrated on the rest, and results outside of the box are \
             coarse; without `Focus` all of the scene counts",
            dominant.what,
            percent(dominant.share)
        )),
        is_usual: false,
    })
}

/// Returns the stage `Subdivide`, and its number of patches.
fn patches(info: &Info, scale: f64) -> (Setting, usize) {
    let rest = info.dominant.as_ref().map_or(1.0, |dominant| 1.0 - dominant.share);
    let area = rest * info.area * scale * scale;
    // Flat surfaces need few, however many triangles they have.
    let fine = (area / (PATCH_WIDTH * PATCH_WIDTH)) as usize;
    let patches = rounded_up(info.triangles.max(fine).clamp(PATCHES.0, PATCHES.1) as f64) as usize;
    let setting = Setting {
        set: format!("Subdivide(patches: {})", grouped(patches as u64)),
        why: format!(
            "the largest triangle has {} of the area, and light is constant on a patch; these patches are about {} m wide",
            percent(info.largest_triangle),
            length((area / patches as f64).sqrt())
        ),
        doubt: None,
        is_usual: info.largest_triangle < 0.002,
    };
    (setting, patches)
}

fn joined(parts: Vec<String>) -> Option<String> {
    (!parts.is_empty()).then(|| parts.join("; "))
}
