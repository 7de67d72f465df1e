//! View factors that obey reciprocity and add up to 1.
//!
//! Unknown are the exchange areas `G_ij = A_i F_ij = G_ji`, and what is blocked and escapes of each group, none of them negative. They
//! are to deviate least from what was counted, each deviation in its standard error, while each row adds up to `A_i`:
//! least-squares smoothing (Larsen and Howell 1986, *J. Heat Transfer* 108, 239–242; van Leersum 1989, *Int. J. Heat and Fluid
//! Flow* 10, 83–85), with the variances of the Monte Carlo estimates as weights (Daun, Morton and Howell 2005, *J. Heat Transfer* 127, 1124–1128).
//!
//! As a Poisson variable, the count `N_ij` has the mean `t_i G_ij` with `t_i = n_i/A_i`, and is independent of all others: that it is not,
//! because a row of `n_i` lines adds up to `n_i`, is what the constraint of the row says. Of `N_ij` and `N_ji` together the best
//! estimate is `G⁰_ij = (N_ij + N_ji)/(t_i + t_j)`, with the variance `v_ij = G⁰_ij/(t_i + t_j)`. What was never seen stays zero.
//!
//! With a multiplier `λ_i` for each row the solution is `G_ij = max(0, G⁰_ij + v_ij (λ_i + λ_j))`. Newton's method finds the
//! multipliers: solve for those `G_ij` that are positive, and again if these change (a primal-dual active set; Hintermüller, Ito and Kunisch
//! 2003, *SIAM J. Optim.* 13, 865–888).

use thiserror::Error;

use crate::view_factors::table::{Receiver, ViewFactors};

/// Most steps of Newton's method; a few are enough where there is a solution.
const STEPS: usize = 50;

/// Sums of rows are as close to 1.
const TOLERANCE: f64 = 1e-9;

/// A pivot that is so much smaller than the diagonal is rounding only.
const SINGULAR: f64 = 1e-12;

/// Why no factors obey reciprocity and add up to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ClosureError {
    /// The equations have no unique solution.
    #[error(
        "no view factors obey reciprocity and add up to 1: so far, some groups only see others whose factors leave nothing to adjust; \
         trace more lines, or ask for fewer groups"
    )]
    Undetermined,
}

/// View factors that obey reciprocity and add up to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Closed {
    areas: Vec<f64>,
    /// Exchange areas, then what is blocked and escapes, of each group; and their variances.
    exchange: Vec<f64>,
    variance: Vec<f64>,
}

impl ViewFactors {
    /// Returns factors that obey reciprocity and add up to 1, and are as close as they can be to those that were counted.
    ///
    /// # Errors
    ///
    /// If there are none, or too few lines to find them.
    pub fn closed(&self) -> Result<Closed, ClosureError> {
        close(self)
    }
}

impl Closed {
    fn at(&self, i: usize, receiver: Receiver) -> usize {
        let groups = self.areas.len();
        let column = match receiver {
            Receiver::Group(j) => j,
            Receiver::Blocked => groups,
            Receiver::Escaped => groups + 1,
        };
        i * (groups + 2) + column
    }

    /// The share of the flux of group `i` that arrives there, and its standard error: zero for what was never seen, and was
    /// held at zero.
    #[must_use]
    pub fn share(&self, i: usize, receiver: Receiver) -> (f64, f64) {
        let (at, area) = (self.at(i, receiver), self.areas[i]);
        (self.exchange[at] / area, self.variance[at].max(0.0).sqrt() / area)
    }

    /// The view factor `F_ij`.
    #[must_use]
    pub fn factor(&self, i: usize, j: usize) -> f64 {
        self.share(i, Receiver::Group(j)).0
    }

    /// By how much `F_ij` and `F_ji` miss reciprocity: rounding.
    #[must_use]
    pub fn reciprocity(&self, i: usize, j: usize) -> f64 {
        self.areas[i] * self.factor(i, j) - self.areas[j] * self.factor(j, i)
    }
}

/// The estimates and variances of all rows, before closure.
struct Estimates {
    groups: usize,
    areas: Vec<f64>,
    mean: Vec<f64>,
    variance: Vec<f64>,
}

impl Estimates {
    fn of(factors: &ViewFactors) -> Self {
        let groups = factors.len();
        let areas: Vec<f64> = (0..groups).map(|i| factors.area(i)).collect();
        let density: Vec<f64> =
            factors.lines().iter().zip(&areas).map(|(&n, area)| n as f64 / area).collect();
        let (mut mean, mut variance) = (Vec::new(), Vec::new());
        for i in 0..groups {
            let others = (0..groups).map(Receiver::Group);
            for receiver in others.chain([Receiver::Blocked, Receiver::Escaped]) {
                let (mut count, mut lines) = (factors.count(i, receiver), density[i]);
                if let Receiver::Group(j) = receiver
                    && j != i
                {
                    count += factors.count(j, Receiver::Group(i));
                    lines += density[j];
                }
                mean.push(count as f64 / lines);
                variance.push(count as f64 / (lines * lines));
            }
        }
        Self { groups, areas, mean, variance }
    }

    /// The value in a row and column for these multipliers, before it is kept from being negative.
    fn adjusted(&self, i: usize, column: usize, multipliers: &[f64]) -> f64 {
        let at = i * (self.groups + 2) + column;
        let other = if column < self.groups && column != i { multipliers[column] } else { 0.0 };
        self.mean[at] + self.variance[at] * (multipliers[i] + other)
    }

    /// For the values that are positive with these multipliers, the equations for the next ones: their matrix, and by how much
    /// the rows fall short of the areas.
    fn equations(&self, multipliers: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let n = self.groups;
        let (mut matrix, mut missing) = (vec![0.0; n * n], self.areas.clone());
        for i in 0..n {
            for column in 0..n + 2 {
                if self.adjusted(i, column, multipliers) > 0.0 {
                    let at = i * (n + 2) + column;
                    missing[i] -= self.mean[at];
                    matrix[i * n + i] += self.variance[at];
                    if column < n && column != i {
                        matrix[i * n + column] += self.variance[at];
                    }
                }
            }
        }
        (matrix, missing)
    }
}

/// Finds the closed factors.
pub(super) fn close(factors: &ViewFactors) -> Result<Closed, ClosureError> {
    let estimates = Estimates::of(factors);
    let n = estimates.groups;
    let mut multipliers = vec![0.0; n];
    for _ in 0..STEPS {
        let (matrix, missing) = estimates.equations(&multipliers);
        let root = Cholesky::of(matrix, n).ok_or(ClosureError::Undetermined)?;
        multipliers = root.solve(missing);
        let exchange: Vec<f64> = (0..n)
            .flat_map(|i| (0..n + 2).map(move |column| (i, column)))
            .map(|(i, column)| estimates.adjusted(i, column, &multipliers).max(0.0))
            .collect();
        let rows = exchange.chunks(n + 2).zip(&estimates.areas);
        if rows.into_iter().all(|(row, area)| (row.iter().sum::<f64>() - area).abs() <= TOLERANCE * area) {
            let variance = variances(&estimates, &exchange, &root);
            return Ok(Closed { areas: estimates.areas, exchange, variance });
        }
    }
    Err(ClosureError::Undetermined)
}

/// Variances of the adjusted values: those of the estimates, less what the constraints explain.
fn variances(estimates: &Estimates, exchange: &[f64], root: &Cholesky) -> Vec<f64> {
    let n = estimates.groups;
    let inverse: Vec<Vec<f64>> = (0..n)
        .map(|k| {
            let mut unit = vec![0.0; n];
            unit[k] = 1.0;
            root.solve(unit)
        })
        .collect();
    let mut variances = Vec::with_capacity(exchange.len());
    for (i, of_row) in inverse.iter().enumerate() {
        for column in 0..n + 2 {
            let at = i * (n + 2) + column;
            let v = estimates.variance[at];
            let explained = match column {
                j if j < n && j != i => of_row[i] + inverse[j][j] + 2.0 * of_row[j],
                _ => of_row[i],
            };
            variances.push(if exchange[at] > 0.0 { (v - v * v * explained).max(0.0) } else { 0.0 });
        }
    }
    variances
}

/// The triangular root of a symmetric positive definite matrix. Written here, since fast libraries round differently on
/// different processors.
struct Cholesky {
    n: usize,
    /// Rows of the lower triangle; the upper one is not used.
    lower: Vec<f64>,
}

impl Cholesky {
    /// The root of a matrix; `None` if that is singular.
    fn of(mut matrix: Vec<f64>, n: usize) -> Option<Self> {
        for i in 0..n {
            let (above, row) = matrix.split_at_mut(i * n);
            for j in 0..i {
                let dot: f64 = above[j * n..j * n + j].iter().zip(&row[..j]).map(|(a, b)| a * b).sum();
                row[j] = (row[j] - dot) / above[j * n + j];
            }
            let pivot = row[i] - row[..i].iter().map(|a| a * a).sum::<f64>();
            if pivot <= SINGULAR * row[i] {
                return None;
            }
            row[i] = pivot.sqrt();
        }
        Some(Self { n, lower: matrix })
    }

    /// Solves for a right-hand side.
    fn solve(&self, mut x: Vec<f64>) -> Vec<f64> {
        let (n, lower) = (self.n, &self.lower);
        for i in 0..n {
            let dot: f64 = (0..i).map(|j| lower[i * n + j] * x[j]).sum();
            x[i] = (x[i] - dot) / lower[i * n + i];
        }
        for i in (0..n).rev() {
            x[i] /= lower[i * n + i];
            for j in 0..i {
                x[j] -= lower[i * n + j] * x[i];
            }
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_solve_and_singular_matrices_have_none() {
        let matrix = vec![4.0, 1.0, 0.5, 1.0, 3.0, -1.0, 0.5, -1.0, 2.0];
        let x = Cholesky::of(matrix.clone(), 3).unwrap().solve(vec![1.0, 2.0, 3.0]);
        for (row, expected) in matrix.chunks(3).zip([1.0, 2.0, 3.0]) {
            let found: f64 = row.iter().zip(&x).map(|(a, b)| a * b).sum();
            assert!((found - expected).abs() < 1e-14, "{found}");
        }
        assert!(Cholesky::of(vec![1.0, 1.0, 1.0, 1.0], 2).is_none());
    }

    /// Counts of some groups of area 1 with 1,000 lines each.
    fn counted(counts: &[&[u64]]) -> ViewFactors {
        let n = counts.len();
        ViewFactors {
            names: vec![String::new(); n],
            areas: vec![1.0; n],
            lines: vec![1000; n],
            counts: counts.concat(),
        }
    }

    #[test]
    fn negative_factors_are_kept_out() {
        // Far more arrives at the second group than it has room for.
        let factors = counted(&[&[43, 913, 20, 24, 0], &[161, 653, 98, 68, 20], &[4, 908, 83, 5, 0]]);
        let closed = factors.closed().unwrap();
        for i in 0..3 {
            let receivers = (0..3).map(Receiver::Group).chain([Receiver::Blocked, Receiver::Escaped]);
            let shares: Vec<f64> = receivers.map(|receiver| closed.share(i, receiver).0).collect();
            assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{shares:?}");
            assert!(shares.iter().all(|&share| share >= 0.0), "{shares:?}");
            assert!((0..3).all(|j| closed.reciprocity(i, j).abs() < 1e-15));
        }
        assert_eq!(closed.share(1, Receiver::Group(1)), (0.0, 0.0));
        assert!(closed.factor(0, 1) > 0.5);
    }

    #[test]
    fn what_cannot_be_closed_is_an_error() {
        // Two groups that see only each other have the same exchange area, but different areas.
        let mut factors = counted(&[&[0, 1000, 0, 0], &[1000, 0, 0, 0]]);
        factors.areas[1] = 2.0;
        assert_eq!(factors.closed(), Err(ClosureError::Undetermined));
    }
}
