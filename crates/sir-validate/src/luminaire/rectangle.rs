//! The flux that a lamp with the intensity `I₀ cosⁿ θ` sends to a rectangle across its axis: checks of the exact answers in
//! `luminaires.json`.
//!
//! There is a closed form for every whole `n`. At the distance `h` the illuminance is `I₀ hⁿ⁺¹ s^−(n+3)/2` with
//! `s = h² + x² + y²`, and the divergence of `(x, y) s^−k` relates the integrals of `s^−k` and `s^−(k+1)` over a rectangle
//! to integrals along its edges. The first of them are a solid angle (even `n`) and the configuration factor of a
//! rectangle (odd `n`).

use crate::data::{Case, Reference, Shape};
use crate::luminaire::lamp::Lamp;
use crate::luminaire::setup::Setup;

/// Returns `∫ (c + t²)^−k dt` from 0 to `y`, for `2k = twice` of at least 2.
fn edge(twice: i32, c: f64, y: f64) -> f64 {
    match twice {
        2 => (y / c.sqrt()).atan() / c.sqrt(),
        3 => y / (c * (c + y * y).sqrt()),
        _ => {
            let k = f64::from(twice - 2) / 2.0;
            (y * (c + y * y).powf(-k) + (2.0 * k - 1.0) * edge(twice - 2, c, y)) / (2.0 * k * c)
        }
    }
}

/// Returns the integral of `s^−k` over the rectangle from the axis to the corner `x`, `y`, for `2k = twice` of at least 3. It
/// changes its sign with `x` and `y`.
fn corner(twice: i32, h: f64, x: f64, y: f64) -> f64 {
    if twice == 3 {
        return (x * y / (h * (h * h + x * x + y * y).sqrt())).atan() / h;
    }
    let k = f64::from(twice - 2) / 2.0;
    // Its factor is 0 for k = 1.
    let before = if twice == 4 { 0.0 } else { (2.0 * k - 2.0) * corner(twice - 2, h, x, y) };
    let edges = x * edge(twice - 2, h * h + x * x, y) + y * edge(twice - 2, h * h + y * y, x);
    (before + edges) / (2.0 * k * h * h)
}

/// Returns the points and weights of Gauss-Legendre quadrature from −1 to 1 with `n` points, by Newton's method.
fn gauss_legendre(n: u32) -> Vec<(f64, f64)> {
    let point = |i: u32| {
        let mut x = (std::f64::consts::PI * (f64::from(i) + 0.75) / (f64::from(n) + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=n {
                let k = f64::from(k);
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = f64::from(n) * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(point).collect()
}

/// A rectangle across the axis of a lamp, with the flux that it receives.
struct Rectangle {
    peak: f64,
    exponent: i32,
    height: f64,
    /// Limits along x and along y.
    x: [f64; 2],
    y: [f64; 2],
    flux: f64,
}

impl Rectangle {
    /// Returns the rectangles of LU-01.
    fn all() -> Vec<Self> {
        let reference = Reference::built_in().unwrap();
        let case: &Case = reference.cases.iter().find(|case| case.id == "LU-01").unwrap();
        let setups: Vec<Setup> = case.values().unwrap();
        let mut all = Vec::new();
        for setup in &setups {
            let Lamp::Power { peak, exponent, .. } = setup.lamp else { continue };
            for surface in &setup.surfaces {
                let Shape::Polygon { vertices } = &surface.shape else { continue };
                let ends = |axis: usize| [vertices[0][axis], vertices[2][axis]];
                let flux = setup.fluxes[&surface.name];
                let height = setup.position[2];
                all.push(Self { peak, exponent, height, x: ends(0), y: ends(1), flux });
            }
        }
        all
    }

    fn factor(&self) -> f64 {
        self.peak * self.height.powi(self.exponent + 1)
    }

    fn closed_form(&self) -> f64 {
        let Self { exponent, height, x: [left, right], y: [near, far], .. } = *self;
        let at = |x, y| corner(exponent + 3, height, x, y);
        self.factor() * (at(right, far) - at(left, far) - at(right, near) + at(left, near))
    }

    fn quadrature(&self, points: u32) -> f64 {
        let rule = gauss_legendre(points);
        let along = |[a, b]: [f64; 2]| {
            rule.iter().map(move |(t, weight)| (0.5 * (a + b) + 0.5 * (b - a) * t, 0.5 * (b - a) * weight))
        };
        let mut sum = 0.0;
        for (x, dx) in along(self.x) {
            for (y, dy) in along(self.y) {
                let s = self.height * self.height + x * x + y * y;
                sum += dx * dy * s.powf(-0.5 * f64::from(self.exponent + 3));
            }
        }
        self.factor() * sum
    }
}

/// The answers are those of the closed form, and of quadrature, which converges.
#[test]
fn rectangles_have_their_flux() {
    let all = Rectangle::all();
    assert_eq!(all.len(), 6);
    for rectangle in all {
        let near = |found: f64, tolerance: f64| (found / rectangle.flux - 1.0).abs() < tolerance;
        let [few, some, many] = [4, 16, 24].map(|points| rectangle.quadrature(points));
        let closed = rectangle.closed_form();
        assert!(near(closed, 1e-12), "{closed}, {}", rectangle.flux);
        assert!(near(few, 1e-2) && !near(few, 1e-9), "{few}");
        assert!(near(some, 1e-10) && near(many, 1e-12), "{some}, {many}");
    }
}
