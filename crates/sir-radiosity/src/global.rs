//! Global lines, and what they meet.

use std::ops::Range;

use sir_lines::{Domain, Streams};

use crate::segments::{Segment, segments};
use crate::{Counts, Model};

/// Traces global lines in order, counts what they meet, and calls `visit` for each of their segments with the number
/// of the line.
pub(crate) fn trace(
    model: &Model,
    domain: &Domain,
    streams: &Streams,
    lines: Range<u64>,
    counts: &mut Counts,
    mut visit: impl FnMut(u64, Segment),
) {
    let mut tracer = model.accel.tracer();
    for index in lines {
        let line = domain.sample(&mut streams.line(index));
        let hits = tracer.all_hits(&line);
        counts.lines += 1;
        counts.empty += u64::from(hits.is_empty());
        counts.odd += hits.len() as u64 % 2;
        counts.crossings += hits.len() as u64;
        segments(&model.mesh, hits, |segment| visit(index, segment));
    }
}
