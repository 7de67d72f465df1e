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
