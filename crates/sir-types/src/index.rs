//! Typed indices: numbers that cannot be mixed up.

/// Declares an index type: a `u32` that cannot be mixed up with indices of other things.
///
/// The type has `new` (from a `usize`), `index` (to a `usize`), ordering, hashing and a plain-number `Display`.
#[macro_export]
macro_rules! typed_index {
    ($(#[$meta:meta])* $name:ident) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// Creates the index `i`, which must be below 2³².
            #[inline]
            #[must_use]
            pub fn new(i: usize) -> Self {
                debug_assert!(u32::try_from(i).is_ok(), "index {i} does not fit in 32 bits");
                Self(i as u32)
            }

            /// Returns the index as a position in a slice.
            #[inline]
            #[must_use]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

typed_index!(
    /// Number of a triangle in its list, from 0.
    TriangleId
);
