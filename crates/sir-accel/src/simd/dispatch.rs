//! Choice of the backend at run time.

#[cfg(target_arch = "x86_64")]
use crate::simd::avx2::token::Avx2;
#[cfg(target_arch = "x86_64")]
use crate::simd::avx512::Avx512;
use crate::simd::backend::{Kernel, SimdBackend};
use crate::simd::portable::Portable;

/// A backend that the processor supports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Backend {
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    Portable(Portable),
}

impl Backend {
    /// Returns the backends that the processor supports, the best first and the portable one last.
    pub(crate) fn available() -> impl Iterator<Item = Self> {
        #[cfg(target_arch = "x86_64")]
        let of_processor = [Avx512::detect().map(Self::Avx512), Avx2::detect().map(Self::Avx2)];
        #[cfg(not(target_arch = "x86_64"))]
        let of_processor = [None];
        of_processor.into_iter().flatten().chain([Self::Portable(Portable)])
    }

    /// Returns the best backend that the processor supports.
    pub(crate) fn best() -> Self {
        Self::available().next().unwrap_or(Self::Portable(Portable))
    }

    /// Runs a kernel with this backend.
    pub(crate) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(token) => token.run(kernel),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(token) => token.run(kernel),
            Self::Portable(token) => token.run(kernel),
        }
    }
}
