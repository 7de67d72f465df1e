//! Where things stand in a file.

use std::ops::Range;

use crate::text::field::Format;
use crate::text::reader::Reader;
use crate::text::ron_tree::Node;

/// Bytes of a pipeline's text. All spans are equal: two files that say the same in different places say the same.
#[derive(Clone, Debug, Default)]
pub struct Span(pub Range<usize>);

impl PartialEq for Span {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A value, and where it stands in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub span: Span,
}

/// The format of a value whose place is remembered.
#[derive(Clone, Copy)]
pub(crate) struct WithSpan<F>(pub(crate) F);

impl<F: Format> Format for WithSpan<F> {
    type Value = Spanned<F::Value>;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<Self::Value> {
        // Of what has a name, that is enough.
        let part = if node.name().is_empty() { node.text } else { node.name() };
        let span = Span(reader.span(part));
        self.0.read(reader, node, name).map(|value| Spanned { value, span })
    }

    fn write(&self, value: &Self::Value) -> String {
        self.0.write(&value.value)
    }

    fn describe(&self) -> String {
        self.0.describe()
    }

    fn example(&self) -> String {
        self.0.example()
    }
}
