//! OBJ and MTL files that claim more data than they have, or refer to files outside their folder.

use crate::bounded::{alone, load_hostile, refused};
use crate::files::warnings;

const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// Returns a triangle of the material `a`.
fn triangle(statements: &str) -> String {
    format!("{statements}\n{VERTICES}usemtl a\nf 1 2 3\n")
}

#[test]
fn indices_beyond_the_vertices_are_refused() {
    let _alone = alone();
    for index in ["4", "0", "-4", "1000000000", "-1000000000", "9223372036854775807", "99999999999999999999"]
    {
        refused(&[("a.obj", format!("{VERTICES}f 1 2 {index}\n").as_bytes())], &["a.obj:4:", index]);
    }
    for index in ["1e9", "x", "1.5", "/1", &"9".repeat(10_000)] {
        refused(&[("a.obj", format!("{VERTICES}f 1 2 {index}\n").as_bytes())], &["a.obj:4:"]);
    }
    // Some exporters write faces first.
    assert!(load_hostile(&[("a.obj", format!("f 1 2 3\n{VERTICES}").as_bytes())]).is_ok());
    refused(&[("a.obj", format!("f 1 2 3\n{VERTICES}f 9 1 2").as_bytes())], &["a.obj:5:", "3 vertices"]);
    refused(&[("a.obj", format!("f -1 2 3\n{VERTICES}").as_bytes())], &["a.obj:1:", "0 vertices before"]);
}

#[test]
fn coordinates_that_are_no_numbers() {
    let _alone = alone();
    for bad in ["nan", "inf", "-inf", "1e999", "1.#IND"] {
        let text = format!("{VERTICES}v {bad} 1 1\nf 1 2 3\nf 1 2 4\n");
        let built = load_hostile(&[("a.obj", text.as_bytes())]).unwrap();
        assert_eq!(built.scene.triangles().len(), 1);
        refused(
            &[("a.obj", format!("{VERTICES}v {bad} 1 1\nf 1 2 4\n").as_bytes())],
            &["finite coordinates"],
        );
    }
    for bad in ["v 0 0", "v", "v a b c", &format!("v {} 1 x\u{1b}[2J", "x".repeat(100_000))] {
        refused(&[("a.obj", format!("{bad}\n").as_bytes())], &["a.obj:1:"]);
    }
}

#[test]
fn long_lines_take_memory_in_proportion() {
    let _alone = alone();
    let long = "x".repeat(50_000_000);
    let texts = [format!("# {long}\n{}", triangle("")), triangle(&format!("o {long}"))];
    for text in texts {
        assert_eq!(load_hostile(&[("a.obj", text.as_bytes())]).unwrap().scene.triangles().len(), 1);
    }
    // A face of five million corners.
    let text = format!("{VERTICES}f{}\n", " 1 2 3".repeat(1_700_000));
    assert!(load_hostile(&[("a.obj", text.as_bytes())]).is_ok());
    refused(&[("a.obj", "v 0 0 0 ".repeat(2_000_000).as_bytes())], &["no triangles"]);
}

#[test]
fn many_short_meshes_take_memory_in_proportion() {
    let _alone = alone();
    let text = format!("{VERTICES}{}", "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n".repeat(50_000));
    assert_eq!(load_hostile(&[("a.obj", text.as_bytes())]).unwrap().scene.triangles().len(), 100_000);
}

#[test]
fn libraries_and_textures_outside_the_folder_are_not_read() {
    let _alone = alone();
    let secret = b"newmtl a\nKd 0.25 0.25 0.25\n";
    for name in ["../secret.mtl", "/etc/passwd", "C:\\secret.mtl", "a/../../secret.mtl", "..\\secret.mtl"] {
        let text = triangle(&format!("mtllib {name}"));
        let built = load_hostile(&[("a.obj", text.as_bytes()), ("../secret.mtl", secret)]).unwrap();
        assert_eq!(built.scene.materials()[0].reflectance.x, 0.5, "{name}");
        assert!(warnings(&built)[0].contains("not in the folder of the scene"), "{:?}", built.warnings);
        let library = format!("newmtl a\nmap_Kd {name}\n");
        let text = triangle("mtllib a.mtl");
        let files: [(&str, &[u8]); 3] =
            [("a.obj", text.as_bytes()), ("a.mtl", library.as_bytes()), ("../secret.mtl", secret)];
        let built = load_hostile(&files).unwrap();
        assert!(warnings(&built)[0].contains("not in the folder of the scene"), "{:?}", built.warnings);
    }
    // These formats have no percent encoding, so this names a file in the folder, which does not exist.
    let text = triangle("mtllib %2e%2e/secret.mtl");
    let built = load_hostile(&[("a.obj", text.as_bytes()), ("../secret.mtl", secret)]).unwrap();
    assert!(warnings(&built)[0].contains("cannot be read"), "{:?}", built.warnings);
}

#[test]
fn a_library_is_read_once_however_it_is_named() {
    let _alone = alone();
    let names: String = (0..20_000).map(|i| format!("mtllib {}a.mtl a.mtl\n", "./".repeat(i % 9))).collect();
    let library = format!("{}newmtl a\nKd 0.25 0.25 0.25\n", "newmtl b\nKd 1 1 1\n".repeat(10_000));
    let built =
        load_hostile(&[("a.obj", triangle(&names).as_bytes()), ("a.mtl", library.as_bytes())]).unwrap();
    assert_eq!(built.scene.materials()[0].reflectance.x, 0.25);
}

#[test]
fn a_library_that_names_libraries_leads_nowhere() {
    let _alone = alone();
    let library = "mtllib a.mtl\nmtllib a.obj\nnewmtl a\nKd 0.25 0.25 0.25\n";
    let text = triangle("mtllib a.obj a.mtl");
    let built = load_hostile(&[("a.obj", text.as_bytes()), ("a.mtl", library.as_bytes())]).unwrap();
    assert_eq!(built.scene.materials()[0].reflectance.x, 0.25);
}

#[test]
fn a_texture_that_is_no_image_is_a_warning() {
    let _alone = alone();
    let library = b"newmtl a\nKd 0.25 0.25 0.25\nmap_Kd a.obj\n";
    let text = triangle("mtllib a.mtl");
    let built = load_hostile(&[("a.obj", text.as_bytes()), ("a.mtl", library)]).unwrap();
    assert!(warnings(&built)[0].contains("textures cannot be read"), "{:?}", built.warnings);
}

#[test]
fn broken_libraries_name_their_line() {
    let _alone = alone();
    for (line, word) in [
        ("Kd 1 2", "three numbers"),
        ("Kd x y z", "Kd"),
        ("Ke 1 nan x", "Ke"),
        ("Kd inf -1 0", "finite"),
        ("Kd -1e297 0 0", "not negative"),
    ] {
        let library = format!("newmtl a\n{line}\n");
        let text = triangle("mtllib a.mtl");
        refused(&[("a.obj", text.as_bytes()), ("a.mtl", library.as_bytes())], &["a.mtl:2:", word]);
    }
}

#[test]
fn huge_numbers_are_written_short() {
    let _alone = alone();
    let obj = triangle("mtllib a.mtl");
    let mtl = |color: &str| format!("newmtl a\nKd {color}\n");
    let built = load_hostile(&[("a.obj", obj.as_bytes()), ("a.mtl", mtl("1e297 0 0").as_bytes())]).unwrap();
    assert!(warnings(&built).concat().contains("reflects 1.0e297 of"), "{:?}", built.warnings);
}

#[test]
fn encodings() {
    let _alone = alone();
    let text = triangle("g x");
    let marked = format!("\u{feff}{}", text.replace('\n', "\r\n"));
    for bytes in
        [marked.as_bytes(), &[text.as_bytes(), b"# \xff\xfe\n"].concat(), &[text.as_bytes(), b"\0"].concat()]
    {
        assert_eq!(load_hostile(&[("a.obj", bytes)]).unwrap().scene.triangles().len(), 1);
    }
    for order in [u16::to_le_bytes, u16::to_be_bytes] {
        let bytes: Vec<u8> = marked.encode_utf16().flat_map(order).collect();
        assert_eq!(load_hostile(&[("a.obj", &bytes)]).unwrap().scene.triangles().len(), 1);
    }
    refused(&[("a.obj", b"")], &["it has no triangles"]);
    refused(&[("a.obj", b"\xff\xfev\0 \x000\0")], &["a.obj:1: \"v 0\" must have three numbers"]);
}
