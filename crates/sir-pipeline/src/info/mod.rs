//! The contents of a scene, and suggested pipeline settings to light it.

pub(crate) mod advice;
pub(crate) mod choices;
pub(crate) mod facts;
pub(crate) mod inspect;
pub(crate) mod lamp_place;
pub(crate) mod lamps;
pub(crate) mod lines;
pub(crate) mod shape;
pub(crate) mod survey;

pub use facts::{Group, Info, Lights, MaterialInfo, Setting, Textures};
pub use inspect::inspect;
pub use lines::{Fates, Global, Lines};
pub use shape::{Dominant, Extent, Twins};
