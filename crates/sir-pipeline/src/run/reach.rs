//! Warns if few of the global lines meet what is lit.

use sir_geom::{BoundingBox, TriangleId};
use sir_lines::Domain;
use sir_mesh::PatchId;
use sir_radiosity::{Model, Solution};

use crate::format::{dimensions, grouped, percent};
use crate::info::shape::Extent;
use crate::plan::Action;
use crate::prepare::prepared::Prepared;
use crate::report::result::{BalanceReport, LinesReport};

/// Share of the received power that lands on what counts as lit.
const MOST: f64 = 0.9;

/// Share of the global lines below which those that meet what is lit are few.
const FEW: f64 = 0.01;

/// Share of the power of the sources below which what reflecting surfaces receive is next to nothing.
const NOTHING: f64 = 1e-3;

/// Returns a warning if next to nothing of the power of the sources has reached a surface that reflects.
pub(crate) fn dark_warning(action: &Action, lines: &LinesReport) -> Vec<String> {
    let sum = |bands: [f64; 3]| bands.iter().sum::<f64>();
    let BalanceReport { emitted, absorbed, blocked, escaped, unshot } = lines.balance;
    let emitted = sum(emitted);
    if !matches!(action, Action::FirstShot(_)) || sum(absorbed) + sum(unshot) > NOTHING * emitted {
        return Vec::new();
    }
    vec![format!(
        "next to nothing of the power of the light sources meets a surface that reflects: {} leaves the scene or misses it, \
         and {} falls on backs, which absorb it; is the light outside of the room, or do surfaces face the wrong way? \
         `Load(sides: Both)` makes backs reflect",
        percent(sum(escaped) / emitted),
        percent(sum(blocked) / emitted)
    )]
}

/// Returns a warning if global lines were drawn through a scene most of which is dark, so that few of them met what is
/// lit. A focus makes up for that.
pub(crate) fn few_lines_warning(
    prepared: &Prepared,
    lines: &LinesReport,
    solution: &Solution,
) -> Vec<String> {
    let Some(domain) = lines.domain.as_ref().filter(|_| prepared.focus.is_none()) else { return Vec::new() };
    let Some(lit) = lit_box(&prepared.model, solution) else { return Vec::new() };
    // A lamp that lights nothing but what covers it has no use for a focus.
    if prepared.lamps_are_covered {
        return Vec::new();
    }
    // Of uniform lines through a convex body, those that meet another one in it are in proportion to its surface
    // (Cauchy and Crofton; Santaló 1976, section II.14).
    let share = Domain::Box(lit).surface() / domain.surface;
    if share >= FEW {
        return Vec::new();
    }
    let (lit, met) = (Extent::from(lit), share * lines.lines as f64);
    vec![format!(
        "{} of {} global lines met the part of the scene that gets {} % of the light, {}; its light has large \
         errors; set `{}`",
        if met < 1.0 {
            "less than one".into()
        } else {
            format!("only about {}", grouped(met.round() as u64))
        },
        grouped(lines.lines),
        100.0 * MOST,
        dimensions(lit.size()),
        lit.focus()
    )]
}

/// Returns the box around the brightest sides that together receive most of the power; `None` if nothing is lit.
fn lit_box(model: &Model, solution: &Solution) -> Option<BoundingBox> {
    let Model { scene, mesh, .. } = model;
    let mut sides: Vec<(f64, f64, TriangleId, PatchId)> = Vec::new();
    mesh.for_each_side(|triangle, patch, _, side| {
        let irradiance = solution.irradiance[side.index()].element_sum();
        if irradiance > 0.0 {
            sides.push((irradiance, irradiance * mesh.patch_area(triangle, patch), triangle, patch));
        }
    });
    sides.sort_by(|a, b| b.0.total_cmp(&a.0));
    let wanted = MOST * sides.iter().map(|side| side.1).sum::<f64>();
    let mut sum = 0.0;
    let brightest = sides.iter().take_while(|(_, power, ..)| {
        let is_part = sum < wanted;
        sum += power;
        is_part
    });
    BoundingBox::of(brightest.flat_map(|&(_, _, triangle, patch)| mesh.corners(scene, triangle, patch)))
}
