//! Fields: the syntax of a value, and its default.

use serde::Serialize;

use crate::format::list;
use crate::text::reader::{Fields, Reader};
use crate::text::ron_tree::Node;

/// Syntax of a value in a pipeline file.
pub(crate) trait Format: Sized {
    /// Type of the value.
    type Value: Clone;

    /// Reads the value of the field `name`. Reports problems to `reader` and returns `None` if it is invalid.
    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<Self::Value>;

    /// Writes a value so that [`read`](Self::read) can read it.
    fn write(&self, value: &Self::Value) -> String;

    /// Describes the valid values, for the reference.
    fn describe(&self) -> String;

    /// Returns an example of a valid value.
    fn example(&self) -> String;

    /// Returns a required field.
    fn required(self) -> Field<Self> {
        Field { format: self, unit: "", default: None }
    }

    /// Returns a field with a default.
    fn or(self, default: Self::Value) -> Field<Self> {
        Field { format: self, unit: "", default: Some(default) }
    }

    /// Returns an optional field. `without` describes for the reference what applies if it is omitted.
    fn optional(self, without: &'static str) -> Optional<Self> {
        Optional { format: self, unit: "", without }
    }
}

/// Row of a table of fields in the reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Name of the field.
    pub name: &'static str,
    /// Valid values.
    #[serde(rename = "value")]
    pub values: String,
    /// Unit, or empty.
    pub unit: &'static str,
    /// Default, or a remark that there is none.
    pub default: String,
    /// Meaning of the field.
    pub meaning: &'static str,
}

/// Part of a record: one field, or several fields of which exactly one is given.
pub(crate) trait Part {
    /// Type of the value of the part.
    type Value;

    /// Returns the rows of the reference for the part with this name and meaning.
    fn rows(&self, name: &'static str, meaning: &'static str) -> Vec<Row>;

    /// Reads the part. Reports problems to `reader` and returns `None` if it is invalid.
    fn read<'a>(&self, reader: &mut Reader<'a>, fields: &Fields<'a>, name: &str) -> Option<Self::Value>;

    /// Writes the part as a field: its name and its value. Returns `None` if it is omitted.
    fn write(&self, value: &Self::Value, name: &'static str) -> Option<(&'static str, String)>;
}

/// Returns the part unchanged. Fixes the type of its value for type inference.
pub(crate) fn part<T, P: Part<Value = T>>(part: P) -> P {
    part
}

/// Field that is required or has a default.
pub(crate) struct Field<F: Format> {
    format: F,
    unit: &'static str,
    default: Option<F::Value>,
}

impl<F: Format> Field<F> {
    /// Sets the unit.
    pub(crate) fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }
}

impl<F: Format> Part for Field<F> {
    type Value = F::Value;

    fn rows(&self, name: &'static str, meaning: &'static str) -> Vec<Row> {
        let Self { format, unit, default } = self;
        let default =
            default.as_ref().map_or("required".into(), |value| format!("`{}`", format.write(value)));
        vec![Row { name, values: format.describe(), unit, default, meaning }]
    }

    fn read<'a>(&self, reader: &mut Reader<'a>, fields: &Fields<'a>, name: &str) -> Option<F::Value> {
        match (fields.get(name), &self.default) {
            (Some(node), _) => self.format.read(reader, node, name),
            (None, Some(default)) => Some(default.clone()),
            (None, None) => {
                if !fields.is_excused(name) {
                    let Fields { owner, place, .. } = fields;
                    let help = format!("write `{owner}({name}: {}, …)`", self.format.example());
                    reader.problem(place, format!("`{owner}` lacks the field `{name}`"), help);
                }
                None
            }
        }
    }

    fn write(&self, value: &F::Value, name: &'static str) -> Option<(&'static str, String)> {
        Some((name, self.format.write(value)))
    }
}

/// Optional field.
pub(crate) struct Optional<F: Format> {
    format: F,
    unit: &'static str,
    without: &'static str,
}

impl<F: Format> Optional<F> {
    /// Sets the unit.
    pub(crate) fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }
}

impl<F: Format> Part for Optional<F> {
    type Value = Option<F::Value>;

    fn rows(&self, name: &'static str, meaning: &'static str) -> Vec<Row> {
        let Self { format, unit, without } = self;
        vec![Row { name, values: format.describe(), unit, default: (*without).into(), meaning }]
    }

    fn read<'a>(&self, reader: &mut Reader<'a>, fields: &Fields<'a>, name: &str) -> Option<Self::Value> {
        match fields.get(name) {
            Some(node) => self.format.read(reader, node, name).map(Some),
            None => Some(None),
        }
    }

    fn write(&self, value: &Self::Value, name: &'static str) -> Option<(&'static str, String)> {
        value.as_ref().map(|value| (name, self.format.write(value)))
    }
}

/// Several fields, of which exactly one is given.
pub(crate) struct OneOf<T> {
    alternatives: Vec<Alternative<T>>,
}

struct Alternative<T> {
    row: Row,
    example: String,
    read: Box<ReadValue<T>>,
    write: Box<WriteValue<T>>,
}

type ReadValue<T> = dyn for<'a> Fn(&mut Reader<'a>, &Node<'a>) -> Option<T>;
type WriteValue<T> = dyn Fn(&T) -> Option<String>;

impl<T: 'static> OneOf<T> {
    /// Returns a part without fields.
    pub(crate) fn new() -> Self {
        Self { alternatives: Vec::new() }
    }

    /// Adds a field. `wrap` converts its value to that of the part; `unwrap` converts it back, if it is of this field.
    pub(crate) fn field<F: Format + Clone + 'static>(
        mut self,
        name: &'static str,
        format: F,
        unit: &'static str,
        meaning: &'static str,
        wrap: fn(F::Value) -> T,
        unwrap: fn(&T) -> Option<F::Value>,
    ) -> Self {
        let row = Row { name, values: format.describe(), unit, default: String::new(), meaning };
        let example = format.example();
        let writer = format.clone();
        self.alternatives.push(Alternative {
            row,
            example,
            read: Box::new(move |reader, node| format.read(reader, node, name).map(wrap)),
            write: Box::new(move |value| unwrap(value).map(|value| writer.write(&value))),
        });
        self
    }

    fn names(&self) -> Vec<&'static str> {
        self.alternatives.iter().map(|a| a.row.name).collect()
    }
}

impl<T: 'static> Part for OneOf<T> {
    type Value = T;

    fn rows(&self, _: &'static str, _: &'static str) -> Vec<Row> {
        let names = self.names();
        let row = |a: &Alternative<T>| {
            let others: Vec<&str> = names.iter().copied().filter(|name| *name != a.row.name).collect();
            let comma = if others.len() > 1 { "," } else { " or" };
            Row { default: format!("this{comma} {}", list(&others, "or")), ..a.row.clone() }
        };
        self.alternatives.iter().map(row).collect()
    }

    fn read<'a>(&self, reader: &mut Reader<'a>, fields: &Fields<'a>, _: &str) -> Option<T> {
        let Fields { owner, place, .. } = fields;
        let mut given = self.alternatives.iter().filter_map(|a| fields.get(a.row.name).map(|node| (a, node)));
        let Some((first, node)) = given.next() else {
            if !self.names().iter().any(|name| fields.is_excused(name)) {
                let examples: Vec<String> =
                    self.alternatives.iter().map(|a| format!("{}: {}", a.row.name, a.example)).collect();
                let message = format!("`{owner}` needs one of the fields {}", list(&self.names(), "and"));
                reader.problem(place, message, format!("write {}", list(&examples, "or")));
            }
            return None;
        };
        let value = (first.read)(reader, node);
        for (other, node) in given {
            let message = format!("`{owner}` has both `{}` and `{}`", first.row.name, other.row.name);
            reader.problem(node.text, message, "keep one of them");
            (other.read)(reader, node);
        }
        value
    }

    fn write(&self, value: &T, _: &'static str) -> Option<(&'static str, String)> {
        self.alternatives.iter().find_map(|a| (a.write)(value).map(|text| (a.row.name, text)))
    }
}
