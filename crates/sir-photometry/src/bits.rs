//! Hash of the bits of numbers, which identifies a table in a short text.

/// Returns a hash of 128 bits of numbers: FNV-1a (Fowler, Noll and Vo) over words of 64 bits in place of bytes. Each step is
/// a bijection of the state, so two sequences that differ in one number have different hashes.
pub(crate) fn hash_of(numbers: impl IntoIterator<Item = f64>) -> u128 {
    const BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;
    let step = |hash: u128, number: f64| (hash ^ u128::from(number.to_bits())).wrapping_mul(PRIME);
    numbers.into_iter().fold(BASIS, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_bits_and_their_order_count() {
        let hash = hash_of([1.0, 2.0, 0.0]);
        assert_eq!(hash, hash_of([1.0, 2.0, 0.0]));
        for other in [&[1.0, 2.0, -0.0][..], &[2.0, 1.0, 0.0], &[1.0, 2.0], &[1.0 + f64::EPSILON, 2.0, 0.0]] {
            assert_ne!(hash, hash_of(other.iter().copied()), "{other:?}");
        }
    }
}
