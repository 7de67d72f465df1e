//! Materials of the hall.

use sir_geom::{Material, MaterialId, Rgb, SceneBuilder};

use crate::model::furnish::lamp;

/// Indices of the materials.
pub(super) struct Palette {
    /// Limestone of the building.
    pub(super) stone: MaterialId,
    /// Paler limestone of moldings and balusters.
    pub(super) pale: MaterialId,
    /// Red marble.
    pub(super) rosso: MaterialId,
    /// Green marble.
    pub(super) verde: MaterialId,
    pub(super) cream_tile: MaterialId,
    pub(super) ochre_tile: MaterialId,
    pub(super) dark_tile: MaterialId,
    pub(super) terracotta: MaterialId,
    pub(super) green_wall: MaterialId,
    pub(super) frieze: MaterialId,
    pub(super) plaster: MaterialId,
    pub(super) niche: MaterialId,
    pub(super) coffer: MaterialId,
    pub(super) carpet: MaterialId,
    pub(super) carpet_border: MaterialId,
    pub(super) gold: MaterialId,
    pub(super) bronze: MaterialId,
    pub(super) verdigris: MaterialId,
    pub(super) iron: MaterialId,
    pub(super) marble: MaterialId,
    pub(super) wood: MaterialId,
    pub(super) dark_wood: MaterialId,
    pub(super) leather: MaterialId,
    pub(super) clay: MaterialId,
    pub(super) glaze: MaterialId,
    pub(super) celadon: MaterialId,
    /// Colors of the paintings, as in [`PAINTS`].
    pub(super) paints: [MaterialId; 10],
    /// Light of the sky.
    pub(super) sky: MaterialId,
    /// Light of the strips hidden on the cornice.
    pub(super) cove_lamp: MaterialId,
    /// Light of the strips hidden in the great niche.
    pub(super) niche_lamp: MaterialId,
    /// Light of the sconces.
    pub(super) bulb: MaterialId,
    /// Light of the globes on the stair.
    pub(super) globe: MaterialId,
    /// Light in the vitrines.
    pub(super) spot: MaterialId,
}

/// Colors of the paintings: sky to earth, then accents.
const PAINTS: [[f64; 3]; 10] = [
    [0.36, 0.47, 0.58],
    [0.62, 0.58, 0.46],
    [0.70, 0.45, 0.20],
    [0.16, 0.25, 0.30],
    [0.16, 0.24, 0.09],
    [0.30, 0.26, 0.08],
    [0.20, 0.11, 0.05],
    [0.07, 0.05, 0.04],
    [0.52, 0.07, 0.04],
    [0.72, 0.64, 0.50],
];

impl Palette {
    pub(super) fn new(builder: &mut SceneBuilder) -> Self {
        let mut paint =
            |name: &str, r, g, b| builder.add_material(Material::diffuse(name, Rgb::new(r, g, b)));
        let mut palette = Self {
            stone: paint("limestone", 0.66, 0.55, 0.39),
            pale: paint("pale limestone", 0.73, 0.67, 0.56),
            rosso: paint("red marble", 0.40, 0.14, 0.10),
            verde: paint("green marble", 0.10, 0.20, 0.15),
            cream_tile: paint("cream tile", 0.68, 0.61, 0.48),
            ochre_tile: paint("ochre tile", 0.52, 0.34, 0.17),
            dark_tile: paint("dark tile", 0.10, 0.10, 0.10),
            terracotta: paint("terracotta", 0.56, 0.21, 0.11),
            green_wall: paint("green wall", 0.13, 0.29, 0.20),
            frieze: paint("frieze", 0.66, 0.48, 0.25),
            plaster: paint("plaster", 0.79, 0.75, 0.67),
            niche: paint("niche", 0.13, 0.29, 0.36),
            coffer: paint("coffer", 0.11, 0.20, 0.36),
            carpet: paint("carpet", 0.55, 0.035, 0.035),
            carpet_border: paint("carpet border", 0.66, 0.44, 0.14),
            gold: paint("gold", 0.72, 0.50, 0.18),
            bronze: paint("bronze", 0.26, 0.17, 0.085),
            verdigris: paint("verdigris", 0.15, 0.36, 0.31),
            iron: paint("iron", 0.12, 0.12, 0.12),
            marble: paint("white marble", 0.82, 0.80, 0.76),
            wood: paint("oak", 0.38, 0.21, 0.10),
            dark_wood: paint("walnut", 0.20, 0.10, 0.05),
            leather: paint("leather", 0.34, 0.07, 0.045),
            clay: paint("clay", 0.56, 0.25, 0.11),
            glaze: paint("black glaze", 0.06, 0.05, 0.05),
            celadon: paint("celadon", 0.36, 0.52, 0.42),
            paints: [MaterialId(0); 10],
            sky: MaterialId(0),
            cove_lamp: MaterialId(0),
            niche_lamp: MaterialId(0),
            bulb: MaterialId(0),
            globe: MaterialId(0),
            spot: MaterialId(0),
        };
        for (i, [r, g, b]) in PAINTS.into_iter().enumerate() {
            palette.paints[i] = paint(&format!("paint {i}"), r, g, b);
        }
        let mut light = |name: &str, radiance: f64, r, g, b| {
            builder.add_material(lamp(name, radiance * Rgb::new(r, g, b)))
        };
        palette.sky = light("sky", 11.5, 0.57, 0.86, 1.26);
        palette.cove_lamp = light("cove lamp", 8.0, 1.30, 0.86, 0.44);
        palette.niche_lamp = light("niche lamp", 13.0, 1.30, 0.86, 0.46);
        palette.bulb = light("bulb", 170.0, 1.32, 0.84, 0.42);
        palette.globe = light("globe", 11.0, 1.25, 0.90, 0.52);
        palette.spot = light("spot", 60.0, 1.20, 0.92, 0.60);
        palette
    }
}
