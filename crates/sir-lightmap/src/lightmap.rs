//! A lightmap: from a solution to texels.

use sir_geom::{Rgb, Side, TriangleId};
use sir_view::{DisplayMesh, Exposure};

use crate::dark::Dark;
use crate::dilate::dilate;
use crate::document::Document;
use crate::error::LightmapError;
use crate::layout::Layout;
use crate::loose;
use crate::means::keep_power;
use crate::objects::Objects;
use crate::observer::Observer;
use crate::options::{LightmapOptions, LightmapSides};
use crate::seams::{self, SeamSteps};
use crate::solution::Solution;
use crate::texels::{self, Light, Texels};
use crate::unwrap::unwrap;

/// A lightmap: charts on pages of texels, with the light of a solution.
pub struct Lightmap<'a> {
    pub(crate) solution: Solution<'a>,
    pub(crate) options: LightmapOptions,
    pub(crate) document: Document,
    pub(crate) objects: Objects,
    pub(crate) layout: Layout,
    pub(crate) texels: Texels,
    pub(crate) direct: Option<Vec<[f32; 3]>>,
    pub(crate) steps: Option<SeamSteps>,
    /// Factor from radiance to brightness on a screen that suits the scene.
    pub(crate) exposure: f64,
    pub(crate) notes: Vec<String>,
}

impl<'a> Lightmap<'a> {
    /// Makes the lightmap of a solution.
    ///
    /// The result is the same for any number of threads.
    ///
    /// # Errors
    ///
    /// If the glTF file cannot be read again, if the charts do not fit the pages, or if `observer` stops the work.
    pub fn new(
        solution: Solution<'a>,
        options: LightmapOptions,
        observer: &dyn Observer,
    ) -> Result<Self, LightmapError> {
        let Solution { scene, mesh, irradiance, errors, .. } = solution;
        let mut notes = Vec::new();
        let (document, objects) = open(&solution)?;
        if !document.missing_images.is_empty() {
            notes.push(format!("images could not be read: {}", document.missing_images.join(", ")));
        }
        let dark = Dark::new(&objects, &solution, options.sides);
        let is_dark = |mesh, side, primitive, number| dark.is_dark(mesh, side, primitive, number);
        let layout = unwrap(&document, &objects, &is_dark, &options, &mut notes, observer)?;
        let display = DisplayMesh::new(scene, mesh, irradiance);
        let exposure = Exposure::Auto.factor_for_mesh(&display);
        let fill = |display: &DisplayMesh<'_>, irradiance: &[Rgb]| {
            let [vertices, errors] = &keep_power(display, irradiance, errors);
            let light = Light { display, vertices, errors, is_radiosity: false };
            texels::fill(&objects, &layout, &light, options.sides, options.threads, observer)
        };
        let mut texels = fill(&display, irradiance)?;
        drop(display);
        let direct = solution.direct.map(|direct| {
            let display = DisplayMesh::new(scene, mesh, direct);
            fill(&display, direct)
        });
        let mut direct = direct.transpose()?;
        let is_lit = dilate(&mut texels, &layout, options.padding);
        if let Some(direct) = &mut direct {
            dilate(direct, &layout, options.padding);
        }
        let steps = match options.seams {
            true => Some(seams::fit(&objects, &layout, &mut texels, &is_lit, observer)?),
            false => None,
        };
        if texels.lost > 0.0 {
            notes.push(format!(
                "{:.2e} m² of surface cannot be unfolded and have no texels (their triangles are too thin)",
                texels.lost
            ));
        }
        let direct = direct.map(|direct| direct.light);
        Ok(Self { solution, options, document, objects, layout, texels, direct, steps, exposure, notes })
    }

    /// Returns width and height of a page \[texels\], and the number of pages.
    #[must_use]
    pub fn size(&self) -> ([u32; 2], u32) {
        ([self.layout.width, self.layout.height], self.layout.pages)
    }

    /// Returns the number of texels per meter of surface.
    #[must_use]
    pub fn texels_per_meter(&self) -> f64 {
        self.layout.texels_per_meter
    }

    /// Returns the number of charts.
    #[must_use]
    pub fn charts(&self) -> u32 {
        self.layout.charts
    }

    /// Returns the share of the texels that charts cover, at least in part.
    #[must_use]
    pub fn covered(&self) -> f64 {
        let covered = (0..self.texels.area.len()).filter(|&i| self.texels.is_covered(i)).count();
        covered as f64 / self.texels.area.len().max(1) as f64
    }

    /// Returns what is worth saying about single meshes, such as why their own layout is not used.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Returns the steps at the edges of charts; `None` if texels were not fitted.
    #[must_use]
    pub fn seam_steps(&self) -> Option<SeamSteps> {
        self.steps
    }

    /// Returns the mean irradiance \[W/m²\] of each texel, page by page and row by row from the top.
    #[must_use]
    pub fn irradiance(&self) -> &[[f32; 3]] {
        &self.texels.light
    }

    /// Returns the standard error of the irradiance \[W/m²\] of each texel.
    #[must_use]
    pub fn errors(&self) -> &[[f32; 3]] {
        &self.texels.error
    }

    /// Returns the area \[m²\] of the surfaces in each texel that stop light.
    #[must_use]
    pub fn areas(&self) -> &[f32] {
        &self.texels.area
    }

    /// Returns the page and the corners \[texels\] of a side of a triangle; `None` if it has no texels.
    #[must_use]
    pub fn place(&self, triangle: TriangleId, side: Side) -> Option<(u32, [glam::DVec2; 3])> {
        let place = self.layout.locate(&self.objects, self.solution.scene, triangle, side)?;
        Some((place.page, place.corners))
    }

    /// Returns the mean radiosity of the texels \[W/m²\], with textures, and their opacity.
    pub(crate) fn radiosity(&self, observer: &dyn Observer) -> Result<Texels, LightmapError> {
        let Solution { scene, mesh, irradiance, errors, .. } = self.solution;
        let display = DisplayMesh::new(scene, mesh, irradiance);
        let [vertices, errors] = &keep_power(&display, irradiance, errors);
        let light = Light { display: &display, vertices, errors, is_radiosity: true };
        let LightmapOptions { sides, threads, padding, .. } = self.options;
        let mut texels = texels::fill(&self.objects, &self.layout, &light, sides, threads, observer)?;
        dilate(&mut texels, &self.layout, padding);
        Ok(texels)
    }

    /// Returns true if a surface of which both sides reflect has texels for one of them only.
    pub(crate) fn has_common_sides(&self) -> bool {
        self.options.sides != LightmapSides::Split
            && self.objects.meshes.iter().flat_map(|mesh| &mesh.primitives).any(|p| p.is_two_sided)
    }
}

/// Opens the document of a solution, adds to it what its file does not have, and finds where the triangles of the scene are
/// in it.
pub(crate) fn open(solution: &Solution<'_>) -> Result<(Document, Objects), LightmapError> {
    let Solution { scene, source, scale, up, .. } = *solution;
    let mut document = match scene.mesh_instances().is_empty() {
        true => Document::new(source),
        false => Document::open(source)?,
    };
    let mut objects = Objects::of_file(&document, scene)?;
    loose::add(&mut document, &mut objects, scene, scale, up);
    Ok((document, objects))
}
