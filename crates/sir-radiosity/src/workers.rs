//! Work other than lines, shared among the threads of this process.

use std::ops::Range;

use sir_geom::TriangleId;
use sir_mesh::{PatchMesh, SideId};

/// A job for one of the [`Workers`].
pub type Job<'a> = Box<dyn FnOnce() + Send + 'a>;

/// The threads of this process, for work other than lines.
pub trait Workers: Sync {
    /// Returns the number of workers: at least 1.
    fn count(&self) -> usize;

    /// Runs all jobs, concurrently if there are several workers.
    fn run(&self, jobs: Vec<Job<'_>>);
}

/// A single worker: the calling thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct OneWorker;

impl Workers for OneWorker {
    fn count(&self) -> usize {
        1
    }

    fn run(&self, jobs: Vec<Job<'_>>) {
        jobs.into_iter().for_each(|job| job());
    }
}

/// Number of items in a block. It does not depend on the number of workers, so sums of floats over the blocks do not,
/// either, if they are added in order.
pub(crate) const BLOCK: usize = 1 << 12;

/// Applies a function to blocks of consecutive sides, and returns the results in order. `items` are the data of the
/// blocks, such as [`BLOCK`] elements of a slice each; the last block may have fewer.
pub(crate) fn map_sides<'m, B: Send, T: Send>(
    workers: &dyn Workers,
    mesh: &'m PatchMesh,
    items: impl IntoIterator<Item = B>,
    function: impl Fn(Sides<'m>, B) -> T + Sync,
) -> Vec<T> {
    map_blocks(workers, mesh.side_count(), items, |sides, item| {
        function(Sides { mesh, range: sides.start as u32..sides.end as u32 }, item)
    })
}

/// Applies a function to blocks of `0..count`, and returns the results in order. `items` are the data of the blocks.
pub(crate) fn map_blocks<B: Send, T: Send>(
    workers: &dyn Workers,
    count: usize,
    items: impl IntoIterator<Item = B>,
    function: impl Fn(Range<usize>, B) -> T + Sync,
) -> Vec<T> {
    let starts = (0..count).step_by(BLOCK);
    let mut blocks: Vec<_> = starts.zip(items).map(|(start, item)| (start, Some(item), None)).collect();
    let share = blocks.len().div_ceil(workers.count()).max(1);
    let function = &function;
    let jobs = blocks.chunks_mut(share).map(|blocks| -> Job<'_> {
        Box::new(move || {
            for (start, item, result) in blocks {
                *result = item.take().map(|item| function(*start..count.min(*start + BLOCK), item));
            }
        })
    });
    workers.run(jobs.collect());
    blocks.into_iter().filter_map(|(_, _, result)| result).collect()
}

/// Items of blocks without data.
pub(crate) fn no_items() -> impl Iterator<Item = ()> {
    std::iter::repeat(())
}

/// Consecutive sides of a mesh.
pub(crate) struct Sides<'m> {
    mesh: &'m PatchMesh,
    range: Range<u32>,
}

impl<'m> Sides<'m> {
    /// Returns the sides in order, each with a triangle of its patch.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (TriangleId, SideId)> + use<'m> {
        let sides = self.mesh.sides_within(self.range.clone());
        sides.flat_map(|(triangle, sides)| sides.map(move |side| (triangle, SideId(side))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_cover_everything_in_order() {
        for count in [0, 1, BLOCK, BLOCK + 1, 5 * BLOCK - 1] {
            let mut items = vec![0; count];
            let blocks = map_blocks(&OneWorker, count, items.chunks_mut(BLOCK), |range, items| {
                range.clone().zip(items).for_each(|(i, item)| *item = i);
                range
            });
            assert!(items.into_iter().eq(0..count));
            assert!(blocks.into_iter().flatten().eq(0..count));
        }
    }
}
