//! Syntax of plain values in a pipeline file: numbers, strings, vectors, colors, names.

use std::marker::PhantomData;

use glam::DVec3;
use sir_geom::Rgb;

use crate::format::{grouped, list};
use crate::text::field::Format;
use crate::text::literal::{float, whole_number};
use crate::text::reader::Reader;
use crate::text::ron_tree::{Node, Value};
use crate::text::suggest::did_you_mean;

/// A whole number in a range.
#[derive(Clone, Copy)]
pub(crate) struct Count<T> {
    min: u64,
    max: u64,
    example: u64,
    number: PhantomData<T>,
}

/// Returns the format of a whole number from `min` to `max`.
pub(crate) fn count<T>(min: u64, max: u64, example: u64) -> Count<T> {
    Count { min, max, example, number: PhantomData }
}

impl<T: TryFrom<u64> + Into<u64> + Copy> Format for Count<T> {
    type Value = T;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<T> {
        let Self { min, max, .. } = *self;
        let parsed = (node.value == Value::Number).then(|| whole_number(node.text)).flatten();
        let value = parsed.filter(|n| (min..=max).contains(n)).and_then(|n| T::try_from(n).ok());
        if value.is_none() {
            let what = format!("a whole number from {min} to {}", grouped(max));
            reader.wrong_value(node, name, &what, grouped(self.example));
        }
        value
    }

    fn write(&self, value: &T) -> String {
        grouped((*value).into())
    }

    fn describe(&self) -> String {
        match self.max {
            u64::MAX => format!("whole number from {}", self.min),
            max if max >= 1_000_000_000_000 && max.to_string().trim_end_matches('0') == "1" => {
                let exponent: String = max.ilog10().to_string().chars().map(superscript).collect();
                format!("whole number from {} to 10{exponent}", self.min)
            }
            max => format!("whole number from {} to {}", self.min, grouped(max).replace('_', ",")),
        }
    }

    fn example(&self) -> String {
        grouped(self.example)
    }
}

fn superscript(digit: char) -> char {
    let all = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    digit.to_digit(10).and_then(|d| all.get(d as usize)).copied().unwrap_or(digit)
}

/// A finite number in a range.
#[derive(Clone, Copy)]
pub(crate) struct Number {
    allowed: fn(f64) -> bool,
    /// Description of the range, appended to "number".
    range: &'static str,
    example: f64,
}

/// Returns the format of a finite number.
pub(crate) fn number(example: f64) -> Number {
    Number { allowed: |_| true, range: "", example }
}

/// Returns the format of a finite number above zero.
pub(crate) fn positive(example: f64) -> Number {
    number(example).with_range(|x| x > 0.0, "above 0")
}

impl Number {
    /// Restricts the number to a range. The description `range` is appended to "number".
    pub(crate) fn with_range(self, allowed: fn(f64) -> bool, range: &'static str) -> Self {
        Self { allowed, range, ..self }
    }

    /// Returns the number of a node if it is in the range, and otherwise a description of valid numbers.
    pub(crate) fn value(&self, node: &Node<'_>) -> Result<f64, String> {
        let number = read_number(node);
        let article = if number.is_some() { "a " } else { "a finite " };
        number.filter(|x| (self.allowed)(*x)).ok_or_else(|| self.noun(article))
    }

    fn noun(&self, article: &str) -> String {
        format!("{article}number {}", self.range).trim_end().to_owned()
    }
}

impl Format for Number {
    type Value = f64;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<f64> {
        let value = self.value(node);
        value.map_err(|what| reader.wrong_value(node, name, &what, self.example())).ok()
    }

    fn write(&self, value: &f64) -> String {
        write_number(*value)
    }

    fn describe(&self) -> String {
        self.noun("")
    }

    fn example(&self) -> String {
        write_number(self.example)
    }
}

fn read_number(node: &Node<'_>) -> Option<f64> {
    (node.value == Value::Number).then(|| float(node.text)).flatten()
}

/// Writes a number so that reading it gives the same bits.
pub(crate) fn write_number(x: f64) -> String {
    if x.fract() != 0.0 || x.abs() >= 1e15 {
        return format!("{x:?}");
    }
    let sign = if x.is_sign_negative() { "-" } else { "" };
    // Numbers of up to four digits are readable without groups.
    let digits = if x.abs() < 1e4 { format!("{:.0}", x.abs()) } else { grouped(x.abs() as u64) };
    format!("{sign}{digits}")
}

/// A string that is not empty. The field is an example.
#[derive(Clone, Copy)]
pub(crate) struct Text(pub(crate) &'static str);

impl Format for Text {
    type Value = String;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<String> {
        match &node.value {
            Value::Text(text) if !text.is_empty() => Some(text.clone()),
            Value::Text(_) => {
                let message = format!("`{name}` must be a string in quotes, but it is empty");
                reader.invalid_value(node, name, message, self.example());
                None
            }
            _ => {
                reader.wrong_value(node, name, "a string in quotes", self.example());
                None
            }
        }
    }

    fn write(&self, value: &String) -> String {
        quoted(value)
    }

    fn describe(&self) -> String {
        "string".into()
    }

    fn example(&self) -> String {
        quoted(self.0)
    }
}

/// Writes a string in quotes, with the escapes of RON.
pub(crate) fn quoted(text: &str) -> String {
    // Serializing a string cannot fail.
    ron::to_string(text).unwrap_or_default()
}

/// Three finite numbers, `(x, y, z)`.
#[derive(Clone, Copy)]
pub(crate) struct Vector(pub(crate) [f64; 3]);

impl Format for Vector {
    type Value = DVec3;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<DVec3> {
        let Some(items) = node.elements() else {
            reader.wrong_value(node, name, "three numbers", self.example());
            return None;
        };
        if items.len() != 3 {
            let message = format!("`{name}` must be three numbers, but there are {}", items.len());
            reader.invalid_value(node, name, message, self.example());
            return None;
        }
        read_numbers(reader, items, name, &self.example()).map(|numbers| DVec3::from_slice(&numbers))
    }

    fn write(&self, value: &DVec3) -> String {
        write_numbers(value.to_array())
    }

    fn describe(&self) -> String {
        "`(x, y, z)`".into()
    }

    fn example(&self) -> String {
        write_numbers(self.0)
    }
}

/// Reads finite numbers. Reports every node that is not one.
fn read_numbers<'a>(
    reader: &mut Reader<'a>,
    nodes: &[Node<'a>],
    name: &str,
    example: &str,
) -> Option<Vec<f64>> {
    let numbers: Vec<Option<f64>> = nodes
        .iter()
        .map(|node| {
            let number = read_number(node);
            if number.is_none() {
                reader.wrong_value(node, name, "a finite number", example);
            }
            number
        })
        .collect();
    numbers.into_iter().collect()
}

fn write_numbers(numbers: [f64; 3]) -> String {
    format!("({})", numbers.map(write_number).join(", "))
}

/// A nonzero vector. Its length does not matter.
#[derive(Clone, Copy)]
pub(crate) struct Direction(pub(crate) [f64; 3]);

impl Format for Direction {
    type Value = DVec3;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<DVec3> {
        let direction = Vector(self.0).read(reader, node, name)?;
        if direction.try_normalize().is_none() {
            let message = format!("`{name}` must be a direction, but its length is zero");
            reader.invalid_value(node, name, message, self.example());
            return None;
        }
        Some(direction)
    }

    fn write(&self, value: &DVec3) -> String {
        Vector(self.0).write(value)
    }

    fn describe(&self) -> String {
        Vector(self.0).describe()
    }

    fn example(&self) -> String {
        Vector(self.0).example()
    }
}

/// Red, green and blue, none below zero; or one number for all three.
#[derive(Clone, Copy)]
pub(crate) struct Color(pub(crate) f64);

impl Format for Color {
    type Value = Rgb;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<Rgb> {
        const EXAMPLE: &str = "(100, 90, 80)";
        let color = match node.elements() {
            None if node.value == Value::Number => Rgb::splat(number(self.0).read(reader, node, name)?),
            Some(items) if items.len() == 3 => Rgb::from_slice(&read_numbers(reader, items, name, EXAMPLE)?),
            _ => {
                reader.wrong_value(node, name, "a number or three", EXAMPLE);
                return None;
            }
        };
        if color.min_element() < 0.0 {
            let message = format!("`{name}` must not be below zero, but it is {}", node.text);
            reader.invalid_value(node, name, message, self.example());
            return None;
        }
        Some(color)
    }

    fn write(&self, value: &Rgb) -> String {
        if *value == Rgb::splat(value.x) { write_number(value.x) } else { write_numbers(value.to_array()) }
    }

    fn describe(&self) -> String {
        "number from 0 or `(r, g, b)`".into()
    }

    fn example(&self) -> String {
        write_number(self.0)
    }
}

/// `true` or `false`.
#[derive(Clone, Copy)]
pub(crate) struct Flag;

impl Format for Flag {
    type Value = bool;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<bool> {
        let Value::Bool(value) = node.value else {
            reader.wrong_value(node, name, "`true` or `false`", self.example());
            return None;
        };
        Some(value)
    }

    fn write(&self, value: &bool) -> String {
        value.to_string()
    }

    fn describe(&self) -> String {
        "`true` or `false`".into()
    }

    fn example(&self) -> String {
        "false".into()
    }
}

/// One of a few names.
#[derive(Clone, Copy)]
pub(crate) struct Choice<T: 'static>(pub(crate) &'static [(&'static str, T)]);

impl<T: Copy + PartialEq> Choice<T> {
    fn names(&self) -> Vec<&'static str> {
        self.0.iter().map(|(name, _)| *name).collect()
    }
}

impl<T: Copy + PartialEq> Format for Choice<T> {
    type Value = T;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<T> {
        let given = match &node.value {
            Value::Items(items) if items.is_empty() => node.name(),
            _ => "",
        };
        let chosen = self.0.iter().find(|(name, _)| *name == given);
        if chosen.is_none() {
            let names = self.names();
            let message = format!("`{name}` must be {}, but it is {}", list(&names, "or"), node.kind());
            let help = did_you_mean(given, &names).unwrap_or_else(|| format!("write {}", list(&names, "or")));
            reader.problem(node.text, message, help);
        }
        chosen.map(|(_, value)| *value)
    }

    fn write(&self, value: &T) -> String {
        self.0.iter().find(|(_, v)| v == value).map_or(String::new(), |(name, _)| (*name).into())
    }

    fn describe(&self) -> String {
        list(&self.names(), "or")
    }

    fn example(&self) -> String {
        self.0.first().map_or(String::new(), |(name, _)| (*name).into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_bits() {
        for x in [0.0, 1.0, -2.0, 0.1, 1e-300, 1.5e300, 123_456_789.0, 1e15, 2f64.powi(60), f64::MIN_POSITIVE]
        {
            assert_eq!(float(&write_number(x)).map(f64::to_bits), Some(x.to_bits()), "{x}");
        }
    }

    #[test]
    fn ranges_are_described_as_people_write_them() {
        let described = |max| count::<u64>(1, max, 1).describe();
        assert_eq!(described(16_384), "whole number from 1 to 16,384");
        assert_eq!(described(1_000_000_000_000_000), "whole number from 1 to 10¹⁵");
        assert_eq!(described(u64::MAX), "whole number from 1");
    }
}
