//! The text of a pipeline file: from RON to a typed [`Pipeline`](crate::plan::Pipeline), with all mistakes at once.
//!
//! * `ron_tree`: the text as a tree whose nodes know their places; `reader`: typed access to its nodes.
//! * `decode`: which stages there are; a file for each stage with more than a few fields; `order`: which may follow which.
//! * [`Diagnostics`]: what is wrong, where, and what to write instead.

pub(crate) mod decode;
pub(crate) mod diagnostic;
mod focus;
mod lights;
pub(crate) mod literal;
pub(crate) mod order;
mod outputs;
mod points_file;
mod read;
pub(crate) mod reader;
mod repeat;
pub(crate) mod ron_tree;
mod sensors;
pub(crate) mod suggest;

pub use diagnostic::{Diagnostic, Diagnostics, Position};
pub use literal::whole_number;
