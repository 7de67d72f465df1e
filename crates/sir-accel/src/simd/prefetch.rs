//! Prefetching of memory that will soon be read.

/// Prefetches the cache lines of a range of memory. This is only a hint: it reads nothing, and any address is allowed.
#[inline(always)]
pub(crate) fn prefetch(start: *const u8, bytes: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        /// Size of a cache line \[bytes\].
        const LINE: usize = 64;
        for offset in (0..bytes).step_by(LINE) {
            // SAFETY: the instruction belongs to SSE, which all x86-64 processors have. It has no effect visible to the
            // program and raises no exception, whatever the address.
            #[allow(unsafe_code, reason = "the intrinsic takes a pointer")]
            unsafe {
                _mm_prefetch::<_MM_HINT_T0>(start.wrapping_add(offset).cast());
            }
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (start, bytes);
}
