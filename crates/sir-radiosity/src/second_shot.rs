//! The second shot: the brightest patches send what they reflect of the first one along local lines, too.
//!
//! Castro, Martínez and Sbert (1998) call it an extended first shot. A global line carries as much as the patch that it leaves is
//! bright; where light falls on a wall from nearby, it is as bright as a lamp, and what it sends makes most of the noise of all that
//! see it. Local lines carry the same from everywhere. The brightest patches are those whose power is to all the power of the
//! sources as the lines of this shot are to those of the first: then a line carries as much as a line of the first shot.

use sir_geom::{Rgb, Side};
use sir_lines::{LocalLines, Stage};
use sir_mesh::{PatchId, SideId};

use crate::balance::Books;
use crate::emitter::Emitter;
use crate::error::SolveError;
use crate::first_shot::{FirstShot, FirstShotTally, Shot};
use crate::inside::Inside;
use crate::model::Model;
use crate::power::Quanta;
use crate::sources::{Aimed, Source};

/// The lines of a second shot.
#[derive(Clone, Debug)]
pub struct SecondShot<'m> {
    lines: FirstShot<'m>,
    /// The side that each source of the lines is, or is a part of.
    sides: Vec<SideId>,
}

impl<'m> SecondShot<'m> {
    /// Shares lines among the brightest patches; with a focus, that of the first shot, among those in it. If none reflects, there are no lines.
    #[must_use]
    pub fn new(model: &'m Model, shot: &Shot, lines: impl Into<LocalLines>, seed: u64) -> Self {
        let LocalLines { count: lines, focus } = lines.into();
        let unshot = shot.unshot(model);
        let total = shot.balance.emitted.total() * lines as f64 / shot.counts.lines.max(1) as f64;
        let share = focus.map_or(1.0, |focus| Aimed::new(model, Some(&focus)).inner_share());
        let bright = brightest(model, &unshot, &Inside::of(model, focus.as_ref()), total * share);
        let (mut sources, mut sides) = (Vec::new(), Vec::new());
        for triangle in model.scene.triangle_ids() {
            let (corners, front) = (model.scene.corners(triangle), model.scene.normal(triangle));
            let patches = model.mesh.patches_of(triangle);
            // A face that is one patch has several triangles.
            let part = model.scene.area(triangle) / (patches.len() as f64 * model.mesh.patch_area(triangle));
            for patch in patches.map(PatchId) {
                for (side, normal) in [(Side::Front, front), (Side::Back, -front)] {
                    let Some(id) = model.mesh.side_of(triangle, patch, side) else { continue };
                    if bright[id.index()] {
                        let corners = model.mesh.patch_corners(triangle, patch).map(|b| b.point(corners));
                        let power = shot.unit.watts(unshot[id.index()]).max(Rgb::ZERO) * part;
                        let emitter =
                            Emitter::Surface { triangle, patch: Some(patch), side, corners, normal };
                        sources.push(Source { emitter, power });
                        sides.push(id);
                    }
                }
            }
        }
        let lines = if sources.is_empty() { 0 } else { lines };
        let lines = FirstShot::of(model, Aimed::plain(sources), shot.unit, lines, seed, Stage::SECOND_SHOT);
        Self { lines, sides }
    }

    /// The lines, which are traced as those of a first shot. There are none if nothing reflects.
    #[must_use]
    pub fn lines(&self) -> &FirstShot<'m> {
        &self.lines
    }

    /// Closes the books once all lines are traced: the light of both shots, and what patches have still to send. `shot` is the
    /// first one.
    ///
    /// # Errors
    ///
    /// If a tally overflowed.
    pub fn finish(self, shot: Shot, tally: FirstShotTally, books: Books) -> Result<Shot, SolveError> {
        let (Self { lines, sides }, Shot { received, sent, .. }) = (self, shot);
        let shot = lines.add(received, tally, books)?;
        let mut all = sent;
        for (side, power) in sides.into_iter().zip(lines.sent()) {
            match all.last_mut() {
                Some((last, sum)) if *last == side => *sum += power,
                _ => all.push((side, power)),
            }
        }
        Ok(Shot { sent: all, ..shot })
    }
}

/// Which sides are the brightest ones `inside` that hold `total` together, or all that hold something.
fn brightest(model: &Model, unshot: &[Quanta], inside: &Inside, total: f64) -> Vec<bool> {
    let mut sides = Vec::new();
    model.mesh.for_each_side(|triangle, _, _, side| {
        let power = unshot[side.index()].total();
        if power > 0.0 && inside.has(side) {
            sides.push((power / model.area(triangle, side), power, side));
        }
    });
    sides.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.2.cmp(&b.2)));
    let (mut bright, mut held) = (vec![false; unshot.len()], 0.0);
    for (_, power, side) in sides {
        if held >= total {
            break;
        }
        held += power;
        bright[side.index()] = true;
    }
    bright
}
