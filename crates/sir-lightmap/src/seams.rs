//! Seams: edges of charts across which the surface continues.
//!
//! Both sides of such an edge show the same line of the surface, interpolated between texels of two charts, each with its
//! own noise. The texels near the edges are fitted to each other by least squares over points of all edges (Iwanicki 2013),
//! as far as their standard errors allow.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use sir_geom::{Side, Weld};

use crate::error::LightmapError;
use crate::layout::{Layout, NO_CHART, Rectangle, Sheet};
use crate::objects::Objects;
use crate::observer::{Observer, Step};
use crate::texels::Texels;

/// Distance below which corners are the same, relative to the distance of the farthest from the middle.
const TOLERANCE: f64 = 1e-6;

/// Cosine of the largest bend across which a surface continues: 30°.
const SMOOTH: f64 = 0.866;

/// Weight of a point of an edge, in units of the weight of a texel: steps are to be a tenth of the standard error.
const FIT: f64 = 100.0;

/// Factor of the bend of the light across an edge.
const BEND: f64 = 1.0;

/// Weight of a texel that no chart covers.
const LOOSE: f64 = 1e-3;

/// Largest change of a texel in standard errors.
const MAX_CHANGE: f64 = 3.0;

/// Number of steps of the conjugate gradient method.
const STEPS: usize = 60;

/// Mean absolute difference of the light at points one texel apart \[W/m²\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeamSteps {
    /// Across edges of charts, before texels were fitted.
    pub before: f64,
    /// Across edges of charts, in the result.
    pub after: f64,
    /// Inside charts, beside the same edges, in the result.
    pub inside: f64,
    /// Number of points at which they were compared.
    pub points: usize,
}

/// One side of an edge of a chart.
#[derive(Clone, Copy)]
struct EdgeSide {
    /// First row of its page.
    row: f64,
    /// Ends of the edge \[texels\].
    ends: [DVec2; 2],
    /// Step from the edge into the chart by the length of a texel \[texels\].
    inward: DVec2,
    /// The same step on the surface \[m\].
    on_surface: DVec3,
    normal: DVec3,
}

/// Finds the pairs of edges that show the same line of a continuous surface.
fn pairs(objects: &Objects, layout: &Layout) -> Vec<[EdgeSide; 2]> {
    let size = DVec2::new(f64::from(layout.width), f64::from(layout.height));
    let corners = objects.instances.iter().flat_map(|instance| {
        let primitives = &objects.meshes[instance.mesh].primitives;
        let place = |p: &[f64; 3]| instance.to_world.transform_point3(DVec3::from_array(*p));
        primitives.iter().flat_map(move |primitive| primitive.positions.iter().map(place))
    });
    let (low, high) = corners
        .filter(|p| p.is_finite())
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let mut weld = Weld::new(0.5 * (low + high), TOLERANCE * low.distance(high));
    let mut edges: BTreeMap<(u32, u32), Vec<EdgeSide>> = BTreeMap::new();
    for sheet in &layout.sheets {
        let outlines = outlines(sheet);
        for &instance in &sheet.instances {
            let Some(rectangle) = layout.rectangle(instance, sheet.side) else { continue };
            let of = &objects.instances[instance];
            let mesh = &objects.meshes[of.mesh];
            // Welding each vertex once keeps the tree small.
            let mut known: BTreeMap<(usize, u32), u32> = BTreeMap::new();
            for &(primitive, triangle, edge) in &outlines {
                let unfolded = &sheet.primitives[primitive];
                let vertices = unfolded.triangles[triangle];
                let [a, b, c] = [0, 1, 2].map(|k| vertices[(edge + k) % 3]);
                let position = |v: u32| {
                    let p = mesh.primitives[primitive].positions[unfolded.origin[v as usize] as usize];
                    of.to_world.transform_point3(DVec3::from_array(p))
                };
                let mut point = |v: u32| {
                    let origin = unfolded.origin[v as usize];
                    *known.entry((primitive, origin)).or_insert_with(|| weld.add(position(v)))
                };
                let (from, to) = (point(a), point(b));
                let texel = |v: u32| rectangle.place(unfolded.coordinates[v as usize]) * size;
                let side = edge_side(
                    [a, b, c].map(position),
                    [a, b, c].map(texel),
                    sheet.side,
                    layout.texels_per_meter,
                );
                let Some(side) = side.filter(|_| from != to) else { continue };
                let side = EdgeSide {
                    // A reflection turns the order of the corners.
                    normal: of.to_world.matrix3.determinant().signum() * side.normal,
                    row: row_of(layout, rectangle),
                    ends: if from < to { side.ends } else { [side.ends[1], side.ends[0]] },
                    ..side
                };
                edges.entry((from.min(to), from.max(to))).or_default().push(side);
            }
        }
    }
    let mut pairs = Vec::new();
    for sides in edges.into_values() {
        for (i, a) in sides.iter().enumerate() {
            let continues = |b: &&EdgeSide| {
                let ahead = -a.on_surface.normalize_or_zero().dot(b.on_surface.normalize_or_zero());
                a.normal.dot(b.normal) > SMOOTH && ahead > SMOOTH
            };
            let mut others = sides.iter().enumerate().filter(|(j, b)| *j != i && continues(b));
            // Where several surfaces go on, none is the continuation.
            if let (Some((j, b)), None) = (others.next(), others.next())
                && i < j
            {
                pairs.push([*a, *b]);
            }
        }
    }
    pairs
}

fn row_of(layout: &Layout, rectangle: Rectangle) -> f64 {
    f64::from(rectangle.page) * f64::from(layout.height)
}

/// Returns the edges of a sheet at which charts end: primitive, triangle, and number of the edge.
fn outlines(sheet: &Sheet) -> Vec<(usize, usize, usize)> {
    let mut all = Vec::new();
    for (p, unfolded) in sheet.primitives.iter().enumerate() {
        let mut counts: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let charted = || (0..unfolded.triangles.len()).filter(|&t| unfolded.charts[t] != NO_CHART);
        let edge = |t: usize, k: usize| {
            let [a, b] = [unfolded.triangles[t][k], unfolded.triangles[t][(k + 1) % 3]];
            (a.min(b), a.max(b))
        };
        charted().for_each(|t| (0..3).for_each(|k| *counts.entry(edge(t, k)).or_default() += 1));
        for t in charted() {
            all.extend((0..3).filter(|&k| counts[&edge(t, k)] == 1).map(|k| (p, t, k)));
        }
    }
    all
}

/// Returns the side of an edge from the first to the second corner of a triangle. `None` for triangles without an area.
fn edge_side(
    [a, b, c]: [DVec3; 3],
    [at_a, at_b, at_c]: [DVec2; 3],
    side: Side,
    texels_per_meter: f64,
) -> Option<EdgeSide> {
    let along = (b - a).try_normalize()?;
    let offset = (c - a) - (c - a).dot(along) * along;
    let height = offset.length();
    let inward = offset.try_normalize()?;
    let normal = (b - a).cross(c - a).try_normalize()?;
    // Where the line from `c` at a right angle meets the edge.
    let foot = at_a.lerp(at_b, (c - a).dot(along) / a.distance(b));
    let step = (at_c - foot) / (height * texels_per_meter);
    step.is_finite().then_some(EdgeSide {
        row: 0.0,
        ends: [at_a, at_b],
        inward: step,
        on_surface: inward,
        normal: if side == Side::Front { normal } else { -normal },
    })
}

impl EdgeSide {
    /// Returns the weights of texels at a part `t` of the edge, and at a depth in texels inside the chart.
    fn sample(&self, layout: &Layout, t: f64, depth: f64) -> Sample {
        sample(layout, self.row, self.ends[0].lerp(self.ends[1], t) + depth * self.inward)
    }
}

/// Sums of texels with weights that are to be zero.
#[derive(Default)]
struct Rows {
    /// Texels, later numbers of unknowns, and their weights, row by row.
    terms: Vec<(usize, f64)>,
    starts: Vec<usize>,
}

impl Rows {
    fn add(&mut self, samples: &[(f64, Sample)]) {
        self.starts.push(self.terms.len());
        for (factor, sample) in samples {
            let terms = sample.iter().filter(|(_, weight)| *weight != 0.0);
            self.terms.extend(terms.map(|&(i, weight)| (i, factor * weight)));
        }
    }

    fn iter(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        let ends = self.starts.iter().skip(1).copied().chain([self.terms.len()]);
        self.starts.iter().zip(ends).map(|(&start, end)| &self.terms[start..end])
    }
}

/// Weights of four texels between which a viewer interpolates.
type Sample = [(usize, f64); 4];

/// Returns the weights of the texels at a place, below a row of pages.
fn sample(layout: &Layout, row: f64, at: DVec2) -> Sample {
    let p = at - 0.5;
    let (corner, part) = (p.floor(), p - p.floor());
    let texel = |dx: f64, dy: f64| {
        let x = (corner.x + dx).clamp(0.0, f64::from(layout.width) - 1.0);
        let y = (corner.y + dy).clamp(0.0, f64::from(layout.height) - 1.0);
        ((row + y) as usize * layout.width as usize) + x as usize
    };
    let (x, y) = (part.x, part.y);
    [
        (texel(0.0, 0.0), (1.0 - x) * (1.0 - y)),
        (texel(1.0, 0.0), x * (1.0 - y)),
        (texel(0.0, 1.0), (1.0 - x) * y),
        (texel(1.0, 1.0), x * y),
    ]
}

/// Returns the interpolated light.
fn value(light: &[[f32; 3]], sample: &Sample) -> DVec3 {
    sample.iter().map(|&(i, weight)| weight * DVec3::from_array(light[i].map(f64::from))).sum()
}

/// Fits the texels on both sides of edges of charts to each other. `is_lit` is true for texels with light.
pub(crate) fn fit(
    objects: &Objects,
    layout: &Layout,
    texels: &mut Texels,
    is_lit: &[bool],
    observer: &dyn Observer,
) -> Result<SeamSteps, LightmapError> {
    let pairs = pairs(objects, layout);
    let mut rows = Rows::default();
    for pair in &pairs {
        let length = |side: &EdgeSide| side.ends[0].distance(side.ends[1]);
        let count = (2.0 * length(&pair[0]).max(length(&pair[1]))).ceil().max(1.0);
        for k in 0..count as usize {
            let t = (k as f64 + 0.5) / count;
            let at = |i: usize, depth: f64| pair[i].sample(layout, t, depth);
            let is_lit = |sample: &Sample| sample.iter().all(|&(i, weight)| weight == 0.0 || is_lit[i]);
            let [a, b] = [0, 1].map(|i| at(i, 0.0));
            if is_lit(&a) && is_lit(&b) {
                rows.add(&[(1.0, a), (-1.0, b)]);
            }
            // The light goes on across the edge as it comes to it.
            let is_inside =
                |sample: &Sample| sample.iter().all(|&(i, weight)| weight < 0.01 || texels.is_covered(i));
            let near = [0, 1].map(|i| at(i, 0.5));
            for i in 0..2 {
                let far = at(i, 1.5);
                if near.iter().chain([&far]).all(is_inside) {
                    rows.add(&[(BEND, far), (-2.0 * BEND, near[i]), (BEND, near[1 - i])]);
                }
            }
        }
    }
    let before = measure(layout, &pairs, texels).0;
    if !rows.starts.is_empty() {
        solve(&mut rows, texels, observer)?;
    }
    let (after, inside, points) = measure(layout, &pairs, texels);
    Ok(SeamSteps { before, after, inside, points })
}

/// Returns the mean step across edges and inside charts, and the number of points.
fn measure(layout: &Layout, pairs: &[[EdgeSide; 2]], texels: &Texels) -> (f64, f64, usize) {
    let (mut across, mut inside, mut count) = (0.0, 0.0, 0usize);
    for pair in pairs {
        let samples = pair[0].ends[0].distance(pair[0].ends[1]).ceil().max(1.0);
        for k in 0..samples as usize {
            let t = (k as f64 + 0.5) / samples;
            let at = |side: &EdgeSide, depth: f64| {
                let sample = side.sample(layout, t, depth);
                let is_inside = sample.iter().all(|&(i, weight)| weight < 0.01 || texels.is_covered(i));
                is_inside.then(|| value(&texels.light, &sample).element_sum() / 3.0)
            };
            let [a, b] = [&pair[0], &pair[1]].map(|side| (at(side, 0.5), at(side, 1.5)));
            if let ((Some(a), Some(a_inside)), (Some(b), Some(b_inside))) = (a, b) {
                across += (a - b).abs();
                inside += 0.5 * ((a - a_inside).abs() + (b - b_inside).abs());
                count += 1;
            }
        }
    }
    let scale = 1.0 / count.max(1) as f64;
    (across * scale, inside * scale, count)
}

/// Changes the texels so that the sums are near zero, by the conjugate gradient method.
fn solve(rows: &mut Rows, texels: &mut Texels, observer: &dyn Observer) -> Result<(), LightmapError> {
    let mut unknowns: Vec<usize> = rows.terms.iter().map(|&(i, _)| i).collect();
    unknowns.sort_unstable();
    unknowns.dedup();
    for (i, _) in &mut rows.terms {
        *i = unknowns.partition_point(|other| other < i);
    }
    let start: Vec<DVec3> =
        unknowns.iter().map(|&i| DVec3::from_array(texels.light[i].map(f64::from))).collect();
    let errors: Vec<DVec3> =
        unknowns.iter().map(|&i| DVec3::from_array(texels.error[i].map(f64::from))).collect();
    let typical = errors.iter().sum::<DVec3>() / errors.len() as f64;
    // Weights are relative to the typical variance: a texel without an error does not change.
    let weights: Vec<DVec3> = unknowns
        .iter()
        .zip(&errors)
        .map(|(&i, &error)| {
            let relative = typical / error.max(1e-6 * typical);
            let weight = (relative * relative).min(DVec3::splat(1e12));
            let weight = if weight.is_finite() { weight } else { DVec3::ONE };
            if texels.is_covered(i) { weight } else { LOOSE * DVec3::ONE }
        })
        .collect();
    let apply = |x: &[DVec3]| {
        let mut product: Vec<DVec3> = x.iter().zip(&weights).map(|(&x, &weight)| weight * x).collect();
        for row in rows.iter() {
            let step: DVec3 = row.iter().map(|&(i, weight)| weight * x[i]).sum();
            row.iter().for_each(|&(i, weight)| product[i] += FIT * weight * step);
        }
        product
    };
    // The unknowns are changes `x`: minimize `Σ w x² + F Σ (step of start + x)²`.
    let mut residual = vec![DVec3::ZERO; unknowns.len()];
    for row in rows.iter() {
        let step: DVec3 = row.iter().map(|&(i, weight)| weight * start[i]).sum();
        row.iter().for_each(|&(i, weight)| residual[i] -= FIT * weight * step);
    }
    let diagonal: Vec<DVec3> = {
        let mut all = weights.clone();
        rows.terms.iter().for_each(|&(i, weight)| all[i] += FIT * weight * weight * DVec3::ONE);
        all
    };
    let product = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(&a, &b)| a * b).sum::<DVec3>();
    let scaled = |r: &[DVec3]| -> Vec<DVec3> { r.iter().zip(&diagonal).map(|(&r, &d)| r / d).collect() };
    let quotient = |a: DVec3, b: DVec3| {
        DVec3::from_array(std::array::from_fn(|k| if b[k] > 0.0 { a[k] / b[k] } else { 0.0 }))
    };
    let mut change = vec![DVec3::ZERO; unknowns.len()];
    let mut conditioned = scaled(&residual);
    let mut direction = conditioned.clone();
    let mut power = product(&residual, &conditioned);
    for step in 0..STEPS {
        if !observer.progress(Step::Seams, step as u64, Some(STEPS as u64)) {
            return Err(LightmapError::Stopped);
        }
        let applied = apply(&direction);
        let length = quotient(power, product(&direction, &applied));
        for i in 0..change.len() {
            change[i] += length * direction[i];
            residual[i] -= length * applied[i];
        }
        conditioned = scaled(&residual);
        let next = product(&residual, &conditioned);
        let ratio = quotient(next, power);
        direction.iter_mut().zip(&conditioned).for_each(|(d, &c)| *d = c + ratio * *d);
        power = next;
    }
    for (k, &i) in unknowns.iter().enumerate() {
        let limit = if texels.is_covered(i) { MAX_CHANGE * errors[k] } else { DVec3::INFINITY };
        let fitted = (start[k] + change[k].clamp(-limit, limit)).max(DVec3::ZERO);
        texels.light[i] = fitted.as_vec3().to_array();
    }
    Ok(())
}
