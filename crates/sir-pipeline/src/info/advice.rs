//! Notes about likely mistakes in a scene. All of them follow from numbers in [`Info`].

use crate::format::{grouped, percent};
use crate::info::facts::Info;
use crate::info::lines::{Fates, Lines};
use crate::info::survey::Survey;

/// Share of lines above which an effect is significant: more than what cracks between surfaces cause.
pub(super) const SIGNIFICANT: f64 = 0.01;

/// Share of lines below which an effect is negligible. It is large enough that some of a hundred thousand lines find
/// it.
pub(super) const NEGLIGIBLE: f64 = 0.0005;

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
/// larger. Without emitting surfaces, returns the share of lines from what lines from fronts hit, so that hidden fronts do not
/// count, or of lines from all fronts if they hit nothing.
pub(super) fn of_light(info: &Info, share: fn(Fates) -> f64) -> f64 {
    let Lines { from_fronts, from_emitters, reflected, .. } = info.lines;
    let without = share(reflected.unwrap_or(from_fronts));
    from_emitters.map_or(without, |emitted| share(emitted).max(reflected.map_or(0.0, share)))
}

/// Returns true if fronts face the outside only. (In a room with thick walls, about half of the fronts do, and in a building
/// more, but the light that enters stays between fronts.)
pub(super) fn looks_outward(info: &Info) -> bool {
    let [fronts, backs] = [info.lines.from_fronts.escaped, info.lines.from_backs.escaped];
    let has_rooms = info.lines.reflected.is_some_and(|fates| fates.front > 0.5);
    fronts > 0.7 && backs < 0.5 * fronts && !has_rooms
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
