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
        let built = load_with(
            "a.obj",
            &[("a.obj", obj.as_bytes())],
            &LoadOptions { sides, ..LoadOptions::default() },
        )
        .unwrap();
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
        ("v 1 2", "\"v 1 2\" must have three numbers"),
        ("v 1 2 x", "\"v 1 2 x\" must have three numbers"),
        ("v 0,5 0,5 0", "with a point before decimals"),
        ("f 1 2 x", "\"x\" of a face does not begin with a vertex number"),
        ("f 1 2 1.5", "\"1.5\" of a face"),
        ("f 1 2 /1", "\"/1\" of a face"),
        ("f 1 2 //1", "\"//1\" of a face"),
    ] {
        let error = refused(&format!("{SQUARE}# line 5\n{bad}\nf 1 2 3\n"));
        assert!(matches!(&error, LoadError::Syntax { line: 6, .. }), "{bad}: {error:?}");
        assert!(error.to_string().contains(what) && error.to_string().contains("a.obj:6"), "{error}");
    }
    for bad in ["5", "0", "-5", "99999999999999", "-9223372036854775808", "99999999999999999999"] {
        let error = refused(&format!("{SQUARE}f 1 2 3\n\nf 1 2 {bad}/1\ng x\nf 1 2 3\n"));
        let LoadError::NoSuchVertex { line, index, count, .. } = &error else { panic!("{bad}: {error:?}") };
        assert_eq!((*line, &**index, *count), (7, bad, 4));
    }
    for (mtl, line, what) in [
        ("newmtl a\nKd 1 x 1", 2, "\"Kd 1 x 1\" must have one or three numbers"),
        ("newmtl a\nKd 0,3 0,3 0,3", 2, "with a point before decimals"),
        ("\nnewmtl a\n\nKe 1 2", 4, "\"Ke 1 2\" must have one or three numbers"),
        ("newmtl a\nKd", 2, "\"Kd\" must have one or three numbers"),
        ("newmtl a\nKe 1\nKd nan 0 0", 3, "\"Kd nan 0 0\" must have finite numbers"),
        ("newmtl a\nKe -nan(ind)", 2, "must have finite numbers"),
        ("newmtl a\nKe 0 -0.1 0", 2, "not negative"),
        ("newmtl a\nd nan", 2, "must have a finite number"),
        ("newmtl a\nTr -halo", 2, "must have a finite number"),
    ] {
        let obj = format!("mtllib a.mtl\n{SQUARE}usemtl a\nf 1 2 3\n");
        let error = load_from("a.obj", &[("a.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes())]).unwrap_err();
        let LoadError::Syntax { path, line: found, .. } = &error else { panic!("{mtl}: {error:?}") };
        assert_eq!((path.ends_with("a.mtl"), *found), (true, line), "{error}");
        assert!(error.to_string().contains(what), "{error}");
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
    assert!(folder.to_string().contains("folder.obj is a folder; name the scene file in it"), "{folder}");
}

/// Statements of materials without a face say nothing and stop nothing; those before the first material belong to none.
#[test]
fn materials_without_faces_are_not_read() {
    let mtl =
        "Kd 1 2\nnewmtl b\nKd nan\nKe x\nbump b.png\nd\nnewmtl\nKd 7,5\nnewmtl a\nKd 0.25\nnewmtl c\nTr x";
    let built = read(&format!("mtllib a.mtl\n{SQUARE}usemtl a\nf 1 2 3\nusemtl none\nusemtl b\n"), mtl);
    assert_eq!(warnings(&built), [""; 0]);
    let [a] = built.scene.materials() else { panic!("{:?}", built.scene.materials()) };
    assert_eq!((&*a.name, a.reflectance), ("a", DVec3::splat(0.25)));
}

#[test]
fn a_missing_name_is_a_name() {
    let obj = format!("mtllib a.mtl\n{SQUARE}usemtl \nf 1 2 3\nusemtl a\nf 1 2 4\n");
    let built = read(&obj, "newmtl\nKd 0.1 0.2 0.3\nnewmtl a\nKd 0.4\n");
    assert_eq!(warnings(&built), [""; 0]);
    let reflectance = |t| built.scene.material(t).reflectance;
    let all: Vec<DVec3> = built.scene.triangle_ids().map(reflectance).collect();
    assert_eq!(all, [DVec3::new(0.1, 0.2, 0.3), DVec3::splat(0.4)]);
    let built = read(&obj, "newmtl \nnewmtl a\nKd 0.4\n");
    assert_eq!(warnings(&built), ["1 materials have no diffuse color, and are made gray: (no name)"]);
    let built = read(&obj, "newmtl a\nKd 0.4\n");
    assert_eq!(
        warnings(&built),
        [
            "1 materials are in no library, and are made gray: (no name)",
            "1 faces have no known material, and are made gray",
        ]
    );
    assert_eq!(built.scene.materials()[1].reflectance, DVec3::splat(0.5));
}

#[test]
fn colors_that_are_not_rgb_are_one_warning() {
    let obj = format!("mtllib a.mtl\n{SQUARE}usemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\n");
    let mtl = "newmtl a\nKd spectral a.rfl 1\nKe xyz 1 2 3\nnewmtl b\nKd xyz 0.2 0.3 0.4\nKd 0.4\n";
    let built = read(&obj, mtl);
    assert_eq!(
        warnings(&built),
        [
            "2 materials have spectral or CIE XYZ colors, which are not read: a, b",
            "1 materials have no diffuse color, and are made gray: a",
        ]
    );
    let all: Vec<_> = built.scene.materials().iter().map(|m| (m.reflectance.x, m.exitance.x)).collect();
    assert_eq!(all, [(0.5, 0.0), (0.4, 0.0)]);
}

#[test]
fn free_forms_and_included_files_are_warnings() {
    let free = "v 0 3 0 1\nvp 0 0\ncstype rat bspline\ndeg 1 1\nsurf 0 1 0 1 -4 -3 -2 -1\nparm u 0 0 1 1\nend\n\
                curv 0 1 1 2\nend\nbzp 1 2 3 4\ncall other.obj\n";
    let built = read(&format!("{SQUARE}{free}FO 1 2 3\nF 1 2 4\n"), "");
    assert_eq!(built.scene.triangles().len(), 2);
    assert_eq!(
        warnings(&built)[..2],
        [
            "3 free-form curves and surfaces were skipped",
            "1 statements `call`, which include other files, were skipped",
        ]
    );
    let text = chain(&refused(&format!("{SQUARE}{free}")));
    assert!(text.contains("(3 free-form curves and surfaces were skipped and 1 statements"), "{text}");
}

/// A lamp that a program has mirrored without turning its faces around, as its normals show.
#[test]
fn normals_against_the_winding_of_lamps_are_a_warning() {
    let mtl = "newmtl lamp\nKe 1\nKd 0\nnewmtl wall\nKd 0.5\n";
    let scene = |faces: &str| {
        let built = read(&format!("mtllib a.mtl\n{SQUARE}vn 0 0 -1\nvn 0.6 0 0.8\nvt 0 0\n{faces}"), mtl);
        warnings(&built)
    };
    let reversed = scene(
        "usemtl lamp\nf 1//1 2//1 3//1\ng ceiling\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -4//-2 -3//-2 -2//-2\n\
         usemtl wall\nf 1//1 2//1 3//1\n",
    );
    assert_eq!(
        reversed,
        [
            "3 emitting faces have normals (`vn`) that point to their backs, but only fronts emit, where corners run \
          counterclockwise; turn the faces around if their light is on the wrong side: \"lamp\", \"lamp\" in \"ceiling\""
        ]
    );
    for fine in [
        "f 1//2 2//2 3//2",
        "f 3//1 2//1 1//1",
        "f 1//1 2//1 3",
        "f 1 2 3",
        "f 1//1 2//1 3//9",
        "f 1/1 2/1 3/1",
    ] {
        assert_eq!(scene(&format!("usemtl lamp\n{fine}\n")), [""; 0], "{fine}");
    }
}

#[test]
fn text_need_not_be_utf8() {
    let obj = [SQUARE.as_bytes(), b"g caf\xe9\n# \xff\nusemtl caf\xe9\nf 1 2 3\n"].concat();
    let built = load_from("a.obj", &[("a.obj", &obj)]).unwrap();
    assert_eq!(built.scene.groups(), ["", "caf\\xE9"]);
}

/// Chinese names in GBK, some of which are the same once unreadable bytes are replaced, and one that ends with a
/// backslash in Shift JIS.
#[test]
fn names_are_bytes() {
    let names: [&[u8]; 4] = [b"\xc7\xbd", b"\xb5\xd8", b"\xb6\xa5", b"\x83\x5c"];
    let mut obj = [b"mtllib \xb2\xc4\\\xc7\xbd.mtl\n", SQUARE.as_bytes()].concat();
    let mut mtl = Vec::new();
    for (i, name) in names.into_iter().enumerate() {
        obj.extend([b"usemtl ", name, b"\ng ", name, b"\nf 1 2 3\n"].concat());
        mtl.extend([b"newmtl ", name, format!("\nKd 0.{}\n", i + 1).as_bytes()].concat());
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.obj"), &obj).unwrap();
    let built = sir_geom::load(&folder.path().join("a.obj"), &LoadOptions::default()).unwrap();
    assert_eq!(
        warnings(&built)[..2],
        [
            "1 material libraries cannot be read: \\xB2\\xC4\\\\xC7\\xBD.mtl",
            "4 materials are in no library, and are made gray: \u{1fd}, \\xB5\\xD8, \\xB6\\xA5, \\x83\\",
        ]
    );
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt as _;
        let sub = folder.path().join(std::ffi::OsStr::from_bytes(b"\xb2\xc4"));
        std::fs::create_dir(&sub).unwrap();
        std::fs::write(sub.join(std::ffi::OsStr::from_bytes(b"\xc7\xbd.mtl")), &mtl).unwrap();
        let built = sir_geom::load(&folder.path().join("a.obj"), &LoadOptions::default()).unwrap();
        assert_eq!(warnings(&built), [""; 0]);
        let read = |t| built.scene.material(t).reflectance.x;
        assert_eq!(built.scene.triangle_ids().map(read).collect::<Vec<_>>(), [0.1, 0.2, 0.3, 0.4]);
        assert_eq!(order(&built), ["\u{1fd}", "\\xB5\\xD8", "\\xB6\\xA5", "\\x83\\"]);
        assert_eq!(built.scene.groups()[1..], order(&built));
    }
}
