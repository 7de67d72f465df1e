//! Luminous openings: the signs of width, length and height encode the shape.

use crate::ies::version::Version;
use crate::opening::{Along, Opening, Outline};

/// Sign of an extent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sign {
    /// Round.
    Minus,
    Zero,
    Plus,
}

impl Sign {
    fn of(extent: f64) -> Self {
        match extent {
            _ if extent < 0.0 => Self::Minus,
            _ if extent > 0.0 => Self::Plus,
            _ => Self::Zero,
        }
    }
}

/// Returns the opening of a file, from the extents in meters as they are in the file, with their signs. Length is along the
/// 0° plane, width across it, and height along the vertical axis.
///
/// Many files state a version and write the shapes of another one. Each shape is recognized in all versions; if two of them
/// use the same signs for different shapes, the version decides.
pub(crate) fn opening(
    version: Version,
    [width, length, height]: [f64; 3],
    warnings: &mut Vec<String>,
) -> Opening {
    use Sign::{Minus, Plus, Zero};
    let signs = [width, length, height].map(Sign::of);
    let [w, l, h] = [width, length, height].map(f64::abs);
    let mut warn =
        |text: &str| warnings.push(format!("The luminous opening {width} × {length} × {height} m {text}."));
    let box_or_face = |w: f64, l: f64, h: f64| {
        let outline = Outline::Rectangle;
        if h == 0.0 {
            Opening::Flat { outline, length: l, width: w }
        } else {
            Opening::Solid { outline, length: l, width: w, height: h }
        }
    };
    let round = |w: f64, l: f64, h: f64| {
        let outline = Outline::Ellipse;
        if h == 0.0 {
            Opening::Flat { outline, length: l, width: w }
        } else {
            Opening::Solid { outline, length: l, width: w, height: h }
        }
    };
    let ellipsoid = Opening::Ellipsoid { length: l, width: w, height: h };
    match signs {
        [Zero, Zero, Zero] => Opening::Point,
        [Plus | Zero, Plus | Zero, Plus | Zero] => box_or_face(w, l, h),
        // Circles and vertical cylinders: −d × −d from 2002, −d × 0 before.
        [Minus, Minus, Zero | Plus] => round(w, l, h),
        [Minus, Zero, Zero | Plus] => round(w, w, h),
        [Zero, Minus, Zero | Plus] => {
            warn("has a round length, but no width; it is read as a circle");
            round(l, l, h)
        }
        [Minus, Minus, Minus] => ellipsoid,
        [Minus, Zero, Minus] if version >= Version::V2002 => {
            warn("is a vertical disc, which is approximated by a vertical square face");
            box_or_face(w, 0.0, h)
        }
        [Zero, Minus, Minus] if version >= Version::V2002 => {
            warn("is a vertical disc, which is approximated by a vertical square face");
            box_or_face(0.0, l, h)
        }
        // A sphere of 1995.
        [Minus, Zero, Minus] => Opening::Ellipsoid { length: w, width: w, height: h },
        // Horizontal cylinders of 1995, whose height is the diameter.
        [Zero, Plus, Minus] => Opening::Tube { along: Along::Length, length: l, width: h, height: h },
        [Plus, Zero, Minus] => Opening::Tube { along: Along::Width, length: h, width: w, height: h },
        // Ellipsoids of 1986 and 1995, cylinders from 2002.
        [Minus, Plus, Minus] if version >= Version::V2002 => {
            Opening::Tube { along: Along::Length, length: l, width: w, height: h }
        }
        [Plus, Minus, Minus] if version >= Version::V2002 => {
            Opening::Tube { along: Along::Width, length: l, width: w, height: h }
        }
        [Minus, Plus, Minus] | [Plus, Minus, Minus] => ellipsoid,
        [Minus, Plus, Plus] if version <= Version::V1991 => ellipsoid,
        // Ellipses and elliptical cylinders before 2002.
        [Minus, Plus, Zero | Plus] | [Plus, Minus, Zero | Plus] => {
            if version >= Version::V2002 {
                warn("has a shape of an older version of the standard; it is read as elliptical");
            }
            round(w, l, h)
        }
        [_, _, Minus] => {
            warn("has no defined shape; the sign of the height is ignored");
            box_or_face(w, l, h)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_follow_the_version() {
        use Version::{V1986, V1991, V1995, V2002, V2019};
        let flat = |outline, length, width| Opening::Flat { outline, length, width };
        let solid = |outline, length, width, height| Opening::Solid { outline, length, width, height };
        let ellipsoid = |length, width, height| Opening::Ellipsoid { length, width, height };
        let tube = |along, length, width, height| Opening::Tube { along, length, width, height };
        let all = [V1986, V1991, V1995, V2002, V2019];
        let (old, new) = (&all[..3], &all[3..]);
        let (rectangle, ellipse) = (Outline::Rectangle, Outline::Ellipse);
        // Versions, width, length and height in the file, the opening, and the number of warnings.
        for (versions, extents, expected, count) in [
            (&all[..], [0.0, 0.0, 0.0], Opening::Point, 0),
            (&all, [0.2, 1.2, 0.0], flat(rectangle, 1.2, 0.2), 0),
            (&all, [0.2, 1.2, 0.1], solid(rectangle, 1.2, 0.2, 0.1), 0),
            (&all, [0.0, 1.2, 0.1], solid(rectangle, 1.2, 0.0, 0.1), 0),
            (&all, [-0.3, 0.0, 0.0], flat(ellipse, 0.3, 0.3), 0),
            (&all, [-0.3, 0.0, 0.5], solid(ellipse, 0.3, 0.3, 0.5), 0),
            (&all, [-0.3, -0.3, 0.0], flat(ellipse, 0.3, 0.3), 0),
            (&all, [-0.3, -0.6, 0.0], flat(ellipse, 0.6, 0.3), 0),
            (&all, [-0.3, -0.3, 0.5], solid(ellipse, 0.3, 0.3, 0.5), 0),
            (&all, [-0.3, -0.6, 0.5], solid(ellipse, 0.6, 0.3, 0.5), 0),
            (&all, [-0.3, -0.3, -0.3], ellipsoid(0.3, 0.3, 0.3), 0),
            (&all, [-0.3, -0.4, -0.5], ellipsoid(0.4, 0.3, 0.5), 0),
            (old, [-0.3, 0.6, 0.0], flat(ellipse, 0.6, 0.3), 0),
            (new, [-0.3, 0.6, 0.0], flat(ellipse, 0.6, 0.3), 1),
            (&all[..2], [-0.3, 0.6, 0.5], ellipsoid(0.6, 0.3, 0.5), 0),
            (&[V1995], [-0.3, 0.6, 0.5], solid(ellipse, 0.6, 0.3, 0.5), 0),
            (&[V1995], [0.3, -0.6, 0.5], solid(ellipse, 0.6, 0.3, 0.5), 0),
            (old, [-0.3, 0.6, -0.5], ellipsoid(0.6, 0.3, 0.5), 0),
            (old, [-0.3, 0.0, -0.3], ellipsoid(0.3, 0.3, 0.3), 0),
            (&all, [0.0, 1.2, -0.03], tube(Along::Length, 1.2, 0.03, 0.03), 0),
            (&all, [1.2, 0.0, -0.03], tube(Along::Width, 0.03, 1.2, 0.03), 0),
            (new, [-0.04, 1.2, -0.03], tube(Along::Length, 1.2, 0.04, 0.03), 0),
            (new, [1.2, -0.04, -0.03], tube(Along::Width, 0.04, 1.2, 0.03), 0),
            (new, [-0.3, 0.0, -0.3], solid(rectangle, 0.0, 0.3, 0.3), 1),
            (&all, [0.2, 1.2, -0.1], solid(rectangle, 1.2, 0.2, 0.1), 1),
            (&all, [0.0, -0.3, 0.0], flat(ellipse, 0.3, 0.3), 1),
        ] {
            for &version in versions {
                let mut warnings = Vec::new();
                assert_eq!(opening(version, extents, &mut warnings), expected, "{version:?} {extents:?}");
                assert_eq!(warnings.len(), count, "{version:?} {extents:?} {warnings:?}");
            }
        }
    }
}
