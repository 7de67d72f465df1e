//! Frozen batches: global lines pass on what the batch before them has brought.
//!
//! While the lines of a batch are traced, what each side sends with a line is fixed, and what they bring is only added up;
//! the next batch sends it on. So the lines of a batch may be traced in any order and by any number of workers, and the
//! result does not depend on it. It is stochastic iteration (Szirmay-Kalos 1999, *Stochastic iteration for
//! non-diffuse global illumination*) along global lines, with these refinements:
//!
//! * *Nothing is lost.* A side that holds the power `U` and expects `n` lines of a batch sends `U/q` with each, and what
//!   `c` lines did not take, `U − cU/q`, stays for the next batch. Among all `q`, `n + 1` leaves the smallest mean square:
//!   `E(1 − c/q)²` for a Poisson number `c` is then `1/(n+1)`. Here `q = n + 1 + √n` (less if `n < 1`), for few sides to
//!   be crossed so often that they send more than they hold: what stays is then negative, and takes back later what was
//!   sent too much.
//! * *Lines go where the power is.* The sources are sent out in `K` equal parts with the first `K` batches, and the number
//!   of lines of a batch is about in proportion to the power that it sends. The batches after those are the *tail*.
//! * *Lines are counted.* A side is crossed more or less often than it should be. Of the `C` lines that crossed it, each is
//!   as good as any other, so at the end the power that they brought is multiplied by the number of lines expected, `λ`, over `C`: a
//!   ratio estimator. Given `C`, which is Poisson, it is exact on average if `λ` is divided by `1 − exp(−λ)`, for the sides
//!   that no line crossed. What is left of the noise is that lines bring different amounts, and nothing where all bring the
//!   same. A factor for all sides, almost one, lets them receive in all what was sent.
//! * *A focus has more lines.* With one, lines that do not meet it are rarer by a whole number, which is their weight: so many times the
//!   share of a side leaves with such a line, and so many lines it counts for. Sides in the focus are only crossed by lines of weight 1, as if
//!   there were no others. Of the others, `n` is the number of lines as if all had the larger weight, and what they receive is not
//!   multiplied, since lines are not as good as each other. How many lines a batch has follows from the power in the focus.
//! * *The tail is stretched.* What is still unshot at the end would be received much as was the power sent after the sources
//!   had ceased. Let there have been `L₀` unshot at that time and `L` at the end: then the power received since is
//!   multiplied by `1 + L/(L₀ − L)`, so that all power is accounted for.

mod estimator;
mod schedule;
mod side_range;
mod side_state;
mod sums;
mod transport;

pub use transport::{BatchSettings, Batches};
