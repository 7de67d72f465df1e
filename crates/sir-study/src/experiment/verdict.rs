//! What the paper claims, and whether the numbers here agree.
//!
//! Every verdict follows from measured numbers by a rule that the report states.

use serde::Serialize;

use crate::experiment::bodies::Bodies;
use crate::experiment::farm::Farm;
use crate::experiment::markdown::{percent, signed_percent, whole_percent};
use crate::experiment::mix::{Best, Mix};
use crate::experiment::paper::{BEST_SHARE, EFFICIENCY, EMPTY_SHARE, P, SPHERE_TO_BOX};
use crate::experiment::speed::Speed;
use crate::experiment::spread::Unevenness;
use crate::scaling::study::Row;

/// Whether a claim holds here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Verdict {
    /// The numbers agree with it.
    Confirmed,
    /// They do not.
    Refuted,
    /// There are not enough of them.
    Open,
}

/// A claim, and what was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Claim {
    /// What the paper says, in short.
    pub(crate) claim: String,
    /// What was found.
    pub(crate) here: String,
    /// Whether it agrees.
    pub(crate) verdict: Verdict,
    /// When it is taken to agree.
    pub(crate) rule: String,
}

/// How far an efficiency may be below the paper's.
const EFFICIENCY_SLACK: f64 = 0.05;

/// How much efficiencies may differ to be constant.
const CONSTANT: f64 = 0.1;

/// How many numbers of workers it takes to say that efficiency is constant.
const SEVERAL: usize = 3;

/// Largest share of a run that is little communication.
const LITTLE: f64 = 0.05;

/// How far a share of empty lines may be from the paper's.
const EMPTY_SLACK: f64 = 0.05;

/// How far a ratio of volumes may be from the paper's.
const VOLUME_SLACK: f64 = 0.1;

/// Largest deviation of the cost of one of eight shares of lines that are almost the same.
const EVEN: f64 = 0.01;

/// Largest loss of light that is none.
const NO_LOSS: f64 = 0.005;

impl Verdict {
    fn of(agrees: Option<bool>) -> Self {
        match agrees {
            Some(true) => Self::Confirmed,
            Some(false) => Self::Refuted,
            None => Self::Open,
        }
    }

    /// A word for people.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::Refuted => "not confirmed",
            Self::Open => "open",
        }
    }
}

fn claim(claim: String, rule: String, here: String, agrees: Option<bool>) -> Claim {
    Claim { claim, here, verdict: Verdict::of(agrees), rule }
}

/// Smallest and largest of some numbers.
fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, x| range.map_or(Some((x, x)), |(a, b): (f64, f64)| Some((a.min(x), b.max(x)))))
}

/// Claims about speed-up. Only rows with several workers, but not more than cores, say something of them.
pub(crate) fn of_speed(speed: &Speed) -> Vec<Claim> {
    let rows = || speed.study.rows.iter().filter(|row| row.p > 1 && !row.more_than_cores);
    let (threads, ranks): (Vec<&Row>, Vec<&Row>) = rows().partition(|row| row.workers.ranks.get() == 1);
    let mut claims = of_efficiency("threads", &threads);
    if !ranks.is_empty() {
        claims.extend(of_efficiency("ranks", &ranks));
    }
    let communication = range(ranks.iter().map(|row| row.communication.share));
    claims.push(claim(
        "communication costs very little".into(),
        format!("with ranks, it is at most {} of the whole run", whole_percent(LITTLE)),
        communication.map_or_else(
            || "not measured with ranks".into(),
            |(_, b)| format!("up to {} of the run, waiting included", percent(b)),
        ),
        communication.map(|(_, b)| b <= LITTLE),
    ));
    claims
}

/// Claims about the efficiency of one kind of workers.
fn of_efficiency(kind: &str, rows: &[&Row]) -> Vec<Claim> {
    let efficiencies = range(rows.iter().map(|row| row.whole.efficiency));
    let several = efficiencies.filter(|_| rows.len() >= SEVERAL);
    let numbers = rows.iter().map(|row| row.p.to_string()).collect::<Vec<_>>().join(", ");
    let too_few = || match rows.len() {
        0 => "measured with no more than one worker".to_owned(),
        _ => format!("measured for p = {numbers} only"),
    };
    let least = EFFICIENCY - EFFICIENCY_SLACK;
    vec![
        claim(
            format!(
                "efficiency is about {} for any number of processors up to {P} ({kind})",
                whole_percent(EFFICIENCY)
            ),
            format!(
                "the smallest efficiency of a whole run, with 2 workers or more but not more than cores, is \
                 at least {least:.2}"
            ),
            efficiencies.map_or_else(too_few, |(a, b)| {
                let values = if a == b { format!("{a:.2}") } else { format!("{a:.2} to {b:.2}") };
                format!("E = {values} for p = {numbers}")
            }),
            efficiencies.map(|(a, _)| a >= least),
        ),
        claim(
            format!("efficiency stays constant with more processors ({kind})"),
            format!(
                "the efficiencies of at least {SEVERAL} numbers of workers above 1 differ by at most {CONSTANT}"
            ),
            several.map_or_else(too_few, |(a, b)| format!("E differs by {:.2} for p = {numbers}", b - a)),
            several.map(|(a, b)| b - a <= CONSTANT),
        ),
    ]
}

/// Claims about the share of local lines.
pub(crate) fn of_mix(mix: &Mix) -> Vec<Claim> {
    let best = |what: &str, best: Option<Best>| {
        claim(
            format!("{} local lines give the best result, {what}", whole_percent(BEST_SHARE)),
            format!(
                "the error at {} local lines is at most 5 % above the smallest one",
                whole_percent(BEST_SHARE)
            ),
            best.map_or_else(|| "not measured".into(), |best| best.text()),
            best.map(|best| best.includes(BEST_SHARE)),
        )
    };
    vec![best("of equally many lines", mix.best_of_lines), best("in equal time", mix.best_of_time)]
}

/// Claims about the bounding sphere.
pub(crate) fn of_bodies(bodies: &Bodies) -> Vec<Claim> {
    let (empty, ratio) = (bodies.empty_in_sphere(), bodies.sphere_to_box);
    vec![
        claim(
            format!("{} of the lines through the bounding sphere miss the scene", whole_percent(EMPTY_SHARE)),
            format!("the share is within {} of it", whole_percent(EMPTY_SLACK)),
            empty.map_or_else(|| "not measured".into(), percent),
            empty.map(|share| (share - EMPTY_SHARE).abs() <= EMPTY_SLACK),
        ),
        claim(
            format!(
                "the volume of the bounding sphere is about {} above that of the bounding box",
                whole_percent(SPHERE_TO_BOX - 1.0)
            ),
            format!("the ratio of volumes is within {VOLUME_SLACK} of {SPHERE_TO_BOX}"),
            ratio.map_or_else(|| "the box is flat".into(), |ratio| format!("{} above", percent(ratio - 1.0))),
            ratio.map(|ratio| (ratio - SPHERE_TO_BOX).abs() <= VOLUME_SLACK),
        ),
    ]
}

/// The claim about the cost of lines.
pub(crate) fn of_spread(spread: &Unevenness) -> Vec<Claim> {
    vec![claim(
        "the cost of global lines differs much, but evens out over many of them".into(),
        format!(
            "none of {P} equal shares of the lines has crossings that differ from the mean by more than {}",
            whole_percent(EVEN)
        ),
        format!(
            "at most {} apart for {} lines each",
            percent(spread.largest()),
            super::markdown::count(spread.lines / P as u64)
        ),
        (!spread.shares.is_empty()).then(|| spread.largest() <= EVEN),
    )]
}

/// What the paper takes for granted about its replicas.
pub(crate) fn of_farm(farm: &Farm) -> Vec<Claim> {
    let bias = farm.bias(P as u64);
    vec![claim(
        format!("the mean of {P} replicas is as good as one solution with all lines (implied)"),
        format!("the reflected light of {P} replicas is that of the reference within {}", percent(NO_LOSS)),
        bias.map_or_else(
            || "too few lines".into(),
            |bias| format!("{} reflected light", signed_percent(bias)),
        ),
        bias.map(|bias| bias.abs() <= NO_LOSS),
    )]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scaling::study::{Study, Timing};
    use crate::scaling::workers::Plan;
    use std::num::NonZeroUsize;

    /// Verdicts on runs of 1, 2, … threads that take so long.
    fn verdicts(cores: usize, seconds: &[f64]) -> Vec<Verdict> {
        let threads: Vec<_> = (1..=seconds.len()).filter_map(NonZeroUsize::new).collect();
        let plan = Plan::each(&[NonZeroUsize::MIN], &threads, NonZeroUsize::MIN);
        let timing = |&whole: &f64| {
            vec![Timing { first_shot: None, multipath: None, whole, sequential: 0.0, communication: 0.0 }]
        };
        let timings: Vec<_> = seconds.iter().map(timing).collect();
        let study = Study::new("x", cores, &plan, &timings);
        let speed = Speed { study, stages: Vec::new(), published: None };
        of_speed(&speed).iter().map(|claim| claim.verdict).collect()
    }

    #[test]
    fn efficiencies_decide() {
        use Verdict::{Confirmed, Open, Refuted};
        assert_eq!(verdicts(4, &[12.0, 6.5, 4.4, 3.4]), [Confirmed, Confirmed, Open]);
        assert_eq!(verdicts(4, &[12.0, 6.5, 5.5, 4.5]), [Refuted, Refuted, Open]);
        // Two numbers of workers are no trend, and more workers than cores say nothing.
        assert_eq!(verdicts(2, &[12.0, 6.5, 6.0, 6.0]), [Confirmed, Open, Open]);
        assert_eq!(verdicts(1, &[12.0]), [Open, Open, Open]);
    }

    #[test]
    fn ranks_are_judged_by_themselves() {
        let numbers = [1, 2].map(|n| NonZeroUsize::new(n).unwrap());
        let plan = Plan::each(&numbers, &numbers, NonZeroUsize::MIN);
        let timing = |whole, communication| {
            vec![Timing { first_shot: None, multipath: None, whole, sequential: 0.0, communication }]
        };
        // One worker, two threads, two ranks.
        let timings = [timing(10.0, 0.0), timing(5.5, 0.0), timing(8.0, 0.3)];
        let speed = Speed { study: Study::new("x", 2, &plan, &timings), stages: Vec::new(), published: None };
        let verdicts: Vec<_> = of_speed(&speed).iter().map(|claim| claim.verdict).collect();
        use Verdict::{Confirmed, Open, Refuted};
        assert_eq!(verdicts, [Confirmed, Open, Refuted, Open, Confirmed]);
    }

    #[test]
    fn shares_of_empty_lines_decide() {
        let bodies = |empty_share, sphere_to_box| Bodies {
            lines: 1,
            bodies: vec![crate::experiment::bodies::Miss {
                domain: "Sphere".into(),
                surface: 1.0,
                empty_share,
            }],
            sphere_to_box,
        };
        let verdicts = |bodies| of_bodies(&bodies).iter().map(|claim| claim.verdict).collect::<Vec<_>>();
        assert_eq!(verdicts(bodies(0.33, Some(1.35))), [Verdict::Confirmed; 2]);
        assert_eq!(verdicts(bodies(0.5, Some(2.7))), [Verdict::Refuted; 2]);
        assert_eq!(verdicts(bodies(0.5, None)), [Verdict::Refuted, Verdict::Open]);
    }

    #[test]
    fn the_best_share_and_the_loss_decide() {
        let best = |from, to| Some(Best { share: from, relative_rms: 0.01, from, to });
        let rates = crate::experiment::lines::Rates { local: 1.0, global: 1.0 };
        let lines = crate::experiment::lines::Lines { local: 1, global: 1 };
        let mix = Mix {
            lines,
            rates,
            equal_lines: Vec::new(),
            equal_time: Vec::new(),
            best_of_lines: best(0.4, 0.6),
            best_of_time: best(0.1, 0.4),
        };
        let verdicts: Vec<_> = of_mix(&mix).iter().map(|claim| claim.verdict).collect();
        assert_eq!(verdicts, [Verdict::Confirmed, Verdict::Refuted]);
        assert_eq!(of_farm(&Farm { transports: Vec::new() })[0].verdict, Verdict::Open);
    }
}
