//! Valid inputs that mutation starts from. They are small, and contain most of what the readers support.

use serde_json::{Value, json};

/// Kind of file whose reader is tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Target {
    /// Pipeline files.
    Pipeline,
    /// OBJ with a material library.
    Obj,
    /// glTF text with a buffer file.
    Gltf,
    /// Binary glTF.
    Glb,
    /// IES LM-63 with a file of tilt factors.
    Ies,
    /// EULUMDAT.
    Ldt,
}

impl Target {
    /// Returns the name of the file that is read.
    pub(crate) fn file(self) -> &'static str {
        match self {
            Self::Pipeline => "a.ron",
            Self::Obj => "a.obj",
            Self::Gltf => "a.gltf",
            Self::Glb => "a.glb",
            Self::Ies => "a.ies",
            Self::Ldt => "a.ldt",
        }
    }

    /// Returns words with a meaning in files of this kind, and numbers at the limits of numeric types.
    pub(crate) fn words(self) -> Vec<&'static str> {
        let mut words = vec![
            "0",
            "-1",
            "1",
            "255",
            "65536",
            "2147483648",
            "4294967295",
            "4294967296",
            "18446744073709551615",
            "1e9",
            "1e38",
            "1e-45",
            "1e308",
            "1e999",
            "-1e300",
            "nan",
            "inf",
            "\u{feff}",
            "\r\n",
            "\0",
            "\u{1b}[2J",
            "ß",
            "../",
            "/",
            "%2e%2e/",
        ];
        words.extend_from_slice(match self {
            Self::Pipeline => &[
                "(",
                ")",
                "[",
                "]",
                "[[[[",
                "((((",
                "Some(",
                "None",
                "Auto",
                "r#\"",
                "\"",
                "/*",
                "*/",
                "//",
                "Load",
                "Save",
                "Image",
                "Multipath",
                "lines:",
                "path:",
                ",",
                "1_000",
                "0x1F",
                "..",
                "'a'",
                "{",
                "#![enable(implicit_some)]",
            ],
            Self::Obj => &[
                "v ",
                "f ",
                "l ",
                "p ",
                "usemtl ",
                "mtllib ",
                "newmtl ",
                "Kd ",
                "Ke ",
                "map_Kd ",
                "map_Ke ",
                "map_d ",
                "d ",
                "Tr ",
                "vt ",
                "-clamp on ",
                "-o 1e30 ",
                "\\\n",
                "#",
                "-s 1 1 1 ",
                "//",
                "1/1/1",
                "a.mtl",
                "a.obj",
                "t.png",
                "\n",
            ],
            Self::Ies | Self::Ldt => &[
                "TILT=INCLUDE\n",
                "TILT=NONE\n",
                "TILT=a.tlt\n",
                "TILT=../a\n",
                "IESNA91\n",
                "IES:LM-63-2019\n",
                "[MORE] x\n",
                "[LUMINAIRE]",
                "\n",
                " ",
                ",",
                "1D3",
                "-.5",
                "0 90 ",
                "0 45 90 180 ",
                "-90 0 90 ",
                "90 180 270 ",
                "2",
                "3",
                "4",
                "360",
            ],
            Self::Gltf | Self::Glb => &[
                "{",
                "}",
                "[",
                "]",
                ",",
                ":",
                "null",
                "\"",
                "\\u0000",
                "data:",
                ";base64,",
                "KHR_",
                "t.png",
                "MASK",
                "BLEND",
                "alphaCutoff",
                "33071",
                "33648",
                "TEXCOORD_1",
                "COLOR_0",
                "VEC4",
            ],
        });
        words
    }

    /// Returns the unchanged files; the first one is the one that is read.
    pub(crate) fn seed(self) -> Vec<(&'static str, Vec<u8>)> {
        let file = self.file();
        match self {
            Self::Pipeline => vec![(file, PIPELINE.into()), ("room.gltf", Vec::new())],
            Self::Obj => vec![(file, OBJ.into()), ("a.mtl", MTL.into()), ("t.png", PNG.into())],
            Self::Gltf => vec![
                (file, document(Some("data.bin")).to_string().into()),
                ("data.bin", data()),
                ("t.png", PNG.into()),
            ],
            Self::Glb => vec![(file, glb(&document(None), &data())), ("t.png", PNG.into())],
            Self::Ies => vec![(file, IES.into()), ("a.tlt", "1 3 0 45 90 1 .9 .8\n".into())],
            Self::Ldt => vec![(file, ldt().into())],
        }
    }
}

const PIPELINE: &str = r#"// A room.
Pipeline(
    seed: 7,
    stages: [
        Load(path: "room.gltf", sides: Both),
        Subdivide(patches: 20_000),
        FirstShot(lines: 1e6),
        Save([Image(path: "direct.png", width: 800, height: 600, samples: 4, exposure: Auto, camera: "front")]),
        SecondShot(lines: 250_000),
        Multipath(lines: 1_000_000, transport: Replicas(count: 4, tail: 1000), domain: Box),
        Save([
            Image(path: "view.exr", exposure: 1.5, camera: Camera(eye: (4, 1.7, 3), target: (0, 1, 0), up: (0, 1, 0), fov: 45)),
            Gltf(path: "result.glb"),
            Table(path: "patches.csv"),
        ]),
    ],
)
"#;

const OBJ: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0 # c\nv 1 1 0\nv 0 1 0 1 1 1\nv 0 0 1\nvt 0 0\nvn 0 0 1\no thing\nusemtl a\n\
    f 1/1/1 2/1 3//1\ng x\ns 1\nf -4 -3 -2 -1\nl 1 2 3\np 1\nusemtl b\nf 1/1 2/-1 \\\n 5/1\nf 2 3 5\n";
const MTL: &str = "# m\nnewmtl a\nKd 0.5 0.5 0.5\nKe 1 1 1\nNs 10\nmap_Kd -s 1 1 1 t.png\nd 0.5\nnewmtl b\nKd 0.5\nTr 0.1\nmap_d t.png\nmap_Ke t.png\n";

const IES: &str = "IESNA:LM-63-1995\r\n[TEST] 7\r\n[MANUFAC] x\r\n[MORE] y\r\n[LUMINAIRE] z\r\n[_CCT] 3000 K\r\n\
    TILT=a.tlt\r\n2 1000 1.5 4 3 1 2 -.3 0 .1\r\n.9 1 36\r\n0 30 60 90\r\n0,45,90\r\n\
    100 80 50 0\r\n100 85. 55 0\r\n1E2 90 60 0\r\n";

/// Returns a EULUMDAT file with four of six planes and two sets of lamps.
fn ldt() -> String {
    let header =
        "x 3 2 6 60 4 30 report luminaire 1 a.ldt today 600 300 100 500 200 10 10 20 20 100 80 1 0 2";
    let lamps = "1 LED 1000 3000 1B 20 -1 LED 1200,5 4000 1B 25";
    let ratios = ".5 .5 .5 .5 .5 .5 .5 .5 .5 .5";
    let angles = "0 60 120 180 240 300 0 30 60 90";
    let values = "300 200 100 0 300 210 110 0 300 220 120 0 300 230 130 0";
    format!("{header} {lamps} {ratios} {angles} {values}").replace(' ', "\r\n")
}

/// A PNG image of one gray pixel.
const PNG: &[u8] = &[
    0x89, b'P', b'N', b'G', 13, 10, 26, 10, 0, 0, 0, 13, b'I', b'H', b'D', b'R', 0, 0, 0, 1, 0, 0, 0, 1, 8,
    0, 0, 0, 0, 0x3a, 0x7e, 0x9b, 0x55, 0, 0, 0, 10, b'I', b'D', b'A', b'T', 0x78, 0x9c, 0x63, 0x68, 0, 0, 0,
    0x82, 0, 0x81, 0x77, 0xcd, 0x72, 0xb6, 0, 0, 0, 0, b'I', b'E', b'N', b'D', 0xae, 0x42, 0x60, 0x82,
];

/// Returns a glTF document whose buffer is [`data`], in the file `uri` or in the binary chunk.
pub(crate) fn document(uri: Option<&str>) -> Value {
    let mut document = json!({
        "asset": {"version": "2.0", "generator": "x"},
        "scene": 0,
        "scenes": [{"nodes": [0, 3], "name": "s"}],
        "nodes": [
            {"mesh": 0, "children": [1, 2], "translation": [1, 2, 3], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
            {"camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
            {"mesh": 0, "name": "n"},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1, "aspectRatio": 1.5}}],
        "meshes": [{"primitives": [
            {"attributes": {"POSITION": 0, "NORMAL": 0, "COLOR_0": 0, "TEXCOORD_0": 2}, "indices": 1, "mode": 5, "material": 0},
            {"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "material": 1},
        ]}],
        "materials": [
            {"name": "m", "emissiveFactor": [1, 0.5, 0], "emissiveTexture": {"index": 0}, "doubleSided": true,
             "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3}}},
            {"alphaMode": "MASK", "alphaCutoff": 0.5, "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1],
                "baseColorTexture": {"index": 0, "texCoord": 0, "extensions":
                    {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1, "scale": [2, 3], "texCoord": 0}}}}},
        ],
        "textures": [{"source": 0, "sampler": 0}, {"source": 1}],
        "samplers": [{"wrapS": 33071, "wrapT": 33648}],
        "images": [{"bufferView": 4, "mimeType": "image/png"}, {"uri": "t.png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4, "byteOffset": 0,
             "min": [0, 0, 0], "max": [1, 1, 2], "sparse": {"count": 1,
                "indices": {"bufferView": 2, "componentType": 5123, "byteOffset": 0},
                "values": {"bufferView": 3, "byteOffset": 0}}},
            {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 4},
            {"bufferView": 0, "componentType": 5126, "type": "VEC2", "count": 4},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48, "byteStride": 12, "target": 34962},
            {"buffer": 0, "byteOffset": 48, "byteLength": 8},
            {"buffer": 0, "byteOffset": 56, "byteLength": 4},
            {"buffer": 0, "byteOffset": 60, "byteLength": 12},
            {"buffer": 0, "byteOffset": 72, "byteLength": PNG.len()},
        ],
        "buffers": [{"byteLength": data().len()}],
        "extensionsUsed": ["KHR_materials_emissive_strength", "KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 10}]}},
    });
    if let Some(uri) = uri {
        document["buffers"][0]["uri"] = json!(uri);
    }
    document
}

/// Returns the buffer: four positions, four indices, a sparse index and its value, and an image.
pub(crate) fn data() -> Vec<u8> {
    let floats = |list: &[f32]| list.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let positions = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    [positions, vec![0, 0, 1, 0, 2, 0, 3, 0, 1, 0, 0, 0], floats(&[1.0, 0.0, 2.0]), PNG.to_vec()].concat()
}

/// Returns a GLB file of a document and its buffer.
pub(crate) fn glb(document: &Value, data: &[u8]) -> Vec<u8> {
    let mut body = Vec::new();
    for (kind, mut chunk, pad) in
        [(b"JSON", document.to_string().into_bytes(), b' '), (b"BIN\0", data.to_vec(), 0)]
    {
        chunk.resize(chunk.len().next_multiple_of(4), pad);
        body.extend((chunk.len() as u32).to_le_bytes());
        body.extend(kind);
        body.extend(chunk);
    }
    [&b"glTF"[..], &2u32.to_le_bytes(), &(12 + body.len() as u32).to_le_bytes(), &body].concat()
}
