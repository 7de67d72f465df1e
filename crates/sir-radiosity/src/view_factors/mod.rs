//! View factors between groups of surfaces.
//!
//! `F_ij` is the share of the diffuse flux leaving group `i` that arrives directly at group `j` (Howell, Mengüç, Daun
//! and Siegel, *Thermal Radiation Heat Transfer*, ch. 4). It is estimated by local lines: `n_i` of them leave uniform
//! points of the active sides of group `i` in cosine-distributed directions, and the first hit of `N_ij` of them is on
//! an active side of group `j`. So `F_ij ≈ N_ij / n_i` is binomial, whatever the shape of the scene and however small
//! the group, and different rows are independent.

mod closure;
mod effort;
mod lines;
mod table;

pub use closure::{Closed, ClosureError};
pub use effort::{Accuracy, ViewFactorSettings};
pub use lines::{MAX_GROUPS, ViewFactorLines, ViewFactorTask};
pub use table::{Receiver, Residual, Share, ViewFactors};
