//! Unwrapping: unfolds meshes into charts, and places them on pages.

use std::rc::Rc;

use sir_geom::Side;
use uvunwrap::{Atlas, Density, Error};

use crate::atlas::Sizes;
use crate::document::Document;
use crate::error::LightmapError;
use crate::existing::{self, Existing};
use crate::input::Input;
use crate::layout::Layout;
use crate::objects::Objects;
use crate::observer::Observer;
use crate::options::{LightmapOptions, LightmapSides};

/// Factor of the size of surfaces without light, of which a texel shows all that there is.
const DARK_SCALE: f32 = 0.01;

/// Number of attempts to find the density for several pages.
const ATTEMPTS: usize = 8;

/// Unfolds all meshes. Adds to `notes` why layouts of the file are not used.
pub(crate) fn unwrap(
    document: &Document,
    objects: &Objects,
    is_dark: &IsDark<'_>,
    options: &LightmapOptions,
    notes: &mut Vec<String>,
    observer: &dyn Observer,
) -> Result<Layout, LightmapError> {
    let mut existing = Vec::with_capacity(objects.meshes.len());
    for (number, mesh) in objects.meshes.iter().enumerate() {
        let is_split =
            options.sides == LightmapSides::Split && mesh.primitives.iter().any(|p| p.is_two_sided);
        let first = objects.instances.iter().find(|instance| instance.mesh == number);
        existing.push(match first.filter(|_| !is_split) {
            Some(instance) => existing::of_mesh(document, mesh, instance.area, notes)?.map(Rc::new),
            None => None,
        });
    }
    loop {
        let layout = pack(objects, &existing, is_dark, options, observer)?;
        let Some((sheet, why)) = existing::too_coarse(&layout) else { return Ok(layout) };
        let mesh = layout.sheets[sheet].mesh;
        notes.push(existing::note(&objects.meshes[mesh], &why));
        existing[mesh] = None;
    }
}

/// Returns true if a side of a triangle of a mesh has no light: of the mesh, the primitive and the number in it.
pub(crate) type IsDark<'a> = dyn Fn(usize, Side, usize, usize) -> bool + 'a;

/// Collects the sides of all meshes. Backs without light are left out. `with_dark` is true to keep fronts without light apart,
/// where a mesh has one instance.
fn inputs(
    objects: &Objects,
    existing: &[Option<Rc<Existing>>],
    is_dark: &IsDark<'_>,
    with_dark: bool,
    options: &LightmapOptions,
) -> Vec<Input> {
    let mut inputs = Vec::new();
    for (number, mesh) in objects.meshes.iter().enumerate() {
        let instances: Vec<usize> =
            (0..objects.instances.len()).filter(|&i| objects.instances[i].mesh == number).collect();
        for side in [Side::Front, Side::Back] {
            let is_split = options.sides == LightmapSides::Split;
            let has_side =
                |primitive: usize| side == Side::Front || is_split && mesh.primitives[primitive].is_two_sided;
            // Backs without light, such as the outsides of a room, are left out.
            let is_apart = match side {
                Side::Front => {
                    Some(is_dark).filter(|_| with_dark && instances.len() == 1 && existing[number].is_none())
                }
                Side::Back => Some(is_dark),
            };
            let lit = |p: usize, t: usize| {
                has_side(p) && !is_apart.is_some_and(|is_dark| is_dark(number, side, p, t))
            };
            let dark = |p: usize, t: usize| {
                has_side(p) && is_apart.is_some_and(|is_dark| is_dark(number, side, p, t))
            };
            let of = |has: &dyn Fn(usize, usize) -> bool| {
                Input::new(objects, number, side, instances.clone(), has)
            };
            let lit = Input { existing: existing[number].clone(), ..of(&lit) };
            let dark = Input { scale: DARK_SCALE, ..of(&dark) };
            let all = if side == Side::Front { vec![lit, dark] } else { vec![lit] };
            inputs.extend(all.into_iter().filter(|input| !input.triangles.is_empty()));
        }
    }
    inputs
}

/// Places all sheets on pages.
fn pack(
    objects: &Objects,
    existing: &[Option<Rc<Existing>>],
    is_dark: &IsDark<'_>,
    options: &LightmapOptions,
    observer: &dyn Observer,
) -> Result<Layout, LightmapError> {
    let one_page = match options.texels_per_meter {
        Some(texels) => Density::Fixed { texels_per_unit: texels as f32, page_size: None },
        None => Density::Auto { page_size: options.size },
    };
    let fits = |atlas: &Atlas| atlas.page_count <= 1 && atlas.width.max(atlas.height) <= options.size;
    let mut single = None;
    {
        let inputs = inputs(objects, existing, is_dark, true, options);
        let sizes = Sizes { objects, inputs: &inputs, options, observer };
        match sizes.generate(one_page, false) {
            Ok(atlas) if fits(&atlas) => single = Some(sizes.layout(&atlas)),
            Ok(atlas) if options.texels_per_meter.is_none() && options.pages == 1 => {
                return Err(sizes.too_small(&atlas, None));
            }
            // With a density there are as many pages as needed.
            Ok(_) | Err(Error::AtlasTooLarge { .. }) => {}
            Err(error) => return Err(sizes.error(error)),
        }
    }
    let single = match single {
        Some(layout) if options.texels_per_meter.is_some() || options.pages == 1 => return Ok(layout),
        other => other,
    };
    let inputs = inputs(objects, existing, is_dark, false, options);
    let sizes = Sizes { objects, inputs: &inputs, options, observer };
    if let Some(texels) = options.texels_per_meter {
        let density = Density::Fixed { texels_per_unit: texels as f32, page_size: Some(options.size) };
        let atlas = sizes.generate(density, true).map_err(|error| sizes.error(error))?;
        return Ok(sizes.layout(&atlas));
    }
    // The density at which the charts of all sheets fill the pages, lowered until they fit.
    let area: f64 = inputs.iter().map(Input::area).sum();
    let texels = f64::from(options.pages) * f64::from(options.size) * f64::from(options.size);
    let mut density = (0.8 * texels / area.max(f64::MIN_POSITIVE)).sqrt();
    let (mut fitting, mut too_high, mut refusal) = (None, f64::INFINITY, None);
    for _ in 0..ATTEMPTS {
        let fixed = Density::Fixed { texels_per_unit: density as f32, page_size: Some(options.size) };
        match sizes.generate(fixed, true) {
            Ok(atlas) if atlas.page_count <= options.pages => {
                fitting = Some((density, atlas));
            }
            Ok(atlas) => {
                too_high = density;
                refusal = Some(sizes.too_small(&atlas, Some(atlas.page_count)));
            }
            Err(error @ (Error::ChartTooLarge { .. } | Error::AtlasTooLarge { .. })) => {
                too_high = density;
                refusal = Some(sizes.error(error));
            }
            Err(error) => return Err(sizes.error(error)),
        }
        density = match &fitting {
            Some((low, _)) if too_high < 1.03 * low => break,
            Some((low, _)) => (low * too_high).sqrt().min(1.2 * low),
            None => 0.8 * density,
        };
    }
    match (fitting, single) {
        // On several pages a mesh stays on one, which may fill them worse than a single page.
        (Some((density, atlas)), single)
            if single.as_ref().is_none_or(|of| of.texels_per_meter < density) =>
        {
            Ok(sizes.layout(&atlas))
        }
        (_, Some(layout)) => Ok(layout),
        (_, None) => Err(refusal.unwrap_or(LightmapError::Stopped)),
    }
}
