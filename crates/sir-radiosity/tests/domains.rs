//! The light does not depend on the domain of the global lines. Only the share of wasted lines does.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use common::{
    Estimate, add_polygon, batches_in, case, domains, gray, multipath_in, per_face, radiosities, reference,
    shoot,
};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder, Sides};
use sir_lines::Domain;
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{Model, Shot, Transported};

/// Transports the light of a first shot with lines of a domain, with a number of lines and a seed.
type Transport = fn(Domain, &Model, Shot, u64, u64) -> Transported;

const TRANSPORTS: [(&str, Transport); 2] = [("batches", batches_in), ("multipath", multipath_in)];

/// Two plates with a common edge: an open scene whose hull is a wedge. With one patch per plate, the exact radiosities
/// are `B₁ = M₁ + ρ₁F₁₂B₂` and `B₂ = M₂ + ρ₂F₂₁B₁`.
#[test]
fn plates_have_their_exact_radiosities_in_all_domains() {
    let plates = case(&reference("view-factors.json"), "VF-04");
    let factor = |name: &str| plates["values"][name].as_f64().unwrap();
    let (f12, f21) = (factor("F12"), factor("F21"));
    let (exitance, reflectance) = ([1.0, 0.5], [0.6, 0.9]);
    let feedback = 1.0 - reflectance[0] * reflectance[1] * f12 * f21;
    let exact = [
        (exitance[0] + reflectance[0] * f12 * exitance[1]) / feedback,
        (exitance[1] + reflectance[1] * f21 * exitance[0]) / feedback,
    ];
    let mut b = SceneBuilder::new();
    for (k, surface) in plates["geometry"]["surfaces"].as_array().unwrap().iter().enumerate() {
        let m = b.add_material(gray(exitance[k], reflectance[k]));
        add_polygon(&mut b, surface, m);
    }
    let model = per_face(b);
    for domain in domains(&model) {
        for (way, transport) in TRANSPORTS {
            let run = |seed| {
                let done = transport(domain.clone(), &model, shoot(&model, 300_000, seed), 300_000, seed);
                radiosities(&model, &done)
            };
            let runs: Vec<Vec<Rgb>> = (1..=8).map(run).collect();
            for plate in 0..2 {
                let what = format!("{}, {way}, plate {plate}", domain.name());
                Estimate::of(runs.iter().map(|r| r[plate].x)).assert_is(exact[plate], &what);
            }
        }
    }
}

/// Returns a room with a table, a ball and a two-sided screen, in 900 patches, some of which have two sides. Its walls
/// are those of a box with one corner cut off.
fn room() -> Model {
    let mut b = SceneBuilder::new();
    let diffuse = |r, g, blue| Material::diffuse("", Rgb::new(r, g, blue));
    let white = b.add_material(diffuse(0.8, 0.8, 0.7));
    let red = b.add_material(diffuse(0.7, 0.2, 0.1));
    let lamp = b.add_material(diffuse(0.5, 0.5, 0.5).emitting(Rgb::new(5.0, 4.0, 3.0)));
    let screen = b.add_material(diffuse(0.3, 0.6, 0.6).with_sides(Sides::Both));
    let at = |x, z| [DVec3::new(x, 0.0, z), DVec3::new(x, 2.5, z)];
    let outline = [at(0.0, 0.0), at(0.0, 3.0), at(4.0, 3.0), at(4.0, 1.5), at(3.0, 0.0)];
    for (k, &[a, up]) in outline.iter().enumerate() {
        let [next, next_up] = outline[(k + 1) % 5];
        shapes::quad(&mut b, [a, up, next_up, next], if k == 1 { red } else { white });
    }
    for (level, reverse, material) in [(0, false, white), (1, true, lamp)] {
        let mut corners = outline.map(|wall| b.add_vertex(wall[level]));
        if reverse {
            corners.reverse();
        }
        b.add_polygon(&corners, material);
    }
    let table = [DVec3::new(1.0, 0.4, 1.0), DVec3::new(2.0, 0.8, 2.0)];
    shapes::cuboid(&mut b, table[0], table[1], [red; 6], Facing::Outward);
    shapes::sphere(&mut b, DVec3::new(3.0, 1.0, 2.0), 0.5, 2, Facing::Outward, |_| white);
    let sheet = [
        DVec3::new(0.5, 0.0, 0.5),
        DVec3::new(0.5, 0.0, 2.5),
        DVec3::new(0.7, 1.5, 2.5),
        DVec3::new(0.7, 1.5, 0.5),
    ];
    shapes::quad(&mut b, sheet, screen);
    Model::new(b.build().unwrap().scene, Subdivision::Triangles(PatchSize::Count(900))).unwrap()
}

/// All domains give every material the same radiosity, and every patch the same irradiance, within the errors that runs
/// show and state. The mean square of the differences of patches in units of their errors is 1 ± √(2/7000) per band if
/// patches are independent. It is a little larger in batches, because the stated errors leave out the noise that
/// patches inherit from each other (`errors.rs`).
#[test]
fn a_furnished_room_looks_the_same_in_all_domains() {
    const LINES: u64 = 100_000;
    const RUNS: u64 = 8;
    let model = room();
    let shot = shoot(&model, LINES, 1);
    let direct = shot.solution(&model).error;
    let hull = Domain::hull(model.scene.vertices()).surface();
    for (way, transport) in TRANSPORTS {
        // The same number of crossings in each domain.
        let runs = domains(&model).map(|domain| {
            let lines = (LINES as f64 * domain.surface() / hull) as u64;
            let first = domain.name().len() as u64 * 100;
            let run = |seed| transport(domain.clone(), &model, shot.clone(), lines, seed);
            (domain.name(), (first..first + RUNS).map(run).collect::<Vec<_>>())
        });
        for (i, (name, these)) in runs.iter().enumerate() {
            let (other, those) = &runs[(i + 1) % 3];
            let [a, b] = [these, those].map(|runs| runs.iter().map(|run| radiosities(&model, run)));
            let [a, b] = [a, b].map(Iterator::collect::<Vec<_>>);
            for material in 0..4 {
                for band in 0..3 {
                    let [a, b] = [&a, &b].map(|r| Estimate::of(r.iter().map(|r| r[material][band])));
                    let sigma = a.sigma.hypot(b.sigma);
                    assert!(sigma < 0.006 * a.mean, "{sigma} is too large for a meaningful comparison");
                    let z = (a.mean - b.mean) / sigma;
                    let values = format!("{} and {}, z {z:+.2}", a.mean, b.mean);
                    println!("{way}, {name} and {other}, material {material}: {values}");
                    assert!(z.abs() <= 4.0, "{way}, {name} and {other}, material {material}: {values}");
                }
            }
            let (mut squares, mut terms) = (Rgb::ZERO, 0.0);
            for (a, b) in these.iter().zip(those) {
                let [a, b] = [a, b].map(|run| run.solution(&model));
                for (side, &direct) in direct.iter().enumerate() {
                    let square = |v: Rgb| v * v;
                    let [a, b] = [&a, &b].map(|run| (run.irradiance[side], run.error[side]));
                    // Both runs have the same direct light and share its error.
                    let variance = square(a.1) + square(b.1) - 2.0 * square(direct);
                    squares += square(a.0 - b.0) / variance;
                    terms += 1.0;
                }
            }
            let mean = squares / terms;
            println!("{way}, {name} and {other}: mean square {mean:.3} of {terms} differences");
            let most = if way == "batches" { 1.13 } else { 1.07 };
            assert!(mean.min_element() > 0.9 && mean.max_element() < most, "{way}, {name}, {other}: {mean}");
        }
    }
}

#[test]
fn in_a_convex_room_no_line_of_the_hull_is_wasted() {
    let model = room();
    let shot = shoot(&model, 1_000, 1);
    let scene = &model.scene;
    let hull = Domain::hull(scene.vertices()).surface();
    for domain in domains(&model) {
        let (name, surface) = (domain.name(), domain.surface());
        let counts = batches_in(domain, &model, shot.clone(), 300_000, 1).counts;
        let hit = (counts.lines - counts.empty) as f64 / counts.lines as f64;
        let sigma = (hit * (1.0 - hit) / counts.lines as f64).sqrt();
        println!("{name}: {hit:.4} of the lines hit something, {:.4} by area", hull / surface);
        assert!((hit - hull / surface).abs() <= 4.0 * sigma, "{name}: {hit}");
        if name == "Hull" {
            assert_eq!(counts.empty, 0);
        }
    }
}
