//! One HTML page with the result of a radiosity run.
//!
//! [`View`] codes the light of all patches for the viewer of the page. [`write_page`] writes the page: the viewer, the
//! coded light, and *facts*, a JSON object with the figures of the run. The page is one file. It needs no server and no
//! network, and a content security policy allows nothing but its own script and style sheet.
//!
//! # Coded light
//!
//! The page holds the vertices of the display mesh with their irradiance, and for every side of a patch its irradiance, its
//! standard error and where it belongs. Numbers of light are 16-bit codes of logarithms: steps of .05 % over 14 decades
//! ([`LogScale`]), so that three digits are exact. Arrays are differences of neighbors in planes of bytes, which deflates to a
//! third. `web/script/mesh.js` reads them.
//!
//! [`LiveServer`] serves a page that follows a run.
//!
//! Very large meshes are shown with fewer patches: see [`MAX_SIDES`].

mod arrays;
mod live;
mod log_scale;
mod page;
mod simplified;
mod view;

pub use live::LiveServer;
pub use log_scale::LogScale;
pub use page::write_page;
pub use view::{Light, MAX_SIDES, View};
