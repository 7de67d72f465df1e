//! Unfolds sheets and places them on pages, by the crate `uvunwrap`.

use glam::DVec2;
use sir_geom::Side;
use uvunwrap::{Atlas, Density, Error, MeshInput, Options, Packing, Stage};

use crate::error::LightmapError;
use crate::existing;
use crate::input::Input;
use crate::layout::{Layout, Rectangle, Sheet};
use crate::objects::Objects;
use crate::observer::{Observer, Step};
use crate::options::LightmapOptions;
use crate::text::grouped;

/// Number of triangles from which charts are placed by the faster, less dense method.
const MANY_TRIANGLES: usize = 5_000;

/// Share of a page that charts fill, at least, if they are placed by the faster method.
const FILLED: f64 = 0.4;

/// Sheets that are placed on pages.
pub(crate) struct Sizes<'a> {
    pub(crate) objects: &'a Objects,
    pub(crate) inputs: &'a [Input],
    pub(crate) options: &'a LightmapOptions,
    pub(crate) observer: &'a dyn Observer,
}

impl Sizes<'_> {
    /// Unfolds and places all sheets. With `is_whole`, each sheet stays on one page.
    pub(crate) fn generate(&self, density: Density, is_whole: bool) -> Result<Atlas, Error> {
        let single = [1.0];
        let meshes: Vec<MeshInput<'_>> = self
            .inputs
            .iter()
            .map(|input| {
                let is_instanced = input.instances.len() > 1;
                let scales: &[f32] = match is_instanced {
                    true => &input.scales,
                    false if is_whole => &single,
                    false => &[],
                };
                match &input.existing {
                    Some(existing) => MeshInput {
                        instance_scales: scales,
                        ..MeshInput::new(&existing.frame, &existing::FRAME_TRIANGLES)
                    },
                    None => MeshInput {
                        face_materials: Some(&input.primitives),
                        seams: Some(&input.creases),
                        scale: input.scale,
                        instance_scales: scales,
                        ..MeshInput::new(&input.positions, &input.indices)
                    },
                }
            })
            .collect();
        let options =
            |packing| Options { density, padding: self.options.padding, packing, ..Options::default() };
        let report = |progress: uvunwrap::Progress| {
            let total = progress.total.map(|total| total as u64);
            match progress.stage {
                // Meshes are counted first, in little time.
                Stage::Segmenting => self.observer.progress(Step::Unwrapping, 0, None),
                Stage::Parameterizing => {
                    self.observer.progress(Step::Unwrapping, progress.done as u64, total)
                }
                _ => self.observer.progress(Step::Packing, progress.done as u64, None),
            }
        };
        let triangles: usize = self.inputs.iter().map(|input| input.triangles.len()).sum();
        let packing = if triangles > MANY_TRIANGLES { Packing::Fast } else { Packing::Shape };
        let generate = || uvunwrap::generate_with_progress(&meshes, &options(packing), report);
        // Without a pool, all processors would work.
        match rayon::ThreadPoolBuilder::new().num_threads(self.options.threads.max(1)).build() {
            Ok(pool) => pool.install(generate),
            Err(_) => generate(),
        }
    }

    /// Returns the layout of an atlas.
    pub(crate) fn layout(&self, atlas: &Atlas) -> Layout {
        let Objects { meshes, instances, .. } = self.objects;
        let mut layout = Layout {
            width: atlas.width,
            height: atlas.height,
            pages: atlas.page_count.max(1),
            texels_per_meter: f64::from(atlas.texels_per_unit),
            charts: atlas.chart_count,
            sheets: Vec::with_capacity(self.inputs.len()),
            of_mesh: vec![[None; 2]; meshes.len()],
            rectangles: vec![[None; 2]; instances.len()],
        };
        for (input, output) in self.inputs.iter().zip(&atlas.meshes) {
            let mesh = &meshes[input.mesh];
            let primitives = match &input.existing {
                Some(existing) => existing.unfolded(output, &mut layout.charts),
                None => input.unfolded(mesh, output),
            };
            let back = usize::from(input.side == Side::Back);
            if let Some(sheet) = layout.of_mesh[input.mesh][back] {
                // The part without light joins the other one.
                let sheet: &mut Sheet = &mut layout.sheets[sheet];
                sheet.primitives.iter_mut().zip(primitives).for_each(|(of, dark)| of.join(dark));
                continue;
            }
            let rectangles = output.instances.iter().map(|place| {
                let [min, max] = [place.min, place.max].map(|p| DVec2::from_array(p.map(f64::from)));
                Rectangle { page: place.page, min, max }
            });
            let rectangles =
                if output.instances.is_empty() { vec![Rectangle::whole(0)] } else { rectangles.collect() };
            for (&instance, rectangle) in input.instances.iter().zip(rectangles) {
                layout.rectangles[instance][back] = Some(rectangle);
            }
            layout.of_mesh[input.mesh][back] = Some(layout.sheets.len());
            layout.sheets.push(Sheet {
                mesh: input.mesh,
                side: input.side,
                primitives,
                instances: input.instances.clone(),
                existing: input.existing.as_ref().map(|existing| existing.set),
            });
        }
        layout
    }

    pub(crate) fn too_small(&self, atlas: &Atlas, pages: Option<u32>) -> LightmapError {
        let margin = 2.0 * f64::from(self.options.padding) + 1.0;
        // Every chart needs a texel and its padding.
        let texels = f64::from(atlas.chart_count) * margin * margin / FILLED;
        let per_page = texels / f64::from(self.options.pages);
        let why = match pages {
            Some(pages) => format!("they need {pages}"),
            None => format!("each needs {margin} × {margin} with its padding"),
        };
        let charts = format!("{} charts", grouped(u64::from(atlas.chart_count)));
        self.refusal(&charts, per_page.sqrt(), &why)
    }

    /// Returns the error that charts do not fit, with the size of pages that they need.
    fn refusal(&self, charts: &str, size: f64, why: &str) -> LightmapError {
        let LightmapOptions { size: given, pages, texels_per_meter, .. } = *self.options;
        let pages = if pages == 1 { "a page".to_owned() } else { format!("{pages} pages") };
        let what = format!("the {charts} of the lightmap do not fit {pages} of {given} texels ({why})");
        let needed = (size.max(1.2 * f64::from(given)).min(1e9) as u32).next_multiple_of(64);
        let or = if texels_per_meter.is_some() { "texels_per_meter" } else { "padding" };
        LightmapError::TooSmall { what, needed, or }
    }

    pub(crate) fn error(&self, error: Error) -> LightmapError {
        match error {
            Error::Cancelled => LightmapError::Stopped,
            Error::ChartTooLarge { width, height, .. } => {
                let why = format!("one mesh needs {width} × {height} texels, and a mesh stays on one page");
                self.refusal("charts", f64::from(width.max(height)), &why)
            }
            Error::AtlasTooLarge { texels } => {
                let why = format!("they need {} texels", grouped(texels));
                self.refusal("charts", (texels as f64).sqrt(), &why)
            }
            other => LightmapError::Unwrap(other),
        }
    }
}
