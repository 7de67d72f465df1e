//! Sums of power over sides.

use std::ops::AddAssign;

use crate::power::Quanta;

/// Power of all sides, and of the sides in the focus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct FocusSums {
    pub(super) all: Quanta,
    pub(super) in_focus: Quanta,
}

impl FocusSums {
    #[inline]
    pub(super) fn add(&mut self, power: Quanta, in_focus: bool) {
        self.all += power;
        if in_focus {
            self.in_focus += power;
        }
    }

    /// Returns the sum in which sides outside the focus have the weight `outside`.
    pub(super) fn weighted(self, outside: f64) -> f64 {
        self.in_focus.total() + outside * (self.all - self.in_focus).total()
    }
}

impl AddAssign for FocusSums {
    fn add_assign(&mut self, other: Self) {
        self.all += other.all;
        self.in_focus += other.in_focus;
    }
}

/// Power of a batch, summed over sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct BatchSums {
    pub(super) unshot: FocusSums,
    pub(super) sent: FocusSums,
    pub(super) reflected: FocusSums,
    pub(super) absorbed: Quanta,
}

impl AddAssign for BatchSums {
    fn add_assign(&mut self, other: Self) {
        self.unshot += other.unshot;
        self.sent += other.sent;
        self.reflected += other.reflected;
        self.absorbed += other.absorbed;
    }
}
