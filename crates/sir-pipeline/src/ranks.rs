//! Agreement of the ranks of a run on errors, inputs and texts.

use sir_parallel::Communicator;

use crate::error::Error;
use crate::error_kind::ErrorKind;
use crate::fingerprint::Fingerprint;

/// Kinds of errors, indexed by the numbers that ranks exchange.
const KINDS: [ErrorKind; 3] = [ErrorKind::Failed, ErrorKind::Usage, ErrorKind::Interrupted];

/// Makes all ranks fail if one does. The first rank that failed keeps its error and reports it; the others return
/// [`Error::Elsewhere`] with its number.
pub(crate) fn agree<T>(comm: &dyn Communicator, outcome: Result<T, Error>) -> Result<T, Error> {
    let Some(rank) = comm.first_failed(outcome.is_err()) else { return outcome };
    let mine = outcome.err().filter(|_| rank == comm.rank());
    let number = |error: &Error| KINDS.iter().position(|&kind| kind == error.kind()).unwrap_or_default();
    // The ranks without the error add 0.
    let mut sum = [mine.as_ref().map_or(0, |error| number(error) as i64)];
    comm.sum(&mut sum);
    Err(mine.unwrap_or(Error::Elsewhere { rank, kind: KINDS[sum[0] as usize] }))
}

/// Checks that the fingerprint of this rank equals that of rank 0.
pub(crate) fn same_everywhere(comm: &dyn Communicator, fingerprint: Fingerprint) -> Result<(), Error> {
    let mut first: [i64; 32] = fingerprint.map(i64::from);
    comm.broadcast(&mut first);
    if first == fingerprint.map(i64::from) {
        return Ok(());
    }
    Err(Error::OtherInput { rank: comm.rank() })
}

/// Returns the text of rank 0 on all ranks.
pub(crate) fn broadcast_text(comm: &dyn Communicator, text: &str) -> String {
    let mut length = [text.len() as i64];
    comm.broadcast(&mut length);
    let mut words: Vec<i64> = text.bytes().map(i64::from).collect();
    words.resize(length[0] as usize, 0);
    comm.broadcast(&mut words);
    let bytes: Vec<u8> = words.into_iter().map(|word| word as u8).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}
