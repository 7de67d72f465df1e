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

/// Largest size of pages that is used without being asked for \[texels\].
const MAX_SIZE: u32 = 8_192;

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
    let mut options = *options;
    loop {
        let packed = Job { objects, existing: &existing, is_dark, options: &options, observer }.pack();
        let layout = match packed {
            // The light may have taken hours, so it is not lost for this.
            Err(LightmapError::TooSmall { what, needed, .. }) if needed <= MAX_SIZE => {
                notes.push(format!("{what}; pages of {needed} texels are used instead"));
                options.size = needed;
                continue;
            }
            Err(LightmapError::TooSmall { what, .. }) if options.padding > 1 => {
                notes.push(format!("{what}; charts are only 2 texels apart"));
                options.padding = 1;
                continue;
            }
            packed => packed?,
        };
        let Some((sheet, why)) = existing::too_coarse(&layout) else { return Ok(layout) };
        let mesh = layout.sheets[sheet].mesh;
        notes.push(existing::note(&objects.meshes[mesh], &why));
        existing[mesh] = None;
    }
}

/// Returns true if a side of a triangle of a mesh has no light: of the mesh, the primitive and the number in it.
pub(crate) type IsDark<'a> = dyn Fn(usize, Side, usize, usize) -> bool + 'a;

/// What is placed on pages.
#[derive(Clone, Copy)]
struct Job<'a> {
    objects: &'a Objects,
    existing: &'a [Option<Rc<Existing>>],
    is_dark: &'a IsDark<'a>,
    options: &'a LightmapOptions,
    observer: &'a dyn Observer,
}

impl Job<'_> {
    /// Places all sheets on pages.
    fn pack(self) -> Result<Layout, LightmapError> {
        match (self.on_one_page()?, self.options.texels_per_meter) {
            (Some(layout), Some(_)) => Ok(layout),
            (Some(layout), None) if self.options.pages == 1 => Ok(layout),
            (None, Some(density)) => self.at_density(density),
            (single, None) => self.on_pages(single),
        }
    }

    /// Places all sheets on one page; `None` if they do not fit it, and may have more.
    fn on_one_page(self) -> Result<Option<Layout>, LightmapError> {
        let Self { options, .. } = self;
        let density = match options.texels_per_meter {
            Some(texels) => Density::Fixed { texels_per_unit: texels as f32, page_size: None },
            None => Density::Auto { page_size: options.size },
        };
        let fits = |atlas: &Atlas| atlas.page_count <= 1 && atlas.width.max(atlas.height) <= options.size;
        let inputs = self.inputs(true);
        let sizes = self.sizes(&inputs);
        match sizes.generate(density, false) {
            Ok(atlas) if fits(&atlas) => Ok(Some(sizes.layout(&atlas))),
            Ok(atlas) if options.texels_per_meter.is_none() && options.pages == 1 => {
                Err(sizes.too_small(&atlas, None))
            }
            // With a density there are as many pages as needed.
            Ok(_) | Err(Error::AtlasTooLarge { .. }) => Ok(None),
            Err(error) => Err(sizes.error(error)),
        }
    }

    /// Places sheets with this number of texels per meter on as many pages as they need.
    fn at_density(self, density: f64) -> Result<Layout, LightmapError> {
        let inputs = self.inputs(false);
        let sizes = self.sizes(&inputs);
        let fixed = Density::Fixed { texels_per_unit: density as f32, page_size: Some(self.options.size) };
        let atlas = sizes.generate(fixed, true).map_err(|error| sizes.error(error))?;
        Ok(sizes.layout(&atlas))
    }

    /// Places all sheets on several pages, or on a single one if it has more texels per meter: on several pages each mesh
    /// stays on one, which may fill them worse.
    fn on_pages(self, single: Option<Layout>) -> Result<Layout, LightmapError> {
        let Self { options, .. } = self;
        let inputs = self.inputs(false);
        let sizes = self.sizes(&inputs);
        // The density at which the charts of all sheets fill the pages, lowered until they fit, then raised.
        let area: f64 = inputs.iter().map(Input::area).sum();
        let texels = f64::from(options.pages) * f64::from(options.size) * f64::from(options.size);
        let mut density = (0.8 * texels / area.max(f64::MIN_POSITIVE)).sqrt();
        let (mut fitting, mut too_high, mut refusal) = (None, f64::INFINITY, None);
        for _ in 0..ATTEMPTS {
            let fixed = Density::Fixed { texels_per_unit: density as f32, page_size: Some(options.size) };
            match sizes.generate(fixed, true) {
                Ok(atlas) if atlas.page_count <= options.pages => fitting = Some((density, atlas)),
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
            (Some((density, _)), Some(layout)) if layout.texels_per_meter >= density => Ok(layout),
            (Some((_, atlas)), _) => Ok(sizes.layout(&atlas)),
            (None, Some(layout)) => Ok(layout),
            (None, None) => Err(refusal.unwrap_or(LightmapError::Stopped)),
        }
    }

    fn sizes<'a>(&'a self, inputs: &'a [Input]) -> Sizes<'a> {
        Sizes { objects: self.objects, inputs, options: self.options, observer: self.observer }
    }

    /// Collects the sides of all meshes. Backs without light are left out. `with_dark` is true to keep fronts without light
    /// apart, where a mesh has one instance.
    fn inputs(&self, with_dark: bool) -> Vec<Input> {
        let Self { objects, existing, is_dark, options, .. } = *self;
        let mut inputs = Vec::new();
        for (number, mesh) in objects.meshes.iter().enumerate() {
            let instances: Vec<usize> =
                (0..objects.instances.len()).filter(|&i| objects.instances[i].mesh == number).collect();
            for side in [Side::Front, Side::Back] {
                let is_split = options.sides == LightmapSides::Split;
                let has_side = |primitive: usize| {
                    side == Side::Front || is_split && mesh.primitives[primitive].is_two_sided
                };
                // Backs without light, such as the outsides of a room, are left out.
                let is_apart = match side {
                    Side::Front => Some(is_dark)
                        .filter(|_| with_dark && instances.len() == 1 && existing[number].is_none()),
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
}
