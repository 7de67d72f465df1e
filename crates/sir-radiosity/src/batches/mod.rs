//! Frozen batches: global lines pass on the power that the previous batch has brought.
//!
//! While the lines of a batch are traced, the power that each side sends with a line is fixed, and the power that lines
//! bring is only added up. The next batch sends it on. The lines of a batch may therefore be traced in any order and by
//! any number of workers, with the same result. The method is stochastic iteration (Szirmay-Kalos 1999, *Stochastic
//! iteration for non-diffuse global illumination*) along global lines, with these refinements:
//!
//! * *Power is conserved.* A side that holds the power `U` and expects `n` lines of a batch sends `U/q` with each. What
//!   `c` lines did not take, `U − cU/q`, is kept for the next batch. Among all `q`, `n + 1` leaves the smallest mean
//!   square: `E(1 − c/q)²` for a Poisson number `c` is then `1/(n+1)`. Here `q = n + 1 + √n` (less if `n < 1`), so that
//!   few sides are crossed so often that they send more than they hold. The power of such a side becomes negative, and
//!   later lines take the excess back.
//! * *Lines in proportion to power.* The power of the sources is sent out in `K` equal parts with the first `K`
//!   batches, and the number of lines of a batch is about in proportion to the power that it sends. The batches after
//!   those are the *tail*.
//! * *Ratio estimator.* A side is crossed more or less often than expected. The `C` lines that crossed it are
//!   equivalent, so at the end the power that they brought is multiplied by the expected number of lines `λ` over `C`.
//!   Given `C`, which is Poisson-distributed, the estimator is exact on average if `λ` is divided by `1 − exp(−λ)`,
//!   which accounts for sides that no line crossed. The remaining noise comes from the different amounts that lines
//!   bring, and vanishes where all bring the same. A common factor close to one makes the total received power equal to
//!   the total sent.
//! * *Focus.* With a focus, lines that do not meet it are rarer by an integer factor, which is their weight: such a
//!   line takes the share of a side times its weight, and counts for as many lines. Sides in the focus are crossed only
//!   by lines of weight 1, as if there were no others. For the other sides, `n` is the number of lines if all had the
//!   larger weight, and the ratio estimator is not applied, because their lines are not equivalent. The number of lines
//!   of a batch follows from the power in the focus.
//! * *Random walks.* What is unshot when the lines end is sent on by random walks along local lines, which end where
//!   their light is absorbed. So nothing is left out, however few lines meet a surface, or however often light is
//!   reflected.

mod patch_sizes;
mod schedule;
mod side_range;
mod side_state;
mod sums;
mod transport;
mod walks;

pub use patch_sizes::crossings_per_patch;
pub use transport::{BatchSettings, Batches};
