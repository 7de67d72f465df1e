//! View factors that obey reciprocity and add up to 1.
//!
//! The unknowns are the exchange areas `G_ij = A_i F_ij = G_ji`, and the blocked and escaped parts of each group, none
//! of them negative. They minimize the squared deviations from the estimates, in units of their standard errors, under
//! the constraint that each row adds up to `A_i`: least-squares smoothing (Larsen and Howell 1986, *J. Heat Transfer*
//! 108, 239–242; van Leersum 1989, *Int. J. Heat and Fluid Flow* 10, 83–85), with the variances of the Monte Carlo
//! estimates as weights (Daun, Morton and Howell 2005, *J. Heat Transfer* 127, 1124–1128).
//!
//! The count `N_ij` is taken as a Poisson variable with the mean `t_i G_ij`, where `t_i = n_i/A_i`, independent of all
//! other counts. The counts of a row are not independent, because they add up to `n_i`, but this is expressed by the
//! constraint of the row. The best estimate from `N_ij` and `N_ji` together is `G⁰_ij = (N_ij + N_ji)/(t_i + t_j)`,
//! with the variance `v_ij = G⁰_ij/(t_i + t_j)`. An exchange area without counts stays zero.
//!
//! With a multiplier `λ_i` for each row, the solution is `G_ij = max(0, G⁰_ij + v_ij (λ_i + λ_j))`. Newton's method
//! finds the multipliers: it solves for the `G_ij` that are positive, and repeats this if their set changes (a
//! primal-dual active set; Hintermüller, Ito and Kunisch 2003, *SIAM J. Optim.* 13, 865–888).

use thiserror::Error;

use crate::view_factors::table::{Receiver, ViewFactors};

/// Largest number of steps of Newton's method. A few are enough if there is a solution.
const STEPS: usize = 50;

/// Largest relative deviation of the sum of a row.
const TOLERANCE: f64 = 1e-9;

/// Ratio of a pivot to the diagonal below which the pivot is only rounding error.
const SINGULAR: f64 = 1e-12;

/// The reason why no factors obey reciprocity and add up to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ClosureError {
    /// The equations have no unique solution.
    #[error(
        "no view factors obey reciprocity and add up to 1 (with the lines so far, some groups see only \
         groups whose factors cannot be adjusted); trace more lines, or use fewer groups"
    )]
    Undetermined,
}

/// View factors that obey reciprocity and add up to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Closed {
    areas: Vec<f64>,
    /// Exchange areas of each group, followed by its blocked and escaped parts, and their variances.
    exchange: Vec<f64>,
    variance: Vec<f64>,
}

impl ViewFactors {
    /// Returns the factors that obey reciprocity, add up to 1, and deviate least from the estimates.
    ///
    /// # Errors
    ///
    /// If there are none, or too few lines to determine them.
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

    /// Returns the share of the flux of group `i` that arrives at a receiver, and its standard error. The error is zero
    /// for a share that was never observed, and for one that was clamped to zero.
    #[must_use]
    pub fn share(&self, i: usize, receiver: Receiver) -> (f64, f64) {
        let (at, area) = (self.at(i, receiver), self.areas[i]);
        (self.exchange[at] / area, self.variance[at].max(0.0).sqrt() / area)
    }

    /// Returns the view factor `F_ij`.
    #[must_use]
    pub fn factor(&self, i: usize, j: usize) -> f64 {
        self.share(i, Receiver::Group(j)).0
    }

    /// Returns the reciprocity residual of `F_ij` and `F_ji`, which is only rounding error.
    #[must_use]
    pub fn reciprocity(&self, i: usize, j: usize) -> f64 {
        self.areas[i] * self.factor(i, j) - self.areas[j] * self.factor(j, i)
    }
}

/// Estimates and variances of all rows, before closure.
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

    /// Returns the value in a row and column for these multipliers, before it is clamped at zero.
    fn adjusted(&self, i: usize, column: usize, multipliers: &[f64]) -> f64 {
        let at = i * (self.groups + 2) + column;
        let other = if column < self.groups && column != i { multipliers[column] } else { 0.0 };
        self.mean[at] + self.variance[at] * (multipliers[i] + other)
    }

    /// Returns the equations for the next multipliers, from the values that are positive with these multipliers: the
    /// matrix, and the difference between the areas and the sums of the rows.
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

/// Returns the variances of the adjusted values: those of the estimates, less what the constraints explain.
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

/// Cholesky factor of a symmetric positive definite matrix. Implemented here, because fast libraries round differently
/// on different processors.
struct Cholesky {
    n: usize,
    /// Rows of the lower triangle; the upper one is not used.
    lower: Vec<f64>,
}

impl Cholesky {
    /// Returns the factor of a matrix, or `None` if the matrix is singular.
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

    /// Returns factors with these counts, for groups of area 1 with 1,000 lines each.
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
        // Far more flux arrives at the second group than its area allows.
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
