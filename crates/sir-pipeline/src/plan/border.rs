//! Border of a plane of sensors: a width, or that of the standard.

use crate::text::field::Format;
use crate::text::formats::{Number, number};
use crate::text::reader::Reader;
use crate::text::ron_tree::{Node, Value};

/// Border without sensors along the outline of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Border {
    /// Border of EN 12464-1: 0.5 m, or 15 % of the shorter side if that is less.
    Standard,
    /// Width \[m\], not negative.
    Width(f64),
}

/// Format of a border: `Standard`, or a width.
#[derive(Clone, Copy)]
pub(super) struct BorderFormat;

impl BorderFormat {
    const WIDTH: fn() -> Number = || number(0.5).with_range(|x| x >= 0.0, "from 0");
}

impl Format for BorderFormat {
    type Value = Border;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<Border> {
        if node.name() == "Standard" && node.value == Value::Items(Vec::new()) {
            return Some(Border::Standard);
        }
        if node.value == Value::Number {
            return Self::WIDTH().read(reader, node, name).map(Border::Width);
        }
        let message = format!("`{name}` must be `Standard` or a number, but it is {}", node.kind());
        reader.problem(node.text, message, format!("write `{name}: Standard` or for instance `{name}: 0.5`"));
        None
    }

    fn write(&self, value: &Border) -> String {
        match value {
            Border::Standard => "Standard".into(),
            Border::Width(width) => Self::WIDTH().write(width),
        }
    }

    fn describe(&self) -> String {
        "`Standard` or a number from 0".into()
    }

    fn example(&self) -> String {
        "Standard".into()
    }
}
