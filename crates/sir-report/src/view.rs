//! The light of a scene, coded for the viewer of a page.

use std::io::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use glam::DVec3;
use serde_json::{Value, json};
use sir_geom::{Rgb, luminance, median_extent};
use sir_view::{DisplayMesh, DisplayPiece};

use crate::arrays::{Arrays, Coding, differences_of_bands};
use crate::log_scale::LogScale;
use crate::simplified::{means, patches};

/// Largest number of sides of patches that a page shows. With more, it shows patches of about half this number, and says so.
pub const MAX_SIDES: usize = 1_000_000;

/// Largest step of the coordinates, in typical distances of vertices from the middle of the scene.
const LARGEST_STEP: f64 = 1e-4;

/// Light of all sides of patches, indexed by [`SideId`](sir_mesh::SideId).
#[derive(Clone, Copy, Debug)]
pub struct Light<'a> {
    /// Irradiance \[W/m²\].
    pub irradiance: &'a [Rgb],
    /// Standard error of the irradiance \[W/m²\]; zero where it is not known.
    pub error: &'a [Rgb],
    /// Direct irradiance \[W/m²\], if it is known.
    pub direct: Option<&'a [Rgb]>,
}

/// A lit scene, coded for the viewer.
#[derive(Clone, Debug)]
pub struct View {
    /// Deflated arrays, as text.
    pub(crate) coded: String,
    patches: Option<usize>,
}

impl View {
    /// Codes light with the display mesh of its irradiance.
    ///
    /// # Panics
    ///
    /// If `light` does not have one value for every side of the patches of `display`.
    #[must_use]
    pub fn new(display: &DisplayMesh<'_>, light: Light<'_>) -> Self {
        Self::with_at_most(MAX_SIDES, display, light)
    }

    fn with_at_most(sides: usize, display: &DisplayMesh<'_>, light: Light<'_>) -> Self {
        let (scene, mesh) = (display.scene(), display.mesh());
        let coarse = if mesh.side_count() > sides { patches(scene, sides / 2) } else { None };
        let Some(coarse) = coarse.filter(|coarse| coarse.side_count() < mesh.side_count()) else {
            return Self { coded: code(display, light), patches: None };
        };
        let over = |values: &[Rgb]| means(scene, mesh, &coarse, values);
        let (irradiance, error, direct) = (over(light.irradiance), over(light.error), light.direct.map(over));
        let light = Light { irradiance: &irradiance, error: &error, direct: direct.as_deref() };
        let display = DisplayMesh::new(scene, &coarse, &irradiance);
        Self { coded: code(&display, light), patches: Some(coarse.patch_count()) }
    }

    /// Returns the number of patches that are shown, if these are fewer than those of the solution.
    #[must_use]
    pub fn simplified_patches(&self) -> Option<usize> {
        self.patches
    }
}

/// Returns the coded light: deflated, in Base64.
fn code(display: &DisplayMesh<'_>, light: Light<'_>) -> String {
    let (scene, mesh) = (display.scene(), display.mesh());
    let is_shown = |piece: &DisplayPiece<'_>| {
        let patch = mesh.patch_of_side(piece.triangle, piece.id);
        !piece.triangles.is_empty() && mesh.covered_area(piece.triangle, patch) > 0.0
    };
    let pieces: Vec<DisplayPiece<'_>> = display.pieces().filter(is_shown).collect();
    let mut arrays = Arrays::default();
    let (order, triangles) = add_triangles(&mut arrays, display, &pieces);
    let (origin, step) = add_positions(&mut arrays, display, &order);

    let largest = |values: &mut dyn Iterator<Item = Rgb>| {
        values.map(|v| v.max_element()).filter(|v| v.is_finite()).fold(0.0, f64::max)
    };
    let vertices =
        || order.iter().map(|&v| Rgb::from_array(display.vertices()[v as usize].irradiance.map(f64::from)));
    let of_sides = |values: &[Rgb]| pieces.iter().map(|piece| values[piece.id.index()]).collect::<Vec<_>>();
    let irradiance = of_sides(light.irradiance);
    let most = largest(&mut vertices().chain(irradiance.iter().copied()));
    let scale = LogScale::up_to(most, LogScale::FINE);
    let bands = |scale: LogScale, value: Rgb| differences_of_bands(value.to_array().map(|x| scale.code(x)));
    let vertices: Vec<_> = vertices().map(|e| bands(scale, e)).collect();
    arrays.add("vertexIrradiance", &vertices, 2, Coding::Differences);
    let irradiance: Vec<_> = irradiance.into_iter().map(|e| bands(scale, e)).collect();
    arrays.add("sideIrradiance", &irradiance, 2, Coding::Differences);

    let mut logs = json!({ "irradiance": json_of(scale) });
    let mut add_values = |arrays: &mut Arrays, name: &str, array: &str, values: Vec<f64>, step: f64| {
        let scale =
            LogScale::up_to(values.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max), step);
        let codes: Vec<_> = values.into_iter().map(|value| [u32::from(scale.code(value))]).collect();
        arrays.add(array, &codes, 2, Coding::Differences);
        logs[name] = json_of(scale);
    };
    let luminances = |values: &[Rgb]| of_sides(values).into_iter().map(luminance).collect::<Vec<_>>();
    add_values(&mut arrays, "error", "sideError", luminances(light.error), LogScale::COARSE);
    if let Some(direct) = light.direct {
        add_values(&mut arrays, "direct", "sideDirect", luminances(direct), LogScale::FINE);
    }
    let areas = pieces.iter().map(|piece| area(display, piece)).collect();
    add_values(&mut arrays, "area", "area", areas, LogScale::COARSE);
    let patch = |piece: &DisplayPiece<'_>| mesh.patch_of_side(piece.triangle, piece.id);
    let reflectance = pieces.iter().map(|piece| mesh.reflectance(scene, piece.triangle, patch(piece)));
    let exitance = pieces.iter().map(|piece| mesh.exitance(scene, piece.triangle, patch(piece), piece.side));
    for (name, values) in [("reflectance", reflectance.collect::<Vec<_>>()), ("exitance", exitance.collect())]
    {
        let scale = LogScale::up_to(largest(&mut values.iter().copied()), LogScale::FINE);
        let codes: Vec<_> = values.into_iter().map(|value| bands(scale, value)).collect();
        arrays.add(name, &codes, 2, Coding::Differences);
        logs[name] = json_of(scale);
    }
    let mut add_numbers = |name: &str, number: &dyn Fn(&DisplayPiece<'_>) -> u32| {
        let numbers: Vec<_> = pieces.iter().map(|piece| [number(piece)]).collect();
        arrays.add(name, &numbers, 4, Coding::Differences);
    };
    add_numbers("patch", &|piece| patch(piece).0);
    add_numbers("triangle", &|piece| {
        let first = mesh.pieces(piece.triangle, patch(piece)).next();
        scene.triangle(first.map_or(piece.triangle, |first| first.triangle)).source
    });
    add_numbers("material", &|piece| scene.triangle(piece.triangle).material.0);
    add_numbers("object", &|piece| scene.triangle(piece.triangle).group.0);

    let header = json!({
        "origin": origin.to_array(),
        "step": step,
        "vertices": order.len(),
        "triangles": triangles,
        "sides": pieces.len(),
        "logs": logs,
        "materials": scene.materials().iter().map(|m| json!({ "name": cut(&m.name) })).collect::<Vec<_>>(),
        "objects": scene.groups().iter().map(|name| cut(name)).collect::<Vec<_>>(),
    });
    deflated(&arrays.finish(header))
}

/// Returns the area of the triangles of a side \[m²\].
fn area(display: &DisplayMesh<'_>, piece: &DisplayPiece<'_>) -> f64 {
    let position = |v: u32| display.positions()[display.vertices()[v as usize].position as usize];
    let areas = piece.triangles.iter().map(|t| {
        let [a, b, c] = t.map(position);
        0.5 * (b - a).cross(c - a).length()
    });
    areas.sum()
}

/// Adds the triangles, and returns the vertices in the order of their first use, and the number of triangles.
fn add_triangles(
    arrays: &mut Arrays,
    display: &DisplayMesh<'_>,
    pieces: &[DisplayPiece<'_>],
) -> (Vec<u32>, usize) {
    let mut numbers = vec![u32::MAX; display.vertices().len()];
    let (mut order, mut codes) = (Vec::new(), Vec::new());
    for &vertex in pieces.iter().flat_map(|piece| piece.triangles.as_flattened()) {
        let next = order.len() as u32;
        let number = &mut numbers[vertex as usize];
        if *number == u32::MAX {
            *number = next;
            order.push(vertex);
        }
        // Zero for a new vertex, otherwise how long ago it was first used.
        codes.push([next - *number]);
    }
    arrays.add("index", &codes, 4, Coding::Plain);
    let counts: Vec<_> = pieces.iter().map(|piece| [piece.triangles.len() as u32]).collect();
    arrays.add("sideTriangles", &counts, 4, Coding::Plain);
    (order, codes.len() / 3)
}

/// Adds the positions of vertices as whole numbers of steps, and returns the origin and the step.
fn add_positions(arrays: &mut Arrays, display: &DisplayMesh<'_>, order: &[u32]) -> (DVec3, f64) {
    let positions =
        || order.iter().map(|&v| display.positions()[display.vertices()[v as usize].position as usize]);
    let origin = positions().fold(DVec3::INFINITY, DVec3::min);
    let extent = (positions().fold(DVec3::NEG_INFINITY, DVec3::max) - origin).max_element();
    let (_, typical) = median_extent(display.scene().vertices());
    let short = extent / f64::from(u16::MAX);
    let (width, step) =
        if short <= LARGEST_STEP * typical { (2, short) } else { (4, extent / f64::from(1 << 24)) };
    let step = if step > 0.0 { step } else { 1.0 };
    let codes: Vec<_> = positions()
        .map(|position| ((position - origin) / step).round().to_array().map(|x| x as u32))
        .collect();
    arrays.add("position", &codes, width, Coding::Differences);
    (if order.is_empty() { DVec3::ZERO } else { origin }, step)
}

fn json_of(scale: LogScale) -> Value {
    json!({ "low": scale.low, "step": scale.step })
}

/// Longest name on a page, in characters.
const LONGEST_NAME: usize = 200;

/// Returns a name, without its end if it is too long for a page.
fn cut(name: &str) -> String {
    match name.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.into(),
    }
}

fn deflated(bytes: &[u8]) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    // Writing to memory does not fail.
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    STANDARD.encode(written.unwrap_or_default())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a step that fails is a test that fails")]
mod tests {
    use sir_geom::shapes::{Facing, cuboid};
    use sir_geom::{Material, SceneBuilder};
    use sir_mesh::{PatchMesh, PatchSize, Subdivision};

    use super::*;

    #[test]
    fn too_many_patches_are_shown_as_fewer() {
        let mut builder = SceneBuilder::new();
        let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
        cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
        let scene = builder.build().unwrap().scene;
        let mesh = PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::Count(2000))).unwrap();
        let values = vec![Rgb::ONE; mesh.side_count()];
        let light = Light { irradiance: &values, error: &values, direct: Some(&values) };
        let display = DisplayMesh::new(&scene, &mesh, &values);
        let view = |most| View::with_at_most(most, &display, light);
        let [all, fewer] = [usize::MAX, 600].map(view);
        assert_eq!(all.simplified_patches(), None);
        let patches = fewer.simplified_patches().unwrap();
        assert!((250..=350).contains(&patches), "{patches}");
        assert!(fewer.coded.len() < all.coded.len());
    }
}
