//! Arguments of `map_…` statements: options and a file name.

use glam::DVec2;

use crate::load::obj::text::{number, split_word};
use crate::load::texture::Placement;
use crate::texture::Wrap;

/// A texture, with its transform and wrap mode.
#[derive(Debug, PartialEq)]
pub(super) struct Map<'a> {
    pub(super) name: &'a [u8],
    /// Transform from the coordinates of the file, whose second axis points up, to those of images.
    pub(super) placement: Placement,
    pub(super) wrap: [Wrap; 2],
    /// Unsupported options that affect the appearance.
    pub(super) ignored: Vec<&'a str>,
}

/// Parses a statement without its keyword. Coordinates are scaled by `-s`, then translated by `-o`.
pub(super) fn parse(mut map: &[u8]) -> Map<'_> {
    let (mut scale, mut offset) = (DVec2::ONE, DVec2::ZERO);
    let mut wrap = Wrap::Repeat;
    let mut ignored = Vec::new();
    loop {
        let (option, mut rest) = split_word(map);
        let option = str::from_utf8(option).unwrap_or_default();
        let (most, numbers) = match option {
            "-o" | "-s" | "-t" => (3, true),
            "-mm" => (2, true),
            "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-clamp" | "-colorspace" | "-imfchan"
            | "-texres" | "-type" => (1, false),
            _ => break,
        };
        let mut values = Vec::new();
        let mut word = &[][..];
        for _ in 0..most {
            let (value, behind) = split_word(rest);
            let number = number(value);
            if numbers && number.is_none() {
                break;
            }
            values.extend(number);
            (word, rest) = (value, behind);
        }
        let at = |i: usize, default: f64| values.get(i).copied().unwrap_or(default);
        match option {
            "-s" => scale = DVec2::new(at(0, 1.0), at(1, 1.0)),
            "-o" => offset = DVec2::new(at(0, 0.0), at(1, 0.0)),
            "-clamp" => wrap = if word.eq_ignore_ascii_case(b"on") { Wrap::Clamp } else { Wrap::Repeat },
            "-imfchan" | "-mm" | "-t" | "-type" => ignored.push(option),
            _ => {}
        }
        map = rest;
    }
    let placement = Placement {
        x_axis: scale.x * DVec2::X,
        y_axis: -scale.y * DVec2::Y,
        offset: DVec2::new(offset.x, 1.0 - offset.y),
    };
    Map { name: map, placement, wrap: [wrap; 2], ignored }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    #[test]
    fn options_before_a_texture_are_passed_over() {
        for (map, ignored) in [
            ("a b.png", &[][..]),
            ("-s 1 1 1 a b.png", &[]),
            ("-o 0.1 -s 2 -clamp on a b.png", &[]),
            ("-mm 0 1 -type sphere\ta b.png", &["-mm", "-type"]),
            ("-texres 512 -blendu off -bm 0.3 a b.png", &[]),
        ] {
            let parsed = parse(map.as_bytes());
            assert_eq!((parsed.name, &parsed.ignored[..]), (&b"a b.png"[..], ignored));
        }
        assert_eq!(parse(b"-o").name, b"");
    }

    #[test]
    fn coordinates_are_scaled_and_moved_and_turned_over() {
        let at = |map: &str, x: f32, y: f32| parse(map.as_bytes()).placement.apply(Vec2::new(x, y));
        assert_eq!(at("a.png", 0.25, 0.25), Vec2::new(0.25, 0.75));
        assert_eq!(at("-o 0.5 0.25 -s 2 4 9 a.png", 0.25, 0.5), Vec2::new(1.0, -1.25));
        assert_eq!(at("-s 3 a.png", 0.5, 0.25), Vec2::new(1.5, 0.75));
        assert_eq!(parse(b"-clamp on a.png").wrap, [Wrap::Clamp; 2]);
        assert_eq!(parse(b"-clamp off a.png").wrap, [Wrap::Repeat; 2]);
    }
}
