//! The second shot: the brightest patches send what they reflect of the first one along local lines, too.
//!
//! Castro, Martínez and Sbert (1998) call it an extended first shot. A global line carries as much as the patch that it leaves is
//! bright; where light falls on a wall from nearby, it is as bright as a lamp, and what it sends makes most of the noise of all that
//! see it. Local lines carry the same from everywhere. The brightest patches are those whose power is to all the power of the
//! sources as the lines of this shot are to those of the first: then a line carries as much as a line of the first shot.

use std::ops::Range;

use sir_geom::{Rgb, Side};
use sir_lines::Purpose;
use sir_mesh::{PatchId, SideId};

use crate::emitter::Emitter;
use crate::error::SolveError;
use crate::focus_sides::FocusSides;
use crate::model::Model;
use crate::power::Quanta;
use crate::shot::{Shot, ShotSettings};
use crate::shot_lines::ShotLines;
use crate::sources::{FocusedSources, Source};
use crate::stage::{AnyOrder, Stage, Workers};
use crate::tallies::{Counters, PatchTallies};
use crate::totals::StageTotals;
use crate::visitor::Visitor;

/// The second shot: lines from the brightest patches; with a focus, that of the first shot, from those in it. There are no lines
/// if nothing reflects.
#[derive(Debug)]
pub struct SecondShot<'m> {
    /// The outcome of the first shot.
    first: Shot,
    lines: ShotLines<'m>,
    /// The side that each source of the lines is, or is a part of.
    sides: Vec<SideId>,
    tallies: PatchTallies,
}

impl<'m> Stage for SecondShot<'m> {
    type Settings = ShotSettings<'m>;
    type Input = Shot;
    type Outcome = Shot;
    type Chain = AnyOrder;

    fn identity(settings: &Self::Settings) -> Vec<u64> {
        settings.identity(4)
    }

    fn begin(settings: Self::Settings, shot: Shot, workers: &dyn Workers) -> Result<Self, SolveError> {
        let ShotSettings { model, lines, seed } = settings;
        let unshot = shot.unshot(model);
        let total = shot.balance.emitted.total() * lines.count as f64 / shot.counts.lines.max(1) as f64;
        let focus = lines.focus.as_ref();
        let share = focus.map_or(1.0, |focus| FocusedSources::new(model, Some(focus)).inner_share());
        let bright = brightest(model, &unshot, &FocusSides::of(model, focus), total * share);
        let (sources, sides) = sources_of(model, &shot, &unshot, &bright);
        let count = if sources.is_empty() { 0 } else { lines.count };
        let sources = FocusedSources::plain(sources);
        let lines = ShotLines::new(model, sources, shot.unit, count, seed, Purpose::SECOND_SHOT);
        let tallies = lines.tallies(workers.count());
        Ok(Self { first: shot, lines, sides, tallies })
    }

    fn restore(
        settings: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError> {
        // Which patches are bright follows from the first shot.
        let first = Shot::restore(settings.model, visitor);
        let stage = Self::begin(settings, first, workers)?;
        stage.tallies.visit(Counters::All, visitor);
        Ok(stage)
    }

    fn round(&self) -> Range<u64> {
        0..self.lines.lines()
    }

    fn chain(&self, _number: u64) -> AnyOrder {
        AnyOrder
    }

    fn trace(&self, worker: usize, _chain: &mut AnyOrder, lines: Range<u64>, totals: &mut StageTotals) {
        self.lines.trace(worker, lines, &self.tallies, totals);
    }

    fn visit_round(&mut self, visitor: &mut dyn Visitor) {
        self.tallies.visit(Counters::All, visitor);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.first.visit(visitor);
        self.tallies.visit(Counters::All, visitor);
    }

    /// Returns the light of both shots, and what patches have still to send.
    fn finish(self, totals: StageTotals) -> Result<Shot, SolveError> {
        let Self { first: Shot { received, sent: mut all, .. }, lines, sides, tallies } = self;
        let both = lines.add_to(received, &tallies, totals)?;
        for (side, power) in sides.into_iter().zip(lines.sent()) {
            match all.last_mut() {
                Some((last, sum)) if *last == side => *sum += power,
                _ => all.push((side, power)),
            }
        }
        Ok(Shot { sent: all, ..both })
    }
}

/// Returns the patches of the bright sides as sources of what they have still to send, with the side of each.
fn sources_of(model: &Model, shot: &Shot, unshot: &[Quanta], bright: &[bool]) -> (Vec<Source>, Vec<SideId>) {
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
                    let emitter = Emitter::Surface { triangle, patch: Some(patch), side, corners, normal };
                    sources.push(Source { emitter, power });
                    sides.push(id);
                }
            }
        }
    }
    (sources, sides)
}

/// Returns, per side, whether it is one of the brightest in the focus that hold `total` together, or of all that hold something.
fn brightest(model: &Model, unshot: &[Quanta], in_focus: &FocusSides, total: f64) -> Vec<bool> {
    let mut sides = Vec::new();
    model.mesh.for_each_side(|triangle, _, _, side| {
        let power = unshot[side.index()].total();
        if power > 0.0 && in_focus.contains(side) {
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
