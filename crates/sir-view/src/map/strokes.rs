//! Smooth lines and their labels, legible on any color.

use std::ops::Range;

use glam::DVec2;
use image::Rgb;

use crate::map::canvas::{Anchor, Canvas, INK, WHITE, blend};

/// Half the width of a line \[pixels\].
const CORE: f64 = 0.65;
/// Half the width of the bright border of a line \[pixels\].
const HALO: f64 = 1.9;
/// Opacity of the bright border.
const HALO_OPACITY: f32 = 0.55;
/// Size of a label \[pixels\].
const LABEL_SIZE: f32 = 14.0;
/// Distance between the labels of a line \[pixels\].
const BETWEEN_LABELS: f64 = 420.0;
/// Length of a line without a label, at most \[pixels\].
const UNLABELED: f64 = 60.0;

/// Displacements of the bright copies of a label: eight points of a circle \[pixels\].
const HALO_STEPS: [(f32, f32); 8] =
    [(1.8, 0.0), (1.3, 1.3), (0.0, 1.8), (-1.3, 1.3), (-1.8, 0.0), (-1.3, -1.3), (0.0, -1.8), (1.3, -1.3)];

/// A line with a label.
pub(super) struct Stroke {
    /// Points of the line \[pixels\].
    pub(super) points: Vec<DVec2>,
    /// Text that stands in gaps of the line.
    pub(super) label: String,
}

/// A rectangle \[pixels\].
#[derive(Clone, Copy)]
struct Area {
    from: DVec2,
    to: DVec2,
}

impl Area {
    fn around(center: DVec2, half: DVec2) -> Self {
        Self { from: center - half, to: center + half }
    }

    fn contains(self, point: DVec2) -> bool {
        self.from.cmple(point).all() && point.cmple(self.to).all()
    }

    fn overlaps(self, other: Self) -> bool {
        self.from.cmplt(other.to).all() && other.from.cmplt(self.to).all()
    }
}

/// Draws lines with their labels inside of a rectangle of the image. A label is left out where it would cover another one.
pub(super) fn draw_strokes(canvas: &mut Canvas, x: Range<u32>, y: Range<u32>, strokes: &[Stroke]) {
    let frame = Area {
        from: DVec2::new(f64::from(x.start), f64::from(y.start)),
        to: DVec2::new(f64::from(x.end), f64::from(y.end)),
    };
    let mut labels: Vec<(DVec2, Area, &str)> = Vec::new();
    for Stroke { points, label } in strokes {
        let half = 0.5 * DVec2::new(f64::from(canvas.width(label, LABEL_SIZE)) + 6.0, f64::from(LABEL_SIZE));
        for center in places(points) {
            let area = Area::around(center, half);
            let is_inside = frame.contains(area.from - 2.0) && frame.contains(area.to + 2.0);
            if is_inside && !labels.iter().any(|(_, other, _)| other.overlaps(area)) {
                labels.push((center, area, label));
            }
        }
    }
    let mut coverage = Coverage::new(x, y);
    let gaps: Vec<Area> = labels.iter().map(|(_, area, _)| *area).collect();
    for stroke in strokes {
        stroke.points.windows(2).for_each(|ends| coverage.add([ends[0], ends[1]], &gaps));
    }
    coverage.blend_into(canvas);
    for (center, _, text) in labels {
        write_with_halo(canvas, text, center);
    }
}

/// Returns the points of a line at which labels may stand: the first in the middle of short lines.
fn places(points: &[DVec2]) -> Vec<DVec2> {
    let length: f64 = points.windows(2).map(|ends| ends[0].distance(ends[1])).sum();
    if length < UNLABELED {
        return Vec::new();
    }
    let count = (length / BETWEEN_LABELS).round().max(1.0);
    let mut wanted = (0..count as u32).map(|i| (f64::from(i) + 0.5) * length / count).peekable();
    let (mut passed, mut found) = (0.0, Vec::new());
    for ends in points.windows(2) {
        let part = ends[0].distance(ends[1]);
        while let Some(at) = wanted.next_if(|at| *at <= passed + part && part > 0.0) {
            found.push(ends[0].lerp(ends[1], (at - passed) / part));
        }
        passed += part;
    }
    found
}

/// Writes a label in the color of lines, with a bright border.
fn write_with_halo(canvas: &mut Canvas, text: &str, center: DVec2) {
    let place = center.as_vec2();
    for (x, y) in HALO_STEPS {
        canvas.write_in(text, (place.x + x, place.y + y), Anchor::Middle, LABEL_SIZE, WHITE);
    }
    canvas.write_in(text, (place.x, place.y), Anchor::Middle, LABEL_SIZE, INK);
}

/// How much of each pixel of a rectangle is covered by lines and by their borders. Where lines overlap, the larger one
/// counts.
struct Coverage {
    x: Range<u32>,
    y: Range<u32>,
    pixels: Vec<[f32; 2]>,
}

impl Coverage {
    fn new(x: Range<u32>, y: Range<u32>) -> Self {
        let count = x.len() * y.len();
        Self { x, y, pixels: vec![[0.0; 2]; count] }
    }

    /// Adds a line from one point to another, except in gaps.
    fn add(&mut self, [from, to]: [DVec2; 2], gaps: &[Area]) {
        let (low, high) = (from.min(to) - HALO - 1.0, from.max(to) + HALO + 1.0);
        let range = |low: f64, high: f64, all: &Range<u32>| {
            let clamp = |x: f64| x.clamp(f64::from(all.start), f64::from(all.end)) as u32;
            clamp(low)..clamp(high.ceil())
        };
        let along = to - from;
        for y in range(low.y, high.y, &self.y) {
            for x in range(low.x, high.x, &self.x) {
                let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                if gaps.iter().any(|gap| gap.contains(pixel)) {
                    continue;
                }
                let share = ((pixel - from).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
                let distance = pixel.distance(from + share * along);
                let place = (y - self.y.start) as usize * self.x.len() + (x - self.x.start) as usize;
                let Some(covered) = self.pixels.get_mut(place) else { continue };
                for (covered, radius) in covered.iter_mut().zip([HALO, CORE]) {
                    *covered = covered.max((radius + 0.5 - distance).clamp(0.0, 1.0) as f32);
                }
            }
        }
    }

    fn blend_into(&self, canvas: &mut Canvas) {
        let layers: [(Rgb<u8>, f32); 2] = [(WHITE, HALO_OPACITY), (INK, 1.0)];
        for (place, covered) in self.pixels.iter().enumerate() {
            let (x, y) = (place % self.x.len(), place / self.x.len());
            let at = (self.x.start + x as u32, self.y.start + y as u32);
            let Some(pixel) = canvas.image.get_pixel_mut_checked(at.0, at.1) else { continue };
            for ((color, opacity), covered) in layers.into_iter().zip(covered) {
                blend(pixel, opacity * covered, color);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_have_several_labels_and_short_ones_none() {
        let line = |length: f64| vec![DVec2::ZERO, DVec2::X * 0.3 * length, DVec2::X * length];
        assert!(places(&line(50.0)).is_empty());
        assert_eq!(places(&line(100.0)), [DVec2::new(50.0, 0.0)]);
        assert_eq!(places(&line(840.0)), [DVec2::new(210.0, 0.0), DVec2::new(630.0, 0.0)]);
        assert!(places(&[DVec2::ZERO]).is_empty() && places(&[]).is_empty());
    }

    #[test]
    fn lines_leave_a_gap_for_their_label() {
        let mut canvas = Canvas::new(200, 40).unwrap();
        let points = vec![DVec2::new(-10.0, 20.5), DVec2::new(210.0, 20.5)];
        draw_strokes(&mut canvas, 0..200, 0..40, &[Stroke { points, label: "500".into() }]);
        assert_eq!(*canvas.image.get_pixel(20, 20), INK);
        assert_eq!(*canvas.image.get_pixel(20, 25), WHITE);
        // Next to the text there is no line, in the text there is ink.
        let dark = |x: u32| (0..40).any(|y| canvas.image.get_pixel(x, y).0[0] < 128);
        assert!(!dark(86) && (90..110).any(dark) && dark(80) && dark(120));
    }
}
