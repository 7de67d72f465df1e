//! View factors between all groups, as they were counted.

use crate::view_factors::effort::variance;

/// Where flux that leaves a group may arrive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Receiver {
    /// At active sides of the group of this number.
    Group(usize),
    /// At the back of a one-sided surface, which absorbs it.
    Blocked,
    /// Nowhere: it leaves the scene.
    Escaped,
}

/// A share of the flux that leaves a group, as it was counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// The share: the binomial mean `N/n`. The shares of a row add up to 1.
    pub value: f64,
    /// Its standard error `√(p (1 − p)/n)`, with Laplace's `p = (N + 1)/(n + 2)` in place of the share: it is never zero, since that
    /// none of `n` lines arrived, or all of them, does not prove that none, or all, would.
    pub error: f64,
    /// Where nothing arrived: what the share is below, with 95 % confidence, `3/n` (the rule of three; Hanley and Lippman-Hand 1983).
    pub bound: Option<f64>,
}

/// View factors between all groups of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewFactors {
    pub(super) names: Vec<String>,
    pub(super) areas: Vec<f64>,
    /// Lines of each group.
    pub(super) lines: Vec<u64>,
    /// Of each group, the lines that met each group, were blocked, and escaped.
    pub(super) counts: Vec<u64>,
}

/// By how much two estimates of the same exchange area differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// `A_i F_ij − A_j F_ji`, in the square of the scene's unit of length.
    pub value: f64,
    /// Its standard error, never zero.
    pub error: f64,
}

impl Residual {
    /// The difference in standard errors.
    #[must_use]
    pub fn z(self) -> f64 {
        self.value / self.error
    }
}

impl ViewFactors {
    /// Number of groups.
    #[must_use]
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether there are no groups: never, of a scene.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Names of the groups, as their [`Grouping`](crate::Grouping) has them.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Area `A_i` of the active sides of a group, in the square of the scene's unit of length.
    #[must_use]
    pub fn area(&self, i: usize) -> f64 {
        self.areas[i]
    }

    /// Lines that left each group.
    #[must_use]
    pub fn lines(&self) -> &[u64] {
        &self.lines
    }

    /// Lines in all.
    #[must_use]
    pub fn total_lines(&self) -> u64 {
        self.lines.iter().sum()
    }

    /// How many lines of group `i` arrived there.
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

    /// The share of the flux of group `i` that arrives there.
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

    /// The view factor `F_ij`.
    #[must_use]
    pub fn factor(&self, i: usize, j: usize) -> f64 {
        self.share(i, Receiver::Group(j)).value
    }

    /// The standard error of `F_ij`.
    #[must_use]
    pub fn error(&self, i: usize, j: usize) -> f64 {
        self.share(i, Receiver::Group(j)).error
    }

    /// By how much `F_ij` and `F_ji` miss reciprocity, `A_i F_ij = A_j F_ji`: by chance only, since both are counted by themselves.
    ///
    /// The standard error is that of two binomial shares of the exchange area that both rows together give, with one line more: few
    /// lines of a row say too little about their own error.
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
