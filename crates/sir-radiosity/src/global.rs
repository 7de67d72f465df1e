//! Tracing of global lines.

use std::ops::Range;

use sir_geom::Line;
use sir_mesh::SideId;

use crate::model::Model;
use crate::segments::{End, Segment, Segments};
use crate::totals::Counts;

/// Prefetch distance in records.
pub(crate) const PREFETCH_DISTANCE: usize = 40;

/// Number of lines that are generated at a time.
const LINES: usize = 1024;

/// Traces global lines in order, counts their hits, and calls `visit` for each of their segments with the number of the
/// line and its weight.
///
/// `draw` returns a line and its weight for a number. `prefetch` is called for the sides at the ends of a segment some
/// time before it is visited.
pub(crate) fn trace(
    model: &Model,
    draw: impl Fn(u64) -> (Line, u32),
    lines: Range<u64>,
    counts: &mut Counts,
    prefetch: impl Fn(SideId),
    mut visit: impl FnMut(u64, u32, Segment),
) {
    let mut tracer = model.accel.tracer();
    let mut segments = Segments::default();
    let (mut drawn, mut weights) = (Vec::with_capacity(LINES), Vec::with_capacity(LINES));
    let mut first = lines.start;
    while first < lines.end {
        let end = lines.end.min(first + LINES as u64);
        drawn.clear();
        weights.clear();
        for (line, weight) in (first..end).map(&draw) {
            drawn.push(line);
            weights.push(weight);
        }
        let mut line = first;
        tracer.all_hits_each(&drawn, |hits| {
            for hits in hits.lines() {
                counts.lines += 1;
                counts.empty += u64::from(hits.is_empty());
                counts.odd += hits.len() as u64 % 2;
                counts.crossings += hits.len() as u64;
            }
            segments.find(&model.mesh, hits);
            for (i, (of_line, segment)) in segments.iter().enumerate() {
                if let Some((_, Segment { from, to })) = segments.get(i + PREFETCH_DISTANCE) {
                    for end in [from, to] {
                        if let End::Side(side, _) = end {
                            prefetch(side);
                        }
                    }
                }
                let index = line + of_line as u64;
                visit(index, weights[(index - first) as usize], segment);
            }
            line += hits.lines().len() as u64;
        });
        first = end;
    }
}
