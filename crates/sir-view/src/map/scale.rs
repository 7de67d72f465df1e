//! Scale of false colors: which value has which color, and the bar that shows it.

use image::Rgb;

use crate::map::canvas::{Anchor, Canvas, INK};
use crate::map::colors::viridis;
use crate::map::ticks::{multiples, number, step};

/// Width of the bar \[pixels\].
const WIDTH: u32 = 22;
/// Smallest height of the bar \[pixels\].
pub(super) const MIN_HEIGHT: u32 = 120;
/// Size of its numbers \[pixels\].
pub(super) const TEXT_SIZE: f32 = 17.0;
/// Distance of neighboring numbers \[pixels\].
const DISTANCE: f64 = 50.0;

/// Values from the darkest to the lightest color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    /// Value with the darkest color.
    pub(super) low: f64,
    /// Value with the lightest color, above `low`.
    pub(super) high: f64,
    /// True if equal steps of color are equal factors. `low` is then positive.
    pub(super) is_logarithmic: bool,
}

impl Scale {
    /// Returns the place of a value on the scale, from 0 to 1; outside of it for a value outside of the scale.
    pub(super) fn place(self, value: f64) -> f64 {
        let Self { low, high, is_logarithmic } = self;
        if is_logarithmic {
            // Zero and below have the darkest color.
            (value.max(f64::MIN_POSITIVE) / low).ln() / (high / low).ln()
        } else {
            (value - low) / (high - low)
        }
    }

    /// Returns the color of a value.
    pub(super) fn color(self, value: f64) -> Rgb<u8> {
        viridis(self.place(value))
    }

    /// Returns round values on the scale with their texts, for a bar of this height \[pixels\].
    fn ticks(self, height: u32) -> Vec<(f64, String)> {
        let Self { low, high, is_logarithmic } = self;
        let count = (f64::from(height) / DISTANCE).clamp(2.0, 10.0);
        if !is_logarithmic {
            let step = step((high - low) / count);
            return multiples(step, low, high).map(|value| (value, number(value, step))).collect();
        }
        let decades = (high / low).log10();
        let first = low.log10().floor() as i32;
        let powers = (first..=high.log10().ceil() as i32).map(|exponent| 10f64.powi(exponent));
        // 1, 2 and 5 of each power of ten, or 1 alone; every second or third power, if there are many.
        let factors: &[f64] = if 3.0 * decades <= count { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let every = (decades / count).ceil().max(1.0) as usize;
        let all = powers.step_by(every).flat_map(|power| factors.iter().map(move |factor| factor * power));
        let is_on = |value: &f64| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(value);
        let mut ticks: Vec<_> = all.filter(is_on).collect();
        if ticks.len() < 2 {
            ticks = multiples(step((high - low) / count), low, high).collect();
        }
        ticks.into_iter().map(|value| (value, number(value, value))).collect()
    }

    /// Draws the bar with its upper left corner at a place. The unit stands above it.
    pub(super) fn draw(self, canvas: &mut Canvas, [left, above]: [u32; 2], height: u32, unit: &str) {
        for y in 0..height {
            let t = 1.0 - (f64::from(y) + 0.5) / f64::from(height);
            canvas.fill(left..left + WIDTH, above + y..above + y + 1, viridis(t));
        }
        canvas.frame(left..left + WIDTH, above..above + height);
        for (value, text) in self.ticks(height) {
            let y = above as f32 + ((1.0 - self.place(value)) * f64::from(height)) as f32;
            canvas.fill(left + WIDTH..left + WIDTH + 6, y as u32..y as u32 + 1, INK);
            canvas.write(&text, ((left + WIDTH + 11) as f32, y), Anchor::Start, TEXT_SIZE);
        }
        canvas.write(unit, (left as f32, above as f32 - 18.0), Anchor::Start, TEXT_SIZE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_on_both_kinds_of_scale() {
        let texts = |low, high, is_logarithmic, height| {
            let ticks = Scale { low, high, is_logarithmic }.ticks(height).into_iter();
            ticks.map(|(_, text)| text).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(texts(0.0, 620.0, false, 300), "0 200 400 600");
        assert_eq!(texts(1.0, 1000.0, true, 600), "1 2 5 10 20 50 100 200 500 1000");
        assert_eq!(texts(1.0, 1e5, true, 300), "1 10 100 1000 10000 100000");
        assert_eq!(texts(0.02, 3.0, true, 200), "0.1 1");
        assert_eq!(texts(30.0, 70.0, true, 200), "30 40 50 60 70");
    }

    #[test]
    fn places_are_proportional_to_values_or_logarithms() {
        let linear = Scale { low: 100.0, high: 300.0, is_logarithmic: false };
        let logarithmic = Scale { low: 1.0, high: 100.0, is_logarithmic: true };
        assert_eq!(linear.place(200.0), 0.5);
        assert!((logarithmic.place(10.0) - 0.5).abs() < 1e-12);
        assert_eq!(logarithmic.color(0.0), viridis(0.0));
        assert_eq!(linear.color(1e9), viridis(1.0));
    }
}
