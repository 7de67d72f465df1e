//! Approximate signed distance functions of figures, and the primitives that compose them.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

/// Returns the smooth union of two distances, with a fillet of about the width `k`.
pub(super) fn blend(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - 0.25 * h * h * k
}

/// Returns the distance from a limb: a ball that moves from `a` to `b` while its radius changes from `ra` to `rb`.
pub(super) fn limb(p: DVec3, a: [f64; 3], b: [f64; 3], [ra, rb]: [f64; 2]) -> f64 {
    let (a, b) = (DVec3::from_array(a), DVec3::from_array(b));
    let axis = b - a;
    let t = ((p - a).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
    p.distance(a + t * axis) - (ra + t * (rb - ra))
}

/// Returns the approximate distance from an ellipsoid.
pub(super) fn ellipsoid(p: DVec3, middle: [f64; 3], radii: [f64; 3]) -> f64 {
    let (q, radii) = (p - DVec3::from_array(middle), DVec3::from_array(radii));
    let scaled = (q / radii).length();
    scaled * (scaled - 1.0) / (q / (radii * radii)).length().max(1e-9)
}

/// Returns the distance from a head of height 0.27 about the origin that looks along `+z`, with hair in a knot.
fn head(p: DVec3) -> f64 {
    let mut d = ellipsoid(p, [0.0, 0.02, -0.005], [0.083, 0.115, 0.105]);
    d = blend(d, ellipsoid(p, [0.0, -0.055, 0.03], [0.060, 0.075, 0.072]), 0.05);
    // Nose, brow and chin.
    d = blend(d, limb(p, [0.0, 0.025, 0.092], [0.0, -0.030, 0.118], [0.010, 0.017]), 0.025);
    d = blend(d, limb(p, [-0.05, 0.035, 0.082], [0.05, 0.035, 0.082], [0.012, 0.012]), 0.02);
    d = blend(d, ellipsoid(p, [0.0, -0.100, 0.068], [0.026, 0.022, 0.026]), 0.03);
    // Sockets of the eyes, and the mouth.
    for side in [-1.0, 1.0] {
        d = -blend(-d, ellipsoid(p, [side * 0.034, 0.008, 0.112], [0.020, 0.013, 0.018]), 0.02);
    }
    // Hair, in strands.
    let strands = 0.006 * (9.0 * p.x.atan2(p.y + 0.02)).sin();
    let hair = ellipsoid(p, [0.0, 0.052, -0.030], [0.094, 0.095, 0.108]) + strands;
    let face = ellipsoid(p, [0.0, -0.02, 0.115], [0.075, 0.10, 0.075]);
    d = blend(d, hair.max(-face), 0.012);
    blend(d, ellipsoid(p, [0.0, 0.045, -0.145], [0.050, 0.048, 0.050]), 0.02)
}

/// Returns the distance from a bust from `y = 0` up to about 0.68, without its foot.
pub(super) fn bust(p: DVec3) -> f64 {
    let mut d = ellipsoid(p, [0.0, 0.13, 0.0], [0.19, 0.22, 0.125]);
    d = blend(d, limb(p, [-0.19, 0.235, -0.01], [0.19, 0.235, -0.01], [0.075, 0.075]), 0.08);
    d = blend(d, limb(p, [0.0, 0.25, -0.01], [0.0, 0.44, 0.01], [0.072, 0.058]), 0.06);
    // A cloak over one shoulder.
    let folds = 0.012 * (38.0 * (p.y + 0.7 * p.x)).sin();
    let cloak = limb(p, [0.2, 0.25, 0.02], [-0.10, 0.02, 0.10], [0.085, 0.055]) + folds;
    d = blend(d, cloak, 0.02);
    // Cut off below, and along the arms.
    d = d.max(0.004 - p.y).max(p.x.abs() - 0.225);
    let turned = DVec2::from_angle(0.35).rotate(DVec2::new(p.x, p.z));
    blend(d, head(DVec3::new(turned.x, p.y - 0.54, turned.y)), 0.035)
}

/// Pose and attributes of a standing figure.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Figure {
    /// Figure with wings and one raised arm.
    Victory,
    /// Figure with a jar on its shoulder.
    WaterBearer,
}

/// Returns the distance from a draped figure of a woman, 1.95 m high to the head, with its feet on `y = 0`.
pub(super) fn figure(p: DVec3, kind: Figure) -> f64 {
    // Contrapposto: the hip leans to one side, the chest to the other.
    let sway = 0.045 * (TAU * (p.y - 0.2) / 2.1).sin();
    let q = p - DVec3::new(sway, 0.0, 0.0);
    let mut d = body(q);
    d = d.max(0.004 - p.y);
    d = blend(d, limb(q, [0.0, 1.48, -0.01], [0.0, 1.66, 0.01], [0.062, 0.050]), 0.05);
    let turn = DVec2::from_angle(-0.3).rotate(DVec2::new(q.x, q.z));
    d = blend(d, head(0.9 * DVec3::new(turn.x, q.y - 1.80, turn.y)), 0.03);
    match kind {
        Figure::Victory => {
            d = blend(d, arm(q, [[0.19, 1.47, 0.0], [0.43, 1.56, 0.07], [0.50, 1.86, 0.16]]), 0.05);
            d = blend(d, arm(q, [[-0.19, 1.47, 0.0], [-0.34, 1.22, -0.02], [-0.30, 1.02, 0.19]]), 0.05);
            blend(wings(q), d, 0.02)
        }
        Figure::WaterBearer => {
            d = blend(d, arm(q, [[0.19, 1.47, 0.0], [0.37, 1.60, 0.06], [0.27, 1.90, 0.02]]), 0.05);
            d = blend(d, arm(q, [[-0.19, 1.47, 0.0], [-0.30, 1.20, -0.05], [-0.20, 1.02, 0.15]]), 0.05);
            let jar = q - DVec3::new(0.245, 1.80, -0.03);
            d = blend(d, ellipsoid(jar, [0.0; 3], [0.125, 0.165, 0.125]), 0.02);
            blend(d, limb(jar, [0.0, 0.14, 0.0], [0.0, 0.25, 0.0], [0.048, 0.062]), 0.03)
        }
    }
}

/// Returns the distance from the torso and the folded dress.
fn body(q: DVec3) -> f64 {
    let angle = q.x.atan2(q.z);
    // Folds run down the dress and fade out toward the belt. The overfold ends in a wavy hem at the hip.
    let fade = (1.0 - q.y / 1.1).clamp(0.0, 1.0);
    let folds = (0.010 + 0.046 * fade) * (8.0 * angle + 0.9 * (2.5 * q.y).sin()).sin();
    let narrow = DVec3::new(q.x, q.y, 1.18 * q.z);
    let dress = limb(narrow, [0.0, 0.0, 0.0], [0.0, 1.02, 0.0], [0.34, 0.185]) + folds;
    let over = limb(narrow, [0.0, 0.78, 0.0], [0.0, 1.08, 0.0], [0.255, 0.185])
        + 0.012 * (8.0 * angle + 2.0).sin()
        + 0.3 * (0.70 + 0.05 * (5.0 * angle).sin() - q.y).max(0.0);
    let mut d = blend(dress, over, 0.02);
    // The free leg shows through the cloth.
    d = blend(d, limb(q, [0.10, 0.88, 0.06], [0.13, 0.48, 0.21], [0.10, 0.085]), 0.08);
    d = blend(d, limb(q, [0.13, 0.48, 0.21], [0.15, 0.06, 0.20], [0.085, 0.07]), 0.08);
    let mut torso = ellipsoid(q, [0.0, 1.27, 0.0], [0.175, 0.27, 0.125]);
    torso = blend(torso, limb(q, [-0.165, 1.47, -0.01], [0.165, 1.47, -0.01], [0.066, 0.066]), 0.08);
    for side in [-1.0, 1.0] {
        torso = blend(torso, ellipsoid(q, [side * 0.078, 1.33, 0.088], [0.068, 0.065, 0.058]), 0.03);
    }
    d = blend(d, torso, 0.05);
    // The belt.
    blend(d, ellipsoid(q, [0.0, 1.10, 0.0], [0.185, 0.035, 0.150]), 0.02)
}

/// Returns the distance from an arm through shoulder, elbow and wrist, with a closed hand.
fn arm(q: DVec3, [shoulder, elbow, wrist]: [[f64; 3]; 3]) -> f64 {
    let upper = limb(q, shoulder, elbow, [0.068, 0.056]);
    let lower = limb(q, elbow, wrist, [0.056, 0.047]);
    blend(blend(upper, lower, 0.02), ellipsoid(q, wrist, [0.058, 0.066, 0.058]), 0.02)
}

/// Returns the distance from a pair of raised wings with long feathers.
fn wings(q: DVec3) -> f64 {
    let r = DVec3::new(q.x.abs(), q.y, q.z);
    let (root, wrist, tip) = ([0.07, 1.36, -0.14], [0.34, 1.88, -0.28], [0.58, 2.16, -0.33]);
    let mut d = blend(limb(r, root, wrist, [0.085, 0.075]), limb(r, wrist, tip, [0.075, 0.055]), 0.03);
    let feathers = 8;
    // Feathers are wider than thick: they are limbs in a space that is stretched perpendicular to the wing.
    let thin = DVec3::new(1.0, 1.0, 1.7);
    for i in 0..feathers {
        let t = f64::from(i) / f64::from(feathers - 1);
        // From the arm of the wing outward and down; the outer feathers are the longest.
        let from = DVec3::new(0.11 + 0.45 * t, 1.34 + 0.78 * t.powf(0.8), -0.17 - 0.16 * t);
        let (sin, cos) = (-1.45 + 1.25 * t).sin_cos();
        let long = 0.50 + 0.12 * t;
        let to = from + long * DVec3::new(0.70 * cos, sin, -0.05);
        let [from, to] = [from, to].map(|p| (thin * p).to_array());
        d = blend(d, 0.75 * limb(thin * r, from, to, [0.088, 0.076]), 0.012);
    }
    d
}
