//! Frozen batches: global lines pass on what the batch before them has brought.
//!
//! While the lines of a batch are traced, what each side sends with a line is fixed, and what they bring is only added up;
//! the next batch sends it on. So the lines of a batch may be traced in any order and by any number of workers, and the
//! result does not depend on it. It is stochastic iteration (Szirmay-Kalos 1999, *Stochastic iteration for
//! non-diffuse global illumination*) along global lines, with these refinements:
//!
//! * *Nothing is lost.* A side that holds the power `U` and expects `n` lines of a batch sends `U/q` with each, and what
//!   `c` lines did not take, `U − cU/q`, stays for the next batch. Among all `q`, `n + 1` leaves the smallest mean square:
//!   `E(1 − c/q)²` for a Poisson number `c` is then `1/(n+1)`. Here `q = n + 1 + √n` (less if `n < 1`), for few sides to
//!   be crossed so often that they send more than they hold: what stays is then negative, and takes back later what was
//!   sent too much.
//! * *Lines go where the power is.* The sources are sent out in `K` equal parts with the first `K` batches, and the number
//!   of lines of a batch is about in proportion to the power that it sends. The batches after those are the *tail*.
//! * *Lines are counted.* A side is crossed more or less often than it should be. Of the `C` lines that crossed it, each is
//!   as good as any other, so at the end the power that they brought is multiplied by the number of lines expected, `λ`, over `C`: a
//!   ratio estimator. Given `C`, which is Poisson, it is exact on average if `λ` is divided by `1 − exp(−λ)`, for the sides
//!   that no line crossed. What is left of the noise is that lines bring different amounts, and nothing where all bring the
//!   same. A factor for all sides, almost one, lets them receive in all what was sent.
//! * *A focus has more lines.* With one, lines that do not meet it are rarer by a whole number, which is their weight: so many times the
//!   share of a side leaves with such a line, and so many lines it counts for. Sides in the focus are only crossed by lines of weight 1, as if
//!   there were no others. Of the others, `n` is the number of lines as if all had the larger weight, and what they receive is not
//!   multiplied, since lines are not as good as each other. How many lines a batch has follows from the power in the focus.
//! * *The tail is stretched.* What is still unshot at the end would be received much as was the power sent after the sources
//!   had ceased. Let there have been `L₀` unshot at that time and `L` at the end: then the power received since is
//!   multiplied by `1 + L/(L₀ − L)`, so that all power is accounted for.

use std::ops::{AddAssign, Range};

use sir_geom::TriangleId;
use sir_lines::{GlobalLines, Stage, Streams};
use sir_mesh::SideId;

use crate::balance::{Balance, Books};
use crate::error::SolveError;
use crate::first_shot::Shot;
use crate::global;
use crate::inside::Inside;
use crate::ledger::{Counters, Ledger, Page, SquareUnit};
use crate::model::Model;
use crate::multipath::Transported;
use crate::power::{PowerUnit, Quanta};
use crate::received::Received;
use crate::segments::{End, Segment};
use crate::solution::Solution;
use crate::state::Visitor;
use crate::state::{from_word, to_word, visit_counts, visit_float, visit_slice};

/// Most parts in which the sources are sent out.
///
/// More parts spread the light of a source over more lines, to a limit that is nearly reached with 16, and cost an exchange
/// between ranks each.
const MOST_PARTS: u64 = 16;

/// Crossings of a typical patch that a batch with a part of the sources should have at least, for what it holds not to
/// be mere chance.
const CROSSINGS_PER_PART: f64 = 8.0;

/// How often the smallest batch crosses a typical patch. The smaller, the less of what the tail sends is held back.
const SMALLEST: f64 = 0.25;

/// Crossings of a typical patch that are kept for the tail, times the absorbed share of what is sent: what is unshot falls to
/// less than `exp(−RESERVE/2)`.
const RESERVE: f64 = 7.0;

/// Most of all lines that are kept for the tail.
const MOST_RESERVED: f64 = 0.75;

/// Into how many batches the reserve is cut at most.
const RESERVE_BATCHES: f64 = 32.0;

/// Share of the sources' power below which the unshot is not worth another batch.
const NEGLIGIBLE: f64 = 1e-5;

/// Largest share of the power unshot when the sources had ceased that may be left for the tail to be stretched.
const STRETCHABLE: f64 = 0.9;

/// A transport of power along global lines in frozen batches.
#[derive(Debug)]
pub struct Batches<'m> {
    model: &'m Model,
    lines: GlobalLines,
    /// Where the sequence of lines through the focus begins.
    offset: u64,
    inside: Inside,
    streams: Streams,
    /// What the lines of this batch bring, and the share of its power that each side sends with a line.
    ledger: Ledger,
    /// The direct light.
    direct: Received,
    accounts: Vec<Account>,
    unit: PowerUnit,
    plan: Plan,
}

/// What is noted of a side.
#[derive(Clone, Copy, Debug, Default)]
struct Account {
    /// Power that it holds.
    unshot: Quanta,
    /// Power that lines have brought.
    brought: Quanta,
    /// While the sources are sent out, what is to be sent of them; afterwards, as `brought` when they had ceased.
    noted: [f32; 3],
    /// Lines that have crossed it, by their weights.
    crossings: u64,
}

/// What is known of all batches so far, and follows for the next one.
#[derive(Clone, Copy, Debug)]
struct Plan {
    /// Lines of all batches together.
    lines: u64,
    /// The lines of this batch.
    batch: [u64; 2],
    /// Its number.
    number: u64,
    /// Parts in which the sources are sent out.
    parts: u64,
    /// Lines of the smallest batch.
    least: u64,
    /// Reflected power per power sent in the first shot.
    guess: f64,
    /// Most lines of a batch.
    most: u64,
    /// How much a side outside of the focus counts for the number of lines.
    outside: f64,
    /// Reflected direct power, in all.
    source: Sums,
    /// Unshot power when the sources had ceased.
    ceased: Sums,
    /// Sums over all batches so far; `unshot` is that of now.
    totals: Totals,
}

/// A sum over all sides, and over those in the focus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Sums {
    all: Quanta,
    inside: Quanta,
}

impl Sums {
    #[inline]
    fn add(&mut self, power: Quanta, inside: bool) {
        self.all += power;
        if inside {
            self.inside += power;
        }
    }

    /// The sum if sides outside of the focus count for so much.
    fn weighed(self, outside: f64) -> f64 {
        self.inside.total() + outside * (self.all - self.inside).total()
    }

    /// The sum over sides in the focus, or over the others.
    fn part(self, inside: bool) -> Quanta {
        if inside { self.inside } else { self.all - self.inside }
    }
}

impl AddAssign for Sums {
    fn add_assign(&mut self, other: Self) {
        self.all += other.all;
        self.inside += other.inside;
    }
}

/// Sums over sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    unshot: Sums,
    sent: Sums,
    reflected: Sums,
    absorbed: Quanta,
}

impl AddAssign for Totals {
    fn add_assign(&mut self, other: Self) {
        self.unshot += other.unshot;
        self.sent += other.sent;
        self.reflected += other.reflected;
        self.absorbed += other.absorbed;
    }
}

/// Some consecutive sides between two batches. All parts together have all sides, and may be worked on at the same time.
#[derive(Debug)]
pub struct Part<'a> {
    model: &'a Model,
    lines: &'a GlobalLines,
    inside: &'a Inside,
    ledger: &'a Ledger,
    plan: Plan,
    first: u32,
    accounts: &'a mut [Account],
}

impl<'m> Batches<'m> {
    /// Prepares the transport of the reflected direct power of a first shot along `lines` lines, drawn `through` a domain or also a
    /// focus, for this number of workers: how many there are has no effect on the result, but on the time.
    #[must_use]
    pub fn new(
        model: &'m Model,
        shot: Shot,
        lines: u64,
        through: impl Into<GlobalLines>,
        seed: u64,
        workers: usize,
    ) -> Self {
        let through = through.into();
        let inside = Inside::of(model, through.focus());
        let unshot = shot.unshot(model);
        let Shot { received: direct, unit, balance, .. } = shot;
        let sides = model.mesh.side_count();
        let mut accounts = Vec::with_capacity(sides);
        let mut source = Sums::default();
        let forecast = through.forecast(lines);
        let (mut area, mut square, mut most, mut brightest) = (0.0, 0.0, 0.0, [0.0; 3]);
        model.mesh.for_each_side(|triangle, _, _, side| {
            let reflectance = model.reflectance(triangle, side);
            let unshot = unshot[side.index()];
            let is_inside = inside.has(side);
            source.add(unshot, is_inside);
            accounts.push(Account { unshot, noted: unshot.0.map(|q| q as f32), ..Account::default() });
            let a = model.area(triangle, side);
            let crossings = forecast.crossings(a);
            let weight = if is_inside { 1.0 } else { f64::from(through.weight()) };
            if is_inside || inside.is_empty() {
                (area, square) = (area + a, square + a * a);
            }
            // Lines are fewer than their weights, and cross it once.
            most = f64::max(most, if is_inside { crossings } else { crossings.min(lines as f64) });
            for band in 0..3 {
                // All light that a side reflects, if what it sees is as bright, over all its crossings.
                let share = weight * (unshot.0[band] as f64 / (1.0 - reflectance[band]) / crossings);
                // Not a number, and not counted, for a patch that is all gap.
                brightest[band] = f64::max(brightest[band], share);
            }
        });
        let ledger = Ledger::new(sides, workers, 1, SquareUnit::new(brightest, most));
        // Lines that cross a typical patch once: typical of where the area is.
        let once = forecast.surface * area / (2.0 * square);
        let parts = (lines as f64 / once / CROSSINGS_PER_PART) as u64;
        let plan = Plan {
            lines,
            batch: [0; 2],
            number: 0,
            parts: parts.clamp(1, MOST_PARTS),
            least: (SMALLEST * once).ceil() as u64,
            guess: balance.unshot.total() / balance.emitted.total().max(1.0),
            source,
            most: through.most(),
            outside: 1.0 / f64::from(through.weight()),
            ceased: Sums::default(),
            totals: Totals { unshot: source, ..Totals::default() },
        };
        let plan = Plan { batch: [0, plan.next_lines()], ..plan };
        let streams = Streams::new(seed, Stage::GLOBAL);
        let offset = Streams::new(seed, Stage::ALLOCATION).line(Stage::GLOBAL.0 - Stage::FIRST_SHOT.0).unit();
        let offset = (offset * 2f64.powi(64)) as u64;
        Self { model, lines: through, offset, inside, streams, ledger, direct, accounts, unit, plan }
    }

    /// The lines of the current batch. Each of them is traced once, by whomever, when all parts have been
    /// [opened](Part::open).
    #[must_use]
    pub fn lines(&self) -> Range<u64> {
        self.plan.batch[0]..self.plan.batch[1]
    }

    /// Number of the current batch, from 0; at the end, that of the last one.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.plan.number
    }

    /// Traces some lines of the current batch; `worker` is the number of who does.
    pub fn trace(&self, worker: usize, lines: Range<u64>, books: &mut Books) {
        let Books { balance, counts } = books;
        let page = self.ledger.page(worker);
        let soon = |side| page.prefetch(side);
        let draw = |index| self.lines.line(index, self.offset, self.streams.line(index).point());
        if self.lines.focus().is_none() {
            // The weight is known, and costs nothing.
            global::trace(self.model, draw, lines, counts, soon, |_, _, segment| {
                pass(page, balance, segment, 1);
            });
        } else {
            global::trace(self.model, draw, lines, counts, soon, |_, weight, segment| {
                pass(page, balance, segment, weight);
            });
        }
    }

    /// Cuts the sides into at most `count` parts.
    pub fn parts(&mut self, count: usize) -> impl Iterator<Item = Part<'_>> {
        let Self { model, ref lines, ref inside, ref ledger, ref mut accounts, plan, .. } = *self;
        let size = accounts.len().div_ceil(count.max(1)).max(1);
        accounts.chunks_mut(size).enumerate().map(move |(i, accounts)| {
            let first = (i * size) as u32;
            Part { model, lines, inside, ledger, plan, first, accounts }
        })
    }

    /// Goes on to the next batch, when all lines of the current one are traced and all parts have been
    /// [closed](Part::close). Returns whether there is one.
    pub fn advance(&mut self, closed: Totals) -> bool {
        let plan = &mut self.plan;
        plan.totals += closed;
        plan.totals.unshot = closed.unshot;
        let [_, end] = plan.batch;
        if end >= plan.lines {
            return false;
        }
        plan.number += 1;
        if plan.number == plan.parts {
            plan.ceased = plan.totals.unshot;
        }
        plan.batch = [end, end];
        plan.batch[1] += plan.next_lines();
        true
    }

    /// Shows what the lines of the current batch have brought to a visitor, as far as the next batch depends on it.
    pub fn visit_batch(&mut self, visitor: &mut dyn Visitor) {
        self.ledger.visit(Counters::Batch, visitor);
    }

    /// Shows what only the standard errors depend on to a visitor.
    pub fn visit_squares(&mut self, visitor: &mut dyn Visitor) {
        self.ledger.visit(Counters::Squares, visitor);
    }

    /// Shows the state of the stage to a visitor.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.unit.visit(visitor);
        self.plan.visit(!self.inside.is_all(), visitor);
        self.ledger.visit_unit(visitor);
        self.ledger.visit(Counters::All, visitor);
        self.ledger.visit_shares(visitor);
        self.direct.visit(visitor);
        Account::visit(&mut self.accounts, visitor);
    }

    /// Closes the books when there is no further batch; `books` are those of all workers.
    ///
    /// # Errors
    ///
    /// If a tally overflowed.
    pub fn finish(self, books: Books) -> Result<Transported, SolveError> {
        let Self { model, lines, inside, direct: mut received, ledger, accounts, unit, plan, .. } = self;
        let Books { balance: Balance { blocked, escaped, .. }, counts } = books;
        let Totals { unshot, absorbed, .. } = plan.totals;
        let balance = Balance { emitted: plan.source.all, absorbed, blocked, escaped, unshot: unshot.all };
        if !balance.closes() {
            return Err(SolveError::Unbalanced { stage: "multipath" });
        }
        let (forecast, stretches) =
            (lines.forecast(plan.lines), [false, true].map(|inside| plan.stretch(inside)));
        let factor = |account: &Account, triangle, side| {
            account.factor(forecast.crossings(model.area(triangle, side)))
        };
        let (mut plain, mut corrected) = ([0.0; 3], [0.0; 3]);
        model.mesh.for_each_side(|triangle, _, _, side| {
            if !inside.has(side) {
                return;
            }
            let (account, [_, stretch]) = (&accounts[side.index()], stretches);
            let factor = factor(account, triangle, side);
            for band in 0..3 {
                let [_, _, power] = account.stretched(band, stretch[band]);
                plain[band] += power;
                corrected[band] += factor * power;
            }
        });
        let scale = |band| if corrected[band] > 0.0 { plain[band] / corrected[band] } else { 1.0 };
        let mut made_up = Quanta::ZERO;
        let Received { power, variance } = &mut received;
        model.mesh.for_each_side(|triangle, _, _, side| {
            let (account, squares) = (&accounts[side.index()], ledger.squares(side));
            // Where lines have different weights, they are not corrected.
            let is_inside = inside.has(side);
            let factor = if is_inside { factor(account, triangle, side) } else { 1.0 };
            let stretch = stretches[usize::from(is_inside)];
            let (power, variance) = (&mut power[side.index()], &mut variance[side.index()]);
            let mut sum = Quanta::ZERO;
            for band in 0..3 {
                let [brought, tail, stretched] = account.stretched(band, stretch[band]);
                let factor = if is_inside { factor * scale(band) } else { 1.0 };
                sum.0[band] = (factor * stretched).round() as i64;
                // Lines bring about the same at all times, so the squares of the tail are in proportion to its power.
                let share = if brought > 0.0 { (tail / brought).clamp(0.0, 1.0) } else { 0.0 };
                let longer = 1.0 - share + share * (1.0 + stretch[band]) * (1.0 + stretch[band]);
                let squares = longer * squares[band];
                let spread = if is_inside { account.variance(stretched, squares) } else { squares };
                let more = factor * factor * spread;
                variance[band] = (f64::from(variance[band]) + more) as f32;
            }
            *power += sum;
            made_up += sum - account.brought;
        });
        let solution = Solution::new(model, &received, unit);
        Ok(Transported { solution, received, unit, balance, counts, made_up })
    }
}

/// What a line of some weight does along a segment.
#[inline]
fn pass(page: Page<'_>, balance: &mut Balance, segment: Segment, weight: u32) {
    match (segment.from, segment.to) {
        (End::Side(i, _), End::Side(j, _)) => page.exchange(i, j, weight),
        (End::Side(i, _), End::Outside) | (End::Outside, End::Side(i, _)) => {
            balance.escaped += page.leave(i, weight);
        }
        (End::Side(i, _), End::Inactive) | (End::Inactive, End::Side(i, _)) => {
            balance.blocked += page.leave(i, weight);
        }
        _ => {}
    }
}

impl Account {
    /// What is to be multiplied with the power that lines have brought, for the number of lines expected.
    fn factor(&self, expected: f64) -> f64 {
        if self.crossings == 0 { 1.0 } else { expected / -(-expected).exp_m1() / self.crossings as f64 }
    }

    /// The power that lines have brought, the part of it in the tail, and all with the tail stretched.
    fn stretched(&self, band: usize, stretch: f64) -> [f64; 3] {
        let brought = self.brought.0[band] as f64;
        let tail = brought - f64::from(self.noted[band]);
        [brought, tail, brought + tail * stretch]
    }

    /// Variance of the power that lines have brought, given their number: in all `sum`, with the sum of `squares`.
    fn variance(&self, sum: f64, squares: f64) -> f64 {
        let lines = self.crossings as f64;
        if lines < 2.0 { squares } else { (squares - sum * sum / lines).max(0.0) * lines / (lines - 1.0) }
    }

    /// Shows the accounts of all sides to a visitor.
    fn visit(accounts: &mut [Self], visitor: &mut dyn Visitor) {
        visit_slice(
            accounts,
            visitor,
            |account| {
                let Self { unshot: Quanta([a, b, c]), brought: Quanta([d, e, f]), noted, crossings } =
                    *account;
                let [g, h, i] = noted.map(to_word);
                [a, b, c, d, e, f, g, h, i, crossings as i64]
            },
            |[a, b, c, d, e, f, g, h, i, crossings]| Self {
                unshot: Quanta([a, b, c]),
                brought: Quanta([d, e, f]),
                noted: [g, h, i].map(from_word),
                crossings: crossings as u64,
            },
        );
    }
}

impl Plan {
    /// Share of the sources' power that is kept for later batches.
    fn withheld(&self) -> f64 {
        (1.0 - (self.number + 1) as f64 / self.parts as f64).max(0.0)
    }

    /// How many lines the batch that begins now should have.
    ///
    /// Of each unit of power sent, `r` is reflected and has to be sent again. Some lines are kept in reserve, and the rest is
    /// shared in proportion to power, for the same relative error in all that is sent: `1/(1−r)` for each unit held. In
    /// the tail the number of lines falls off more slowly, with the square root of the power, for less to be left at the
    /// end. (With its fourth root still less is left, but where light is smooth the noise grows by 13 %.) The tail ends
    /// with the reserve, in small batches.
    fn next_lines(&self) -> u64 {
        let (left, least) = (self.lines - self.batch[0], self.least as f64);
        let weighed = |sums: Sums| sums.weighed(self.outside);
        let (source, held, sent) =
            (weighed(self.source), weighed(self.totals.unshot), weighed(self.totals.sent));
        let r = if sent > 0.0 { weighed(self.totals.reflected) / sent } else { self.guess };
        let sends = |r: f64| 1.0 / (1.0 - r);
        let r = r.clamp(0.0, 0.999);

        let emitting = self.number < self.parts;
        let in_tail = if emitting { source / self.parts as f64 * r * sends(r) } else { held };
        let still_to_send = held * sends(r) + in_tail * (sends(r.sqrt()) - sends(r));
        let reserve = (RESERVE / SMALLEST * least * sends(r)).min(MOST_RESERVED * self.lines as f64);
        let shared = (left as f64 - reserve).max(0.0);
        let wanted = shared * (held - self.withheld() * source) / still_to_send;

        let over = !emitting && held <= NEGLIGIBLE * source;
        let wanted = wanted.max(reserve / RESERVE_BATCHES).max(least);
        let lines = if over { left } else { left.min(wanted as u64) };
        let lines = if left - lines < self.least { left } else { lines };
        // Crossings of a side are counted in 32 bits.
        lines.min(self.most)
    }

    /// What is to be added to the power received in the tail for each unit of it, per band.
    /// The power left in the focus is taken to spread in it, and that left elsewhere likewise.
    fn stretch(&self, inside: bool) -> [f64; 3] {
        let [ceased, unshot] = [self.ceased, self.totals.unshot].map(|sums| sums.part(inside));
        std::array::from_fn(|band| {
            let (before, after) = (ceased.0[band] as f64, unshot.0[band] as f64);
            if after > 0.0 && after <= STRETCHABLE * before { after / (before - after) } else { 0.0 }
        })
    }

    fn visit(&mut self, focused: bool, visitor: &mut dyn Visitor) {
        // The other fields follow from the scene and the number of lines.
        let Self { batch: [start, end], number, guess, source, ceased, totals, .. } = self;
        visit_counts([start, end, number], visitor);
        visit_float(guess, visitor);
        let Totals { unshot, sent, reflected, absorbed } = totals;
        for sums in [source, ceased, unshot, sent, reflected] {
            visitor.same(&mut sums.all.0);
            if focused {
                visitor.same(&mut sums.inside.0);
            } else {
                sums.inside = sums.all;
            }
        }
        visitor.same(&mut absorbed.0);
    }
}

impl<'a> Part<'a> {
    /// Sets what the sides of this part send with each line of the batch that begins.
    pub fn open(&mut self) {
        let forecast = self.lines.forecast(self.plan.batch[1] - self.plan.batch[0]);
        let heavy = f64::from(self.lines.weight());
        let withheld = self.plan.withheld();
        let ceased = self.plan.number == self.plan.parts;
        for (triangle, sides) in self.sides() {
            for i in sides {
                let weight = if self.inside.has(SideId(i)) { 1.0 } else { heavy };
                let expected = forecast.crossings(self.model.area(triangle, SideId(i))) / weight;
                let lines = weight * (expected + 1.0 + expected.sqrt() * expected.min(1.0));
                let k = (i - self.first) as usize;
                let account = &mut self.accounts[k];
                if ceased {
                    account.noted = account.brought.0.map(|q| q as f32);
                }
                let kept = |band: usize| withheld * f64::from(account.noted[band]);
                let share = |band: usize| (account.unshot.0[band] as f64 - kept(band)) / lines;
                self.ledger.set_share(SideId(i), [0, 1, 2].map(share));
            }
        }
    }

    /// Books what the lines of the batch that ends have brought to the sides of this part, and taken from them.
    pub fn close(&mut self) -> Totals {
        let mut totals = Totals::default();
        for (triangle, sides) in self.sides() {
            for i in sides {
                let side = SideId(i);
                let reflectance = self.model.reflectance(triangle, side);
                let (power, crossings) = self.ledger.take(side);
                let sent = self.ledger.share(side).times(i64::from(crossings));
                let reflected = power.scaled(reflectance);
                let account = &mut self.accounts[(i - self.first) as usize];
                account.brought += power;
                account.unshot += reflected - sent;
                account.crossings += u64::from(crossings);
                let inside = self.inside.has(side);
                totals.unshot.add(account.unshot, inside);
                totals.sent.add(sent, inside);
                totals.reflected.add(reflected, inside);
                totals.absorbed += power - reflected;
            }
        }
        totals
    }

    /// The sides of this part: triangles, and consecutive sides of each.
    fn sides(&self) -> impl Iterator<Item = (TriangleId, Range<u32>)> + use<'a> {
        self.model.mesh.sides_within(self.first..self.first + self.accounts.len() as u32)
    }
}
