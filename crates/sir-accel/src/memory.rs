//! Hints for memory that is read in random order: prefetching and huge pages. They have no effect on results.

use crate::simd::prefetch::prefetch as prefetch_bytes;

/// Prefetches a value that will soon be read.
#[inline]
pub fn prefetch<T>(what: &T) {
    prefetch_bytes(std::ptr::from_ref(what).cast(), size_of::<T>());
}

/// Collects items that will be read in random order. On Linux a large collection requests transparent huge pages,
/// because a TLB miss takes as long as a memory read.
pub fn collect_in_huge_pages<T>(things: impl ExactSizeIterator<Item = T>) -> Vec<T> {
    let mut all = Vec::with_capacity(things.len());
    advise(&mut all);
    all.extend(things);
    all
}

/// Size of a huge page on most processors \[bytes\].
#[cfg(target_os = "linux")]
const HUGE_PAGE: usize = 2 << 20;

/// Requests huge pages for the spare capacity of a vector.
#[cfg(target_os = "linux")]
#[allow(unsafe_code, reason = "a system call that changes only how memory is organized")]
fn advise<T>(empty: &mut Vec<T>) {
    let room = empty.spare_capacity_mut();
    let bytes = size_of_val(room);
    let start = room.as_mut_ptr().cast::<u8>();
    // Only whole huge pages within the spare capacity.
    let before = start.align_offset(HUGE_PAGE);
    let whole = bytes.saturating_sub(before) / HUGE_PAGE * HUGE_PAGE;
    if whole > 0 {
        // SAFETY: the range lies in memory that the vector owns, and the advice changes no contents. A failure is
        // harmless.
        unsafe { libc::madvise(start.wrapping_add(before).cast(), whole, libc::MADV_HUGEPAGE) };
    }
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_: &mut Vec<T>) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_collected() {
        for count in [0, 1, 1000, 3_000_000] {
            assert!(collect_in_huge_pages(0..count).into_iter().eq(0..count));
        }
    }
}
