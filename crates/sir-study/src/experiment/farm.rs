//! Part `farm`: what the mean of independent replicas loses.

use serde::Serialize;

use crate::error::StudyError;
use crate::experiment::accuracy::{Bands, Reference, power};
use crate::experiment::markdown::{Grid, percent, signed_percent};
use crate::experiment::runs::{Done, Runs, Wanted};
use crate::experiment::speed;
use crate::experiment::subject::{Changes, DIRECT, Subject, TABLE};
use crate::scaling::table::seconds;
use sir_pipeline::plan::{Replicas, Transport};
use sir_pipeline::report::Report;

/// Numbers of replicas.
const REPLICAS: [u64; 3] = [1, 8, 64];

/// A transport, and what it makes of the reflected light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Transported {
    /// `Replicas` or `Batches`.
    pub(crate) transport: &'static str,
    /// How many, of replicas.
    pub(crate) replicas: Option<u64>,
    /// Power of the reflected light against that of the reference, minus 1.
    pub(crate) reflected_bias: Bands,
    /// Error of the radiosity against the reference.
    pub(crate) relative_rms: Bands,
    /// Share of what surfaces reflect that was not sent on. Batches make up for it.
    pub(crate) unshot_share: f64,
    /// Seconds of multipath, on all cores.
    pub(crate) seconds: f64,
}

/// What the part finds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Farm {
    /// Replicas, fewest first, and then batches.
    pub(crate) transports: Vec<Transported>,
}

/// The transports that are compared, with the names of their runs.
fn transports(subject: &Subject) -> Vec<(String, Transport)> {
    let replicas = REPLICAS.into_iter().filter(|&replicas| replicas <= subject.lines.global);
    let replicas = replicas
        .map(|count| (format!("farm-{count:02}"), Transport::Replicas(Replicas { count, tail: Some(0) })));
    // The run with the pictures is one in batches already, if the pipeline asks for them.
    let batches =
        (subject.transport != Transport::Batches).then(|| ("farm-batches".into(), Transport::Batches));
    replicas.chain(batches).collect()
}

fn wanted(runs: &Runs, subject: &Subject, (name, transport): &(String, Transport)) -> Wanted {
    Wanted::new(name, Changes { transport: transport.clone(), ..subject.changes() }, runs.cores)
}

/// Announces all runs.
pub(crate) fn plan(runs: &mut Runs, subject: &Subject) {
    for transport in transports(subject) {
        let wanted = wanted(runs, subject, &transport);
        runs.plan(subject, &wanted);
    }
}

/// Makes the runs and compares them. `full` is the pipeline's own run, whose first shot all of them share.
pub(crate) fn find(
    runs: &mut Runs,
    subject: &Subject,
    reference: &Reference,
    full: &Done,
) -> Result<Farm, StudyError> {
    let direct = power(&full.table(DIRECT)?);
    let compared = |transport: &Transport, run: &Done| -> Result<Transported, StudyError> {
        let table = run.table(TABLE)?;
        let (transport, replicas) = match transport {
            Transport::Batches => ("Batches", None),
            Transport::Replicas(replicas) => ("Replicas", Some(replicas.count)),
        };
        Ok(Transported {
            transport,
            replicas,
            reflected_bias: reference.reflected_bias(power(&table) - direct),
            relative_rms: reference.accuracy(&table)?.relative_rms,
            unshot_share: unshot_share(&run.report),
            seconds: speed::time(&run.report, &["Multipath"]),
        })
    };
    let mut found = Vec::new();
    for transport in transports(subject) {
        let run = runs.get(subject, &wanted(runs, subject, &transport))?;
        found.push(compared(&transport.1, &run)?);
    }
    if subject.transport == Transport::Batches {
        found.push(compared(&Transport::Batches, full)?);
    }
    Ok(Farm { transports: found })
}

/// Unshot power of multipath over what it was given, all bands together.
fn unshot_share(report: &Report) -> f64 {
    let lines = report.stages.iter().find(|s| s.name == "Multipath").and_then(|s| s.lines.as_ref());
    lines.map_or(0.0, |lines| {
        let sum = |bands: &[f64; 3]| bands.iter().sum::<f64>();
        sum(&lines.balance.unshot) / sum(&lines.balance.emitted).max(f64::MIN_POSITIVE)
    })
}

impl Farm {
    /// The reflected light of so many replicas, in luminance, against the reference.
    pub(crate) fn bias(&self, replicas: u64) -> Option<f64> {
        self.transports.iter().find(|t| t.replicas == Some(replicas)).map(|t| t.reflected_bias.luminance)
    }

    /// The section of the report.
    pub(crate) fn section(&self) -> String {
        let columns = [
            "transport",
            "reflected light, luminance",
            "red",
            "green",
            "blue",
            "relative RMS",
            "not sent on",
            "time [s]",
        ];
        let mut grid = Grid::new(&columns);
        for t in &self.transports {
            let b = t.reflected_bias;
            let name =
                t.replicas.map_or_else(|| t.transport.to_owned(), |p| format!("{}, P = {p}", t.transport));
            let biases = [b.luminance, b.red, b.green, b.blue].map(signed_percent);
            let rest = [percent(t.relative_rms.luminance), percent(t.unshot_share), seconds(t.seconds)];
            grid.row(std::iter::once(name).chain(biases).chain(rest));
        }
        format!(
            "### Replicas and batches\n\nThe paper's processors compute independent replicas, whose mean is \
             the result; each loses what it has not sent on when its lines end (`tail: 0`). Reflected light \
             is the power that surfaces reflect after the first reflection of the direct light, against the \
             reference; the RMS is that of luminance of all light. Batches make up for what was not sent \
             on.\n\n{}",
            grid.end()
        )
    }
}
