//! Frozen batches: global lines pass on what the batch before them has brought.
//!
//! While the lines of a batch are traced, what each side sends with a line is fixed, and what they bring is only added up;
//! the next batch sends it on. So the lines of a batch may be traced in any order and by any number of workers, and the
//! result does not depend on it. It is stochastic iteration (Szirmay-Kalos 1999, *Stochastic iteration for
//! non-diffuse global illumination*) along global lines, with four refinements:
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
//! * *The tail is stretched.* What is still unshot at the end would be received much as was the power sent after the sources
//!   had ceased. Let there have been `L₀` unshot at that time and `L` at the end: then the power received since is
//!   multiplied by `1 + L/(L₀ − L)`, so that all power is accounted for.

use std::ops::{AddAssign, Range};

use sir_geom::TriangleId;
use sir_lines::{Domain, Stage, Streams};
use sir_mesh::SideId;

use crate::global;
use crate::ledger::{Counters, Ledger, SquareUnit};
use crate::segments::End;
use crate::state::{from_word, to_word, visit_counts, visit_float, visit_slice};
use crate::{
    Balance, Books, Model, PowerUnit, Quanta, Received, Shot, Solution, SolveError, Transported, Visitor,
};

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
    domain: Domain,
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
    /// Lines that have crossed it.
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
    /// Reflected direct power, in all.
    source: Quanta,
    /// Unshot power when the sources had ceased.
    ceased: Quanta,
    /// Sums over all batches so far; `unshot` is that of now.
    totals: Totals,
}

/// Sums over sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    unshot: Quanta,
    sent: Quanta,
    reflected: Quanta,
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
    domain: &'a Domain,
    ledger: &'a Ledger,
    plan: Plan,
    first: u32,
    accounts: &'a mut [Account],
}

impl<'m> Batches<'m> {
    /// Prepares the transport of the reflected direct power of a first shot along `lines` lines, for this number of
    /// workers: how many there are has no effect on the result, but on the time.
    #[must_use]
    pub fn new(model: &'m Model, shot: Shot, lines: u64, domain: Domain, seed: u64, workers: usize) -> Self {
        let unshot = shot.unshot(model);
        let Shot { received: direct, unit, balance, .. } = shot;
        let sides = model.mesh.side_count();
        let mut accounts = Vec::with_capacity(sides);
        let mut source = Quanta::ZERO;
        let forecast = domain.forecast(lines);
        let (mut area, mut square, mut most, mut brightest) = (0.0, 0.0, 0.0, [0.0; 3]);
        model.mesh.for_each_side(|triangle, _, _, side| {
            let reflectance = model.reflectance(triangle, side);
            let unshot = unshot[side.index()];
            source += unshot;
            accounts.push(Account { unshot, noted: unshot.0.map(|q| q as f32), ..Account::default() });
            let a = model.area(triangle, side);
            (area, square) = (area + a, square + a * a);
            let crossings = forecast.crossings(a);
            most = f64::max(most, crossings);
            for band in 0..3 {
                // All light that a side reflects, if what it sees is as bright, over all its crossings.
                let share = unshot.0[band] as f64 / (1.0 - reflectance[band]) / crossings;
                // Not a number, and not counted, for a patch that is all gap.
                brightest[band] = f64::max(brightest[band], share);
            }
        });
        let ledger = Ledger::new(sides, workers, 1, SquareUnit::new(brightest, most));
        // Lines that cross a typical patch once: typical of where the area is.
        let once = domain.surface() * area / (2.0 * square);
        let parts = (lines as f64 / once / CROSSINGS_PER_PART) as u64;
        let plan = Plan {
            lines,
            batch: [0; 2],
            number: 0,
            parts: parts.clamp(1, MOST_PARTS),
            least: (SMALLEST * once).ceil() as u64,
            guess: balance.unshot.total() / balance.emitted.total().max(1.0),
            source,
            ceased: Quanta::ZERO,
            totals: Totals { unshot: source, ..Totals::default() },
        };
        let plan = Plan { batch: [0, plan.next_lines()], ..plan };
        let streams = Streams::new(seed, Stage::GLOBAL);
        Self { model, domain, streams, ledger, direct, accounts, unit, plan }
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
        global::trace(self.model, &self.domain, &self.streams, lines, counts, soon, |_, segment| {
            match (segment.from, segment.to) {
                (End::Side(i, _), End::Side(j, _)) => page.exchange(i, j),
                (End::Side(i, _), End::Outside) | (End::Outside, End::Side(i, _)) => {
                    balance.escaped += page.leave(i);
                }
                (End::Side(i, _), End::Inactive) | (End::Inactive, End::Side(i, _)) => {
                    balance.blocked += page.leave(i);
                }
                _ => {}
            }
        });
    }

    /// Cuts the sides into at most `count` parts.
    pub fn parts(&mut self, count: usize) -> impl Iterator<Item = Part<'_>> {
        let Self { model, ref domain, ref ledger, ref mut accounts, plan, .. } = *self;
        let size = accounts.len().div_ceil(count.max(1)).max(1);
        accounts.chunks_mut(size).enumerate().map(move |(i, accounts)| {
            let first = (i * size) as u32;
            Part { model, domain, ledger, plan, first, accounts }
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
        self.plan.visit(visitor);
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
        let Self { model, domain, direct: mut received, ledger, accounts, unit, plan, .. } = self;
        let Books { balance: Balance { blocked, escaped, .. }, counts } = books;
        let Totals { unshot, absorbed, .. } = plan.totals;
        let balance = Balance { emitted: plan.source, absorbed, blocked, escaped, unshot };
        if !balance.closes() {
            return Err(SolveError::Unbalanced { stage: "multipath" });
        }
        let (forecast, stretch) = (domain.forecast(plan.lines), plan.stretch());
        let factor = |account: &Account, triangle, side| {
            account.factor(forecast.crossings(model.area(triangle, side)))
        };
        let (mut plain, mut corrected) = ([0.0; 3], [0.0; 3]);
        model.mesh.for_each_side(|triangle, _, _, side| {
            let account = &accounts[side.index()];
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
            let factor = factor(account, triangle, side);
            let (power, variance) = (&mut power[side.index()], &mut variance[side.index()]);
            let mut sum = Quanta::ZERO;
            for band in 0..3 {
                let [brought, tail, stretched] = account.stretched(band, stretch[band]);
                let factor = factor * scale(band);
                sum.0[band] = (factor * stretched).round() as i64;
                // Lines bring about the same at all times, so the squares of the tail are in proportion to its power.
                let share = if brought > 0.0 { (tail / brought).clamp(0.0, 1.0) } else { 0.0 };
                let longer = 1.0 - share + share * (1.0 + stretch[band]) * (1.0 + stretch[band]);
                let more = factor * factor * account.variance(stretched, longer * squares[band]);
                variance[band] = (f64::from(variance[band]) + more) as f32;
            }
            *power += sum;
            made_up += sum - account.brought;
        });
        let solution = Solution::new(model, &received, unit);
        Ok(Transported { solution, received, unit, balance, counts, made_up })
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
        let (source, held, sent) =
            (self.source.total(), self.totals.unshot.total(), self.totals.sent.total());
        let r = if sent > 0.0 { self.totals.reflected.total() / sent } else { self.guess };
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
        lines.min(1 << 31)
    }

    /// What is to be added to the power received in the tail for each unit of it, per band.
    fn stretch(&self) -> [f64; 3] {
        std::array::from_fn(|band| {
            let (before, after) = (self.ceased.0[band] as f64, self.totals.unshot.0[band] as f64);
            if after > 0.0 && after <= STRETCHABLE * before { after / (before - after) } else { 0.0 }
        })
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        // The other fields follow from the scene and the number of lines.
        let Self { batch: [start, end], number, guess, source, ceased, totals, .. } = self;
        visit_counts([start, end, number], visitor);
        visit_float(guess, visitor);
        let Totals { unshot, sent, reflected, absorbed } = totals;
        for quanta in [source, ceased, unshot, sent, reflected, absorbed] {
            visitor.same(&mut quanta.0);
        }
    }
}

impl<'a> Part<'a> {
    /// Sets what the sides of this part send with each line of the batch that begins.
    pub fn open(&mut self) {
        let forecast = self.domain.forecast(self.plan.batch[1] - self.plan.batch[0]);
        let withheld = self.plan.withheld();
        let ceased = self.plan.number == self.plan.parts;
        for (triangle, sides) in self.sides() {
            for i in sides {
                let expected = forecast.crossings(self.model.area(triangle, SideId(i)));
                let lines = expected + 1.0 + expected.sqrt() * expected.min(1.0);
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
                totals.unshot += account.unshot;
                totals.sent += sent;
                totals.reflected += reflected;
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
