//! Grids of sensors by EN 12464-1.

use glam::DVec2;

/// Largest distance of neighboring sensors \[m\].
const MAX_SPACING: f64 = 10.0;

/// Width of the border \[m\] if the area is large.
const BORDER: f64 = 0.5;

/// Width of the border of a small area, relative to its shorter side.
const BORDER_SHARE: f64 = 0.15;

/// Ratio of the sides from which the shorter one decides.
const ELONGATED: f64 = 2.0;

/// Returns the distance of neighboring sensors for an area whose decisive side has the length `d`: `p = 0.2 · 5^(log₁₀ d)`,
/// at most 10 m (EN 12464-1:2021). All lengths are in meters.
fn spacing(d: f64) -> f64 {
    (0.2 * libm::pow(5.0, libm::log10(d))).min(MAX_SPACING)
}

/// Returns the numbers of cells along both sides of an area \[m\], at least one each.
///
/// The decisive side `d` is the longer one, or the shorter one if the ratio of the two is 2 or more. It has the whole number
/// of cells nearest to `d/p`. The other side has the whole number nearest to its length divided by the size of these cells.
/// So the number is rounded to the nearest and not up, which agrees with the table of the standard, such as 6 cells for 2 m
/// and 8 for 5 m, and cells are between half and one and a half times as long as wide.
pub(super) fn counts(size: DVec2) -> DVec2 {
    let (longer, shorter) = (size.max_element(), size.min_element());
    let decisive = if longer >= ELONGATED * shorter { shorter } else { longer };
    let count = (decisive / spacing(decisive)).round().max(1.0);
    (size * (count / decisive)).round().max(DVec2::ONE)
}

/// Returns the width of the border without sensors along the sides of an area \[m\]: 0.5 m, or 15 % of the shorter side if
/// that is less (EN 12464-1:2021).
pub(super) fn border(size: DVec2) -> f64 {
    BORDER.min(BORDER_SHARE * size.min_element())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spacings_are_those_of_the_formula() {
        for (d, p) in [(1.0, 0.2), (10.0, 1.0), (100.0, 5.0), (1000.0, 10.0)] {
            assert!((spacing(d) - p).abs() < 1e-12, "{d}: {}", spacing(d));
        }
        // The table of the standard has rounded values of larger areas.
        for (d, p) in [(2.0, 0.3), (5.0, 0.6), (25.0, 2.0), (50.0, 3.0)] {
            assert!((spacing(d) / p - 1.0).abs() < 0.1, "{d}: {}", spacing(d));
        }
    }

    #[test]
    fn numbers_of_cells_are_those_of_the_standard() {
        for (d, n) in [(1.0, 5.0), (2.0, 6.0), (5.0, 8.0), (10.0, 10.0), (100.0, 20.0)] {
            assert_eq!(counts(DVec2::splat(d)), DVec2::splat(n), "{d}");
        }
        assert_eq!(counts(DVec2::new(5.0, 4.0)), DVec2::new(8.0, 6.0));
        // A corridor: its width of 2 m decides, with 6 cells of a third of a meter.
        assert_eq!(counts(DVec2::new(20.0, 2.0)), DVec2::new(60.0, 6.0));
        assert_eq!(counts(DVec2::new(2.0, 4.0)), DVec2::new(6.0, 12.0));
    }

    #[test]
    fn cells_are_nearly_square_and_not_larger_than_ten_meters() {
        let sides: Vec<f64> = (0..80).map(|i| libm::pow(10.0, f64::from(i) / 16.0 - 2.0)).collect();
        for size in sides.iter().flat_map(|&x| sides.iter().map(move |&y| DVec2::new(x, y))) {
            let cell = size / counts(size);
            let ratio = cell.x / cell.y;
            assert!((0.5..=2.0).contains(&ratio), "{size}: {ratio}");
            assert!(cell.max_element() < 1.5 * MAX_SPACING + 1e-9, "{size}: {cell}");
        }
    }

    #[test]
    fn the_border_of_a_small_area_is_a_share_of_its_shorter_side() {
        assert_eq!(border(DVec2::new(8.0, 6.0)), 0.5);
        assert!((border(DVec2::new(8.0, 2.0)) - 0.3).abs() < 1e-12);
    }
}
