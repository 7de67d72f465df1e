//! Files, read back by other code than they were written with.

#![allow(clippy::unwrap_used, reason = "a step that fails is a test that fails")]

use std::fs;

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Camera, Material, Rgb, Scene, SceneBuilder, Sides};
use sir_mesh::{PatchMesh, PatchSize, Per, SideSums, Subdivision};
use sir_view::{DisplayMesh, Exposure, Row, Table, compare, write_glb};

fn scene() -> Scene {
    let mut builder = SceneBuilder::new();
    let red = builder.add_material(Material::diffuse("red \"wall\"", Rgb::new(0.8, 0.1, 0.1)));
    let white = builder.add_material(Material::diffuse("white", Rgb::splat(0.7)).with_sides(Sides::Both));
    let lamp = builder.add_material(Material::diffuse("lamp", Rgb::ZERO).emitting(Rgb::splat(100.0)));
    shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [red, red, white, lamp, red, red], Facing::Inward);
    builder.build().unwrap().scene
}

fn irradiance(mesh: &PatchMesh) -> Vec<Rgb> {
    (0..mesh.side_count() as u32).map(|i| Rgb::new(1.0, 2.0, 0.1) * (1.0 + f64::from(i) / 7.0)).collect()
}

fn table(scene: &Scene, subdivision: Subdivision) -> Table {
    let mesh = PatchMesh::new(scene, subdivision).unwrap();
    let e = irradiance(&mesh);
    let se: Vec<Rgb> = e.iter().map(|e| 0.01 * *e).collect();
    Table::new(scene, &mesh, &e, &se)
}

#[test]
fn a_glb_holds_the_light_by_material() {
    let scene = scene();
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(0.02))).unwrap();
    let e = irradiance(&mesh);
    let display = DisplayMesh::new(&scene, &mesh, &e);
    let camera = Camera::looking_at(DVec3::new(0.5, 0.6, 0.9), DVec3::splat(0.5), DVec3::Y, 1.0).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("lit.glb");
    write_glb(&path, &display, Exposure::Auto, std::slice::from_ref(&camera), DVec3::Z).unwrap();

    let read = gltf::Gltf::from_slice(&fs::read(&path).unwrap()).unwrap();
    let blob = read.blob.as_deref().unwrap();
    let mut triangles = 0;
    let mut names = Vec::new();
    for primitive in read.meshes().next().unwrap().primitives() {
        let material = primitive.material().name().unwrap().to_owned();
        let reader = primitive.reader(|_| Some(blob));
        let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        let colors: Vec<[f32; 3]> = reader.read_colors(0).unwrap().into_rgb_f32().collect();
        let radiosity = primitive.get(&gltf::Semantic::Extras("RADIOSITY".to_owned())).unwrap();
        assert_eq!([positions.len(), colors.len()], [radiosity.count(); 2]);
        assert!(colors.iter().flatten().all(|c| (0.0..=1.0).contains(c)));
        let view = radiosity.view().unwrap();
        let bytes = &blob[view.offset()..view.offset() + view.length()];
        let values: Vec<f32> =
            bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
        match material.as_str() {
            "lamp" => assert!(values.iter().all(|&b| b == 100.0), "B = M where nothing is reflected"),
            "white" => assert!(values.iter().all(|&b| b > 0.05 && b < 100.0)),
            _ => assert!(values.chunks_exact(3).all(|b| (b[0] / b[2] - 80.0).abs() < 0.01)),
        }
        let bounds = primitive.bounding_box();
        assert!(positions.iter().all(|p| (0..3).all(|i| bounds.min[i] <= p[i] && p[i] <= bounds.max[i])));
        let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        assert!(indices.iter().all(|&i| (i as usize) < positions.len()));
        triangles += indices.len() / 3;
        names.push(material);
    }
    assert_eq!(names, ["red \"wall\"", "white", "lamp"]);
    assert_eq!(triangles, display.triangles().len());

    let root = read.scenes().next().unwrap().nodes().next().unwrap();
    let (_, turn, _) = root.transform().decomposed();
    let up = glam::Quat::from_array(turn) * glam::Vec3::Z;
    assert!(up.distance(glam::Vec3::Y) < 1e-6, "z becomes the file's y");
    let pose = root.children().next().unwrap().transform().matrix();
    let eye = DVec3::from_array([pose[3][0], pose[3][1], pose[3][2]].map(f64::from));
    let backward = DVec3::from_array([pose[2][0], pose[2][1], pose[2][2]].map(f64::from));
    assert!(eye.distance(camera.eye) < 1e-6 && backward.distance(-camera.forward) < 1e-6);
}

#[test]
fn tables_add_up_and_have_a_row_for_each_side() {
    let scene = scene();
    for subdivision in [Subdivision::Triangles(PatchSize::MaxArea(0.01)), Subdivision::PerFace] {
        let rows = table(&scene, subdivision).rows;
        let area: f64 = rows.iter().map(|r| r.area).sum();
        assert!((area - 7.0).abs() < 1e-9, "the white face has two sides: {area}");
        let normals: DVec3 = rows.iter().map(|r| r.area * r.normal).sum();
        assert!((normals.length() - 1.0).abs() < 1e-9, "five faces and a sheet: {normals}");
        for r in &rows {
            assert!((r.normal.length() - 1.0).abs() < 1e-12);
            assert!(r.center.cmpge(DVec3::ZERO).all() && r.center.cmple(DVec3::ONE).all());
            let lamp = r.triangle / 2 == 3;
            assert!(if lamp {
                r.radiosity == Rgb::splat(100.0)
            } else {
                r.radiosity.x < 0.9 * r.irradiance.x
            });
            assert!((r.error - 0.01 * r.radiosity).length() < 1e-9 || lamp);
        }
    }
    let faces = table(&scene, Subdivision::PerFace).rows;
    assert_eq!(faces.len(), 7);
    assert!(faces[0].center.distance(DVec3::new(0.0, 0.5, 0.5)) < 1e-12);
    assert_eq!(faces[2].normal, -faces[3].normal);
}

#[test]
fn tables_are_read_back_to_the_last_bit() {
    let written = table(&scene(), Subdivision::Triangles(PatchSize::MaxArea(0.03)));
    let dir = tempfile::tempdir().unwrap();
    let (csv, npy) = (dir.path().join("t.csv"), dir.path().join("t.npy"));
    written.write_csv(&csv).unwrap();
    written.write_npy(&npy).unwrap();
    assert_eq!(Table::read(&csv).unwrap(), written);
    assert_eq!(Table::read(&npy).unwrap(), written);
    let bytes = fs::read(&npy).unwrap();
    let header = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert_eq!(header % 64, 0);
    assert_eq!(bytes.len() - header, 160 * written.rows.len());
}

#[test]
fn tables_of_parts_are_means_of_patches() {
    let scene = scene();
    let mesh = PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::MaxArea(0.02))).unwrap();
    let e = irradiance(&mesh);
    let se: Vec<Rgb> = e.iter().map(|e| 0.01 * *e).collect();
    let patches = Table::new(&scene, &mesh, &e, &se);
    let dir = tempfile::tempdir().unwrap();
    for (per, count) in [(Per::Triangle, 14), (Per::Face, 7), (Per::Material, 3), (Per::Group, 1)] {
        let sums = SideSums::new(&scene, &mesh, per);
        let table = Table::of_parts(&scene, &mesh, &sums, &e, &se, None);
        assert_eq!(table.rows.len(), count);
        let total =
            |table: &Table, of: fn(&Row) -> Rgb| table.rows.iter().map(|r| r.area * of(r)).sum::<Rgb>();
        for of in [|row: &Row| row.radiosity, |row: &Row| row.irradiance, |_: &Row| Rgb::ONE] {
            let [whole, parts] = [&patches, &table].map(|table| total(table, of));
            assert!((whole - parts).length() < 1e-5 * whole.length(), "{per:?}: {whole} {parts}");
        }
        let squares = |table: &Table| -> f64 {
            table.rows.iter().map(|r| (r.area * r.irradiance_error).length_squared()).sum()
        };
        let [whole, parts] = [&patches, &table].map(squares);
        if per != Per::Triangle {
            assert!((whole / parts - 1.0).abs() < 1e-6, "{per:?}: {whole} {parts}");
        }
        for name in ["t.csv", "t.npy"] {
            let path = dir.path().join(name);
            if name == "t.csv" { table.write_csv(&path) } else { table.write_npy(&path) }.unwrap();
            assert_eq!(Table::read(&path).unwrap(), table, "{per:?}");
        }
        assert_eq!(compare(&table, &table).unwrap().rows, count);
        assert!(compare(&table, &patches).unwrap_err().to_string().contains("of the second a patch"));
    }
}

#[test]
fn errors_of_parts_are_those_of_repeats() {
    let scene = scene();
    let mesh = PatchMesh::new(&scene, Subdivision::PerFace).unwrap();
    let (e, se) = (vec![Rgb::ONE; 7], vec![Rgb::splat(0.1); 7]);
    let sums = SideSums::new(&scene, &mesh, Per::Material);
    let stated: Vec<_> =
        (0..3).map(|i| [Rgb::splat(f64::from(i)), Rgb::splat(10.0 + f64::from(i))]).collect();
    let table = Table::of_parts(&scene, &mesh, &sums, &e, &se, Some(&stated));
    assert_eq!(table.names, ["red \"wall\"", "white", "lamp"]);
    for (i, row) in table.rows.iter().enumerate() {
        assert_eq!([row.irradiance_error, row.error], stated[i]);
    }
    assert!((table.rows[0].radiosity - Rgb::new(0.8, 0.1, 0.1)).length() < 1e-6);
    assert!((table.rows[1].area - 2.0).abs() < 1e-12, "both sides");
}

#[test]
fn tables_of_other_programs_are_read() {
    let written = table(&scene(), Subdivision::PerFace);
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t.csv");
    written.write_csv(&path).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("patch,triangle,area,") && !text.contains(['"', '\r', ' ']), "{text}");
    let quoted: Vec<String> =
        text.lines().map(|line| format!("\"{}\" ", line.replace(',', "\", \""))).collect();
    for other in [
        text.replace('\n', "\r\n"),
        format!("\u{feff}{}", text.replace(',', " , ")),
        text.replace('\n', ",note\n\n   \n"),
        quoted.join("\n").replace(" \"", "\""),
    ] {
        fs::write(&path, &other).unwrap();
        assert_eq!(Table::read(&path).unwrap(), written, "{other}");
    }
}

#[test]
fn a_broken_table_names_its_fault() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("broken");
    let good = table(&scene(), Subdivision::PerFace);
    good.write_csv(&path).unwrap();
    let header = fs::read_to_string(&path).unwrap().lines().next().unwrap().to_owned();
    let row = "0,0,1,0,0,0,0,0,1,1,1,1,1,1,1,0,0,0,0,0,0";
    let faults: [(&str, &[&str]); 6] = [
        ("", &["broken", "column patch"]),
        (&header.replace("E_g", "E_q"), &["column E_g"]),
        (
            &format!("{header}\n{row}\n{}", row.replacen(",1", ",one", 1)),
            &["row 2", "column area", "\"one\""],
        ),
        (&format!("{header}\n0,0,1"), &["row 1", "column cx", "only 3"]),
        (&format!("{header}\n{}", row.replacen("0,0,1", "0,0,NaN", 1)), &["row 1", "area", "finite"]),
        (&format!("{header}\n{}", row.replacen("0,0,1", "0.5,0,1", 1)), &["row 1", "patch", "whole"]),
    ];
    for (text, parts) in faults {
        fs::write(&path, text).unwrap();
        let error = Table::read(&path).unwrap_err().to_string();
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    }
    good.write_npy(&path).unwrap();
    let bytes = fs::read(&path).unwrap();
    for (cut, part) in [(bytes.len() - 1, "row 7 of 7"), (8, "broken")] {
        fs::write(&path, &bytes[..cut]).unwrap();
        let error = Table::read(&path).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
    let missing = Table::read(&dir.path().join("missing.csv")).unwrap_err().to_string();
    assert!(missing.contains("cannot read") && missing.contains("missing.csv"), "{missing}");
}

#[test]
fn a_comparison_gives_known_figures() {
    let a = table(&scene(), Subdivision::PerFace);
    let same = compare(&a, &a).unwrap();
    assert_eq!((same.luminance.relative_rms, same.luminance.relative_bias), (0.0, 0.0));
    assert!(same.worst.is_empty());
    assert_eq!(same.largest_z, Some(0.0));

    let mut b = a.clone();
    for row in &mut b.rows {
        row.radiosity *= 1.1;
    }
    b.rows[4].radiosity *= 2.0;
    let c = compare(&a, &b).unwrap();
    assert_eq!(c.rows, 7);
    for band in 0..3 {
        let (mut sum, mut difference, mut square, mut area) = (0.0, 0.0, 0.0, 0.0);
        for (i, row) in a.rows.iter().enumerate() {
            let d = row.radiosity[band] * if i == 4 { 1.2 } else { 0.1 };
            area += row.area;
            sum += row.area * row.radiosity[band];
            difference += row.area * d;
            square += row.area * d * d;
        }
        assert!((c.bands[band].mean - sum / area).abs() < 1e-12);
        assert!((c.bands[band].relative_bias - difference / sum).abs() < 1e-12);
        assert!((c.bands[band].relative_rms - (square / area).sqrt() / (sum / area)).abs() < 1e-12);
    }
    assert_eq!(c.worst[0].row, 4);
    // A lamp that reflects nothing is known without error.
    assert_eq!(c.worst[0].z, None);
    let expected = 0.1 / (0.01 * 2f64.sqrt());
    assert!((c.largest_z.unwrap() - expected).abs() < 1e-9);
}

#[test]
fn tables_of_other_patches_are_refused() {
    let a = table(&scene(), Subdivision::PerFace);
    let other = table(&scene(), Subdivision::PerTriangle);
    let error = compare(&a, &other).unwrap_err().to_string();
    assert!(error.contains("7 rows") && error.contains("14"), "{error}");
    let mut wider = a.clone();
    wider.rows[3].area *= 1.01;
    let error = compare(&a, &wider).unwrap_err().to_string();
    assert!(error.contains("row 4") && error.contains("area"), "{error}");
}
