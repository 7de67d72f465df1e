//! What a pipeline says, with every default filled in: plain types.

pub(crate) mod lights;
pub(crate) mod output;
pub(crate) mod pipeline;
pub(crate) mod sensors;
pub(crate) mod transport;

pub use lights::Lamp;
pub use output::{CameraChoice, Content, Image, Output};
pub use pipeline::{Action, Pipeline, Repeat, Stage, Until};
pub use sensors::{Grid, Place, Plane, Sensors};
pub use transport::{DomainKind, Transport};
