//! Estimated view factors between all groups.

use crate::view_factors::effort::variance;

/// Receiver of flux that leaves a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Receiver {
    /// Active sides of the group with this number.
    Group(usize),
    /// The back of a one-sided surface, which absorbs the flux.
    Blocked,
    /// None: the flux leaves the scene.
    Escaped,
}

/// Estimated share of the flux that leaves a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// The share, as the binomial mean `N/n`. The shares of a row add up to 1.
    pub value: f64,
    /// Standard error `√(p (1 − p)/n)`, where Laplace's `p = (N + 1)/(n + 2)` replaces the share. It is never zero: if
    /// none or all of `n` lines arrived, that does not prove that the share is 0 or 1.
    pub error: f64,
    /// Upper bound of the share with 95 % confidence where nothing arrived: `3/n` (the rule of three; Hanley and
    /// Lippman-Hand 1983).
    pub bound: Option<f64>,
}

/// View factors between all groups of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewFactors {
    pub(super) names: Vec<String>,
    pub(super) areas: Vec<f64>,
    /// Number of lines of each group.
    pub(super) lines: Vec<u64>,
    /// For each group, the number of lines that arrived at each group, were blocked, and escaped.
    pub(super) counts: Vec<u64>,
}

/// Difference between two estimates of the same exchange area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// `A_i F_ij − A_j F_ji`, in the square of the scene's unit of length.
    pub value: f64,
    /// Standard error of `value`, never zero.
    pub error: f64,
}

impl Residual {
    /// Returns the difference in units of its standard error.
    #[must_use]
    pub fn z(self) -> f64 {
        self.value / self.error
    }
}

impl ViewFactors {
    /// Returns the number of groups.
    #[must_use]
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// True if there are no groups, which never happens for a scene.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Returns the names of the groups, as in their [`Grouping`](crate::Grouping).
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the area `A_i` of the active sides of a group, in the square of the scene's unit of length.
    #[must_use]
    pub fn area(&self, i: usize) -> f64 {
        self.areas[i]
    }

    /// Returns the number of lines that left each group.
    #[must_use]
    pub fn lines(&self) -> &[u64] {
        &self.lines
    }

    /// Returns the total number of lines.
    #[must_use]
    pub fn total_lines(&self) -> u64 {
        self.lines.iter().sum()
    }

    /// Returns the number of lines of group `i` that arrived at a receiver.
    #[must_use]
    pub fn count(&self, i: usize, receiver: Receiver) -> u64 {
        let groups = self.len();
        let column = match receiver {
            Receiver::Group(j) => j,
            Receiver::Blocked => groups,
            Receiver::Escaped => groups + 1,
        };
        self.counts[i * (groups + 2) + column]
    }

    /// Returns the share of the flux of group `i` that arrives at a receiver.
    #[must_use]
    pub fn share(&self, i: usize, receiver: Receiver) -> Share {
        let (count, lines) = (self.count(i, receiver), self.lines[i]);
        let n = lines as f64;
        Share {
            value: count as f64 / n,
            error: (variance(count, lines) / n).sqrt(),
            bound: (count == 0).then_some((3.0 / n).min(1.0)),
        }
    }

    /// Returns the view factor `F_ij`.
    #[must_use]
    pub fn factor(&self, i: usize, j: usize) -> f64 {
        self.share(i, Receiver::Group(j)).value
    }

    /// Returns the standard error of `F_ij`.
    #[must_use]
    pub fn error(&self, i: usize, j: usize) -> f64 {
        self.share(i, Receiver::Group(j)).error
    }

    /// Returns the reciprocity residual of `F_ij` and `F_ji`, the deviation from `A_i F_ij = A_j F_ji`. It is due to
    /// chance only, because the two are counted independently.
    ///
    /// The standard error is that of two binomial shares of the exchange area estimated from both rows together, with
    /// one line added, because few lines of a row alone give too little information about their own error.
    #[must_use]
    pub fn reciprocity(&self, i: usize, j: usize) -> Residual {
        let (one, other) = (self.count(i, Receiver::Group(j)), self.count(j, Receiver::Group(i)));
        let density = |k: usize| self.lines[k] as f64 / self.areas[k];
        let exchange = (one + other + 1) as f64 / (density(i) + density(j));
        let variance = |k: usize| exchange * (1.0 - exchange / self.areas[k]).max(0.0) / density(k);
        Residual {
            value: self.areas[i] * self.factor(i, j) - self.areas[j] * self.factor(j, i),
            error: (variance(i) + variance(j)).sqrt(),
        }
    }
}
