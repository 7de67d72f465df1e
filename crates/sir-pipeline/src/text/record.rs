//! Records and choices: types whose single declaration generates the reader, the writer and the documentation.
//!
//! A *record* is `Name(field: value, …)`. `record!` declares its fields, each with a name, a type, a meaning and a
//! syntax. A *choice* is one of several named variants; `choice!` declares them.

use std::marker::PhantomData;

use crate::format::list;
use crate::text::field::{Format, Row};
use crate::text::reader::{Fields, Reader};
use crate::text::ron_tree::{Node, Value};

/// Content that may follow a name in a pipeline file: `Name(…)`.
pub(crate) trait Body: Sized {
    /// Reads the content; `node` includes the name.
    fn read<'a>(reader: &mut Reader<'a>, node: &Node<'a>) -> Option<Self>;

    /// Writes the name and the content.
    fn write(&self, name: &str) -> String;
}

/// Type with named fields.
pub(crate) trait Record: Sized {
    /// Name of the record in a file.
    const NAME: &'static str;

    /// Returns the rows of the fields in the reference.
    fn rows() -> Vec<Row>;

    /// Reads all fields. Reports problems to `reader` and returns `None` if any field is invalid.
    fn read_fields<'a>(reader: &mut Reader<'a>, fields: &Fields<'a>) -> Option<Self>;

    /// Writes all fields with their names.
    fn write_fields(&self) -> Vec<(&'static str, String)>;
}

impl<T: Record> Body for T {
    fn read<'a>(reader: &mut Reader<'a>, node: &Node<'a>) -> Option<Self> {
        if !["", T::NAME].contains(&node.name()) {
            let message = format!("expected `{}(…)`, but this is {}", T::NAME, node.kind());
            reader.problem(node.name(), message, format!("write `{}(…)`", T::NAME));
            return None;
        }
        let names: Vec<&str> = T::rows().iter().map(|row| row.name).collect();
        let fields = reader.fields(node, T::NAME, &names);
        T::read_fields(reader, &fields)
    }

    fn write(&self, name: &str) -> String {
        let fields: Vec<String> =
            self.write_fields().into_iter().map(|(name, text)| format!("{name}: {text}")).collect();
        match (name, fields.is_empty()) {
            ("", _) | (_, false) => format!("{name}({})", fields.join(", ")),
            (_, true) => name.into(),
        }
    }
}

/// Declares a record: a struct whose fields are read, written and documented according to this declaration.
///
/// The documentation of a field is its meaning in the reference. A [`Part`](crate::text::field::Part) after `=` defines
/// the syntax of the field. `as` gives a record or a field another name in files. `check` names a function that reports
/// problems which concern several fields.
macro_rules! record {
    (
        $(#[doc = $about:literal])*
        $visibility:vis struct $record:ident $(as $name:literal)? $(, check $check:path)? {
            $( $(#[doc = $meaning:literal])+ pub $field:ident $(as $key:literal)? : $type:ty = $part:expr; )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug, PartialEq)]
        $visibility struct $record {
            $( $(#[doc = $meaning])+ pub $field: $type, )*
        }

        impl $crate::text::record::Record for $record {
            const NAME: &'static str = $crate::text::record::key!($record $($name)?);

            fn rows() -> Vec<$crate::text::field::Row> {
                let mut rows = Vec::new();
                $(
                    rows.extend($crate::text::field::Part::rows(
                        &$crate::text::field::part::<$type, _>($part),
                        $crate::text::record::key!($field $($key)?),
                        concat!($($meaning),+),
                    ));
                )*
                rows
            }

            fn read_fields<'a>(
                reader: &mut $crate::text::reader::Reader<'a>,
                fields: &$crate::text::reader::Fields<'a>,
            ) -> Option<Self> {
                let ($($field,)*) = ($(
                    $crate::text::field::Part::read(
                        &$crate::text::field::part::<$type, _>($part),
                        reader,
                        fields,
                        $crate::text::record::key!($field $($key)?),
                    ),
                )*);
                let record = Self { $($field: $field?,)* };
                $($check(&record, reader, fields);)?
                Some(record)
            }

            fn write_fields(&self) -> Vec<(&'static str, String)> {
                let fields = [$(
                    $crate::text::field::Part::write(
                        &$crate::text::field::part::<$type, _>($part),
                        &self.$field,
                        $crate::text::record::key!($field $($key)?),
                    ),
                )*];
                fields.into_iter().flatten().collect()
            }
        }
    };
}

/// Expands to the name of a record or a field in files.
macro_rules! key {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident $key:literal) => {
        $key
    };
}

/// One of several named variants, each of which may have a content.
pub(crate) trait Choose: Clone + Sized {
    /// Common noun for the variants, such as `light`.
    const WHAT: &'static str;

    /// Names of the variants.
    const NAMES: &'static [&'static str];

    /// Returns the name of this variant.
    fn name(&self) -> &'static str;

    /// Reads the variant with this name.
    fn read_named<'a>(name: &str, reader: &mut Reader<'a>, node: &Node<'a>) -> Option<Self>;

    /// Writes this variant with its name.
    fn write(&self) -> String;

    /// Reads a variant of any name.
    fn read<'a>(reader: &mut Reader<'a>, node: &Node<'a>) -> Option<Self> {
        let name = reader.name_of(node, Self::WHAT, Self::NAMES)?;
        Self::read_named(name, reader, node)
    }
}

/// Returns the elements of the list in `Owner([…])`, or the single element in `Owner(…)`. The help shows `example`, an
/// element.
pub(crate) fn list_items<'n, 'a>(
    reader: &mut Reader<'a>,
    node: &'n Node<'a>,
    what: &str,
    example: &str,
) -> Option<&'n [Node<'a>]> {
    let items = match &node.value {
        Value::Items(items) => match items.as_slice() {
            [Node { value: Value::List(items), .. }] => items.as_slice(),
            single @ [_] => single,
            _ => &[],
        },
        _ => &[],
    };
    if items.is_empty() {
        let owner = node.name();
        let help = format!("write `{owner}([{example}])`");
        let message = match &node.value {
            Value::Items(items) if items.len() == 1 => format!("the list of {what} of `{owner}` is empty"),
            _ => format!("`{owner}` must have a list of {what}"),
        };
        reader.problem(node.text, message, help);
        return None;
    }
    Some(items)
}

/// Writes `Owner([…])`.
pub(crate) fn write_list<T: Choose>(owner: &str, all: &[T]) -> String {
    let all: Vec<String> = all.iter().map(Choose::write).collect();
    format!("{owner}([{}])", all.join(", "))
}

/// Declares a choice: an enum whose variants are written `Name`, or `Name(…)` with the content of the type in it.
macro_rules! choice {
    (
        $(#[doc = $about:literal])*
        pub enum $choice:ident as $what:literal {
            $( $(#[doc = $meaning:literal])+ $variant:ident $(($body:ty))?, )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug, PartialEq)]
        #[allow(clippy::large_enum_variant, reason = "a pipeline has few of them")]
        pub enum $choice {
            $( $(#[doc = $meaning])+ $variant $(($body))?, )*
        }

        impl $crate::text::record::Choose for $choice {
            const WHAT: &'static str = $what;
            const NAMES: &'static [&'static str] = &[$(stringify!($variant)),*];

            fn name(&self) -> &'static str {
                match self {
                    $( $crate::text::record::pattern!($variant $(_ignored $body)?) => stringify!($variant), )*
                }
            }

            fn read_named<'a>(
                name: &str,
                reader: &mut $crate::text::reader::Reader<'a>,
                node: &$crate::text::ron_tree::Node<'a>,
            ) -> Option<Self> {
                $(
                    if name == stringify!($variant) {
                        return $crate::text::record::read_variant!(reader, node, $variant $($body)?);
                    }
                )*
                None
            }

            fn write(&self) -> String {
                match self {
                    $( $crate::text::record::pattern!($variant $(body $body)?) => {
                        $crate::text::record::write_variant!($variant $(body $body)?)
                    } )*
                }
            }
        }
    };
}

macro_rules! pattern {
    ($variant:ident) => {
        Self::$variant
    };
    ($variant:ident $name:ident $body:ty) => {
        Self::$variant($name)
    };
}

macro_rules! read_variant {
    ($reader:ident, $node:ident, $variant:ident) => {{
        $reader.fields($node, stringify!($variant), &[]);
        Some(Self::$variant)
    }};
    ($reader:ident, $node:ident, $variant:ident $body:ty) => {
        <$body as $crate::text::record::Body>::read($reader, $node).map(Self::$variant)
    };
}

macro_rules! write_variant {
    ($variant:ident) => {
        stringify!($variant).to_owned()
    };
    ($variant:ident $name:ident $body:ty) => {
        $crate::text::record::Body::write($name, stringify!($variant))
    };
}

pub(crate) use {choice, key, pattern, read_variant, record, write_variant};

/// Format of a choice.
#[derive(Clone, Copy)]
pub(crate) struct Named<T> {
    example: &'static str,
    choice: PhantomData<T>,
}

/// Returns the format of a choice.
pub(crate) fn named<T: Choose>(example: &'static str) -> Named<T> {
    Named { example, choice: PhantomData }
}

impl<T: Choose> Format for Named<T> {
    type Value = T;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, _: &str) -> Option<T> {
        T::read(reader, node)
    }

    fn write(&self, value: &T) -> String {
        value.write()
    }

    fn describe(&self) -> String {
        list(T::NAMES, "or")
    }

    fn example(&self) -> String {
        self.example.into()
    }
}

/// Format of a record that is the value of a field. It is in a box, because most fields are small.
#[derive(Clone, Copy)]
pub(crate) struct Nested<T> {
    example: &'static str,
    record: PhantomData<T>,
}

/// Returns the format of a record that is the value of a field: its fields in parentheses.
pub(crate) fn nested<T: Record + Clone>(example: &'static str) -> Nested<T> {
    Nested { example, record: PhantomData }
}

impl<T: Record + Clone> Format for Nested<T> {
    type Value = Box<T>;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, _: &str) -> Option<Box<T>> {
        T::read(reader, node).map(Box::new)
    }

    fn write(&self, value: &Box<T>) -> String {
        Body::write(value.as_ref(), "")
    }

    fn describe(&self) -> String {
        let fields: Vec<&str> = T::rows().iter().map(|row| row.name).collect();
        format!("fields in parentheses: {}", list(&fields, "and"))
    }

    fn example(&self) -> String {
        self.example.into()
    }
}
