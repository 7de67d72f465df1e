//! Positions of values in a file.

use std::ops::Range;

use crate::text::field::Format;
use crate::text::reader::Reader;
use crate::text::ron_tree::Node;

/// Byte range in the text of a pipeline. All spans compare as equal, so that pipelines are equal if they differ only in
/// the positions of their values.
#[derive(Clone, Debug, Default)]
pub struct Span(pub Range<usize>);

impl PartialEq for Span {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A value with its position in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Spanned<T> {
    /// Value.
    pub value: T,
    /// Position of the value.
    pub span: Span,
}

/// Format of a value whose position is kept.
#[derive(Clone, Copy)]
pub(crate) struct WithSpan<F>(pub(crate) F);

impl<F: Format> Format for WithSpan<F> {
    type Value = Spanned<F::Value>;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<Self::Value> {
        // The span of a named value is its name.
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
