//! Reads and writes RON text according to declared types. Reports all errors at once, each with its position.
//! Independent of pipelines.
//!
//! * `ron_tree`: the text as a tree whose nodes know their positions.
//! * `reader`: the state while a file is read; [`Diagnostics`]: problems with positions and suggested fixes.
//! * `field`, `formats`, `paths`, `span`: the syntax of values, and their defaults.
//! * `record`: types with named fields, and choices among types, declared once for reader, writer and reference.

pub(crate) mod back_slashes;
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
