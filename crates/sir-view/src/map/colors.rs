//! False colors.

use image::Rgb;

/// Coefficients of `1, t, …, t⁶` in red, green and blue.
const VIRIDIS: [[f64; 3]; 7] = [
    [0.277_727_327_2, 0.005_407_344_5, 0.334_099_805_3],
    [0.105_093_043_1, 1.404_613_529_9, 1.384_590_162_6],
    [-0.330_861_828_7, 0.214_847_559_5, 0.095_095_163_0],
    [-4.634_230_499_0, -5.799_100_973_4, -19.332_440_956_3],
    [6.228_269_936_3, 14.179_933_366_8, 56.690_552_600_7],
    [4.776_384_997_7, -13.745_145_377_7, -65.353_032_633_4],
    [-5.435_455_855_9, 4.645_852_612_2, 26.312_435_249_6],
];

/// Returns the color of a number from 0 to 1 in *viridis* (Smith and van der Walt 2015), from dark violet to yellow.
///
/// Equal steps look equal, also to the color-blind, and lightness increases with the number. The polynomial is that of
/// Zucker (2019), which is public domain.
pub(super) fn viridis(t: f64) -> Rgb<u8> {
    let t = t.clamp(0.0, 1.0);
    let band = |k: usize| VIRIDIS.iter().rev().fold(0.0, |sum, coefficients| sum * t + coefficients[k]);
    Rgb([0, 1, 2].map(|k| (255.0 * band(k).clamp(0.0, 1.0)).round() as u8))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_begin_and_end_right_and_become_lighter_all_the_way() {
        // The published table begins and ends with (68, 1, 84) and (253, 231, 37).
        let near = |a: Rgb<u8>, b: [u8; 3]| a.0.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 5);
        assert!(near(viridis(0.0), [68, 1, 84]) && near(viridis(1.0), [253, 231, 37]));
        assert!(near(viridis(0.5), [33, 145, 140]), "{:?}", viridis(0.5));
        let lightness = |i: u32| {
            let Rgb([r, g, b]) = viridis(f64::from(i) / 50.0);
            0.3 * f64::from(r) + 0.59 * f64::from(g) + 0.11 * f64::from(b)
        };
        assert!((0..50).all(|i| lightness(i) < lightness(i + 1)));
    }
}
