//! The state of a stage as a sequence of numbers.

/// Goes through the state of a stage.
///
/// A stage shows all the numbers that it needs to go on, always in the same order and number. What the visitor makes of
/// them is its business: add them up over several workers, save them, or put back what was saved. The stage takes
/// over what the visitor leaves in place.
pub trait Visitor {
    /// Numbers of which every worker has a part: the true ones are the sums over all workers.
    fn sum(&mut self, words: &mut [i64]);

    /// Numbers that all workers have alike.
    fn same(&mut self, words: &mut [i64]);
}

/// Shows a few whole numbers that all workers have alike.
pub(crate) fn visit_counts<const N: usize>(counts: [&mut u64; N], visitor: &mut dyn Visitor) {
    for count in counts {
        let mut word = [*count as i64];
        visitor.same(&mut word);
        *count = word[0] as u64;
    }
}

/// Shows a number in double precision that all workers have alike.
pub(crate) fn visit_float(float: &mut f64, visitor: &mut dyn Visitor) {
    let mut word = [float.to_bits() as i64];
    visitor.same(&mut word);
    *float = f64::from_bits(word[0] as u64);
}

/// How many elements of a slice are shown at a time.
const CHUNK: usize = 1 << 14;

/// Shows a slice that all workers have alike to a visitor, each element as some numbers.
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

/// Shows numbers in single precision, three by three.
pub(crate) fn visit_floats(floats: &mut [[f32; 3]], visitor: &mut dyn Visitor) {
    visit_slice(floats, visitor, |floats| floats.map(to_word), |words| words.map(from_word));
}

/// A number in single precision as a whole one.
pub(crate) fn to_word(float: f32) -> i64 {
    i64::from(float.to_bits())
}

/// The number that [`to_word`] has made whole.
pub(crate) fn from_word(word: i64) -> f32 {
    f32::from_bits(word as u32)
}
