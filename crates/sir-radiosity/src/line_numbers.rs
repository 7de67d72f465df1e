//! Numbers of the lines of a stage: independent ones, or those of a Sobol' sequence.

use sir_lines::{Numbers, Purpose, SobolPoint, SobolPoints, Stream, Streams};

use crate::shot::Points;

/// Numbers of all lines of a stage.
#[derive(Debug)]
pub(crate) enum LineNumbers {
    Random(Streams),
    Sobol(Box<SobolPoints>),
}

/// Numbers of one line.
pub(crate) enum NumbersOfLine {
    Random(Stream),
    Sobol(SobolPoint),
}

impl LineNumbers {
    pub(crate) fn new(points: Points, seed: u64, purpose: Purpose) -> Self {
        match points {
            Points::Random => Self::Random(Streams::new(seed, purpose)),
            Points::Sobol => Self::Sobol(Box::new(SobolPoints::new(seed, purpose))),
        }
    }

    /// Returns the numbers of a line.
    #[inline]
    pub(crate) fn line(&self, index: u64) -> NumbersOfLine {
        match self {
            Self::Random(streams) => NumbersOfLine::Random(streams.line(index)),
            Self::Sobol(points) => NumbersOfLine::Sobol(points.line(index)),
        }
    }
}

impl Numbers for NumbersOfLine {
    #[inline]
    fn unit(&mut self) -> f64 {
        match self {
            Self::Random(stream) => stream.unit(),
            Self::Sobol(point) => point.unit(),
        }
    }
}
