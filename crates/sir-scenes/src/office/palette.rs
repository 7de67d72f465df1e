//! Materials of the office, with the reflectances that lighting designers assume for ceilings, walls, floors and desks.

use sir_geom::{Material, MaterialId, Opacity, Rgb, SceneBuilder};

/// Indices of the materials.
pub(super) struct Palette {
    pub(super) ceiling: MaterialId,
    pub(super) ceiling_bar: MaterialId,
    pub(super) wall: MaterialId,
    pub(super) floor: MaterialId,
    pub(super) desk: MaterialId,
    pub(super) white: MaterialId,
    pub(super) luminaire: MaterialId,
    pub(super) metal: MaterialId,
    pub(super) dark: MaterialId,
    pub(super) screen: MaterialId,
    pub(super) seat: MaterialId,
    pub(super) meeting_seat: MaterialId,
    pub(super) cabinet: MaterialId,
    pub(super) door: MaterialId,
    pub(super) frame: MaterialId,
    pub(super) glass: MaterialId,
    pub(super) paper: MaterialId,
    pub(super) felt: MaterialId,
    pub(super) pot: MaterialId,
    pub(super) leaf: MaterialId,
    pub(super) facade: MaterialId,
    pub(super) facade_glass: MaterialId,
    pub(super) facade_blind: MaterialId,
    pub(super) ground: MaterialId,
    pub(super) rug: MaterialId,
    pub(super) binders: Vec<MaterialId>,
}

/// Share of the light that each of the two faces of a pane stops. Both together let 0.866² = 75 % pass.
const GLASS_OPACITY: f64 = 0.134;

/// Reflectances of the binders.
const BINDERS: [[f64; 3]; 6] = [
    [0.10, 0.20, 0.36],
    [0.16, 0.32, 0.42],
    [0.56, 0.55, 0.52],
    [0.52, 0.22, 0.08],
    [0.20, 0.21, 0.22],
    [0.62, 0.48, 0.16],
];

impl Palette {
    pub(super) fn new(builder: &mut SceneBuilder) -> Self {
        let glass = Material {
            opacity: Opacity { factor: GLASS_OPACITY, ..Opacity::default() },
            ..Material::diffuse("glass", Rgb::splat(0.5))
        };
        let glass = builder.add_material(glass);
        let mut paint =
            |name: &str, r, g, b| builder.add_material(Material::diffuse(name, Rgb::new(r, g, b)));
        Self {
            ceiling: paint("ceiling", 0.81, 0.80, 0.78),
            ceiling_bar: paint("ceiling bar", 0.66, 0.66, 0.65),
            wall: paint("wall", 0.62, 0.60, 0.56),
            floor: paint("floor", 0.29, 0.30, 0.32),
            desk: paint("desk", 0.60, 0.49, 0.34),
            white: paint("white", 0.75, 0.75, 0.73),
            luminaire: paint("luminaire", 0.80, 0.80, 0.79),
            metal: paint("metal", 0.52, 0.52, 0.53),
            dark: paint("dark plastic", 0.07, 0.07, 0.075),
            screen: paint("screen", 0.035, 0.037, 0.042),
            seat: paint("seat", 0.09, 0.20, 0.27),
            meeting_seat: paint("meeting seat", 0.56, 0.27, 0.09),
            cabinet: paint("cabinet", 0.66, 0.65, 0.62),
            door: paint("door", 0.42, 0.28, 0.16),
            frame: paint("window frame", 0.30, 0.31, 0.32),
            glass,
            paper: paint("paper", 0.80, 0.79, 0.76),
            felt: paint("felt", 0.22, 0.33, 0.31),
            pot: paint("pot", 0.55, 0.53, 0.50),
            leaf: paint("leaf", 0.10, 0.26, 0.07),
            facade: paint("facade", 0.26, 0.21, 0.17),
            facade_glass: paint("facade glass", 0.09, 0.10, 0.11),
            facade_blind: paint("facade blind", 0.32, 0.31, 0.30),
            rug: paint("rug", 0.42, 0.40, 0.36),
            ground: paint("ground", 0.20, 0.20, 0.19),
            binders: BINDERS
                .iter()
                .enumerate()
                .map(|(i, [r, g, b])| paint(&format!("binder {i}"), *r, *g, *b))
                .collect(),
        }
    }
}
