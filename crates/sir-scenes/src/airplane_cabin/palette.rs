//! Materials of the cabin.

use sir_geom::{Material, MaterialId, Rgb, SceneBuilder};

use crate::model::furnish::lamp;

/// Indices of the materials.
pub(super) struct Palette {
    /// Side walls and ceiling.
    pub(super) panel: MaterialId,
    /// Foot of the side walls.
    pub(super) dado: MaterialId,
    pub(super) reveal: MaterialId,
    pub(super) blind: MaterialId,
    pub(super) bin: MaterialId,
    /// Lower front of the bins.
    pub(super) bin_foot: MaterialId,
    pub(super) trim: MaterialId,
    pub(super) carpet: MaterialId,
    pub(super) runner: MaterialId,
    pub(super) runner_edge: MaterialId,
    pub(super) runner_figure: MaterialId,
    pub(super) runner_dot: MaterialId,
    pub(super) fabric: MaterialId,
    pub(super) accent: MaterialId,
    pub(super) shoulder: MaterialId,
    pub(super) accent_shoulder: MaterialId,
    pub(super) backrest: MaterialId,
    pub(super) tray: MaterialId,
    pub(super) pocket: MaterialId,
    pub(super) armrest: MaterialId,
    pub(super) metal: MaterialId,
    pub(super) dark: MaterialId,
    pub(super) bulkhead: MaterialId,
    pub(super) curtain: MaterialId,
    pub(super) steel: MaterialId,
    pub(super) wood: MaterialId,
    pub(super) magazines: Vec<MaterialId>,
    /// Light of the sky.
    pub(super) sky: MaterialId,
    /// Violet-blue light on the bins.
    pub(super) cove_lamp: MaterialId,
    /// Amber light above the middle of the ceiling.
    pub(super) spine_lamp: MaterialId,
    /// Light of the strip under the middle of the ceiling.
    pub(super) spine_strip: MaterialId,
    /// Warm light along the side walls.
    pub(super) wall_lamp: MaterialId,
    /// Light of the galleys.
    pub(super) galley_lamp: MaterialId,
    /// Light of the reading lamps.
    pub(super) reading_lamp: MaterialId,
    /// Light of the marks along the aisle.
    pub(super) floor_lamp: MaterialId,
    /// Green light of the exit signs.
    pub(super) exit_sign: MaterialId,
    /// Light of the signs at the seats.
    pub(super) seat_sign: MaterialId,
    /// Light of the screens: sea, land and route.
    pub(super) screens: [MaterialId; 3],
}

/// Reflectances of the magazine covers.
const MAGAZINES: [[f64; 3]; 5] =
    [[0.70, 0.66, 0.58], [0.55, 0.08, 0.06], [0.06, 0.30, 0.32], [0.75, 0.52, 0.08], [0.12, 0.16, 0.40]];

impl Palette {
    pub(super) fn new(builder: &mut SceneBuilder) -> Self {
        let mut paint =
            |name: &str, r, g, b| builder.add_material(Material::diffuse(name, Rgb::new(r, g, b)));
        let panel = paint("panel", 0.76, 0.755, 0.74);
        let magazines = MAGAZINES
            .iter()
            .enumerate()
            .map(|(i, [r, g, b])| paint(&format!("magazine {i}"), *r, *g, *b))
            .collect();
        let mut palette = Self {
            panel,
            dado: paint("dado", 0.30, 0.33, 0.40),
            reveal: paint("window reveal", 0.80, 0.80, 0.79),
            blind: paint("blind", 0.66, 0.64, 0.60),
            bin: paint("bin", 0.80, 0.795, 0.78),
            bin_foot: paint("bin foot", 0.50, 0.51, 0.54),
            trim: paint("trim", 0.42, 0.43, 0.46),
            carpet: paint("carpet", 0.09, 0.12, 0.28),
            runner: paint("runner", 0.06, 0.10, 0.33),
            runner_edge: paint("runner edge", 0.04, 0.05, 0.13),
            runner_figure: paint("runner figure", 0.62, 0.23, 0.04),
            runner_dot: paint("runner dot", 0.12, 0.34, 0.52),
            fabric: paint("seat fabric", 0.05, 0.14, 0.55),
            accent: paint("seat accent", 0.80, 0.27, 0.03),
            shoulder: paint("shoulder", 0.05, 0.23, 0.52),
            accent_shoulder: paint("accent shoulder", 0.84, 0.37, 0.05),
            backrest: paint("backrest", 0.08, 0.16, 0.46),
            tray: paint("tray", 0.62, 0.62, 0.63),
            pocket: paint("pocket", 0.05, 0.07, 0.20),
            armrest: paint("arm rest", 0.20, 0.21, 0.25),
            metal: paint("metal", 0.45, 0.46, 0.48),
            dark: paint("dark plastic", 0.06, 0.06, 0.07),
            bulkhead: paint("bulkhead", 0.62, 0.56, 0.50),
            curtain: paint("curtain", 0.60, 0.16, 0.05),
            steel: paint("steel", 0.60, 0.61, 0.62),
            wood: paint("wood", 0.40, 0.22, 0.10),
            magazines,
            sky: panel,
            cove_lamp: panel,
            spine_lamp: panel,
            spine_strip: panel,
            wall_lamp: panel,
            galley_lamp: panel,
            reading_lamp: panel,
            floor_lamp: panel,
            exit_sign: panel,
            seat_sign: panel,
            screens: [panel; 3],
        };
        let mut light = |name: &str, radiance: f64, r, g, b| {
            builder.add_material(lamp(name, radiance * Rgb::new(r, g, b)))
        };
        palette.sky = light("sky", 1.9, 0.54, 0.82, 1.18);
        palette.cove_lamp = light("cove lamp", 8.0, 0.47, 0.40, 1.55);
        palette.spine_lamp = light("spine lamp", 11.0, 1.5, 0.70, 0.20);
        palette.spine_strip = light("spine strip", 0.62, 1.25, 0.90, 0.58);
        palette.wall_lamp = light("wall lamp", 7.5, 1.4, 0.78, 0.32);
        palette.galley_lamp = light("galley lamp", 6.0, 1.25, 0.88, 0.55);
        palette.reading_lamp = light("reading lamp", 120.0, 1.25, 0.95, 0.60);
        palette.floor_lamp = light("floor lamp", 1.1, 1.3, 0.8, 0.25);
        palette.exit_sign = light("exit sign", 0.9, 0.15, 1.0, 0.45);
        palette.seat_sign = light("seat sign", 0.9, 1.3, 0.75, 0.2);
        palette.screens = [
            light("screen sea", 0.55, 0.10, 0.42, 1.0),
            light("screen land", 0.55, 0.30, 0.75, 0.35),
            light("screen route", 0.8, 1.3, 0.75, 0.2),
        ];
        palette
    }
}
