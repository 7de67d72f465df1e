//! All backends find the same hits, bit for bit.

use sir_geom::{Opacity, Scene};
use sir_lines::{Purpose, Streams};
use sir_types::Line;

use crate::ray::{Ray, TRange};
use crate::tests::common::{KINDS, arrange, difficult_line, furnished_room, furnished_room_of};
use crate::tests::{bits, tracers};

/// Returns the room with surfaces that let half of all lines pass.
fn transparent_room() -> Scene {
    furnished_room_of(Opacity { factor: 0.5, ..Opacity::default() })
}

/// Two million lines, most of them through vertices and along edges.
#[test]
fn all_backends_find_the_same_hits_bit_for_bit() {
    find_the_same_hits(&furnished_room(), 20);
    find_the_same_hits(&transparent_room(), 2);
}

/// Traces `batches` times 100,000 lines.
fn find_the_same_hits(scene: &Scene, batches: u64) {
    let accel = arrange(scene);
    let mut tracers = tracers(&accel);
    let streams = Streams::new(8, Purpose::PROBE);
    for batch in 0..batches {
        let lines: Vec<Line> = (batch * 100_000..(batch + 1) * 100_000)
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
fn all_backends_find_the_same_closest_hits_bit_for_bit() {
    find_the_same_closest_hits(&furnished_room());
    find_the_same_closest_hits(&transparent_room());
}

fn find_the_same_closest_hits(scene: &Scene) {
    let accel = arrange(scene);
    let mut tracers = tracers(&accel);
    let streams = Streams::new(9, Purpose::PROBE);
    let mut rays: Vec<Ray> = Vec::new();
    for i in 0..200_000u64 {
        let Some(line) = difficult_line(scene, i as usize % KINDS, &mut streams.line(i)) else {
            continue;
        };
        // Rays from outside, and rays that leave each surface hit.
        rays.push(line.into());
        rays.extend(
            tracers[0]
                .all_hits(&line)
                .iter()
                .map(|hit| Ray::leaving(Line { origin: line.at(hit.t), ..line }, hit.triangle)),
        );
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
    for tracer in &mut tracers {
        let mut is_occluded = vec![false; rays.len()];
        tracer.occluded_each(&rays, |i, is| is_occluded[i] = is);
        assert!(is_occluded.iter().zip(&found[0]).all(|(is, hit)| *is == hit.is_some()));
    }
}

/// Difficult lines through the room, cut at random places and at their hits.
#[test]
fn parts_of_lines_have_the_hits_of_whole_lines_in_their_range() {
    let scene = transparent_room();
    let accel = arrange(&scene);
    let mut tracers = tracers(&accel);
    let streams = Streams::new(10, Purpose::PROBE);
    let mut parts: Vec<(Line, TRange)> = Vec::new();
    let mut expected = Vec::new();
    for i in 0..60_000u64 {
        let mut s = streams.line(i);
        let Some(line) = difficult_line(&scene, i as usize % KINDS, &mut s) else { continue };
        let hits = tracers[0].all_hits(&line);
        let mut place = || match hits.get((s.unit() * 8.0) as usize) {
            Some(hit) => hit.t,
            None => 14.0 * s.unit() - 4.0,
        };
        let range = TRange { start: place(), end: place() };
        expected
            .push(hits.iter().filter(|hit| range.contains(hit.t)).map(|&hit| bits(hit)).collect::<Vec<_>>());
        parts.push((line, range));
    }
    assert!(expected.iter().flatten().count() > 20_000);
    for tracer in &mut tracers {
        let mut found: Vec<Vec<_>> = Vec::new();
        tracer.all_hits_within_each(&parts, |hits| {
            found.extend(hits.lines().map(|line| hits.hits()[line].iter().map(|&hit| bits(hit)).collect()));
        });
        assert!(found == expected);
        let rays: Vec<Ray> = parts.iter().map(|(line, range)| Ray::new(*line).within(*range)).collect();
        let mut firsts = vec![None; rays.len()];
        tracer.closest_each(&rays, |i, hit| firsts[i] = hit.map(bits));
        let mut is_occluded = vec![false; rays.len()];
        tracer.occluded_each(&rays, |i, is| is_occluded[i] = is);
        for ((first, is_occluded), expected) in firsts.iter().zip(is_occluded).zip(&expected) {
            assert_eq!(first.as_ref(), expected.first());
            assert_eq!(is_occluded, !expected.is_empty());
        }
    }
}
