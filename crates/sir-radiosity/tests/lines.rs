//! Crossings and view factors of lines, against integral geometry and exact view factors.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use common::{add_polygon, case, domains, gray, per_face, reference};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{SceneBuilder, Sides};
use sir_lines::{Domain, Purpose, Streams};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{End, Model, Segment, Segments};

/// Counts how often each pair of sides faces each other along uniform lines: `count[i][j]` for light from `i` to `j`,
/// with one more column for everything that is not a side.
fn facing_counts(model: &Model, domain: &Domain, lines: u64) -> Vec<Vec<u64>> {
    let n = model.mesh.side_count();
    let mut count = vec![vec![0u64; n + 1]; n];
    let streams = Streams::new(11, Purpose::GLOBAL);
    let mut tracer = model.accel.tracer();
    let index = |end: End| match end {
        End::Side(side, _) => Some(side.index()),
        _ => None,
    };
    let lines: Vec<_> = (0..lines).map(|i| domain.line(streams.line(i).point())).collect();
    let mut segments = Segments::default();
    tracer.all_hits_each(&lines, |hits| {
        segments.find(&model.mesh, hits);
        for (_, Segment { from, to }) in segments.iter() {
            for (a, b) in [(from, to), (to, from)] {
                if let Some(a) = index(a) {
                    count[a][index(b).unwrap_or(n)] += 1;
                }
            }
        }
    });
    count
}

/// Crossings counted per side agree with the forecast `N · 2A/S`, on both sides of two-sided surfaces: the sum of
/// squared normalized deviations is χ²-distributed.
#[test]
fn counted_crossings_agree_with_the_forecast() {
    let mut b = SceneBuilder::new();
    let one = b.add_material(gray(1.0, 0.5));
    let two = b.add_material(gray(0.0, 0.5).with_sides(Sides::Both));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::new(4.0, 3.0, 5.0), [one; 6], Facing::Inward);
    shapes::cuboid(&mut b, DVec3::new(1.0, 0.5, 1.0), DVec3::new(1.5, 2.0, 3.0), [two; 6], Facing::Outward);
    shapes::sphere(&mut b, DVec3::new(3.0, 1.0, 2.0), 0.7, 2, Facing::Outward, |_| one);
    let model =
        Model::new(b.build().unwrap().scene, Subdivision::Triangles(PatchSize::Count(2_000))).unwrap();
    let lines = 500_000;
    for domain in domains(&model) {
        let count = facing_counts(&model, &domain, lines);
        let forecast = domain.forecast(lines);
        let (mut chi2, mut sides) = (0.0, 0.0);
        model.mesh.for_each_side(|triangle, patch, _, side| {
            let expected = forecast.crossings(model.mesh.patch_area(triangle, patch));
            let counted: u64 = count[side.index()].iter().sum();
            chi2 += (counted as f64 - expected).powi(2) / expected;
            sides += 1.0;
        });
        // Crossings of one patch are binomial with a small probability: nearly Poisson, variance = mean.
        let z = (chi2 - sides) / f64::sqrt(2.0 * sides);
        println!("{}: χ² = {chi2:.0} over {sides} sides, z = {z:+.2}", domain.name());
        assert!(z.abs() < 4.0);
    }
}

/// The share of the lines leaving `i` that arrive at `j` is the view factor `F_ij`.
#[test]
fn view_factors_of_a_cube() {
    let exact = reference("radiosity-exact.json");
    let cube = &case(&exact, "RE-08")["geometry"]["surfaces"];
    let mut b = SceneBuilder::new();
    let m = b.add_material(gray(1.0, 0.5));
    for surface in cube.as_array().unwrap() {
        add_polygon(&mut b, surface, m);
    }
    let model = per_face(b);
    let count = facing_counts(&model, &Domain::hull(model.scene.vertices()), 500_000);
    let factors = reference("view-factors.json");
    let value = |id: &str| case(&factors, id)["values"]["F12"].as_f64().unwrap();
    let (opposite, adjacent) = (value("VF-01"), value("VF-03"));
    for (i, row) in count.iter().enumerate() {
        let leaving: u64 = row.iter().sum();
        for (j, &arriving) in row[..6].iter().enumerate() {
            // Faces are listed as opposite pairs.
            let expected = if i == j {
                0.0
            } else if i / 2 == j / 2 {
                opposite
            } else {
                adjacent
            };
            let measured = arriving as f64 / leaving as f64;
            let sigma = (expected * (1.0 - expected) / leaving as f64).sqrt();
            assert!(
                (measured - expected).abs() <= 4.0 * sigma,
                "F[{i}][{j}] = {measured} ± {sigma}, {expected}"
            );
            assert_eq!(arriving, count[j][i], "reciprocity holds line by line");
        }
        assert_eq!(row[6], 0, "nothing escapes a closed cube");
    }
}

/// The view factors of concentric spheres, including those of curved surfaces to themselves.
#[test]
fn view_factors_of_concentric_spheres() {
    let factors = reference("view-factors.json");
    for id in ["VF-09", "VF-10"] {
        let c = case(&factors, id);
        let radius = |k: &str| c["geometry"]["parameters"][k].as_f64().unwrap();
        let mut b = SceneBuilder::new();
        for (k, facing) in [("r1", Facing::Outward), ("r2", Facing::Inward)] {
            let m = b.add_material(gray(1.0, 0.5));
            common::add_sphere(&mut b, radius(k), 1, facing, &[(180, m)]);
        }
        let model = per_face(b);
        let sphere_of_side = {
            let mut spheres = Vec::new();
            model.mesh.for_each_side(|t, _, _, _| spheres.push(model.scene.triangle(t).material.index()));
            spheres
        };
        let mut count = [[0; 2]; 2];
        for (i, row) in
            facing_counts(&model, &Domain::hull(model.scene.vertices()), 500_000).iter().enumerate()
        {
            for (j, &n) in row.iter().enumerate().take(sphere_of_side.len()) {
                count[sphere_of_side[i]][sphere_of_side[j]] += n;
            }
        }
        for i in 0..2 {
            let leaving: u64 = count[i].iter().sum();
            for j in 0..2 {
                let expected = c["values"][format!("F{}{}", i + 1, j + 1)].as_f64().unwrap();
                let measured = count[i][j] as f64 / leaving as f64;
                // A chord of a surface that sees itself is counted at both ends, so the variance is at most doubled.
                let sigma = (2.0 * expected * (1.0 - expected) / leaving as f64).sqrt();
                assert!((measured - expected).abs() <= 4.0 * sigma, "{id} F{i}{j}: {measured} {expected}");
            }
        }
    }
}
