//! Colors of vertices, whose range the format does not define.

use glam::Vec4;

use crate::color::Rgb;
use crate::load::notes::Notes;
use crate::texture::srgb_to_linear_at;

/// Color of vertices without one.
const WHITE: [f32; 3] = [1.0; 3];

/// Colors of the vertices of a file.
#[derive(Debug, Default)]
pub(super) struct Colors {
    /// Colors of the vertices up to the last vertex that has one, as in the file.
    colors: Vec<[f32; 3]>,
    /// Value of full brightness.
    full: f32,
}

impl Colors {
    /// Adds the color of the vertex with this number. An undefined color becomes white.
    pub(super) fn add(&mut self, vertex: usize, color: [f32; 3]) {
        self.colors.resize(vertex, WHITE);
        self.colors.push(if color.iter().all(|x| x.is_finite()) { color } else { WHITE });
    }

    pub(super) fn is_empty(&self) -> bool {
        self.colors.is_empty()
    }

    /// Decides from all colors whether they range to 1 or to 255: to 255 if all values are whole numbers from 0 to 255,
    /// and more of them exceed 1 than equal it. Otherwise values above 1 come from rounding or filtering.
    pub(super) fn decide_range(&mut self, notes: &mut Notes) {
        // White is also the color of vertices without one.
        let colored = || self.colors.iter().filter(|color| **color != WHITE);
        let values = || colored().flatten().copied();
        let are_bytes = values().all(|x| x.fract() == 0.0 && (0.0..=255.0).contains(&x));
        let most_are_above = values().filter(|x| *x > 1.0).count() > values().filter(|x| *x == 1.0).count();
        if are_bytes && most_are_above {
            self.full = 255.0;
            notes.count(
                "vertex colors are taken as 0 to 255, because all values are whole numbers and most exceed 1",
                colored().count(),
            );
        } else {
            self.full = 1.0;
            let outside = colored().filter(|color| color.iter().any(|x| !(0.0..=1.0).contains(x)));
            let (least, most) = values().fold((1.0, 0.0), |(a, b): (f32, f32), x| (a.min(x), b.max(x)));
            notes.count(
                format!(
                    "vertex colors are outside 0 to 1 and were clamped: values range from {least} to {most}; if 255 \
                     is full brightness, all values must be whole numbers"
                ),
                outside.count(),
            );
        }
    }

    /// Returns the linear color of a vertex; white if it has none. They are taken as sRGB, because exporters write
    /// colors as displayed.
    pub(super) fn linear(&self, vertex: usize) -> Vec4 {
        let color = self.colors.get(vertex).copied().unwrap_or(WHITE);
        let full = if color == WHITE { 1.0 } else { self.full };
        let linear = |x: f32| srgb_to_linear_at(f64::from(x / full).clamp(0.0, 1.0));
        Rgb::from_array(color.map(linear)).as_vec3().extend(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decided(colors: &[[f32; 3]]) -> Colors {
        let mut all = Colors::default();
        for (i, &color) in colors.iter().enumerate() {
            all.add(i, color);
        }
        all.decide_range(&mut Notes::default());
        all
    }

    #[test]
    fn a_file_ranges_to_255_only_if_all_of_it_does() {
        for (colors, full) in [
            (&[[0.0, 0.5, 1.0]][..], 1.0),
            (&[[0.0, 1.0, 1.0], [1.0; 3]], 1.0),
            (&[[1.0039; 3], [0.5; 3]], 1.0),
            (&[[1.000001; 3], [0.5; 3]], 1.0),
            // Whole numbers, but for one of them.
            (&[[2.0, 0.0, 0.0], [0.0, 1.0, 1.0]], 1.0),
            (&[[255.0, 0.0, 0.0], [0.5, 0.0, 0.0]], 1.0),
            (&[[300.0, 0.0, 0.0]], 1.0),
            (&[[255.0, -1.0, 0.0]], 1.0),
            (&[[255.0, 0.0, 1.0], [17.0, 255.0, 0.0]], 255.0),
            (&[[1.0; 3], [1.0; 3], [255.0, 0.0, 0.0]], 255.0),
            (&[], 1.0),
        ] {
            assert_eq!(decided(colors).full, full, "{colors:?}");
        }
    }

    #[test]
    fn values_are_scaled_or_clamped() {
        let bytes = decided(&[[255.0, 0.0, 51.0], [1.0; 3]]);
        let fifth = srgb_to_linear_at(f64::from(0.2f32)) as f32;
        assert_eq!(bytes.linear(0), Vec4::new(1.0, 0.0, fifth, 1.0));
        assert_eq!([1, 2].map(|i| bytes.linear(i)), [Vec4::ONE; 2]);
        assert_eq!(decided(&[[1.5, -0.25, 0.0]]).linear(0), Vec4::new(1.0, 0.0, 0.0, 1.0));
    }

    /// Found by fuzzing: decoding a color that is not a number did not terminate.
    #[test]
    fn what_is_no_color_is_white() {
        let mut colors = decided(&[[f32::NAN, 0.0, 0.0], [f32::INFINITY, 0.0, 0.0]]);
        colors.add(3, [1.0, 0.0, 0.0]);
        assert_eq!([0, 1, 2, 9].map(|i| colors.linear(i)), [Vec4::ONE; 4]);
        assert_eq!(colors.linear(3), Vec4::new(1.0, 0.0, 0.0, 1.0));
        assert!(srgb_to_linear_at(f64::NAN).is_nan());
    }
}
