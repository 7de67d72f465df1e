//! Dimensions that several parts of the room share \[m\].
//!
//! The middle of the floor is `x = 0`, and the dais is at `z = 0`.

/// Half the width of the room, equal to the radius of its barrel vault.
pub(super) const HALF_WIDTH: f64 = 4.0;
/// Length of one bay between two columns.
pub(super) const BAY: f64 = 3.0;
/// Number of bays.
pub(super) const BAYS: usize = 5;
/// Length of the room.
pub(super) const LENGTH: f64 = BAY * BAYS as f64;
/// Height at which the vault begins.
pub(super) const SPRING: f64 = 4.4;
/// Number of segments of the vault's half circle.
pub(super) const ARC: usize = 24;
/// Width of a floor tile, and of the cells of large surfaces.
pub(super) const TILE: f64 = 0.5;

/// Arched opening in the middle of a bay.
pub(super) struct Opening {
    /// Height of its lower edge.
    pub(super) sill: f64,
    /// Height at which its arch begins.
    pub(super) spring: f64,
    /// Half its width, equal to the radius of its arch.
    pub(super) radius: f64,
}

/// Opening of the windows and of the niche behind the dais.
pub(super) const OPENING: Opening = Opening { sill: 1.2, spring: 2.9, radius: 1.0 };

/// Distance of the columns' axes from the wall.
pub(super) const COLUMN: f64 = 0.4;
/// Height of the underside of the cornice.
pub(super) const CORNICE: f64 = 4.08;

/// Height of the dais.
pub(super) const DAIS: f64 = 0.6;
/// Depth of the dais along `z`.
pub(super) const DAIS_DEPTH: f64 = 2.6;
