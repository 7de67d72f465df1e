//! Part `farm`: the light that the mean of independent replicas loses.

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

/// Numbers of replicas to compare.
const REPLICAS: [u64; 3] = [1, 8, 64];

/// Transport, with the accuracy of its reflected light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Transported {
    /// Name of the transport: `Replicas` or `Batches`.
    pub(crate) transport: &'static str,
    /// Number of replicas, if the transport is `Replicas`.
    pub(crate) replicas: Option<u64>,
    /// Power of the reflected light relative to that of the reference, minus 1.
    pub(crate) reflected_bias: Bands,
    /// Error of the radiosity against the reference.
    pub(crate) relative_rms: Bands,
    /// Unshot share of the power that surfaces reflect. Batches send it on by random walks, and what is left is zero on average.
    pub(crate) unshot_share: f64,
    /// Time of multipath on all cores \[s\].
    pub(crate) seconds: f64,
}

/// Results of the part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Farm {
    /// Replicas, smallest number first, followed by batches.
    pub(crate) transports: Vec<Transported>,
}

/// Returns the transports to compare, with the names of their runs.
fn transports(subject: &Subject) -> Vec<(String, Transport)> {
    let replicas = REPLICAS.into_iter().filter(|&replicas| replicas <= subject.lines.global);
    let replicas = replicas
        .map(|count| (format!("farm-{count:02}"), Transport::Replicas(Replicas { count, tail: Some(0) })));
    // If the pipeline uses batches, the run with the images already is a run in batches.
    let batches =
        (subject.transport != Transport::Batches).then(|| ("farm-batches".into(), Transport::Batches));
    replicas.chain(batches).collect()
}

fn wanted(runs: &Runs, subject: &Subject, (name, transport): &(String, Transport)) -> Wanted {
    Wanted::new(name, Changes { transport: transport.clone(), ..subject.changes() }, runs.cores)
}

/// Adds all runs to the agenda.
pub(crate) fn plan(runs: &mut Runs, subject: &Subject) {
    for transport in transports(subject) {
        let wanted = wanted(runs, subject, &transport);
        runs.plan(subject, &wanted);
    }
}

/// Makes the runs and compares them. `full` is the run of the pipeline itself; all runs have the same first shot.
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

/// Returns the unshot power of multipath over the power that it was given, summed over all bands.
fn unshot_share(report: &Report) -> f64 {
    let lines = report.stages.iter().find(|s| s.name == "Multipath").and_then(|s| s.lines.as_ref());
    lines.map_or(0.0, |lines| {
        let sum = |bands: &[f64; 3]| bands.iter().sum::<f64>();
        sum(&lines.balance.unshot) / sum(&lines.balance.emitted).max(f64::MIN_POSITIVE)
    })
}

impl Farm {
    /// Returns the relative bias of the reflected luminance for a number of replicas.
    pub(crate) fn bias(&self, replicas: u64) -> Option<f64> {
        self.transports.iter().find(|t| t.replicas == Some(replicas)).map(|t| t.reflected_bias.luminance)
    }

    /// Returns the section of the report.
    pub(crate) fn section(&self) -> String {
        let columns = [
            "transport",
            "reflected light, luminance",
            "red",
            "green",
            "blue",
            "relative RMS",
            "unshot",
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
             the result; each replica loses the power that is unshot when its lines end (`tail: 0`). \
             Reflected light is the power that surfaces reflect after the first reflection of the direct \
             light, against the reference; the RMS is that of the luminance of all light. Batches \
             send the rest on by random walks.\n\n{}",
            grid.end()
        )
    }
}
