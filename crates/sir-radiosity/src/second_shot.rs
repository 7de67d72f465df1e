//! The second shot: local lines from the brightest patches, which send what these reflect of the first shot.
//!
//! Castro, Martínez and Sbert (1998) call it an extended first shot. The power that a global line carries is in
//! proportion to the radiosity of the patch that it leaves. Where light falls on a wall from nearby, the wall is as
//! bright as a lamp, and its global lines cause most of the noise of all surfaces that see it. Local lines carry the
//! same power from everywhere.
//!
//! By default, the ratio of the power of the brightest patches to the power of all sources is that of the lines of this
//! shot to the lines of the first shot. A line of this shot then carries as much power as a line of the first shot.

use sir_geom::{Rgb, TriangleId};
use sir_lines::Purpose;
use sir_mesh::SideId;

use crate::error::SolveError;
use crate::focus_sides::FocusSides;
use crate::local_shot::{LocalShot, ShotInput, ShotSources};
use crate::model::Model;
use crate::patch_side::PatchSide;
use crate::power::Quanta;
use crate::shot::{Shot, ShotSettings};
use crate::sources::FocusedSources;
use crate::visitor::Visitor;
use crate::workers::{BLOCK, Sides, Workers, map_sides, no_items};

/// The second shot: lines from the brightest patches; with the focus of the first shot, from the brightest patches in
/// it. There are no lines if nothing reflects.
pub type SecondShot<'m> = LocalShot<'m, Shot, PatchSide>;

impl ShotInput<PatchSide> for Shot {
    const NAME: &'static str = "second shot";
    const KIND: u64 = 4;
    const PURPOSE: Purpose = Purpose::SECOND_SHOT;

    fn sources(
        &self,
        settings: &ShotSettings<'_>,
        workers: &dyn Workers,
    ) -> Result<ShotSources<PatchSide>, SolveError> {
        let ShotSettings { model, lines, reflected_share, .. } = settings;
        let unshot = self.unshot(model, workers);
        let focus = lines.focus.as_ref();
        let in_focus = FocusSides::of(model, focus);
        let total = match reflected_share {
            // All of it, whatever the rounding of sums.
            Some(1.0) => f64::INFINITY,
            Some(share) => share * held(model, &unshot, &in_focus, workers),
            None => {
                let of_first = |focus| FocusedSources::new(model, Some(focus), self.counts.lines);
                let share = focus.map_or(1.0, |focus| of_first(focus).inner_share());
                let ratio = lines.count as f64 / self.counts.lines.max(1) as f64;
                self.balance.emitted.total() * ratio * share
            }
        };
        let bright = brightest(model, &unshot, &in_focus, total, workers);
        let blocks = bright_sides(model, self, &unshot, &bright, workers);
        let all = || blocks.iter().flatten();
        let (sources, sides) = all().map(|bright| (bright.place, bright.id)).unzip();
        let powers: Vec<Rgb> = all().map(|bright| bright.power).collect();
        let weights = powers.iter().map(|power| power.element_sum()).collect();
        Ok(ShotSources { sources, powers, weights, density: 1.0, sides, unit: self.unit })
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        Self::visit(self, visitor);
    }

    fn restore(model: &Model, visitor: &mut dyn Visitor) -> Self {
        Self::restore(model, visitor)
    }

    fn into_shot(self, _model: &Model) -> Shot {
        self
    }
}

/// A bright side.
struct BrightSide {
    place: PatchSide,
    id: SideId,
    /// Power that it still has to send \[W\].
    power: Rgb,
}

/// Returns the bright sides, in blocks.
fn bright_sides(
    model: &Model,
    shot: &Shot,
    unshot: &[Quanta],
    bright: &[bool],
    workers: &dyn Workers,
) -> Vec<Vec<BrightSide>> {
    map_sides(workers, &model.mesh, no_items(), |sides, ()| {
        let bright = sides.iter().filter(|(_, id)| bright[id.index()]);
        let with_power = |(triangle, id): (TriangleId, SideId)| {
            let power = shot.unit.watts(unshot[id.index()]).max(Rgb::ZERO);
            BrightSide { place: PatchSide::of(model, triangle, id), id, power }
        };
        bright.map(with_power).collect()
    })
}

/// Returns the power that the sides in the focus hold together.
fn held(model: &Model, unshot: &[Quanta], in_focus: &FocusSides, workers: &dyn Workers) -> f64 {
    let of_block = |sides: Sides<'_>, unshot: &[Quanta]| {
        let sides = sides.iter().zip(unshot).filter(|((_, side), _)| in_focus.contains(*side));
        sides.map(|(_, unshot)| unshot.total().max(0.0)).sum::<f64>()
    };
    map_sides(workers, &model.mesh, unshot.chunks(BLOCK), of_block).into_iter().sum()
}

/// Returns, per side, true if it is one of the brightest sides in the focus that hold `total` together. If all sides
/// together hold less, all that hold power are bright.
fn brightest(
    model: &Model,
    unshot: &[Quanta],
    in_focus: &FocusSides,
    total: f64,
    workers: &dyn Workers,
) -> Vec<bool> {
    let holds = |side: SideId| unshot[side.index()].total() > 0.0 && in_focus.contains(side);
    let mut bright: Vec<bool> = (0..unshot.len()).map(|side| holds(SideId::new(side))).collect();
    if total == f64::INFINITY {
        return bright;
    }
    let sides = map_sides(workers, &model.mesh, no_items(), |sides, ()| {
        let sides = sides.iter().filter(|(_, side)| bright[side.index()]);
        let with_radiosity = |(triangle, side): (TriangleId, SideId)| {
            let power = unshot[side.index()].total();
            (power / model.area(triangle, side), power, side)
        };
        sides.map(with_radiosity).collect::<Vec<_>>()
    });
    let mut sides = sides.concat();
    sides.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.2.cmp(&b.2)));
    let mut held = 0.0;
    for (_, power, side) in sides {
        bright[side.index()] = held < total;
        held += power;
    }
    bright
}
