//! What an image shows, and the scale of false colors.

use crate::text::field::Format;
use crate::text::formats::{Choice, number, write_number};
use crate::text::reader::Reader;
use crate::text::ron_tree::Node;

/// What an image shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    /// The scene in its own colors.
    Colors,
    /// Luminance in false colors.
    Luminance,
    /// Illuminance of the surfaces in false colors.
    Illuminance,
}

/// Scale of false colors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorScale {
    /// Equal steps of color are equal differences.
    Linear,
    /// Equal steps of color are equal factors.
    Logarithmic,
}

pub(super) const SHOW: Choice<Show> =
    Choice(&[("Colors", Show::Colors), ("Luminance", Show::Luminance), ("Illuminance", Show::Illuminance)]);

pub(super) const SCALE: Choice<ColorScale> =
    Choice(&[("Linear", ColorScale::Linear), ("Logarithmic", ColorScale::Logarithmic)]);

impl Show {
    /// Returns the scale of an image that states none: luminances differ by large factors.
    #[must_use]
    pub fn usual_scale(self) -> ColorScale {
        if self == Self::Luminance { ColorScale::Logarithmic } else { ColorScale::Linear }
    }
}

/// Format of the ends of a scale: two numbers, the first of which is smaller.
#[derive(Clone, Copy)]
pub(super) struct Limits(pub(super) [f64; 2]);

impl Format for Limits {
    type Value = [f64; 2];

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<[f64; 2]> {
        let Some([low, high]) = node.elements() else {
            reader.wrong_value(node, name, "two numbers", self.example());
            return None;
        };
        let end = number(self.0[0]).with_range(|x| x >= 0.0, "from 0");
        let (low, high) = (end.read(reader, low, name), end.read(reader, high, name));
        let limits = [low?, high?];
        if limits[0] >= limits[1] {
            let message = format!("`{name}` must begin with the smaller number, but it is {}", node.text);
            reader.invalid_value(node, name, message, self.example());
            return None;
        }
        Some(limits)
    }

    fn write(&self, [low, high]: &[f64; 2]) -> String {
        format!("({}, {})", write_number(*low), write_number(*high))
    }

    fn describe(&self) -> String {
        "`(low, high)`, numbers from 0".into()
    }

    fn example(&self) -> String {
        self.write(&self.0)
    }
}
