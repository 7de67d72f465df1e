//! Noise taken out of what is shown.
//!
//! The irradiance of a patch is known to its standard error only, and eyes see differences of a per cent between
//! neighbors. So for pictures every patch takes a mean over those around it on the same smooth surface, as far as they
//! differ by no more than noise would make them differ. Where the solution is good, nothing changes.
//!
//! Perona and Malik (1990) diffuse pictures like this, stopping at edges; Schied et al. (2017) take the threshold from the
//! variance, as is done here. The variance is that of light that comes in grains: with grains of `q` watts, a patch
//! of the area `a` \[m²\] and the irradiance `E` has `q E / a`. That holds for patches that no line has met, too,
//! whose own estimate is zero. The grains come from the standard errors of a patch and its neighbors, `Σ σ²a² / Σ E a`.
//!
//! A patch so small that hardly a grain was to be expected says nothing: it is black, or by far too bright. Where such patches have
//! no smooth surface around them, they show what is around them beyond edges.

use std::thread;

use glam::DVec3;
use sir_geom::{Rgb, Side};

use crate::display::mesh::DisplayMesh;

/// How often patches take the mean of their neighbors. Each time adds the area of about ten of them to what a value
/// stands for, so that 10 % of noise become 1 %.
const PASSES: usize = 10;

/// Relative noise that eyes hardly see: from there on, patches keep what they have.
const UNSEEN: f64 = 0.01;

/// Differences of more standard errors than this are taken for real.
const REAL: f64 = 3.0;

/// By how many standard errors of a patch what is shown may differ from what was computed.
const FARTHEST: f64 = 3.0;

/// Area of independent patches whose mean is as good as that over all neighbors of a patch, in units of their sum:
/// corners count some of them twice, and the middle one three times.
const RING: f64 = 0.65;

/// Grains that have to be expected of a patch for it to speak for itself.
const ENOUGH: f64 = 3.0;

/// How far, in patches, light is looked for around those that say nothing.
const FILL_PASSES: usize = 8;

/// Surfaces whose normals have a cosine below this are not beside but behind each other.
const BEHIND: f64 = -0.5;

/// A side of a patch in the course of the passes.
#[derive(Clone, Copy, Default)]
struct State {
    irradiance: Rgb,
    /// Area for which `irradiance` stands \[m²\].
    stands_for: f64,
}

impl DisplayMesh<'_> {
    /// The irradiance \[W/m²\] of every [`SideId`](sir_mesh::SideId) without the noise, for pictures; the mesh is that of the
    /// irradiance as it was computed, and `errors` are its standard errors.
    ///
    /// Neighbors are patches that share a vertex of the mesh, and so belong to one smooth surface; for patches on which hardly
    /// any light was to be expected to arrive, those that share a position. No value moves by more than three standard
    /// errors. The result is the same for any number of threads.
    ///
    /// # Panics
    ///
    /// If `errors` has not one value for every side of the mesh.
    #[must_use]
    pub fn denoise(&self, errors: &[Rgb], threads: usize) -> Vec<Rgb> {
        assert_eq!(errors.len(), self.irradiance.len(), "one error for every side of the mesh");
        let ring = Ring::new(self, |vertex| vertex);
        let mut areas = vec![0.0; errors.len()];
        self.mesh.for_each_side(|t, _, _, id| areas[id.index()] += self.mesh.patch_area(t));
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
            // Where no light has arrived at all, it would come as elsewhere.
            Rgb::select(own.cmpeq(Rgb::ZERO), common, own)
        };
        each(&|i| State { irradiance: grain(i), stands_for: 0.0 }, &mut grains);
        let start = self.irradiance.iter().zip(&areas);
        let mut now: Vec<State> =
            start.map(|(&e, &stands_for)| State { irradiance: e.max(Rgb::ZERO), stands_for }).collect();
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
            let most = FARTHEST * noise.max(errors[i]);
            let computed = self.irradiance[i];
            state.irradiance.max(computed - most).min(computed + most)
        });
        shown.collect()
    }

    /// Mean power of the grains \[W\] in which light comes to some patches.
    fn grain(&self, errors: &[Rgb], areas: &[f64], patches: impl FnOnce(&mut dyn FnMut(usize))) -> Rgb {
        let (mut squares, mut power) = (Rgb::ZERO, Rgb::ZERO);
        patches(&mut |j| {
            let error = areas[j] * errors[j];
            squares += error * error;
            power += areas[j] * self.irradiance[j];
        });
        ratio(squares, power)
    }

    /// The normal of every side.
    fn normals(&self) -> Vec<DVec3> {
        let mut normals = vec![DVec3::ZERO; self.irradiance.len()];
        self.mesh.for_each_side(|triangle, _, side, id| {
            let front = self.scene.normal(triangle);
            normals[id.index()] = if side == Side::Front { front } else { -front };
        });
        normals
    }
}

/// One more mean over the neighbors of a patch.
fn pass(ring: &Ring, now: &[State], areas: &[f64], grain: Rgb, i: usize) -> State {
    let own = now[i];
    // The share that is taken over from others.
    let noise = ratio(grain, own.irradiance * own.stands_for).max_element();
    let (mut sum, mut weights, mut others) = (Rgb::ZERO, 0.0, 0.0);
    ring.around(i, |j| {
        let other = now[j];
        let weight = areas[j] * likeness(own, other, grain);
        sum += weight * other.irradiance;
        weights += weight;
        if j != i {
            others += weight;
        }
    });
    if others == 0.0 {
        return own;
    }
    // A patch that nothing has reached yet, in some band, has all to gain.
    let share = if noise.is_finite() && own.irradiance != Rgb::ZERO {
        noise / (noise + UNSEEN * UNSEEN)
    } else {
        1.0
    };
    State {
        irradiance: own.irradiance.lerp(sum / weights, share),
        stands_for: own.stands_for + share * RING * others,
    }
}

/// Light from around for a patch on which too little was to be expected to arrive.
fn fill(ring: &Ring, now: &[State], normals: &[DVec3], grain: Rgb, i: usize) -> State {
    let own = now[i];
    let (mut sum, mut area) = (Rgb::ZERO, 0.0);
    ring.around(i, |j| {
        if normals[i].dot(normals[j]) > BEHIND {
            sum += now[j].stands_for * now[j].irradiance;
            area += now[j].stands_for;
        }
    });
    // How many grains would have arrived if the patch were as bright as what is around it: a large one that is dark is dark.
    let expected = ratio(sum / area * own.stands_for, grain).max_element() / ENOUGH;
    let share = 1.0 / (1.0 + expected * expected);
    State { irradiance: own.irradiance.lerp(sum / area, share), stands_for: own.stands_for }
}

/// One if two values are the same, and zero if noise cannot have made them as different as they are; in between
/// Tukey's biweight of the band that differs most.
fn likeness(a: State, b: State, grain: Rgb) -> f64 {
    let off = a.irradiance - b.irradiance;
    let area = a.stands_for + b.stands_for;
    let mean = (a.stands_for * a.irradiance + b.stands_for * b.irradiance) / area;
    let variance = grain * mean * (area / (a.stands_for * b.stands_for));
    let furthest = ratio(off * off, REAL * REAL * variance).max_element();
    let rest = (1.0 - furthest).max(0.0);
    rest * rest
}

/// Quotients band by band; zero where there is nothing to divide.
fn ratio(a: Rgb, b: Rgb) -> Rgb {
    Rgb::from_array(std::array::from_fn(|k| if a[k] == 0.0 { 0.0 } else { a[k] / b[k] }))
}

/// Which sides of patches have vertices of the mesh, or positions, in common.
struct Ring {
    /// Sides around each vertex, vertex after vertex, and where those of each begin; likewise vertices of each side.
    sides: Vec<u32>,
    first_sides: Vec<u32>,
    corners: Vec<u32>,
    first_corners: Vec<u32>,
}

impl Ring {
    /// Of sides that have what `point` gives for a vertex in common.
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

    /// Calls `visit` with every side around a side: those across an edge twice, as they share two vertices with it, and the side itself
    /// three times.
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

/// The second numbers of sorted pairs, and where those of each first number below `count` begin.
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
