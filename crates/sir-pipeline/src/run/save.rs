//! Writes the outputs of a stage `Save`.

use std::cell::OnceCell;
use std::fs;
use std::path::Path;
use std::sync::atomic::Ordering::Relaxed;

use sir_geom::Camera;
use sir_radiosity::{Model, Solution};
use sir_report::{Light, View};
use sir_view::{DisplayMesh, Exposure, FalseColors, Picture, PictureSettings, Table, ViewError};
use sir_view::{default_camera, render, render_irradiance};
use sir_view::{write_exr, write_false_colors, write_glb, write_png};

use crate::error::Error;
use crate::plan;
use crate::plan::{ColorScale, Image, Output, Show};
use crate::prepare::cameras::chosen_camera;
use crate::prepare::prepared::Prepared;
use crate::report::page::Shown;
use crate::report::result::OutputReport;
use crate::run::computed::{Computed, PartErrors};
use crate::run::lightmap;
use crate::run::pages::Page;
use crate::run::saver::Saver;
use crate::units::Units;

/// Width of the picture from which the exposure of a camera follows.
const PREVIEW_WIDTH: u32 = 200;

/// Ratio of height to width of an image whose camera has no aspect ratio.
const DEFAULT_SHAPE: f64 = 0.75;

/// Writes the outputs of a stage, one after the other, until the run is asked to stop. Adds its pages to `pages` and what was
/// written to `reports`. Returns true if all are written.
pub(crate) fn save(
    saver: Saver<'_>,
    light: &Computed,
    outputs: &[Output],
    pages: &mut Vec<Page>,
    reports: &mut Vec<OutputReport>,
) -> Result<bool, Error> {
    let Saver { prepared, directory, threads, progress, stop, .. } = saver;
    let Model { scene, mesh, accel } = &prepared.model;
    let solution = &light.solution;
    let lit = OnceCell::new();
    let display = || lit.get_or_init(|| DisplayMesh::new(scene, mesh, &solution.irradiance));
    let calm = if outputs.iter().any(is_denoised) {
        display().denoise(&solution.error, threads)
    } else {
        Vec::new()
    };
    let has_denoised_image = outputs.iter().any(|output| output.image().is_some() && is_denoised(output));
    let denoised = has_denoised_image.then(|| DisplayMesh::new(scene, mesh, &calm));
    let errors = outputs
        .iter()
        .any(|o| matches!(o, Output::Image(_)) && has_extension(o.path(), "exr"))
        .then(|| DisplayMesh::of_errors(scene, mesh, &solution.error));
    let mut renderer = Renderer::new(saver, &display, denoised.as_ref());
    for output in outputs {
        if stop.load(Relaxed) {
            return Ok(false);
        }
        let path = directory.join(output.path());
        progress.note(&format!("Save: {}", output.path().display()));
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(Error::directory(parent))?;
        }
        let mut default_camera = None;
        let kind = match output {
            Output::Image(image) => {
                if chosen_camera(image, scene, prepared.up).is_none() {
                    default_camera = plan::Camera::of_scene(&renderer.default_camera()).map(|c| c.to_ron());
                }
                let Rendered { camera, settings, picture, .. } =
                    renderer.render(image, is_denoised(output))?;
                match &errors {
                    Some(errors) if has_extension(&path, "exr") => {
                        let errors = render(errors, accel, camera, *settings)?;
                        write_exr(&path, picture, &[("error", &errors)])?;
                    }
                    _ if image.show == Show::Colors => write_png(&path, picture, image.exposure)?,
                    _ => write_false_colors(&path, picture, &false_colors(image, saver.pipeline.units))?,
                }
                "image"
            }
            Output::Gltf(_) => {
                write_glb(&path, display(), Exposure::Auto, scene.cameras(), prepared.up)?;
                "gltf"
            }
            Output::Table(output) => {
                let (irradiance, error) = (&solution.irradiance, &solution.error);
                let table = match output.per.and_then(|per| light.parts(per)) {
                    Some(PartErrors { sums, errors }) => {
                        Table::of_parts(scene, mesh, sums, irradiance, error, errors.as_deref())
                    }
                    None => Table::new(scene, mesh, irradiance, error),
                };
                if has_extension(&path, "npy") {
                    table.write_npy(&path)?
                } else {
                    table.write_csv(&path)?
                }
                "table"
            }
            Output::Report(output) => {
                let (view, shown) = renderer.page(light, None)?;
                pages.push(Page { path: output.path.clone(), view, shown });
                "report"
            }
            Output::Lightmap(output) => {
                let irradiance = if output.denoise { &calm } else { &solution.irradiance };
                let beside = lightmap::write(saver, light, irradiance, output, &path)?;
                for file in beside {
                    let path = file.strip_prefix(directory).unwrap_or(&file).to_string_lossy().into_owned();
                    let bytes = Some(size(&file)?);
                    reports.push(OutputReport { path, kind: "lightmap".into(), bytes, camera: None });
                }
                "lightmap"
            }
        };
        // A page is written when the run has ended.
        let bytes = match output {
            Output::Report(_) => None,
            _ => Some(size(&path)?),
        };
        let path = output.path().to_string_lossy().into_owned();
        reports.push(OutputReport { path, kind: kind.into(), bytes, camera: default_camera });
    }
    Ok(!stop.load(Relaxed))
}

/// Returns the size of a file \[bytes\].
fn size(path: &Path) -> Result<u64, Error> {
    let found = fs::metadata(path);
    Ok(found.map_err(|source| ViewError::Io { what: "read", path: path.to_owned(), source })?.len())
}

/// Returns the view of a page of this light, and what else the page shows. `cameras` are those of an earlier page, which
/// take time to find.
pub(crate) fn view_of(
    saver: Saver<'_>,
    light: &Computed,
    cameras: Option<Vec<(Camera, f64)>>,
) -> Result<(View, Shown), Error> {
    let Model { scene, mesh, .. } = &saver.prepared.model;
    let lit = OnceCell::new();
    let display = || lit.get_or_init(|| DisplayMesh::new(scene, mesh, &light.solution.irradiance));
    Renderer::new(saver, &display, None).page(light, cameras)
}

/// Renders images. Keeps the last one, because the same image is often requested as PNG and as EXR.
struct Renderer<'a> {
    prepared: &'a Prepared,
    /// Returns the display mesh, which is built when it is needed for the first time.
    display: &'a dyn Fn() -> &'a DisplayMesh<'a>,
    /// Denoised display mesh, if an image needs it.
    denoised: Option<&'a DisplayMesh<'a>>,
    /// Images of the pipeline.
    images: Vec<&'a Image>,
    threads: usize,
    last: Option<Rendered>,
    default: Option<Camera>,
}

/// An image with its camera and settings.
struct Rendered {
    camera: Camera,
    settings: PictureSettings,
    is_denoised: bool,
    /// True if the picture has the irradiance in place of the radiance.
    has_irradiance: bool,
    picture: Picture,
}

impl<'a> Renderer<'a> {
    fn new(
        saver: Saver<'a>,
        display: &'a dyn Fn() -> &'a DisplayMesh<'a>,
        denoised: Option<&'a DisplayMesh<'a>>,
    ) -> Self {
        let Saver { pipeline, prepared, threads, .. } = saver;
        let images = pipeline.outputs().filter_map(Output::image).collect();
        Self { prepared, display, denoised, images, threads, last: None, default: None }
    }

    /// Returns the view of a page, and what else it shows.
    fn page(
        &mut self,
        light: &Computed,
        cameras: Option<Vec<(Camera, f64)>>,
    ) -> Result<(View, Shown), Error> {
        let Solution { irradiance, error } = &light.solution;
        let view = View::new((self.display)(), Light { irradiance, error, direct: light.direct.as_deref() });
        let cameras = cameras.map_or_else(|| self.cameras(), Ok)?;
        let shown = Shown { cameras, not_final: light.not_final, simplified: view.simplified_patches() };
        Ok((view, shown))
    }

    fn render(&mut self, image: &Image, is_denoised: bool) -> Result<&Rendered, Error> {
        let Model { scene, accel, .. } = &self.prepared.model;
        let chosen = chosen_camera(image, scene, self.prepared.up);
        let settings = settings(image, chosen.as_ref(), self.threads);
        let camera = chosen.unwrap_or_else(|| self.default_camera());
        let has_irradiance = image.show == Show::Illuminance;
        let key = (&camera, settings, is_denoised, has_irradiance);
        let rendered = match self.last.take() {
            Some(last) if (&last.camera, last.settings, last.is_denoised, last.has_irradiance) == key => last,
            _ => {
                let display = self.denoised.filter(|_| is_denoised).unwrap_or_else(self.display);
                let draw = if has_irradiance { render_irradiance } else { render };
                let picture = draw(display, accel, &camera, settings)?;
                Rendered { picture, camera, settings, is_denoised, has_irradiance }
            }
        };
        Ok(self.last.insert(rendered))
    }

    /// Returns the cameras for a page: those of the scene and of images, or else the default camera. Each has the exposure that
    /// its image states, or the automatic one.
    fn cameras(&mut self) -> Result<Vec<(Camera, f64)>, Error> {
        let Prepared { model, up, .. } = self.prepared;
        let nameless = |camera: &Camera| Camera { name: String::new(), ..camera.clone() };
        let of_images = self.images.iter().filter_map(|image| {
            let name = image.path.display().to_string();
            chosen_camera(image, &model.scene, *up).map(|camera| (Camera { name, ..camera }, image.exposure))
        });
        let of_scene = model.scene.cameras().iter().map(|camera| (camera.clone(), Exposure::Auto));
        let mut cameras: Vec<(Camera, Exposure)> = Vec::new();
        for (camera, exposure) in of_scene.chain(of_images) {
            match cameras.iter_mut().find(|(known, _)| nameless(known) == nameless(&camera)) {
                Some((_, known)) if *known == Exposure::Auto => *known = exposure,
                Some(_) => {}
                None => cameras.push((camera, exposure)),
            }
        }
        if cameras.is_empty() {
            cameras.push((self.default_camera(), Exposure::Auto));
        }
        let exposed = cameras.into_iter().map(|(camera, exposure)| {
            let factor = match exposure {
                Exposure::Factor(factor) => factor,
                Exposure::Auto => {
                    let shape = camera.aspect.map_or(DEFAULT_SHAPE, |aspect| 1.0 / aspect);
                    let height = (f64::from(PREVIEW_WIDTH) * shape).round().clamp(1.0, 1000.0) as u32;
                    let settings =
                        PictureSettings { width: PREVIEW_WIDTH, height, grid: 1, threads: self.threads };
                    let picture = render((self.display)(), &model.accel, &camera, settings)?;
                    exposure.factor_for_picture(&picture)
                }
            };
            Ok((camera, factor))
        });
        exposed.collect()
    }

    /// Returns the camera for a scene without cameras. Keeps it, because finding it takes time.
    fn default_camera(&mut self) -> Camera {
        let Prepared { model, up, focus, .. } = self.prepared;
        let bounds = focus.map_or(model.scene.bounding_box(), |focus| focus.bounds());
        let find = || {
            let camera = default_camera((self.display)(), &model.accel, *up, bounds);
            // The report states this camera, so its numbers are short.
            plan::Camera::of_scene(&camera).and_then(|camera| camera.to_scene(*up)).unwrap_or(camera)
        };
        self.default.get_or_insert_with(find).clone()
    }
}

/// Returns how an image is shown in false colors.
fn false_colors(image: &Image, units: Units) -> FalseColors {
    let (title, unit) = match image.show {
        Show::Illuminance => (units.irradiance_name(), units.irradiance()),
        _ => (units.radiance_name(), units.radiance()),
    };
    FalseColors {
        title: title.into(),
        unit: unit.into(),
        limits: image.limits,
        is_logarithmic: image.color_scale() == ColorScale::Logarithmic,
        shows_sky: image.show != Show::Illuminance,
    }
}

/// Returns the render settings of an image.
pub(crate) fn settings(image: &Image, camera: Option<&Camera>, threads: usize) -> PictureSettings {
    let shape = camera.and_then(|c| c.aspect).map_or(DEFAULT_SHAPE, |aspect| 1.0 / aspect);
    let height = (f64::from(image.width) * shape).round().clamp(1.0, 16_384.0);
    PictureSettings {
        width: image.width,
        height: image.height.unwrap_or(height as u32),
        grid: image.samples,
        threads,
    }
}

/// Returns true if an output is a denoised image or lightmap. EXR images are never denoised.
pub(crate) fn is_denoised(output: &Output) -> bool {
    match output {
        Output::Image(image) => image.denoise && !has_extension(output.path(), "exr"),
        Output::Lightmap(lightmap) => lightmap.denoise,
        _ => false,
    }
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}
