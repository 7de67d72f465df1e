//! Errors.

use thiserror::Error;

/// Why light cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum SolveError {
    /// There is no light of any kind.
    #[error(
        "nothing in the scene emits light; give a material an emission \
         (glTF: emissiveFactor with KHR_materials_emissive_strength, OBJ: Ke in the MTL file), or add lights in the pipeline, for \
         instance `Light([Sky(horizontal: 1000)])`"
    )]
    NoLight,
    /// Power was lost or made: a tally overflowed.
    #[error(
        "the energy balance of the {stage} does not close: a tally overflowed, because too few lines \
         carry too much power each; ask for more lines"
    )]
    Unbalanced {
        /// `first shot` or `multipath`.
        stage: &'static str,
    },
    /// View factors are asked for between too many groups.
    #[error(
        "the scene has {groups} groups, and view factors can be had between {most}; group the surfaces by material, or join some"
    )]
    TooManyGroups {
        /// How many there are.
        groups: usize,
        /// The most.
        most: usize,
    },
    /// View factors are asked for with too few lines.
    #[error("{lines} lines are too few for {groups} groups; ask for at least {fewest}")]
    TooFewLines {
        /// Lines asked for.
        lines: u64,
        /// Number of groups.
        groups: usize,
        /// The fewest lines.
        fewest: u64,
    },
}
