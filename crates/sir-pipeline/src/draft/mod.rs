//! Drafts a pipeline for a scene: what [`info`](crate::info) suggests, as a file with a comment on each choice.

mod place;
mod text;
mod write;

pub use text::{Choice, Goal};
pub use write::{Draft, DraftOptions, PIPELINE_FILE, draft};
