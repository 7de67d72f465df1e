//! The error type of the crate.

use thiserror::Error;

use crate::power::POWERS;

/// An error that prevents a solution.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum SolveError {
    /// Nothing in the scene emits light.
    #[error(
        "nothing in the scene emits light; give a material an emission \
         (glTF: emissiveFactor with KHR_materials_emissive_strength, OBJ: Ke in the MTL file), or add lights in \
         the pipeline, for instance `Light([Sky(horizontal: 1000)])`"
    )]
    NoLight,
    /// The power of the sources is outside [`POWERS`](crate::POWERS).
    #[error(
        "the light sources of the scene emit {watts:.3e} W together, but powers must be between {:.0e} and {:.0e} W; \
         correct the emission of materials and lights, or give all of them in another unit", POWERS.start(), POWERS.end()
    )]
    Power {
        /// Total power of the strongest band \[W\].
        watts: f64,
    },
    /// The energy balance does not close, because a tally overflowed.
    #[error(
        "the energy balance of the {stage} does not close (a tally overflowed, because too few lines \
         carry too much power each); trace more lines"
    )]
    Unbalanced {
        /// Name of the stage, such as `first shot` or `multipath`.
        stage: &'static str,
    },
    /// View factors are requested between too many groups.
    #[error(
        "the scene has {groups} groups, but view factors are limited to {most}; group the surfaces by \
         material, or join some groups"
    )]
    TooManyGroups {
        /// Number of groups.
        groups: usize,
        /// Largest number of groups.
        most: usize,
    },
    /// View factors are requested with too few lines.
    #[error("{lines} lines are too few for {groups} groups; ask for at least {fewest}")]
    TooFewLines {
        /// Number of lines requested.
        lines: u64,
        /// Number of groups.
        groups: usize,
        /// Smallest number of lines.
        fewest: u64,
    },
}
