//! The claims of the paper, and verdicts on them.
//!
//! Each verdict follows from measured numbers by a rule that the report states.

use serde::Serialize;

use crate::experiment::bodies::Bodies;
use crate::experiment::farm::Farm;
use crate::experiment::markdown::{percent, signed_percent, whole_percent};
use crate::experiment::mix::{Best, Mix};
use crate::experiment::paper::{BEST_SHARE, EFFICIENCY, EMPTY_SHARE, P, SPHERE_TO_BOX};
use crate::experiment::speed::Speed;
use crate::experiment::spread::Unevenness;
use crate::scaling::study::Row;

/// Verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Verdict {
    /// The numbers agree with the claim.
    Confirmed,
    /// The numbers disagree with the claim.
    Refuted,
    /// There are too few numbers to tell.
    Open,
}

/// Claim with its verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Claim {
    /// Summary of the paper's statement.
    pub(crate) claim: String,
    /// Result of the experiment.
    pub(crate) here: String,
    /// Verdict.
    pub(crate) verdict: Verdict,
    /// Condition under which the result agrees with the claim.
    pub(crate) rule: String,
}

/// Largest difference by which an efficiency may be below the paper's.
const EFFICIENCY_SLACK: f64 = 0.05;

/// Largest difference between efficiencies that count as constant.
const MAX_EFFICIENCY_RANGE: f64 = 0.1;

/// Number of different numbers of workers needed for a verdict on constant efficiency.
const MIN_WORKER_COUNTS: usize = 3;

/// Largest share of communication in a run that counts as very little.
const MAX_COMMUNICATION: f64 = 0.05;

/// Largest deviation of the share of empty lines from the paper's.
const EMPTY_SLACK: f64 = 0.05;

/// Largest deviation of the ratio of volumes from the paper's.
const VOLUME_SLACK: f64 = 0.1;

/// Largest relative deviation of the cost of one of eight shares of lines that counts as even.
const MAX_COST_DEVIATION: f64 = 0.01;

/// Largest loss of light that counts as none.
const MAX_LOSS: f64 = 0.005;

impl Verdict {
    fn of(agrees: Option<bool>) -> Self {
        match agrees {
            Some(true) => Self::Confirmed,
            Some(false) => Self::Refuted,
            None => Self::Open,
        }
    }

    /// Returns the verdict as text for the report.
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

/// Returns the smallest and the largest of some numbers.
fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, x| range.map_or(Some((x, x)), |(a, b): (f64, f64)| Some((a.min(x), b.max(x)))))
}

/// Judges the claims about speed-up. Only rows with several workers, but not more than cores, are considered.
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
        format!("with ranks, it is at most {} of the whole run", whole_percent(MAX_COMMUNICATION)),
        communication.map_or_else(
            || "not measured with ranks".into(),
            |(_, b)| format!("up to {} of the run, waiting included", percent(b)),
        ),
        communication.map(|(_, b)| b <= MAX_COMMUNICATION),
    ));
    claims
}

/// Judges the claims about the efficiency of one kind of workers.
fn of_efficiency(kind: &str, rows: &[&Row]) -> Vec<Claim> {
    let efficiencies = range(rows.iter().map(|row| row.whole.efficiency));
    let several = efficiencies.filter(|_| rows.len() >= MIN_WORKER_COUNTS);
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
                "the efficiencies of at least {MIN_WORKER_COUNTS} numbers of workers above 1 differ by at most {MAX_EFFICIENCY_RANGE}"
            ),
            several.map_or_else(too_few, |(a, b)| format!("E differs by {:.2} for p = {numbers}", b - a)),
            several.map(|(a, b)| b - a <= MAX_EFFICIENCY_RANGE),
        ),
    ]
}

/// Judges the claims about the share of local lines.
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
    vec![best("with an equal number of lines", mix.best_of_lines), best("in equal time", mix.best_of_time)]
}

/// Judges the claims about the bounding sphere.
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

/// Judges the claim about the cost of lines.
pub(crate) fn of_spread(spread: &Unevenness) -> Vec<Claim> {
    vec![claim(
        "the cost of global lines varies much, but averages out over many of them".into(),
        format!(
            "none of {P} equal shares of the lines has crossings that differ from the mean by more than {}",
            whole_percent(MAX_COST_DEVIATION)
        ),
        format!(
            "within {} of the mean for {} lines each",
            percent(spread.largest()),
            super::markdown::count(spread.lines / P as u64)
        ),
        (!spread.shares.is_empty()).then(|| spread.largest() <= MAX_COST_DEVIATION),
    )]
}

/// Judges the implicit assumption of the paper about its replicas.
pub(crate) fn of_farm(farm: &Farm) -> Vec<Claim> {
    let bias = farm.bias(P as u64);
    vec![claim(
        format!("the mean of {P} replicas is as good as one solution with all lines (implied)"),
        format!("the reflected light of {P} replicas is that of the reference within {}", percent(MAX_LOSS)),
        bias.map_or_else(
            || "too few lines".into(),
            |bias| format!("{} reflected light", signed_percent(bias)),
        ),
        bias.map(|bias| bias.abs() <= MAX_LOSS),
    )]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scaling::study::{Study, Timing};
    use crate::scaling::workers::Plan;
    use std::num::NonZeroUsize;

    /// Returns verdicts on runs of 1, 2, … threads with these times \[s\].
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
        // Two numbers of workers are no trend, and rows with more workers than cores do not count.
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
