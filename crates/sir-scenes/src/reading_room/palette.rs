//! Materials of the room.

use sir_geom::{Material, MaterialId, Rgb, SceneBuilder};

use crate::model::furnish::lamp;

/// Indices of the materials.
pub(super) struct Palette {
    pub(super) plaster: MaterialId,
    pub(super) vault: MaterialId,
    pub(super) stone: MaterialId,
    pub(super) pale_tile: MaterialId,
    pub(super) dark_tile: MaterialId,
    pub(super) oak: MaterialId,
    pub(super) walnut: MaterialId,
    pub(super) leather: MaterialId,
    pub(super) seat: MaterialId,
    pub(super) rug: MaterialId,
    pub(super) rug_border: MaterialId,
    pub(super) brass: MaterialId,
    pub(super) lamp_shade: MaterialId,
    pub(super) shade_lining: MaterialId,
    pub(super) window_bar: MaterialId,
    pub(super) urn: MaterialId,
    pub(super) sea: MaterialId,
    pub(super) paper: MaterialId,
    pub(super) books: Vec<MaterialId>,
    /// Light of the sky.
    pub(super) sky: MaterialId,
    /// Light of the strips hidden on the cornices.
    pub(super) cove_lamp: MaterialId,
    /// Light of the strips hidden in the niche.
    pub(super) niche_lamp: MaterialId,
    /// Light of the reading lamps.
    pub(super) bulb: MaterialId,
}

/// Reflectances of the book covers.
const BOOKS: [[f64; 3]; 14] = [
    [0.30, 0.05, 0.04],
    [0.42, 0.09, 0.05],
    [0.22, 0.03, 0.05],
    [0.07, 0.16, 0.10],
    [0.10, 0.24, 0.15],
    [0.05, 0.09, 0.22],
    [0.09, 0.17, 0.33],
    [0.36, 0.20, 0.09],
    [0.24, 0.12, 0.06],
    [0.50, 0.36, 0.17],
    [0.62, 0.53, 0.36],
    [0.55, 0.30, 0.06],
    [0.12, 0.10, 0.10],
    [0.30, 0.29, 0.27],
];

impl Palette {
    pub(super) fn new(builder: &mut SceneBuilder) -> Self {
        let mut paint =
            |name: &str, r, g, b| builder.add_material(Material::diffuse(name, Rgb::new(r, g, b)));
        let mut palette = Self {
            plaster: paint("plaster", 0.72, 0.61, 0.46),
            vault: paint("vault", 0.82, 0.79, 0.72),
            stone: paint("stone", 0.68, 0.64, 0.57),
            pale_tile: paint("pale tile", 0.66, 0.61, 0.52),
            dark_tile: paint("dark tile", 0.10, 0.11, 0.11),
            oak: paint("oak", 0.40, 0.23, 0.11),
            walnut: paint("walnut", 0.25, 0.12, 0.055),
            leather: paint("desk leather", 0.05, 0.15, 0.085),
            seat: paint("seat leather", 0.34, 0.07, 0.045),
            rug: paint("rug", 0.46, 0.04, 0.037),
            rug_border: paint("rug border", 0.60, 0.40, 0.13),
            brass: paint("brass", 0.62, 0.44, 0.17),
            lamp_shade: paint("lamp shade", 0.04, 0.34, 0.14),
            shade_lining: paint("shade lining", 0.85, 0.85, 0.80),
            window_bar: paint("window bar", 0.20, 0.17, 0.14),
            urn: paint("urn", 0.12, 0.28, 0.34),
            sea: paint("sea", 0.10, 0.27, 0.40),
            paper: paint("paper", 0.80, 0.77, 0.68),
            books: Vec::new(),
            sky: MaterialId(0),
            cove_lamp: MaterialId(0),
            niche_lamp: MaterialId(0),
            bulb: MaterialId(0),
        };
        palette.books =
            BOOKS.iter().enumerate().map(|(i, [r, g, b])| paint(&format!("book {i}"), *r, *g, *b)).collect();
        let mut light = |name: &str, radiance: f64, r, g, b| {
            builder.add_material(lamp(name, radiance * Rgb::new(r, g, b)))
        };
        palette.sky = light("sky", 2.6, 0.58, 0.84, 1.22);
        palette.cove_lamp = light("cove lamp", 14.0, 1.30, 0.84, 0.42);
        palette.niche_lamp = light("niche lamp", 22.0, 1.35, 0.78, 0.34);
        palette.bulb = light("bulb", 120.0, 1.30, 0.86, 0.46);
        palette
    }
}
