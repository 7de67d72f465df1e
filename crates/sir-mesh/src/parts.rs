//! Patches of several triangles, and patches that are cells: lists of parts.

use std::ops::Range;

use sir_geom::TriangleId;

use crate::piece::below_one;

/// Cell of a part that is a whole triangle.
pub(crate) const WHOLE: u32 = u32::MAX;

/// Part of a patch in one triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Part {
    pub(crate) triangle: TriangleId,
    /// Cell of the lattice, or [`WHOLE`].
    pub(crate) cell: u32,
    /// Area of this part and those before it in the patch.
    pub(crate) end: f64,
}

/// Parts of all listed patches. Uses 4 bytes per patch and 16 per part.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    parts: Vec<Part>,
    /// Offset of the parts of each patch, and their number at the end; empty without patches.
    starts: Vec<u32>,
}

impl Parts {
    /// Returns the number of patches.
    pub(crate) fn len(&self) -> u32 {
        self.starts.len().saturating_sub(1) as u32
    }

    /// Adds a patch. The `end` of each part is its area.
    pub(crate) fn add(&mut self, parts: impl Iterator<Item = Part>) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        let mut end = 0.0;
        for part in parts {
            end += part.end;
            self.parts.push(Part { end, ..part });
        }
        self.starts.push(self.parts.len() as u32);
    }

    fn range(&self, patch: u32) -> Range<usize> {
        self.starts[patch as usize] as usize..self.starts[patch as usize + 1] as usize
    }

    /// Returns the parts of a patch.
    pub(crate) fn of(&self, patch: u32) -> &[Part] {
        &self.parts[self.range(patch)]
    }

    /// Returns the area of a patch.
    #[inline]
    pub(crate) fn area(&self, patch: u32) -> f64 {
        self.parts[self.starts[patch as usize + 1] as usize - 1].end
    }

    /// Returns a part of a patch for a uniform number in `[0, 1)`, with a probability in proportion to its area, and the
    /// remainder of the number, which is uniform, too.
    pub(crate) fn random(&self, patch: u32, random: f64) -> (Part, f64) {
        let parts = self.of(patch);
        let at = random * parts[parts.len() - 1].end;
        let chosen = parts.partition_point(|part| part.end <= at).min(parts.len() - 1);
        let start = chosen.checked_sub(1).map_or(0.0, |before| parts[before].end);
        (parts[chosen], below_one((at - start) / (parts[chosen].end - start)))
    }

    /// Returns the memory in use \[bytes\].
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.parts[..]) + size_of_val(&self.starts[..])
    }
}
