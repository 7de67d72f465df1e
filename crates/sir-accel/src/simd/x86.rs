//! Macros that the x86 backends share, for methods that differ only in a literal or in the name of an instruction.

/// Defines the methods [`run`](crate::simd::backend::SimdBackend::run) and
/// [`outline`](crate::simd::backend::SimdBackend::outline) of a token that proves these target features.
macro_rules! compiled_for {
    ($features:literal) => {
        fn run<K: Kernel>(self, kernel: K) -> K::Output {
            #[target_feature(enable = $features)]
            fn run<B: SimdBackend, K: Kernel>(backend: B, kernel: K) -> K::Output {
                kernel.run(backend)
            }
            // SAFETY: the token proves the features.
            unsafe { run(self, kernel) }
        }

        #[inline(always)]
        fn outline<R, F: FnOnce() -> R>(self, work: F) -> R {
            #[target_feature(enable = $features)]
            fn outline<R, F: FnOnce() -> R>(work: F) -> R {
                work()
            }
            // The compiler ignores `inline(never)` on functions with target features, but it cannot inline an unknown
            // function pointer.
            let outline: unsafe fn(F) -> R = std::hint::black_box(outline::<R, F>);
            // SAFETY: the token proves the features.
            unsafe { outline(work) }
        }
    };
}

/// Defines a method that applies an instruction to the lanes of `self` and of the other arguments, which consist of a
/// register and the token.
macro_rules! lanewise {
    ($method:ident, $instruction:ident $(, $argument:ident)*) => {
        #[inline(always)]
        fn $method(self $(, $argument: Self)*) -> Self {
            // SAFETY: the value holds the token.
            Self(unsafe { $instruction(self.0 $(, $argument.0)*) }, self.1)
        }
    };
}

/// Defines the same method for types that consist of two registers and the token.
macro_rules! halves {
    ($method:ident, $instruction:ident $(, $argument:ident)*) => {
        #[inline(always)]
        fn $method(self $(, $argument: Self)*) -> Self {
            // SAFETY: the value holds the token.
            let (low, high) = unsafe {
                ($instruction(self.0 $(, $argument.0)*), $instruction(self.1 $(, $argument.1)*))
            };
            Self(low, high, self.2)
        }
    };
}

pub(crate) use {compiled_for, halves, lanewise};
