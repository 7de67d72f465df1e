//! The server of a page that follows a run.

#![allow(clippy::unwrap_used, reason = "a step that fails is a test that fails")]

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use sir_geom::shapes::{Facing, cuboid};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_mesh::{PatchMesh, Subdivision};
use sir_report::{Light, LiveServer, View};
use sir_view::DisplayMesh;

/// Sends a request, and returns the status and the whole answer.
fn ask(server: &LiveServer, method: &str, path: &str, host: Option<&str>) -> (u16, String) {
    let url = server.url();
    let (address, token) = url.strip_prefix("http://").unwrap().split_once('/').unwrap();
    let path = path.replace("TOKEN", token.trim_end_matches('/'));
    let mut stream = TcpStream::connect(address).unwrap();
    let host = host.unwrap_or(address);
    write!(
        stream,
        "{method} {path} HTTP/1.1\r\nHost: {host}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"
    )
    .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    (answer.split(' ').nth(1).unwrap().parse().unwrap(), answer)
}

fn view() -> View {
    let mut builder = SceneBuilder::new();
    let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
    cuboid(&mut builder, glam::DVec3::ZERO, glam::DVec3::ONE, [gray; 6], Facing::Inward);
    let scene = builder.build().unwrap().scene;
    let mesh = PatchMesh::new(&scene, Subdivision::PerFace).unwrap();
    let values = vec![Rgb::ONE; mesh.side_count()];
    View::new(
        &DisplayMesh::new(&scene, &mesh, &values),
        Light { irradiance: &values, error: &values, direct: None },
    )
}

fn version(server: &LiveServer) -> Value {
    let (status, answer) = ask(server, "GET", "/TOKEN/version", None);
    assert_eq!(status, 200);
    serde_json::from_str(answer.split_once("\r\n\r\n").unwrap().1).unwrap()
}

#[test]
fn a_page_follows_a_run() {
    let server = LiveServer::start().unwrap();
    assert!(ask(&server, "GET", "/TOKEN/", None).1.contains("after the first repeat"));
    assert_eq!(version(&server)["version"], 0);
    assert_eq!(ask(&server, "GET", "/TOKEN/mesh", None).0, 404);
    server.show("room <1>", view(), json!({ "title": "room" }), "Repeat 2 of 16");
    let (status, page) = ask(&server, "GET", "/TOKEN/", None);
    assert_eq!(status, 200);
    assert!(page.contains("<title>room &lt;1&gt;</title>") && page.contains("connect-src 'self'"));
    assert!(page.contains("\"live\":{\"version\":1}"));
    let now = version(&server);
    assert_eq!(
        (&now["version"], &now["status"], &now["final"]),
        (&json!(1), &json!("Repeat 2 of 16"), &json!(false))
    );
    assert!(ask(&server, "GET", "/TOKEN/mesh", None).1.len() > 100);
    assert!(!server.wants_end());
    assert_eq!(ask(&server, "POST", "/TOKEN/end", None).0, 200);
    assert!(server.wants_end());
    server.end("room", None, json!({}));
    assert_eq!(version(&server)["final"], true);
    let since = Instant::now();
    server.wait_for_reader(Duration::from_millis(200));
    assert!(since.elapsed() >= Duration::from_millis(200), "the reader has version 1 only");
    assert!(!ask(&server, "GET", "/TOKEN/", None).1.contains("\"live\":"), "nothing more to follow");
    server.wait_for_reader(Duration::from_secs(60));
}

#[test]
fn others_do_not_reach_it() {
    let server = LiveServer::start().unwrap();
    server.show("room", view(), json!({}), "");
    for path in [
        "/",
        "/TOKEN",
        "/TOKENx/",
        "/0123456789abcdef0123456789abcdef/",
        "/TOKEN/../",
        "/TOKEN/x",
        "/favicon.ico",
    ] {
        assert_eq!(ask(&server, "GET", path, None).0, 404, "{path}");
    }
    for host in ["evil.example", "localhost", "127.0.0.1"] {
        assert_eq!(ask(&server, "GET", "/TOKEN/", Some(host)).0, 404, "{host}");
    }
    assert_eq!(ask(&server, "GET", "/TOKEN/end", None).0, 404);
    assert!(!server.wants_end());
    assert!(server.url().starts_with("http://127.0.0.1:"));
    assert_ne!(server.url(), LiveServer::start().unwrap().url());
}
