//! OBJ and MTL.

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::{Built, LoadError, LoadOptions, Sides, SidesPolicy, Warning};

use crate::files::{chain, corners, load_from, load_with, png, warnings};

fn read(obj: &str, mtl: &str) -> Built {
    load_from("a.obj", &[("a.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes())]).unwrap()
}

fn refused(obj: &str) -> LoadError {
    load_from("a.obj", &[("a.obj", obj.as_bytes())]).unwrap_err()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// Returns the material names of the triangles, in order.
fn order(built: &Built) -> Vec<String> {
    built.scene.triangle_ids().map(|t| built.scene.material(t).name.clone()).collect()
}

#[test]
fn faces_are_read_however_they_are_written() {
    let expected = [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]];
    for face in [
        "f 1 2 3",
        "f -4 -3 -2",
        "f\t1  2\t3   # a comment",
        "  f 1/1 2/2 3/3",
        "f 1//9 2//9 3//9\r",
        "f 1/-9/77 2/0/0 3/1/1",
        "f 1 \\\n2 \\\n 3",
    ] {
        let built = read(&format!("{SQUARE}vn 0 0 1\nvt 0 0\n{face}\n"), "");
        assert_eq!(corners(&built.scene), expected, "{face}");
    }
}

#[test]
fn vertices_may_carry_colors_weights_and_comments() {
    let built = read("\u{feff}v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv\t1.0e0 +1 .0 0.5 # corner\nf 1 2 3", "");
    assert_eq!(corners(&built.scene), [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]]);
}

#[test]
fn polygons_are_fans_of_one_face_in_file_order() {
    let obj = format!("{SQUARE}v 2 2 1\nf 1 2 3\nf 1 2 3 4\ng other\nf 1 2 3 5 4\nf 2 3 5\n");
    let scene = read(&obj, "").scene;
    let faces: Vec<u32> = scene.triangles().iter().map(|t| t.face.0).collect();
    assert_eq!(faces, [0, 1, 1, 2, 2, 2, 3]);
    let sources: Vec<u32> = scene.triangles().iter().map(|t| t.source).collect();
    assert_eq!(sources, [0, 1, 2, 3, 4, 5, 6]);
    let corner = |t: usize, i: usize| corners(&scene)[t][i];
    assert_eq!(
        [corner(2, 0), corner(2, 1), corner(2, 2)],
        [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
    );
}

#[test]
fn triangles_stay_in_file_order_when_groups_and_materials_alternate() {
    let obj = format!(
        "mtllib a.mtl\n{SQUARE}usemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\no x\nf 1 3 4\nusemtl a\ng y z\nf 2 3 4\n\
         usemtl b\nusemtl a\nf 1 2 3 4\ng y z\nusemtl b\nf 1 2 3\n"
    );
    let built =
        read(&obj, "newmtl b\nKd 0.2 0.2 0.2\nnewmtl a\nKd 0.1 0.1 0.1\nnewmtl unused\nmap_Kd absent.png\n");
    assert_eq!(order(&built), ["a", "b", "b", "a", "a", "a", "b"]);
    assert!(built.warnings.is_empty(), "{:?}", built.warnings);
}

#[test]
fn groups_are_named_by_the_last_object_or_group() {
    let built = read(
        &format!(
            "{SQUARE}f 1 2 3\no a chair\nf 2 3 4\nusemtl x\nf 1 2 3\ng legs # four\nf 3 4 1\no a chair\nf 1 2 4\ng\nf 1 2 3\n"
        ),
        "",
    );
    let scene = built.scene;
    let names: Vec<&str> = scene.triangles().iter().map(|t| &*scene.groups()[t.group.index()]).collect();
    assert_eq!(names, ["", "a chair", "a chair", "legs", "a chair", ""]);
    assert_eq!(scene.groups(), ["", "a chair", "legs"]);
}

#[test]
fn materials_have_reflectance_and_emission() {
    let mtl = "# lib\nnewmtl my lamp # its name\n\tKd\t0.1 0.2 0.3 # gray\n\tKe 1 2 3\nKs 1 1 1\nnewmtl flat\nkd 0.4\n";
    let built = read(&format!("mtllib a.mtl\n{SQUARE}usemtl my lamp\nf 1 2 3\nusemtl\tflat\nf 1 3 4\n"), mtl);
    let [lamp, flat] = built.scene.materials() else { panic!("{:?}", built.scene.materials()) };
    assert_eq!((&*lamp.name, lamp.reflectance), ("my lamp", DVec3::new(0.1, 0.2, 0.3)));
    assert_eq!(lamp.exitance, PI * DVec3::new(1.0, 2.0, 3.0));
    assert_eq!((lamp.sides, lamp.back_emits), (Sides::Both, false));
    assert_eq!((flat.reflectance, flat.exitance), (DVec3::splat(0.4), DVec3::ZERO));
    assert!(built.warnings.is_empty(), "{:?}", built.warnings);
}

#[test]
fn sides_are_a_matter_of_policy() {
    for (sides, expected) in [
        (SidesPolicy::AsAuthored, Sides::Both),
        (SidesPolicy::Both, Sides::Both),
        (SidesPolicy::Front, Sides::Front),
    ] {
        let obj = format!("{SQUARE}f 1 2 3\n");
        let built = load_with("a.obj", &[("a.obj", obj.as_bytes())], &LoadOptions { sides }).unwrap();
        let material = &built.scene.materials()[0];
        assert_eq!((material.sides, material.back_emits), (expected, false));
    }
}

#[test]
fn several_libraries_are_read_and_the_last_of_equal_names_counts() {
    let obj = format!(
        "{SQUARE}usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\nmtllib x y.mtl\nmtllib one.mtl two.mtl sub\\3.mtl\n"
    );
    let files: [(&str, &[u8]); 5] = [
        ("a.obj", obj.as_bytes()),
        ("x y.mtl", b"newmtl a\nKd 0.9 0.9 0.9"),
        ("one.mtl", b"newmtl a\nKd 0.1 0.1 0.1"),
        ("two.mtl", b"newmtl unused\nKd 1 1 1"),
        ("sub/3.mtl", b"newmtl b\nKd 0.3 0.3 0.3"),
    ];
    let built = load_from("a.obj", &files).unwrap();
    let reflectances: Vec<f64> =
        built.scene.triangle_ids().map(|t| built.scene.material(t).reflectance.x).collect();
    assert_eq!(reflectances, [0.1, 0.3]);
    assert!(built.warnings.is_empty(), "{:?}", built.warnings);
}

#[test]
fn missing_libraries_and_materials_are_warnings() {
    let built = read(
        &format!("mtllib absent.mtl\n{SQUARE}f 1 2 3\nusemtl gone\nf 1 2 3 4\nusemtl too\nf 1 2 4\n"),
        "",
    );
    assert_eq!(
        warnings(&built),
        [
            "1 material libraries cannot be read: absent.mtl",
            "2 materials are in no library, and are made gray: gone, too",
            "3 faces have no known material, and are made gray",
        ]
    );
    let [gray] = built.scene.materials() else { panic!("{:?}", built.scene.materials()) };
    assert_eq!((gray.reflectance, gray.sides), (DVec3::splat(0.5), Sides::Both));
}

#[test]
fn textures_count_with_their_mean() {
    let obj = format!("mtllib sub/a.mtl\n{SQUARE}usemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\nusemtl c\nf 1 3 4\n");
    let mtl = "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd -s 1 1 1 -clamp on my\\wood x.png # c\nKe 1 1 1\nmap_Ke my/wood x.png\n\
               newmtl b\nmap_Kd my/wood x.png\nnewmtl c\nKd 0.3 0.3 0.3\nmap_Kd absent.png\n";
    let image = png([128, 0, 255]);
    let files: [(&str, &[u8]); 3] =
        [("a.obj", obj.as_bytes()), ("sub/a.mtl", mtl.as_bytes()), ("sub/my/wood x.png", &image)];
    let built = load_from("a.obj", &files).unwrap();
    let mean = DVec3::new(0.215_860_500_113_899_26, 0.0, 1.0);
    let [a, b, c] = built.scene.materials() else { panic!("{:?}", built.scene.materials()) };
    assert!(a.reflectance.distance(0.5 * mean) < 1e-14 && a.exitance.distance(PI * mean) < 1e-14, "{a:?}");
    assert!(b.reflectance.distance(mean.min(DVec3::splat(0.999))) < 1e-14, "{b:?}");
    assert_eq!(c.reflectance, DVec3::splat(0.3));
    let texts = warnings(&built);
    assert!(texts[0].starts_with("1 textures cannot be read; only their color factors are used: absent.png"));
    assert!(
        matches!(&built.warnings[1..], [Warning::ClampedReflectance { material, .. }] if material == "b")
    );
}

#[test]
fn points_and_lines_are_one_warning() {
    let built = read(&format!("{SQUARE}p 1\nl 1 2 3 4\nf 1 2\nf 1 2 3\nl 1 2\n"), "");
    assert_eq!(built.scene.triangles().len(), 1);
    assert_eq!(warnings(&built)[0], "4 points and lines were skipped");
}

#[test]
fn coordinates_that_are_no_numbers_drop_their_triangles() {
    let built = read(
        &format!("{SQUARE}v nan 0 0\nv 1e999 0 0\nv -1.#IND 0 0\nf 1 2 5\nf 1 2 3 6\nf 1 2 7\nf 2 3 4"),
        "",
    );
    let sources: Vec<u32> = built.scene.triangles().iter().map(|t| t.source).collect();
    assert_eq!(sources, [1, 4]);
    assert!(built.warnings.contains(&Warning::DroppedTriangles { count: 3 }));
}

#[test]
fn faults_are_errors_with_their_line() {
    for (bad, what) in [
        ("v 1 2", "position parse error in \"v 1 2\""),
        ("v 1 2 x", "position parse error"),
        ("f 1 2 x", "face parse error"),
        ("f 1 2 1.5", "face parse error"),
        ("usemtl", "material parse error"),
    ] {
        let error = refused(&format!("{SQUARE}# line 5\n{bad}\nf 1 2 3\n"));
        assert!(matches!(&error, LoadError::Syntax { line: 6, .. }), "{bad}: {error:?}");
        assert!(error.to_string().contains(what) && error.to_string().contains("a.obj:6"), "{error}");
    }
    for bad in ["5", "0", "-5", "99999999999999", "-9223372036854775808", "9223372036854775807", "/1", "//1"]
    {
        let error = refused(&format!("{SQUARE}f 1 2 3\n\nf 1 2 {bad}\ng x\nf 1 2 3\n"));
        let LoadError::NoSuchVertex { line, index, count, .. } = &error else { panic!("{bad}: {error:?}") };
        assert_eq!((*line, &**index, *count), (7, bad, 4));
    }
    for (mtl, line) in [
        ("newmtl a\nKd 1 x 1", 2),
        ("newmtl\n", 1),
        ("\nnewmtl a\n\nKe 1 2", 4),
        ("newmtl a\nKd spectral a.rfl 1", 2),
    ] {
        let obj = format!("mtllib a.mtl\n{SQUARE}f 1 2 3\n");
        let error = load_from("a.obj", &[("a.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes())]).unwrap_err();
        let LoadError::Syntax { path, line: found, .. } = &error else { panic!("{mtl}: {error:?}") };
        assert_eq!((path.ends_with("a.mtl"), *found), (true, line), "{error}");
    }
}

#[test]
fn files_that_are_no_scenes_are_refused() {
    assert!(chain(&refused("")).contains("no triangle"));
    assert!(chain(&refused("# only a comment\\")).contains("no triangle"));
    let unknown = load_from("a.stl", &[("a.stl", b"solid")]).unwrap_err();
    assert!(unknown.to_string().contains(".gltf, .glb and .obj"), "{unknown}");
    assert!(load_from("noextension", &[]).unwrap_err().to_string().contains("no extension"));
    assert!(matches!(load_from("absent.obj", &[]), Err(LoadError::Read { .. })));
    let folder = load_from("folder.obj", &[("folder.obj/x", b"")]).unwrap_err();
    assert!(chain(&folder).contains("not a regular file"), "{folder}");
}

#[test]
fn text_need_not_be_utf8() {
    let obj = [SQUARE.as_bytes(), b"g caf\xe9\n# \xff\nusemtl caf\xe9\nf 1 2 3\n"].concat();
    let built = load_from("a.obj", &[("a.obj", &obj)]).unwrap();
    assert_eq!(built.scene.triangles().len(), 1);
}
