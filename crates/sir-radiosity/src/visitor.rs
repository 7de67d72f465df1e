//! The state of a stage as a sequence of numbers.

/// Visits the state of a stage.
///
/// A stage passes all the numbers that it needs to continue, always in the same order and number. The visitor may add
/// them up over several workers, save them, or restore saved ones. The stage uses the values that the visitor leaves in
/// place.
pub trait Visitor {
    /// Visits numbers of which every worker holds a part. The true values are the sums over all workers.
    fn sum(&mut self, words: &mut [i64]);

    /// Visits numbers that every worker holds identically.
    fn same(&mut self, words: &mut [i64]);
}

/// Visits counters that every worker holds identically.
pub(crate) fn visit_counts<const N: usize>(counts: [&mut u64; N], visitor: &mut dyn Visitor) {
    for count in counts {
        let mut word = [*count as i64];
        visitor.same(&mut word);
        *count = word[0] as u64;
    }
}

/// Visits a double-precision number that every worker holds identically.
pub(crate) fn visit_float(float: &mut f64, visitor: &mut dyn Visitor) {
    let mut word = [float.to_bits() as i64];
    visitor.same(&mut word);
    *float = f64::from_bits(word[0] as u64);
}

/// Number of elements of a slice that are visited at a time.
const CHUNK: usize = 1 << 14;

/// Visits a slice that every worker holds identically, each element as `N` numbers.
pub(crate) fn visit_slice<T, const N: usize>(
    slice: &mut [T],
    visitor: &mut dyn Visitor,
    to_words: impl Fn(&T) -> [i64; N],
    from_words: impl Fn([i64; N]) -> T,
) {
    let mut words = Vec::new();
    for chunk in slice.chunks_mut(CHUNK) {
        words.clear();
        words.extend(chunk.iter().flat_map(&to_words));
        visitor.same(&mut words);
        for (element, words) in chunk.iter_mut().zip(words.as_chunks().0) {
            *element = from_words(*words);
        }
    }
}

/// Visits single-precision numbers in groups of three.
pub(crate) fn visit_floats(floats: &mut [[f32; 3]], visitor: &mut dyn Visitor) {
    visit_slice(floats, visitor, |floats| floats.map(to_word), |words| words.map(from_word));
}

/// Returns the bits of a single-precision number as an integer.
pub(crate) fn to_word(float: f32) -> i64 {
    i64::from(float.to_bits())
}

/// Returns the number whose bits [`to_word`] returned.
pub(crate) fn from_word(word: i64) -> f32 {
    f32::from_bits(word as u32)
}
