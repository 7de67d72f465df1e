//! Luminous intensity as a function of direction, tabulated over angles.

use std::f64::consts::{PI, TAU};
use std::fmt;

use glam::{DMat3, DVec3};

use crate::bits::hash_of;
use crate::error::TableError;
use crate::span::{Span, share_of_line};

/// Luminous intensity as a function of direction: a table over the angles of a spherical coordinate system, between
/// which it is interpolated linearly in both angles. It is zero outside the table.
///
/// Directions are those of the luminaire: it is aimed at −z, and its length is along x.
///
/// Planes of constant azimuth share the axis of the coordinate system. Intensities are in candela, if the flux is to be in
/// lumens; any other unit gives the flux in that unit times a steradian.
///
/// Its `Debug` text is short: the size of the table, the flux, and a hash of all bits, so that different tables have
/// different texts.
#[derive(Clone, PartialEq)]
pub struct IntensityDistribution {
    /// Directions of the azimuths 0 and 90°, and of the polar angle 0, in the frame of the luminaire.
    axes: DMat3,
    /// Azimuths of the planes \[rad\], ascending, over at most a full turn.
    azimuths: Vec<f64>,
    /// Polar angles \[rad\], ascending, from 0 to π at most.
    polars: Vec<f64>,
    /// Intensities, all polar angles of a plane after each other.
    values: Vec<f64>,
    /// Per plane and polar angle, the integral of the intensity times the sine up to there \[cd rad\].
    sums: Vec<f64>,
    /// Flux between the first plane and each plane \[lm\].
    fluxes: Vec<f64>,
    /// Hash of all of the above.
    hash: u128,
}

impl fmt::Debug for IntensityDistribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("IntensityDistribution")
            .field("planes", &self.azimuths.len())
            .field("polars", &self.polars.len())
            .field("flux", &self.flux())
            .field("hash", &format_args!("{:032x}", self.hash))
            .finish()
    }
}

/// Spherical coordinate system of photometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// Type C of IES LM-63: the polar angle is 0 at −z; the azimuth is 0 at +x, along the luminaire, and 90° at +y.
    C,
    /// C-γ system of EULUMDAT and the CIE: the polar angle γ is 0 at −z. The plane C90 is along the luminaire: C is 0 at
    /// −y and 90° at +x.
    CAcross,
    /// Type B of IES LM-63: planes share the horizontal axis y. The vertical angle is the azimuth around it, 0 at −z and 90°
    /// at +x; the horizontal angle is −90° at +y and 90° at −y, and the polar angle is 90° more.
    B,
    /// Type A of IES LM-63: the vertical angle is −90° at −z, and the polar angle is 90° more; the horizontal angle is 0 at +x
    /// and 90° at −y.
    A,
}

impl Coordinates {
    /// Returns the directions of the azimuths 0 and 90°, and of the polar angle 0, in the frame of the luminaire.
    fn axes(self) -> DMat3 {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        let [zero, quarter, pole] = match self {
            Self::C => [x, y, -z],
            Self::CAcross => [-y, x, -z],
            Self::B => [-z, x, y],
            Self::A => [x, -y, -z],
        };
        DMat3::from_cols(zero, quarter, pole)
    }
}

/// Largest deviation of angles \[°\] that are meant to be a full turn or a pole.
const ROUNDING: f64 = 1e-6;

impl IntensityDistribution {
    /// Makes a distribution from a table. `azimuths` and `polars` are in degrees, and `values` has the intensities of all
    /// polar angles in the first plane, then in the second, and so on. A single plane stands for all azimuths.
    ///
    /// # Errors
    ///
    /// If angles do not ascend, azimuths span more than 360° or polar angles are outside of 0 to 180°, if there are fewer than
    /// two polar angles or no plane, if the number of values is not that of all pairs of angles, if an intensity is negative
    /// or a number is not finite, or if all intensities are zero.
    pub fn new(
        coordinates: Coordinates,
        azimuths: &[f64],
        polars: &[f64],
        values: &[f64],
    ) -> Result<Self, TableError> {
        check(azimuths, polars, values)?;
        let [mut azimuths, polars] = [azimuths, polars]
            .map(|angles| angles.iter().map(|degrees| degrees.to_radians()).collect::<Vec<f64>>());
        let mut values = values.to_vec();
        // A table that ends at 180.0000001° ends at the pole.
        let polars: Vec<f64> = polars.into_iter().map(|polar| polar.min(PI)).collect();
        if let [only] = azimuths[..] {
            azimuths.push(only + TAU);
            values.extend_from_within(..);
        }
        // A table that ends at 360.0001° is one of a full turn.
        if let [first, .., last] = &mut azimuths[..]
            && (*last - *first - TAU).abs() < ROUNDING.to_radians()
        {
            *last = *first + TAU;
        }
        let mut sums = Vec::with_capacity(values.len());
        for plane in values.chunks(polars.len()) {
            let mut sum = 0.0;
            sums.push(sum);
            for (angles, pair) in polars.windows(2).zip(plane.windows(2)) {
                sum += Span::of(angles, pair).up_to(angles[1])[0];
                sums.push(sum);
            }
        }
        let total_of = |plane: usize| sums[(plane + 1) * polars.len() - 1];
        let mut flux = 0.0;
        let mut fluxes = vec![0.0];
        for (plane, pair) in azimuths.windows(2).enumerate() {
            flux += 0.5 * (pair[1] - pair[0]) * (total_of(plane) + total_of(plane + 1));
            fluxes.push(flux);
        }
        if !flux.is_finite() {
            return Err(TableError::NotFinite);
        }
        if flux <= 0.0 {
            return Err(TableError::Dark);
        }
        let table = Self { axes: coordinates.axes(), azimuths, polars, values, sums, fluxes, hash: 0 };
        Ok(table.hashed())
    }

    /// Returns the distribution with the hash of its table.
    fn hashed(mut self) -> Self {
        let Self { azimuths, polars, values, .. } = &self;
        let sizes = [azimuths.len() as f64, polars.len() as f64];
        let table = azimuths.iter().chain(polars).chain(values).copied();
        self.hash = hash_of(self.axes.to_cols_array().into_iter().chain(sizes).chain(table));
        self
    }

    /// Returns the distribution with all intensities multiplied by a factor, which must be positive.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        for numbers in [&mut self.values, &mut self.sums, &mut self.fluxes] {
            numbers.iter_mut().for_each(|number| *number *= factor);
        }
        self.hashed()
    }

    /// Returns the flux \[lm\]: the integral of the intensity over all directions.
    #[must_use]
    pub fn flux(&self) -> f64 {
        self.fluxes.last().copied().unwrap_or(0.0)
    }

    /// Returns the largest intensity \[cd\].
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }

    /// Returns the intensity \[cd\] in a direction of unit length in the frame of the luminaire.
    #[must_use]
    pub fn intensity(&self, direction: DVec3) -> f64 {
        let [a, b, c] = (self.axes.transpose() * direction).to_array();
        let polar = libm::atan2(libm::hypot(a, b), c);
        let Some(i) = cell(&self.polars, polar) else { return 0.0 };
        // The azimuth of the table that stands for this one.
        let (first, azimuth) = (self.azimuths[0], libm::atan2(b, a));
        let turned = (azimuth - first).rem_euclid(TAU);
        // The first plane of a partial table must not be missed by rounding.
        let azimuth = first + if turned > TAU - SLACK { 0.0 } else { turned };
        let Some(plane) = cell(&self.azimuths, azimuth) else { return 0.0 };
        let along = share(&self.polars, i, polar);
        let [near, far] = [plane, plane + 1].map(|plane| {
            let at = plane * self.polars.len() + i;
            self.values[at] + along * (self.values[at + 1] - self.values[at])
        });
        near + share(&self.azimuths, plane, azimuth) * (far - near)
    }

    /// Returns the direction that belongs to a point of the unit square, of unit length, in the frame of the luminaire. The
    /// density of the directions of uniform points is the intensity over the flux.
    ///
    /// The density of the azimuth is linear between planes, and its distribution is inverted exactly; that of the polar angle
    /// is inverted by Newton's method, to rounding. Both grow with their coordinate, so low-discrepancy points keep their
    /// advantage.
    #[must_use]
    pub fn sample(&self, [u, v]: [f64; 2]) -> DVec3 {
        let wanted = u * self.flux();
        // If `wanted` is rounded up to the whole flux, dark planes at the end must not be chosen.
        let total = self.flux();
        let plane = self.fluxes.partition_point(|&flux| flux <= wanted && flux < total);
        let plane = plane.clamp(1, self.fluxes.len() - 1) - 1;
        let n = self.polars.len();
        let [near, far] = [plane, plane + 1].map(|plane| &self.sums[plane * n..(plane + 1) * n]);
        let width = self.azimuths[plane + 1] - self.azimuths[plane];
        let across = share_of_line([near[n - 1], far[n - 1]], (wanted - self.fluxes[plane]) / width);
        // Sums of the interpolated plane.
        let sum = |i: usize| near[i] + across * (far[i] - near[i]);
        let total = sum(n - 1);
        let wanted = v * total;
        let (mut low, mut high) = (0, n - 1);
        while high - low > 1 {
            let middle = low.midpoint(high);
            if sum(middle) <= wanted && sum(middle) < total {
                low = middle;
            } else {
                high = middle;
            }
        }
        let at = |i: usize| {
            let [near, far] = [plane, plane + 1].map(|plane| self.values[plane * n + i]);
            near + across * (far - near)
        };
        let span = Span::of(&self.polars[low..=high], &[at(low), at(high)]);
        let polar = span.inverse(wanted - sum(low), self.polars[high]);
        let azimuth = self.azimuths[plane] + across * width;
        let ((sin_azimuth, cos_azimuth), (sin, cos)) = (libm::sincos(azimuth), libm::sincos(polar));
        self.axes * DVec3::new(sin * cos_azimuth, sin * sin_azimuth, cos)
    }

    /// Returns the integral over all directions of the intensity times a function of the direction, by a midpoint rule over
    /// parts of the cells of the table, of at most `step` degrees in both angles.
    #[must_use]
    pub fn integrate(&self, step: f64, mut of: impl FnMut(DVec3) -> f64) -> f64 {
        let mut sum = 0.0;
        self.for_each_part(step, |direction, flux| sum += flux * of(direction));
        sum
    }

    /// Calls a function with the middle and the flux \[lm\] of each part of the cells that are not dark.
    pub(crate) fn for_each_part(&self, step: f64, mut visit: impl FnMut(DVec3, f64)) {
        let n = self.polars.len();
        let largest = step.to_radians();
        // Middles and widths of the parts of the range between two angles.
        let parts = |angles: &[f64]| {
            let (start, width) = (angles[0], angles[1] - angles[0]);
            let count = ((width / largest - ROUNDING).ceil() as u32).max(1);
            let part = width / f64::from(count);
            (0..count).map(move |i| {
                (start + (f64::from(i) + 0.5) * part, (f64::from(i) + 0.5) / f64::from(count), part)
            })
        };
        for (plane, azimuths) in self.azimuths.windows(2).enumerate() {
            for (i, polars) in self.polars.windows(2).enumerate() {
                let [near, far] = [plane, plane + 1].map(|plane| &self.values[plane * n + i..][..2]);
                if near.iter().chain(far).all(|&value| value == 0.0) {
                    continue;
                }
                for (azimuth, across, turn) in parts(azimuths) {
                    let (sin_azimuth, cos_azimuth) = libm::sincos(azimuth);
                    for (polar, along, height) in parts(polars) {
                        let [near, far] = [near, far].map(|pair| pair[0] + along * (pair[1] - pair[0]));
                        let value = near + across * (far - near);
                        let (sin, cos) = libm::sincos(polar);
                        // cos a − cos b = 2 sin((a + b)/2) sin((b − a)/2)
                        let solid_angle = turn * 2.0 * sin * libm::sin(0.5 * height);
                        let direction = self.axes * DVec3::new(sin * cos_azimuth, sin * sin_azimuth, cos);
                        visit(direction, value * solid_angle);
                    }
                }
            }
        }
    }
}

fn check(azimuths: &[f64], polars: &[f64], values: &[f64]) -> Result<(), TableError> {
    let ascends = |angles: &[f64]| angles.windows(2).all(|pair| pair[0] < pair[1]);
    let (Some(first), Some(last)) = (azimuths.first(), azimuths.last()) else {
        return Err(TableError::Size { azimuths: 0, polars: polars.len(), values: values.len() });
    };
    if polars.len() < 2 || azimuths.len() * polars.len() != values.len() {
        let (azimuths, polars, values) = (azimuths.len(), polars.len(), values.len());
        return Err(TableError::Size { azimuths, polars, values });
    }
    if !azimuths.iter().chain(polars).chain(values).all(|number| number.is_finite()) {
        return Err(TableError::NotFinite);
    }
    if !ascends(azimuths) || !ascends(polars) {
        return Err(TableError::Order);
    }
    if last - first > 360.0 + ROUNDING || polars[0] < 0.0 || polars[polars.len() - 1] > 180.0 + ROUNDING {
        return Err(TableError::Range);
    }
    if let Some(&value) = values.iter().find(|&&value| value < 0.0) {
        return Err(TableError::Negative { value });
    }
    Ok(())
}

/// Largest distance \[rad\] of a direction from a table to which it still belongs: a table that reaches a pole or a full turn
/// must have that direction in spite of rounding.
const SLACK: f64 = 1e-12;

/// Returns the index of the first of the two angles between which an angle lies; `None` if it is outside of all.
fn cell(angles: &[f64], angle: f64) -> Option<usize> {
    let (first, last) = (angles.first()?, angles.last()?);
    (first - SLACK..=last + SLACK)
        .contains(&angle)
        .then(|| angles.partition_point(|&other| other <= angle).clamp(1, angles.len() - 1) - 1)
}

/// Returns the share of the distance from an angle to the next that lies before `angle`.
fn share(angles: &[f64], i: usize, angle: f64) -> f64 {
    ((angle - angles[i]) / (angles[i + 1] - angles[i])).clamp(0.0, 1.0)
}
