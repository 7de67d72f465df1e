//! Being written.

mod decode;
pub mod diagnostic;
mod error;
mod fields;
mod order;
pub mod pipeline;
mod ron_tree;

pub use error::Error;

/// Runs the program.
#[must_use]
pub fn main() -> std::process::ExitCode {
    std::process::ExitCode::SUCCESS
}
