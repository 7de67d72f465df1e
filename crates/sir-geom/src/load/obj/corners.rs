//! Texture coordinates and colors, which bypass `tobj`: it returns corners in the order of the file.

use glam::{Vec2, Vec4};

use crate::color::Rgb;
use crate::texture::srgb_to_linear_at;

/// Index of missing texture coordinates.
const NONE: u32 = u32::MAX;

/// Values at the corners of faces, besides positions.
#[derive(Debug, Default)]
pub(super) struct Corners {
    /// Number of vertices so far.
    vertices: usize,
    /// Colors of the vertices up to the last vertex that has one, as in the file.
    colors: Vec<[f32; 3]>,
    places: Vec<Vec2>,
    /// Indices of vertex and coordinates, corner by corner.
    corners: Vec<[u32; 2]>,
    /// True if colors range to 255 instead of 1, as they should.
    in_bytes: bool,
}

impl Corners {
    /// Adds the vertex of a `v` statement, given by its words: three coordinates, and a color if three more follow. An
    /// invalid color becomes white.
    pub(super) fn add_vertex<'a>(&mut self, words: impl Iterator<Item = &'a str>) {
        let mut color = words.skip(3).map(|word| word.parse().unwrap_or(f32::NAN));
        if let (Some(r), Some(g), Some(b)) = (color.next(), color.next(), color.next()) {
            self.colors.resize(self.vertices, [1.0; 3]);
            let is_color = r.is_finite() && g.is_finite() && b.is_finite();
            self.colors.push(if is_color { [r, g, b] } else { [1.0; 3] });
            self.in_bytes |= is_color && (r > 1.0 || g > 1.0 || b > 1.0);
        }
        self.vertices += 1;
    }

    /// Adds the coordinates of a `vt` statement, given by its words. Their second axis points up, that of images down.
    pub(super) fn add_place<'a>(&mut self, mut words: impl Iterator<Item = &'a str>) {
        let mut number = || words.next().map_or(0.0, |word| word.parse().unwrap_or(f32::NAN));
        self.places.push(Vec2::new(number(), number()));
    }

    /// Adds the corners of an `f` statement, each `position/texture/normal`.
    pub(super) fn add_face<'a>(&mut self, corners: impl Iterator<Item = &'a str>) {
        let (vertices, places) = (self.vertices, self.places.len());
        self.corners.extend(corners.map(|corner| {
            let mut parts = corner.split('/');
            let mut number = |count: usize| {
                let n: i64 = parts.next()?.parse().ok()?;
                // Numbers count from 1 or, if negative, back from the last one so far.
                let index = if n < 0 { n + count as i64 } else { n - 1 };
                u32::try_from(index).ok()
            };
            [number(vertices).unwrap_or(NONE), number(places).unwrap_or(NONE)]
        }));
    }

    pub(super) fn has_colors(&self) -> bool {
        !self.colors.is_empty()
    }

    /// Returns the coordinates of a corner; `None` if it has none, or they do not exist.
    pub(super) fn place(&self, corner: usize) -> Option<Vec2> {
        let [_, place] = *self.corners.get(corner)?;
        self.places.get(place as usize).copied()
    }

    /// Returns the linear color of the vertex of a corner; white if it has none.
    ///
    /// The format does not define the meaning of colors. They are taken as sRGB, because exporters write colors as
    /// displayed.
    pub(super) fn color(&self, corner: usize) -> Vec4 {
        let vertex = self.corners.get(corner).map_or(NONE, |[vertex, _]| *vertex);
        let color = self.colors.get(vertex as usize).copied().unwrap_or([1.0; 3]);
        let scale = if self.in_bytes && color != [1.0; 3] { 255.0 } else { 1.0 };
        let linear = |x: f32| srgb_to_linear_at(f64::from(x / scale).clamp(0.0, 1.0));
        Rgb::from_array(color.map(linear)).as_vec3().extend(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_find_their_values_from_either_end() {
        let mut corners = Corners::default();
        for vertex in ["0 0 0", "0 0 0 1 0.5 0 1", "0 0 0"] {
            corners.add_vertex(vertex.split(' '));
        }
        corners.add_place("0.25 0.5 7".split(' '));
        corners.add_place("2".split(' '));
        corners.add_face("1/1 2/-1/5 -1//1 3/0 2/3 x/-3".split(' '));
        let [a, b] = [Vec2::new(0.25, 0.5), Vec2::new(2.0, 0.0)];
        let places: Vec<_> = (0..7).map(|i| corners.place(i)).collect();
        assert_eq!(places, [Some(a), Some(b), None, None, None, None, None]);
        let half = srgb_to_linear_at(0.5) as f32;
        assert_eq!(corners.color(1), Vec4::new(1.0, half, 0.0, 1.0));
        assert_eq!([0, 2, 3, 5].map(|i| corners.color(i)), [Vec4::ONE; 4]);
    }

    /// Found by fuzzing: decoding a color that is not a number did not terminate.
    #[test]
    fn what_is_no_color_is_white() {
        let mut corners = Corners::default();
        for vertex in ["0 1 0 1 1 1d", "0 0 0 nan 0 0", "0 0 0 inf 0 0", "0 0 0 1 0 0"] {
            corners.add_vertex(vertex.split(' '));
        }
        corners.add_face("1 2 3 4".split(' '));
        assert_eq!([0, 1, 2].map(|i| corners.color(i)), [Vec4::ONE; 3]);
        assert_eq!(corners.color(3), Vec4::new(1.0, 0.0, 0.0, 1.0));
        assert!(srgb_to_linear_at(f64::NAN).is_nan());
    }
}
