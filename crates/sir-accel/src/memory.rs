//! Memory that is read in no order: hints for the processor and the system, without any other effect.

use crate::lanes;

/// Begins to bring something to the caches, because it will soon be needed.
#[inline]
pub fn prefetch<T>(what: &T) {
    lanes::prefetch(std::ptr::from_ref(what).cast(), size_of::<T>());
}

/// Collects things that will be read in no order. Much memory comes in large pages where Linux has them to give, since looking up
/// where a small page is takes as long as reading it.
pub fn collect_in_large_pages<T>(things: impl ExactSizeIterator<Item = T>) -> Vec<T> {
    let mut all = Vec::with_capacity(things.len());
    advise(&mut all);
    all.extend(things);
    all
}

/// Size of a large page of most processors \[bytes\].
#[cfg(target_os = "linux")]
const LARGE_PAGE: usize = 2 << 20;

/// Asks for large pages for what has not been written yet.
#[cfg(target_os = "linux")]
#[allow(unsafe_code, reason = "a call of the system that changes nothing but how memory is organised")]
fn advise<T>(empty: &mut Vec<T>) {
    let room = empty.spare_capacity_mut();
    let bytes = size_of_val(room);
    let start = room.as_mut_ptr().cast::<u8>();
    // Whole pages within.
    let before = start.align_offset(LARGE_PAGE);
    let whole = bytes.saturating_sub(before) / LARGE_PAGE * LARGE_PAGE;
    if whole > 0 {
        // SAFETY: the range lies in memory that belongs to the vector, and its contents stay as they are. Failure is no harm.
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
            assert!(collect_in_large_pages(0..count).into_iter().eq(0..count));
        }
    }
}
