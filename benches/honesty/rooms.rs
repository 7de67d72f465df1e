//! Rooms in which errors are hard to tell: light through small openings, lamps that are shut in, bright walls.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use glam::DVec3;

/// A room with sensors.
pub(crate) struct Room {
    pub(crate) name: &'static str,
    scene: Scene,
    /// Stages between `Load` and `Solve`.
    stages: String,
    pub(crate) lines: u64,
    pub(crate) sensors: Vec<Sensor>,
    /// Exact radiosity of all patches, if it is known.
    pub(crate) exact: Option<f64>,
    /// Corners of the box whose patches count.
    bounds: [DVec3; 2],
}

/// A sensor.
pub(crate) struct Sensor {
    pub(crate) name: &'static str,
    position: [f64; 3],
    direction: [f64; 3],
    /// Exact irradiance, if it is known.
    pub(crate) exact: Option<f64>,
}

/// Where the surfaces come from.
enum Scene {
    File(PathBuf),
    Surfaces(Surfaces),
}

impl Room {
    /// True if all answers are known.
    pub(crate) fn is_exact(&self) -> bool {
        self.exact.is_some() && self.sensors.iter().all(|sensor| sensor.exact.is_some())
    }

    /// True if the patches around a point count.
    pub(crate) fn contains(&self, center: DVec3) -> bool {
        let [min, max] = self.bounds;
        center.cmpge(min).all() && center.cmple(max).all()
    }

    /// Returns the text of a pipeline. Writes the scene to the folder.
    pub(crate) fn pipeline(&self, lines: u64, rays: u64, seed: u64, folder: &Path) -> String {
        let path = match &self.scene {
            Scene::File(path) => path.clone(),
            Scene::Surfaces(surfaces) => surfaces.write(folder),
        };
        let mut text = format!(
            "(seed: {seed}, stages: [Load(path: {path:?}, sides: Front), {}, Solve(lines: {lines}), \
             Save([Table(path: \"patches.npy\")]),",
            self.stages
        );
        for Sensor { name, position: [x, y, z], direction: [a, b, c], .. } in &self.sensors {
            write!(
                text,
                "Sensors(name: {name:?}, rays: {rays}, at: Points([(position: ({x}, {y}, {z}), direction: ({a}, {b}, {c}))])),"
            )
            .unwrap();
        }
        text + "])"
    }
}

/// Quadrilaterals with their materials, as an OBJ file with its MTL file.
#[derive(Default)]
struct Surfaces {
    materials: String,
    shapes: String,
}

/// Center of a face of a box, and two vectors from there to its edges whose cross product points inward.
type Face = [DVec3; 3];

impl Surfaces {
    /// Adds a material, of which the next surfaces are. `radiance` is that of its light.
    fn material(&mut self, name: &str, reflectance: f64, radiance: f64) -> &mut Self {
        let (rho, light) = (reflectance, radiance);
        write!(self.materials, "newmtl {name}\nKd {rho} {rho} {rho}\nKe {light} {light} {light}\n").unwrap();
        self.of(name)
    }

    /// Makes the next surfaces of a known material.
    fn of(&mut self, name: &str) -> &mut Self {
        writeln!(self.shapes, "usemtl {name}").unwrap();
        self
    }

    /// Adds a quadrilateral, whose corners are counterclockwise if seen from the front.
    fn quad(&mut self, corners: [DVec3; 4]) -> &mut Self {
        for DVec3 { x, y, z } in corners {
            writeln!(self.shapes, "v {x} {y} {z}").unwrap();
        }
        writeln!(self.shapes, "f -4 -3 -2 -1").unwrap();
        self
    }

    fn face(&mut self, [center, u, v]: Face) -> &mut Self {
        self.quad([center - u - v, center + u - v, center + u + v, center - u + v])
    }

    /// Adds a face with a square hole of this width around its center.
    fn face_with_hole(&mut self, [center, u, v]: Face, width: f64) -> &mut Self {
        let (a, b) = (width / 2.0 * u.normalize(), width / 2.0 * v.normalize());
        let [beside, above] = [(u - a) / 2.0, (v - b) / 2.0];
        self.face([center - a - beside, beside, v]).face([center + a + beside, beside, v]);
        self.face([center - b - above, a, above]).face([center + b + above, a, above])
    }

    fn write(&self, folder: &Path) -> PathBuf {
        let path = folder.join("room.obj");
        std::fs::write(folder.join("room.mtl"), &self.materials).unwrap();
        std::fs::write(&path, format!("mtllib room.mtl\n{}", self.shapes)).unwrap();
        path
    }
}

/// Returns the faces of a box, which face inward: `−x`, `+x`, `−y`, `+y`, `−z`, `+z`.
fn box_faces(min: DVec3, max: DVec3) -> [Face; 6] {
    let (center, half) = ((min + max) / 2.0, (max - min) / 2.0);
    let [x, y, z] = [half.x * DVec3::X, half.y * DVec3::Y, half.z * DVec3::Z];
    [
        [center - x, y, z],
        [center + x, z, y],
        [center - y, z, x],
        [center + y, x, z],
        [center - z, x, y],
        [center + z, y, x],
    ]
}

const EVERYWHERE: [DVec3; 2] = [DVec3::NEG_INFINITY, DVec3::INFINITY];

fn sensor(name: &'static str, position: [f64; 3], direction: [f64; 3], exact: Option<f64>) -> Sensor {
    Sensor { name, position, direction, exact }
}

/// Returns all rooms.
pub(crate) fn rooms() -> Vec<Room> {
    let up = [0.0, 1.0, 0.0];
    let mut rooms = Vec::new();
    let focus = "Focus(min: (0, 0, 0), max: (5, 2.8, 6)),";
    for (name, focus, lines) in [("sunlit", "", 4_000_000), ("sunlit, Focus", focus, 1_000_000)] {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/sir-pipeline/tests/data");
        rooms.push(Room {
            name,
            scene: Scene::File(data.join("sunlit-room/r.obj")),
            stages: format!(
                "Light([Distant(direction: (0, -0.5, 0.866025404), irradiance: 800)]), {focus} Subdivide(patches: 400, of: Triangles)"
            ),
            lines,
            sensors: vec![
                sensor("near", [1.0, 0.75, 4.5], up, None),
                sensor("far", [4.0, 0.75, 5.0], up, None),
            ],
            exact: None,
            bounds: [DVec3::new(-5.0, -5.0, 0.0), DVec3::new(5.0, 5.0, 6.0)],
        });
    }
    for (name, reflectance) in [("furnace .9", 0.9), ("furnace .95", 0.95)] {
        let mut cube = Surfaces::default();
        cube.material("wall", reflectance, 1.0 / std::f64::consts::PI);
        box_faces(DVec3::ZERO, DVec3::ONE).into_iter().for_each(|face| _ = cube.face(face));
        let all = 1.0 / (1.0 - reflectance);
        rooms.push(Room {
            name,
            scene: Scene::Surfaces(cube),
            stages: "Subdivide(patches: 600, of: Triangles)".into(),
            lines: 100_000,
            sensors: vec![sensor("middle", [0.5, 0.0, 0.5], up, Some(all))],
            exact: Some(all),
            bounds: EVERYWHERE,
        });
    }
    rooms.push(lit_cube());
    rooms.push(behind_a_hole());
    rooms.push(behind_a_door());
    rooms.push(trapped_lamp());
    rooms.push(Room {
        name: "reading room",
        scene: Scene::File(
            Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/reading-room/reading-room.glb"),
        ),
        stages: "Subdivide(patches: 63_552, of: Triangles)".into(),
        lines: 8_000_000,
        sensors: Vec::new(),
        exact: None,
        bounds: EVERYWHERE,
    });
    rooms
}

/// CIE 171:2006, 5.8: an isotropic lamp in the center of a cube with white faces.
fn lit_cube() -> Room {
    let mut cube = Surfaces::default();
    cube.material("wall", 0.95, 0.0);
    box_faces(DVec3::ZERO, DVec3::splat(4.0)).into_iter().for_each(|face| _ = cube.face(face));
    let up = [0.0, 1.0, 0.0];
    Room {
        name: "CIE 5.8, .95",
        scene: Scene::Surfaces(cube),
        stages: "Light([Point(position: (2, 2, 2), power: 10000)]), Subdivide(patches: 600, of: Triangles)"
            .into(),
        lines: 100_000,
        sensors: vec![
            sensor("middle", [2.0, 0.0, 2.0], up, None),
            sensor("corner", [0.05, 0.0, 0.05], up, None),
        ],
        exact: None,
        bounds: EVERYWHERE,
    }
}

/// A lit room, and a dark one behind a wall with a hole of 5 × 5 cm.
fn behind_a_hole() -> Room {
    let mut rooms = two_rooms(0.05);
    rooms
        .material("lamp", 0.0, 100.0)
        .face(box_faces(DVec3::new(1.0, 0.0, 1.0), DVec3::new(2.0, 2.9, 2.0))[3]);
    Room {
        name: "hole",
        scene: Scene::Surfaces(rooms),
        stages: "Subdivide(patches: 600, of: Triangles)".into(),
        lines: 8_000_000,
        sensors: vec![
            sensor("bright", [2.0, 0.8, 2.0], [0.0, 1.0, 0.0], None),
            sensor("dark", [5.5, 0.8, 2.0], [0.0, 1.0, 0.0], None),
            sensor("opposite", [6.9, 1.4, 1.9], [-1.0, 0.0, 0.0], None),
        ],
        exact: None,
        bounds: EVERYWHERE,
    }
}

/// The same rooms with an opening of 80 × 80 cm.
fn behind_a_door() -> Room {
    let mut rooms = two_rooms(0.8);
    rooms
        .material("lamp", 0.0, 100.0)
        .face(box_faces(DVec3::new(1.0, 0.0, 1.0), DVec3::new(2.0, 2.9, 2.0))[3]);
    Room { name: "door", scene: Scene::Surfaces(rooms), lines: 200_000, ..behind_a_hole() }
}

/// Two gray rooms, with a square opening of this width between them.
fn two_rooms(opening: f64) -> Surfaces {
    let mut rooms = Surfaces::default();
    rooms.material("gray", 0.6, 0.0);
    let first = box_faces(DVec3::ZERO, DVec3::new(4.0, 3.0, 4.0));
    let second = box_faces(DVec3::new(4.0, 0.0, 0.0), DVec3::new(7.0, 3.0, 4.0));
    for (faces, between) in [(first, 1), (second, 0)] {
        for (i, face) in faces.into_iter().enumerate() {
            _ = if i == between { rooms.face_with_hole(face, opening) } else { rooms.face(face) };
        }
    }
    rooms
}

/// A lamp in a white box with a hole of 10 × 10 cm below, in the first of two rooms.
fn trapped_lamp() -> Room {
    let mut rooms = two_rooms(0.8);
    // The inside of the box is white, and its outside gray.
    let outside = box_faces(DVec3::new(1.79, 2.19, 1.79), DVec3::new(2.21, 2.61, 2.21));
    let inside = box_faces(DVec3::new(1.8, 2.2, 1.8), DVec3::new(2.2, 2.6, 2.2));
    for (i, [center, u, v]) in outside.into_iter().enumerate() {
        let face = [center, v, u];
        _ = if i == 2 { rooms.face_with_hole(face, 0.1) } else { rooms.face(face) };
    }
    rooms.material("white", 0.95, 0.0);
    for (i, face) in inside.into_iter().enumerate() {
        _ = if i == 2 { rooms.face_with_hole(face, 0.1) } else { rooms.face(face) };
    }
    rooms.material("lamp", 0.0, 3183.1);
    rooms.face(box_faces(DVec3::new(1.95, 2.3, 1.95), DVec3::new(2.05, 2.59, 2.05))[3]);
    Room {
        name: "trapped lamp",
        scene: Scene::Surfaces(rooms),
        stages: "Subdivide(patches: 1000, of: Triangles)".into(),
        lines: 1_000_000,
        sensors: vec![
            sensor("bright", [0.5, 0.8, 2.0], [0.0, 1.0, 0.0], None),
            sensor("dark", [5.5, 0.8, 1.0], [0.0, 1.0, 0.0], None),
        ],
        exact: None,
        bounds: EVERYWHERE,
    }
}
