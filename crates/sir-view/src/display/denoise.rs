//! Denoising of pictures.
//!
//! The irradiance of a patch is known only up to its standard error, and eyes see differences of one percent between
//! neighbors. For pictures, every patch therefore takes a mean over the patches around it on the same smooth surface,
//! as far as noise explains their differences. Where the solution is precise, nothing changes.
//!
//! This is the edge-stopping diffusion of Perona and Malik (1990), with a threshold from the variance as in Schied et
//! al. (2017). The variance is that of shot noise: with light that arrives in grains of `q` watts, a patch of area `a`
//! \[m²\] and irradiance `E` has the variance `q E / a`. This holds also for patches that no line has met, whose own
//! estimate is zero. The power of a grain comes from the standard errors of a patch and its neighbors:
//! `Σ σ²a² / Σ E a`.
//!
//! A patch so small that hardly any grain is expected carries no information: it is black, or far too bright. Where
//! such patches have no smooth surface around them, they take the irradiance of the patches around them beyond edges.

use std::thread;

use glam::DVec3;
use sir_geom::{Rgb, Side};

use crate::display::mesh::DisplayMesh;

/// Number of averaging passes. Each adds the area of about ten patches to the effective area of a value, so that 10 %
/// of noise become 1 %.
const PASSES: usize = 10;

/// Relative noise that is hardly visible; patches with less keep their value.
const INVISIBLE_NOISE: f64 = 0.01;

/// Smallest difference that counts as real, in standard errors.
const REAL_DIFFERENCE: f64 = 3.0;

/// Largest difference of the shown from the computed irradiance, in standard errors of a patch.
const MAX_CHANGE: f64 = 3.0;

/// Area of independent patches whose mean is as precise as the mean over all neighbors of a patch, relative to the sum
/// of the areas of the neighbors. It is below one because some neighbors are counted twice, and the patch itself three
/// times.
const RING_SHARE: f64 = 0.65;

/// Number of expected grains from which on the value of a patch is informative.
const MIN_GRAINS: f64 = 3.0;

/// Number of fill passes: the distance in patches from which patches without information take light.
const FILL_PASSES: usize = 8;

/// Cosine between normals below which surfaces are not beside but behind each other.
const MIN_COSINE: f64 = -0.5;

/// State of a side of a patch between passes.
#[derive(Clone, Copy, Default)]
struct State {
    irradiance: Rgb,
    /// Effective area of the patches that `irradiance` is a mean of \[m²\].
    effective_area: f64,
}

impl DisplayMesh<'_> {
    /// Returns the denoised irradiance \[W/m²\] of every [`SideId`](sir_mesh::SideId), for pictures.
    ///
    /// The mesh must have the irradiance as computed; `errors` are its standard errors. Neighbors are patches that
    /// share a vertex of the mesh, and thus belong to one smooth surface; for patches on which hardly any light is
    /// expected to arrive, they are patches that share a position. No value changes by more than three standard errors.
    /// The result is the same for any number of threads.
    ///
    /// # Panics
    ///
    /// If `errors` does not have one value for every side of the mesh.
    #[must_use]
    pub fn denoise(&self, errors: &[Rgb], threads: usize) -> Vec<Rgb> {
        assert_eq!(errors.len(), self.irradiance.len(), "one error for every side of the mesh");
        let ring = Ring::new(self, |vertex| vertex);
        let mut areas = vec![0.0; errors.len()];
        self.mesh.for_each_side(|t, patch, _, id| areas[id.index()] += self.mesh.patch_area(t, patch));
        let each = |work: &(dyn Fn(usize) -> State + Sync), out: &mut [State]| {
            let share = out.len().div_ceil(threads.max(1)).max(1);
            thread::scope(|scope| {
                for (k, part) in out.chunks_mut(share).enumerate() {
                    scope.spawn(move || (k * share..).zip(part).for_each(|(i, state)| *state = work(i)));
                }
            });
        };
        let mut grains = vec![State::default(); errors.len()];
        let common = self.grain(errors, &areas, |visit| (0..errors.len()).for_each(visit));
        let grain = |i| {
            let own = self.grain(errors, &areas, |visit| ring.around(i, visit));
            // Where no light has arrived at all, the grain is the mean over all patches.
            Rgb::select(own.cmpeq(Rgb::ZERO), common, own)
        };
        each(&|i| State { irradiance: grain(i), effective_area: 0.0 }, &mut grains);
        let start = self.irradiance.iter().zip(&areas);
        let mut now: Vec<State> = start
            .map(|(&e, &effective_area)| State { irradiance: e.max(Rgb::ZERO), effective_area })
            .collect();
        let mut next = now.clone();
        for _ in 0..PASSES {
            each(&|i| pass(&ring, &now, &areas, grains[i].irradiance, i), &mut next);
            std::mem::swap(&mut now, &mut next);
        }
        drop(ring);
        let normals = self.normals();
        let ring = Ring::new(self, |vertex| self.vertices[vertex as usize].position);
        for _ in 0..FILL_PASSES {
            each(&|i| fill(&ring, &now, &normals, grains[i].irradiance, i), &mut next);
            std::mem::swap(&mut now, &mut next);
        }
        let shown = now.iter().enumerate().map(|(i, state)| {
            let noise = (grains[i].irradiance * state.irradiance / areas[i]).map(f64::sqrt);
            let most = MAX_CHANGE * noise.max(errors[i]);
            let computed = self.irradiance[i];
            state.irradiance.max(computed - most).min(computed + most)
        });
        shown.collect()
    }

    /// Returns the mean power of the grains that arrive at some patches \[W\].
    fn grain(&self, errors: &[Rgb], areas: &[f64], patches: impl FnOnce(&mut dyn FnMut(usize))) -> Rgb {
        let (mut squares, mut power) = (Rgb::ZERO, Rgb::ZERO);
        patches(&mut |j| {
            let error = areas[j] * errors[j];
            squares += error * error;
            power += areas[j] * self.irradiance[j];
        });
        ratio(squares, power)
    }

    /// Returns the normal of every side.
    fn normals(&self) -> Vec<DVec3> {
        let mut normals = vec![DVec3::ZERO; self.irradiance.len()];
        self.mesh.for_each_side(|triangle, _, side, id| {
            let front = self.scene.normal(triangle);
            normals[id.index()] = if side == Side::Front { front } else { -front };
        });
        normals
    }
}

/// Returns the state of side `i` after one more averaging pass.
fn pass(ring: &Ring, now: &[State], areas: &[f64], grain: Rgb, i: usize) -> State {
    let own = now[i];
    // Relative variance of the value; it decides the share that is taken from the neighbors.
    let noise = ratio(grain, own.irradiance * own.effective_area).max_element();
    let (mut sum, mut weights, mut others) = (Rgb::ZERO, 0.0, 0.0);
    ring.around(i, |j| {
        let other = now[j];
        let weight = areas[j] * similarity(own, other, grain);
        sum += weight * other.irradiance;
        weights += weight;
        if j != i {
            others += weight;
        }
    });
    if others == 0.0 {
        return own;
    }
    // A patch that no light has reached yet, in some band, takes the mean alone.
    let share = if noise.is_finite() && own.irradiance != Rgb::ZERO {
        noise / (noise + INVISIBLE_NOISE * INVISIBLE_NOISE)
    } else {
        1.0
    };
    State {
        irradiance: own.irradiance.lerp(sum / weights, share),
        effective_area: own.effective_area + share * RING_SHARE * others,
    }
}

/// Returns the state of side `i` after a fill pass: patches with too few expected grains take the light around them.
fn fill(ring: &Ring, now: &[State], normals: &[DVec3], grain: Rgb, i: usize) -> State {
    let own = now[i];
    let (mut sum, mut area) = (Rgb::ZERO, 0.0);
    ring.around(i, |j| {
        if normals[i].dot(normals[j]) > MIN_COSINE {
            sum += now[j].effective_area * now[j].irradiance;
            area += now[j].effective_area;
        }
    });
    // Number of grains expected if the patch were as bright as its surroundings, so that a large dark patch stays dark.
    let expected = ratio(sum / area * own.effective_area, grain).max_element() / MIN_GRAINS;
    let share = 1.0 / (1.0 + expected * expected);
    State { irradiance: own.irradiance.lerp(sum / area, share), effective_area: own.effective_area }
}

/// Returns one if two values are equal, zero if noise cannot explain their difference, and in between Tukey's biweight
/// of the band that differs most.
fn similarity(a: State, b: State, grain: Rgb) -> f64 {
    let off = a.irradiance - b.irradiance;
    let area = a.effective_area + b.effective_area;
    let mean = (a.effective_area * a.irradiance + b.effective_area * b.irradiance) / area;
    let variance = grain * mean * (area / (a.effective_area * b.effective_area));
    let furthest = ratio(off * off, REAL_DIFFERENCE * REAL_DIFFERENCE * variance).max_element();
    let rest = (1.0 - furthest).max(0.0);
    rest * rest
}

/// Returns the quotients band by band, with zero where the dividend is zero.
fn ratio(a: Rgb, b: Rgb) -> Rgb {
    Rgb::from_array(std::array::from_fn(|k| if a[k] == 0.0 { 0.0 } else { a[k] / b[k] }))
}

/// Neighborhoods of sides of patches: sides that share vertices of the mesh, or positions.
struct Ring {
    /// Sides around each vertex, vertex by vertex, and the offset of each list; likewise the vertices of each side.
    sides: Vec<u32>,
    first_sides: Vec<u32>,
    corners: Vec<u32>,
    first_corners: Vec<u32>,
}

impl Ring {
    /// Creates the neighborhoods of sides that share a point; `point` maps a vertex to its point.
    fn new(display: &DisplayMesh<'_>, point: impl Fn(u32) -> u32) -> Self {
        let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(4 * display.irradiance.len());
        for piece in display.pieces() {
            let first = pairs.len();
            pairs.extend(piece.triangles.iter().flatten().map(|&v| (piece.id.index() as u32, point(v))));
            pairs[first..].sort_unstable();
            let mut kept = first;
            for i in first..pairs.len() {
                if i == first || pairs[i] != pairs[i - 1] {
                    pairs[kept] = pairs[i];
                    kept += 1;
                }
            }
            pairs.truncate(kept);
        }
        // With one patch per face a side has several pieces.
        pairs.sort_unstable();
        pairs.dedup();
        let (corners, first_corners) = lists(&pairs, display.irradiance.len());
        pairs.iter_mut().for_each(|(side, vertex)| std::mem::swap(side, vertex));
        pairs.sort_unstable();
        let points = pairs.last().map_or(0, |pair| pair.0 as usize + 1);
        let (sides, first_sides) = lists(&pairs, points);
        Self { sides, first_sides, corners, first_corners }
    }

    /// Calls `visit` with every side around a side. Sides across an edge are visited twice, because they share two
    /// vertices with it, and the side itself three times.
    fn around(&self, side: usize, mut visit: impl FnMut(usize)) {
        for &v in of(&self.corners, &self.first_corners, side) {
            for &other in of(&self.sides, &self.first_sides, v as usize) {
                visit(other as usize);
            }
        }
    }
}

fn of<'a>(all: &'a [u32], firsts: &[u32], i: usize) -> &'a [u32] {
    &all[firsts[i] as usize..firsts[i + 1] as usize]
}

/// Returns the second numbers of sorted pairs, and the offsets of those of each first number below `count`.
fn lists(pairs: &[(u32, u32)], count: usize) -> (Vec<u32>, Vec<u32>) {
    let mut firsts = vec![0; count + 1];
    for &(i, _) in pairs {
        firsts[i as usize + 1] += 1;
    }
    for i in 0..count {
        firsts[i + 1] += firsts[i];
    }
    (pairs.iter().map(|p| p.1).collect(), firsts)
}
