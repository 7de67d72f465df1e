//! Report of the lines of a stage.

use sir_lines::GlobalLines;
use sir_parallel::StageTime;
use sir_radiosity::{Balance, Counts, PowerUnit, Quanta, Walked};

use crate::report::result::{BalanceReport, DomainReport, LinesReport, Time};

/// Energy balance and counts of a finished stage with lines.
#[derive(Clone, Debug)]
pub(crate) struct Facts {
    pub(crate) balance: Balance,
    pub(crate) counts: Counts,
    pub(crate) batches: u64,
    pub(crate) walked: Walked,
    pub(crate) domain: Option<DomainReport>,
}

impl DomainReport {
    pub(crate) fn of(lines: &GlobalLines) -> Self {
        let domain = lines.domain();
        let focus = lines.focus().map(|_| lines.share());
        Self { kind: domain.name().into(), surface: domain.surface(), focus }
    }
}

impl LinesReport {
    /// Creates the report, with powers converted from quanta to watts by `unit`.
    pub(crate) fn new(facts: Facts, unit: PowerUnit) -> Self {
        let Facts { balance, counts, batches, walked, domain } = facts;
        let watts = |quanta: Quanta| unit.watts(quanta).to_array();
        Self {
            lines: counts.lines,
            domain,
            empty_share: counts.empty as f64 / counts.lines.max(1) as f64,
            odd_lines: counts.odd,
            crossings: counts.crossings,
            batches,
            balance: BalanceReport {
                emitted: watts(balance.emitted),
                absorbed: watts(balance.absorbed),
                blocked: watts(balance.blocked),
                escaped: watts(balance.escaped),
                unshot: watts(balance.unshot),
            },
            walks: walked.walks,
            walked: watts(walked.power),
        }
    }
}

impl Time {
    /// Returns the time report of a stage with `lines` lines.
    pub(crate) fn of_lines(time: StageTime, lines: u64) -> Self {
        let seconds = time.total.as_secs_f64();
        Self {
            seconds,
            lines_per_second: Some(lines as f64 / seconds.max(1e-9)),
            sequential: Some(time.sequential().as_secs_f64()),
            communication: Some(time.communication.as_secs_f64()),
            peak_memory: None,
        }
    }
}
