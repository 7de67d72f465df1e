//! Reports of stages as the sums of those of light groups.

use sir_geom::Rgb;

use crate::report::result::{
    BalanceReport, ErrorsFrom, ErrorsReport, GroupReport, LinesReport, StageReport, Time,
};

impl GroupReport {
    /// Returns the factor as a color.
    pub(crate) fn dimming(&self) -> Rgb {
        Rgb::from_array(self.factor)
    }
}

/// Returns the report of stage number `index` of all groups as that of their sum, without its light.
pub(crate) fn sum_of_stages(name: &str, groups: &[GroupReport], index: usize) -> StageReport {
    let stages: Vec<(&StageReport, Rgb)> =
        groups.iter().filter_map(|group| Some((group.stages.get(index)?, group.dimming()))).collect();
    let parts = parts_of_sum(&stages);
    StageReport { stages: parts, ..sum(name, &stages) }
}

/// Returns the sums of the stages of a `Repeat` or `Solve`; none if groups have different ones.
fn parts_of_sum(stages: &[(&StageReport, Rgb)]) -> Vec<StageReport> {
    let names = |stage: &StageReport| stage.stages.iter().map(|part| part.name.clone()).collect::<Vec<_>>();
    let Some((first, _)) = stages.first() else { return Vec::new() };
    let all = names(first);
    if stages.iter().any(|(stage, _)| names(stage) != all) {
        return Vec::new();
    }
    let part =
        |i: usize| stages.iter().filter_map(move |(stage, factor)| Some((stage.stages.get(i)?, *factor)));
    all.iter().enumerate().map(|(i, name)| sum(name, &part(i).collect::<Vec<_>>())).collect()
}

fn sum(name: &str, stages: &[(&StageReport, Rgb)]) -> StageReport {
    let all: Option<Vec<(&LinesReport, Rgb)>> =
        stages.iter().map(|(stage, factor)| Some((stage.lines.as_ref()?, *factor))).collect();
    let lines = all.as_deref().and_then(sum_of_lines);
    let seconds = stages.iter().map(|(stage, _)| stage.time.seconds).sum();
    let rate = lines.as_ref().map(|lines| lines.lines as f64 / f64::max(seconds, 1e-9));
    // Groups may have different numbers of repeats.
    let repeats = stages.first().and_then(|(stage, _)| stage.repeats);
    let repeats = repeats.filter(|_| stages.iter().all(|(stage, _)| stage.repeats == repeats));
    StageReport {
        lines,
        repeats,
        ..StageReport::of(name, Time { lines_per_second: rate, ..Time::of(seconds) })
    }
}

/// Returns sums of counts, and of powers times factors.
fn sum_of_lines(all: &[(&LinesReport, Rgb)]) -> Option<LinesReport> {
    let (first, _) = all.first()?;
    let count = |of: fn(&LinesReport) -> u64| all.iter().map(|(lines, _)| of(lines)).sum::<u64>();
    let power = |of: fn(&LinesReport) -> [f64; 3]| {
        let parts = all.iter().map(|(lines, factor)| *factor * Rgb::from_array(of(lines)));
        parts.sum::<Rgb>().to_array()
    };
    let lines = count(|l| l.lines);
    let empty: f64 = all.iter().map(|(l, _)| l.empty_share * l.lines as f64).sum();
    Some(LinesReport {
        lines,
        domain: first.domain.clone(),
        empty_share: empty / lines.max(1) as f64,
        odd_lines: count(|l| l.odd_lines),
        crossings: count(|l| l.crossings),
        batches: count(|l| l.batches),
        balance: BalanceReport {
            emitted: power(|l| l.balance.emitted),
            absorbed: power(|l| l.balance.absorbed),
            blocked: power(|l| l.balance.blocked),
            escaped: power(|l| l.balance.escaped),
            unshot: power(|l| l.balance.unshot),
        },
        walks: count(|l| l.walks),
        walked: power(|l| l.walked),
    })
}

/// Returns the source of the errors of the sum after stage number `index`: the spread of repeats if that of all groups is
/// known, with the smallest number of them, or else the lines of all groups.
pub(crate) fn errors_of_sum(groups: &[GroupReport], index: usize) -> ErrorsReport {
    let all = || {
        let stages = groups.iter().filter_map(|group| group.stages.get(index));
        stages.filter_map(|stage| stage.light.as_ref()).map(|light| light.errors)
    };
    match all().all(|errors| errors.from == ErrorsFrom::Spread) {
        true => ErrorsReport {
            from: ErrorsFrom::Spread,
            samples: all().map(|errors| errors.samples).min().unwrap_or_default(),
        },
        false => {
            let lines = all().filter(|errors| errors.from == ErrorsFrom::Lines);
            ErrorsReport { from: ErrorsFrom::Lines, samples: lines.map(|errors| errors.samples).sum() }
        }
    }
}
