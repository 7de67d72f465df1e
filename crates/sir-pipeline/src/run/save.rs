//! Writing what a `Save` stage asks for.

use std::fs;
use std::path::Path;

use sir_geom::Camera;
use sir_radiosity::{Model, Solution};
use sir_view::{DisplayMesh, Exposure, Picture, PictureSettings, Table, ViewError};
use sir_view::{default_camera, render, write_exr, write_glb, write_png};

use crate::error::Error;
use crate::plan::{Image, Output};
use crate::prepare::cameras::chosen_camera;
use crate::prepare::prepared::Prepared;
use crate::progress::Progress;
use crate::report::result::OutputReport;

/// Height of a picture whose camera does not say what shape it has, as a share of its width.
const DEFAULT_SHAPE: f64 = 0.75;

/// Writes the outputs of a stage into a directory, one after the other, as long as `written` wants another one.
pub(crate) fn save(
    prepared: &Prepared,
    solution: &Solution,
    outputs: &[Output],
    directory: &Path,
    threads: usize,
    progress: &dyn Progress,
    written: &mut dyn FnMut(OutputReport) -> bool,
) -> Result<(), Error> {
    let Model { scene, mesh, accel } = &prepared.model;
    let seen = outputs.iter().any(|o| !matches!(o, Output::Table(_)));
    let display = seen.then(|| DisplayMesh::new(scene, mesh, &solution.irradiance));
    let denoise = match &display {
        Some(display) if outputs.iter().any(is_denoised) => display.denoise(&solution.error, threads),
        _ => Vec::new(),
    };
    let denoise = (!denoise.is_empty()).then(|| DisplayMesh::new(scene, mesh, &denoise));
    let errors = outputs
        .iter()
        .any(|o| matches!(o, Output::Image(_)) && has_extension(o.path(), "exr"))
        .then(|| DisplayMesh::of_errors(scene, mesh, &solution.error));
    let mut studio = display.as_ref().map(|display| Studio {
        prepared,
        display,
        denoise: denoise.as_ref(),
        threads,
        last: None,
        default: None,
    });
    for output in outputs {
        let path = directory.join(output.path());
        progress.note(&format!("Save: {}", output.path().display()));
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(Error::directory(parent))?;
        }
        let kind = match (output, &mut studio) {
            (Output::Image(image), Some(studio)) => {
                let Taken { camera, settings, picture, .. } = studio.take(image, is_denoised(output))?;
                match &errors {
                    Some(errors) if has_extension(&path, "exr") => {
                        let errors = render(errors, accel, camera, *settings)?;
                        write_exr(&path, picture, &[("error", &errors)])?;
                    }
                    _ => write_png(&path, picture, image.exposure)?,
                }
                "image"
            }
            (Output::Gltf(_), Some(studio)) => {
                write_glb(&path, studio.display, Exposure::Auto, scene.cameras(), prepared.up)?;
                "gltf"
            }
            _ => {
                let table = Table::new(scene, mesh, &solution.irradiance, &solution.error);
                if has_extension(&path, "npy") {
                    table.write_npy(&path)?
                } else {
                    table.write_csv(&path)?
                }
                "table"
            }
        };
        let bytes = fs::metadata(&path).map_err(|source| ViewError::Io { what: "read", path, source })?.len();
        let path = output.path().to_string_lossy().into_owned();
        if !written(OutputReport { path, kind: kind.into(), bytes }) {
            break;
        }
    }
    Ok(())
}

/// Takes pictures. The last one is kept, because the same is often wanted as PNG and as EXR.
struct Studio<'a> {
    prepared: &'a Prepared,
    display: &'a DisplayMesh<'a>,
    /// The same without noise, if a picture is to be without.
    denoise: Option<&'a DisplayMesh<'a>>,
    threads: usize,
    last: Option<Taken>,
    default: Option<Camera>,
}

/// A picture, and how it was taken.
struct Taken {
    camera: Camera,
    settings: PictureSettings,
    is_denoised: bool,
    picture: Picture,
}

impl Studio<'_> {
    fn take(&mut self, image: &Image, is_denoised: bool) -> Result<&Taken, Error> {
        let Model { scene, accel, .. } = &self.prepared.model;
        let chosen = chosen_camera(image, scene);
        let settings = settings(image, chosen.as_ref(), self.threads);
        let camera = chosen.unwrap_or_else(|| self.default_camera());
        let taken = match self.last.take() {
            Some(last)
                if (&last.camera, last.settings, last.is_denoised) == (&camera, settings, is_denoised) =>
            {
                last
            }
            _ => {
                let display = self.denoise.filter(|_| is_denoised).unwrap_or(self.display);
                Taken { picture: render(display, accel, &camera, settings)?, camera, settings, is_denoised }
            }
        };
        Ok(self.last.insert(taken))
    }

    /// The camera of a scene that has none, which takes a while to find.
    fn default_camera(&mut self) -> Camera {
        let Prepared { model, up, .. } = self.prepared;
        self.default.get_or_insert_with(|| default_camera(self.display, &model.accel, *up)).clone()
    }
}

/// The size of a picture, and how it is made.
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

/// Whether an output is a picture without noise. Those for measuring show what was computed.
pub(crate) fn is_denoised(output: &Output) -> bool {
    matches!(output, Output::Image(image) if image.denoise) && !has_extension(output.path(), "exr")
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}
