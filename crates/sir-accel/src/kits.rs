//! Chooses the instructions of the processor that the program runs on.
#![allow(unsafe_code, reason = "functions compiled for a processor are called where it was found")]

use sir_geom::Line;

use crate::grid::Grid;
#[cfg(target_arch = "x86_64")]
use crate::lanes::avx2::Avx2;
use crate::lanes::avx512::Avx512;
use crate::lanes::portable::Portable;
use crate::search;
use crate::search::{AllScratch, ClosestScratch, Rays};
use crate::tree::Tree;

/// The kits, and proof that the processor has what they need: values are only made by [`Kits::available`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kits(Name);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Name {
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    Portable,
}

impl Kits {
    /// Those that the processor has, the best first.
    pub(crate) fn available() -> impl Iterator<Item = Self> {
        #[cfg(target_arch = "x86_64")]
        let of_processor = {
            let avx2 = is_x86_feature_detected!("avx2")
                && is_x86_feature_detected!("fma")
                && is_x86_feature_detected!("bmi1")
                && is_x86_feature_detected!("bmi2")
                && is_x86_feature_detected!("popcnt");
            let avx512 = avx2
                && is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl");
            [avx512.then_some(Name::Avx512), avx2.then_some(Name::Avx2)]
        };
        #[cfg(not(target_arch = "x86_64"))]
        let of_processor = [None];
        of_processor.into_iter().flatten().chain([Name::Portable]).map(Self)
    }

    /// The best that the processor has.
    pub(crate) fn best() -> Self {
        Self::available().next().unwrap_or(Self(Name::Portable))
    }

    /// See [`search::all`].
    pub(crate) fn all(self, grid: &Grid, tree: &Tree, lines: &[Line], scratch: &mut AllScratch) {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the processor has the features.
            Name::Avx512 => unsafe { all_avx512(grid, tree, lines, scratch) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the processor has the features.
            Name::Avx2 => unsafe { all_avx2(grid, tree, lines, scratch) },
            Name::Portable => search::all::<Portable>(grid, tree, lines, scratch),
        }
    }

    /// See [`search::closest`].
    pub(crate) fn closest<R: Rays>(self, tree: &Tree, scratch: &mut ClosestScratch, rays: &mut R) {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the processor has the features.
            Name::Avx512 => unsafe { closest_avx512(tree, scratch, rays) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: the processor has the features.
            Name::Avx2 => unsafe { closest_avx2(tree, scratch, rays) },
            Name::Portable => search::closest::<Portable, R>(tree, scratch, rays),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
fn all_avx512(grid: &Grid, tree: &Tree, lines: &[Line], scratch: &mut AllScratch) {
    search::all::<Avx512>(grid, tree, lines, scratch);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,popcnt")]
fn all_avx2(grid: &Grid, tree: &Tree, lines: &[Line], scratch: &mut AllScratch) {
    search::all::<Avx2>(grid, tree, lines, scratch);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
fn closest_avx512<R: Rays>(tree: &Tree, scratch: &mut ClosestScratch, rays: &mut R) {
    search::closest::<Avx512, R>(tree, scratch, rays);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,popcnt")]
fn closest_avx2<R: Rays>(tree: &Tree, scratch: &mut ClosestScratch, rays: &mut R) {
    search::closest::<Avx2, R>(tree, scratch, rays);
}

#[cfg(test)]
#[path = "../tests/common/mod.rs"]
mod common;

#[cfg(test)]
mod tests {
    use super::common::{KINDS, difficult_line, furnished_room, furnished_room_of};
    use super::*;
    use crate::Accel;
    use crate::hit::Hit;
    use crate::tracer::{Ray, Tracer};
    use sir_geom::{Opacity, Scene, TriangleId};
    use sir_lines::{Stage, Streams};

    fn bits(hit: Hit) -> (TriangleId, bool, [u64; 3]) {
        let front = hit.side == sir_geom::Side::Front;
        (hit.triangle, front, [hit.t, hit.point.v, hit.point.w].map(f64::to_bits))
    }

    /// The tracers of all kits that this processor has; the last one is the portable one.
    fn tracers(accel: &Accel) -> Vec<Tracer<'_>> {
        let kits: Vec<Kits> = Kits::available().collect();
        assert_eq!(kits.last(), Some(&Kits(Name::Portable)));
        kits.into_iter().map(|kits| Tracer::new(accel, kits)).collect()
    }

    /// The room, with surfaces that let half of all lines pass.
    fn veiled_room() -> Scene {
        furnished_room_of(Opacity { factor: 0.5, ..Opacity::default() })
    }

    /// Two million lines, most of them through vertices and along edges.
    #[test]
    fn all_kits_find_the_same_hits_bit_for_bit() {
        find_the_same_hits(&furnished_room(), 20);
        find_the_same_hits(&veiled_room(), 2);
    }

    /// With so many times 100,000 lines.
    fn find_the_same_hits(scene: &Scene, times: u64) {
        let accel = Accel::new(scene);
        let mut tracers = tracers(&accel);
        let streams = Streams::new(8, Stage::PROBE);
        for some in 0..times {
            let lines: Vec<Line> = (some * 100_000..(some + 1) * 100_000)
                .filter_map(|i| difficult_line(scene, i as usize % KINDS, &mut streams.line(i)))
                .collect();
            let found: Vec<_> = tracers
                .iter_mut()
                .map(|tracer| {
                    let (mut hits, mut counts) = (Vec::new(), Vec::new());
                    tracer.all_hits_each(&lines, |found| {
                        hits.extend(found.hits().iter().map(|&hit| bits(hit)));
                        counts.extend(found.lines().map(|line| line.len()));
                    });
                    (hits, counts)
                })
                .collect();
            assert!(found.iter().all(|f| f == &found[0]));
            assert!(found[0].0.len() > lines.len());
        }
    }

    #[test]
    fn all_kits_find_the_same_closest_hits_bit_for_bit() {
        find_the_same_closest_hits(&furnished_room());
        find_the_same_closest_hits(&veiled_room());
    }

    fn find_the_same_closest_hits(scene: &Scene) {
        let accel = Accel::new(scene);
        let mut tracers = tracers(&accel);
        let streams = Streams::new(9, Stage::PROBE);
        let mut rays: Vec<Ray> = Vec::new();
        for i in 0..200_000u64 {
            let Some(line) = difficult_line(scene, i as usize % KINDS, &mut streams.line(i)) else {
                continue;
            };
            // From outside, and on from each surface that is met.
            rays.push(line.into());
            rays.extend(tracers[0].all_hits(&line).iter().map(|hit| {
                let line = Line { origin: line.at(hit.t), ..line };
                Ray { line, leaving: Some(hit.triangle) }
            }));
        }
        assert!(rays.len() > 400_000);
        let found: Vec<_> = tracers
            .iter_mut()
            .map(|tracer| {
                let mut hits = vec![None; rays.len()];
                tracer.closest_each(&rays, |i, hit| hits[i] = hit.map(bits));
                hits
            })
            .collect();
        assert!(found.iter().all(|f| f == &found[0]));
        assert!(found[0].iter().flatten().count() > rays.len() / 3);
    }
}
