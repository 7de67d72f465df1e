//! Lamps given by formulas, and the files that describe them.

use std::f64::consts::PI;
use std::fmt::Write as _;

use glam::DVec3;
use sir_photometry::Photometry;

/// Intensity \[cd\] in a direction of unit length.
pub(crate) type Lamp = fn(DVec3) -> f64;

/// Lambertian: flux π I₀.
pub(crate) fn cosine(d: DVec3) -> f64 {
    1000.0 * (-d.z).max(0.0)
}

/// Narrow beam: flux 2π I₀/(n + 1) with n = 10.
pub(crate) fn beam(d: DVec3) -> f64 {
    1000.0 * (-d.z).max(0.0).powi(10)
}

/// The same in all directions: flux 4π I₀.
pub(crate) fn uniform(_: DVec3) -> f64 {
    100.0
}

/// Without any symmetry: flux 4π 100 (1.5² + 0.7/3).
pub(crate) fn lopsided(d: DVec3) -> f64 {
    100.0 * (1.5 + d.dot(DVec3::new(0.5, 0.3, -0.6))).powi(2)
}

/// Symmetric to the plane y = 0.
pub(crate) fn symmetric_in_y(d: DVec3) -> f64 {
    lopsided(DVec3::new(d.x, d.y * d.y, d.z))
}

/// Symmetric to the plane x = 0.
pub(crate) fn symmetric_in_x(d: DVec3) -> f64 {
    lopsided(DVec3::new(d.x * d.x, d.y, d.z))
}

/// Symmetric to both planes.
pub(crate) fn symmetric_in_both(d: DVec3) -> f64 {
    lopsided(DVec3::new(d.x * d.x, d.y * d.y, d.z))
}

/// Returns the direction of angles \[°\] of IES type C: the vertical angle starts at −z; the horizontal angle starts at +x, and
/// runs counterclockwise, seen from above.
pub(crate) fn type_c(vertical: f64, horizontal: f64) -> DVec3 {
    let ((sin_v, cos_v), (sin_h, cos_h)) =
        (vertical.to_radians().sin_cos(), horizontal.to_radians().sin_cos());
    DVec3::new(sin_v * cos_h, sin_v * sin_h, -cos_v)
}

/// Returns the direction of angles of type A: the vertical angle is the elevation; the horizontal angle starts at +x, and runs
/// clockwise.
pub(crate) fn type_a(vertical: f64, horizontal: f64) -> DVec3 {
    let ((sin_v, cos_v), (sin_h, cos_h)) =
        (vertical.to_radians().sin_cos(), horizontal.to_radians().sin_cos());
    DVec3::new(cos_v * cos_h, -cos_v * sin_h, sin_v)
}

/// Returns the direction of angles of type B: the vertical angle turns from −z to +x around the axis y; the horizontal angle
/// leaves that plane clockwise, which is towards −y.
pub(crate) fn type_b(vertical: f64, horizontal: f64) -> DVec3 {
    let ((sin_v, cos_v), (sin_h, cos_h)) =
        (vertical.to_radians().sin_cos(), horizontal.to_radians().sin_cos());
    DVec3::new(cos_h * sin_v, -sin_h, -cos_h * cos_v)
}

/// Returns the direction of angles of EULUMDAT: the plane C90 is along x, C0 at −y.
pub(crate) fn c_gamma(gamma: f64, c: f64) -> DVec3 {
    type_c(gamma, c - 90.0)
}

/// Returns angles from one to another.
pub(crate) fn angles(from: f64, to: f64, step: f64) -> Vec<f64> {
    (0..=((to - from) / step).round() as u32).map(|i| from + f64::from(i) * step).collect()
}

/// An IES file.
pub(crate) struct Ies {
    /// Lines before `TILT=`.
    pub(crate) header: &'static str,
    /// Type: 1 is C, 2 is B, 3 is A.
    pub(crate) kind: u8,
    pub(crate) vertical: Vec<f64>,
    pub(crate) horizontal: Vec<f64>,
    /// Candela multiplier, ballast factor, and the number behind it. Values in the file are divided by the first two.
    pub(crate) factors: [f64; 3],
    /// Unit, width, length, height.
    pub(crate) opening: &'static str,
}

impl Ies {
    pub(crate) fn new(kind: u8, vertical: Vec<f64>, horizontal: Vec<f64>) -> Self {
        let header = "IESNA:LM-63-2002\n[MANUFAC] Tests\n[LUMINAIRE] Lamp\n";
        Self { header, kind, vertical, horizontal, factors: [1.0; 3], opening: "2 0 0 0" }
    }

    pub(crate) fn text(&self, lamp: Lamp) -> String {
        let Self { header, kind, vertical, horizontal, factors, opening } = self;
        let direction = [type_c, type_b, type_a][usize::from(kind - 1)];
        let mut text =
            format!("{header}TILT=NONE\n1 -1 {} {} {}", factors[0], vertical.len(), horizontal.len());
        writeln!(text, " {kind} {opening}\n{} {} 0", factors[1], factors[2]).unwrap();
        for angles in [vertical, horizontal] {
            writeln!(text, "{}", angles.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")).unwrap();
        }
        for &h in horizontal {
            let values = vertical.iter().map(|&v| lamp(direction(v, h)) / factors[0] / factors[1]);
            writeln!(text, "{}", values.map(|value| format!("{value:.9}")).collect::<Vec<_>>().join(" "))
                .unwrap();
        }
        text
    }

    pub(crate) fn read(&self, lamp: Lamp) -> Photometry {
        Photometry::parse(self.text(lamp).as_bytes()).unwrap()
    }
}

/// A EULUMDAT file.
pub(crate) struct Ldt {
    pub(crate) symmetry: u8,
    /// All planes, from 0 to less than 360°.
    pub(crate) planes: Vec<f64>,
    /// Those whose intensities are in the file.
    pub(crate) measured: Vec<f64>,
    pub(crate) gammas: Vec<f64>,
    /// Sets of lamps: number, flux, watts.
    pub(crate) lamps: Vec<[f64; 3]>,
    pub(crate) output_ratio: f64,
    pub(crate) conversion: f64,
    /// Length, width, heights of the luminous area \[mm\].
    pub(crate) area: [f64; 6],
}

impl Ldt {
    pub(crate) fn new(symmetry: u8, step: f64, gammas: Vec<f64>) -> Self {
        let planes = angles(0.0, 360.0 - step, step);
        let measured = match symmetry {
            0 => planes.clone(),
            1 => vec![0.0],
            2 => angles(0.0, 180.0, step),
            3 => angles(270.0, 450.0, step),
            _ => angles(0.0, 90.0, step),
        };
        let (lamps, area) = (vec![[1.0, 1000.0, 0.0]], [0.0; 6]);
        Self { symmetry, planes, measured, gammas, lamps, output_ratio: 100.0, conversion: 1.0, area }
    }

    pub(crate) fn text(&self, lamp: Lamp) -> String {
        let Self { symmetry, planes, measured, gammas, lamps, output_ratio, conversion, area } = self;
        let mut lines = vec!["Tests".to_owned(), "3".into(), symmetry.to_string()];
        lines.extend([planes.len().to_string(), "0".into(), gammas.len().to_string(), "0".into()]);
        lines.extend(["Report", "Lamp", "1", "lamp.ldt", "today", "0", "0", "0"].map(str::to_owned));
        lines.extend(area.map(|size| size.to_string()));
        lines.extend(["50".into(), output_ratio.to_string(), conversion.to_string(), "0".into()]);
        lines.push(lamps.len().to_string());
        for [count, flux, watts] in lamps {
            lines.extend([count.to_string(), "LED".into(), flux.to_string()]);
            lines.extend(["3000".into(), "1B".into(), watts.to_string()]);
        }
        lines.extend(std::iter::repeat_n("0.5".to_owned(), 10));
        lines.extend(planes.iter().chain(gammas).map(f64::to_string));
        let unit = lamps[0][1] / 1000.0 * conversion;
        for &c in measured {
            lines.extend(gammas.iter().map(|&gamma| format!("{:.9}", lamp(c_gamma(gamma, c)) / unit)));
        }
        lines.join("\r\n")
    }

    pub(crate) fn read(&self, lamp: Lamp) -> Photometry {
        Photometry::parse(self.text(lamp).as_bytes()).unwrap()
    }
}

/// Seeded generator of uniform numbers (SplitMix64; Steele, Lea and Flood 2014).
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    /// Returns a number in [0, 1).
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * 2f64.powi(-53)
    }

    /// Returns a uniform direction.
    pub(crate) fn direction(&mut self) -> DVec3 {
        let (z, azimuth) = (2.0 * self.next() - 1.0, 2.0 * PI * self.next());
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z)
    }
}

/// Checks that a file has the intensity of a lamp in 1,000 directions, within a share of the largest one.
pub(crate) fn assert_same(photometry: &Photometry, lamp: Lamp, tolerance: f64, what: &str) {
    let mut dice = Dice(1);
    for _ in 0..1000 {
        let direction = dice.direction();
        let (found, expected) = (photometry.distribution.intensity(direction), lamp(direction));
        let scale = photometry.distribution.largest();
        assert!(
            (found - expected).abs() < tolerance * scale,
            "{what}: {found} cd, not {expected} cd, at {direction}"
        );
    }
}
