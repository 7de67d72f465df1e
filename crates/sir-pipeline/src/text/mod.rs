//! Reading and writing RON text by declared types, with all mistakes at once, each at its place. Knows nothing of pipelines.
//!
//! * `ron_tree`: the text as a tree whose nodes know their places.
//! * `reader`: what is known while a file is read; [`Diagnostics`]: what is wrong, where, and what to write instead.
//! * `field`, `formats`, `paths`, `span`: how values are written, and what holds where they are left out.
//! * `record`: types with named fields, and choices among them, declared once for reader, writer and reference.

pub(crate) mod diagnostic;
pub(crate) mod field;
pub(crate) mod formats;
pub(crate) mod literal;
pub(crate) mod paths;
pub(crate) mod reader;
pub(crate) mod record;
pub(crate) mod ron_tree;
pub(crate) mod span;
pub(crate) mod suggest;

pub use diagnostic::{Diagnostic, Diagnostics, Position};
pub use literal::whole_number;
pub use span::{Span, Spanned};
