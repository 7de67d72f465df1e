//! Estimates the memory that a run needs.

use glam::DVec3;
use sir_geom::Rgb;
use sir_mesh::{Per, SideSums, Subdivision};
use sir_radiosity::{
    Measurement, Model, ProbeMeasurement, Quanta, RepeatedMeasurements, RepeatedProbes, Repeats,
};

use crate::error::Error;
use crate::format::bytes;
use crate::memory;
use crate::plan::{Action, Lightmap, Output, Pipeline, Stage};
use crate::prepare::cameras::chosen_camera;
use crate::prepare::layout::Placed;
use crate::prepare::prepared::Prepared;
use crate::progress::Progress;
use crate::run::save::{is_denoised, settings};

/// Bytes per side for its power and the variance of it.
const POWER_BYTES: usize = size_of::<Quanta>() + size_of::<[f32; 3]>();

/// Bytes per side while lines are traced. In a second shot: power, two tally records of 64 bytes, a source. In batches: power,
/// one record, the state of the side (72 bytes), and what lines have brought to it (48 bytes).
const LINES_BYTES: usize = POWER_BYTES + 64 + 72 + 48;

/// Bytes of the program itself and of its buffers, of which copies of tallies for several threads are the largest.
const PROGRAM_BYTES: usize = 32 << 20;

/// Bytes per side of the display mesh of images and lit meshes, of patches that are triangles and of patches of surfaces:
/// measured, rounded up. A cell is shown as four triangles around its center.
const DISPLAY_BYTES: [usize; 2] = [200, 500];

/// Bytes per triangle that finding the surfaces needs, and that the process keeps: measured, rounded up.
const SURFACE_BYTES: usize = 200;

/// Bytes per side for a page while it is coded, and for its coded light: measured, rounded up.
const PAGE_BYTES: usize = 250;

/// Bytes per texel of a lightmap while its files are written, and those of the direct light: measured, rounded up.
const TEXEL_BYTES: [usize; 2] = [90, 45];

/// Bytes per side of a triangle while surfaces are unfolded: measured, rounded up.
const UNFOLD_BYTES: usize = 1_000;

/// Bytes per light of the scene without a surface, besides its source: measured, rounded up.
const LIGHT_BYTES: usize = 700;

/// Share of a page that charts fill, at least.
const FILLED: f64 = 0.4;

/// Bytes per pixel of the largest image: colors while it is rendered and when it is finished, and its file.
const PIXEL_BYTES: usize = 2 * 24 + 16;

/// Returns the memory that a lightmap needs in addition to a display mesh \[bytes\].
fn lightmap_bytes(lightmap: &Lightmap, Model { scene, mesh, .. }: &Model) -> usize {
    let of_page = f64::from(lightmap.size).powi(2);
    let texels = match lightmap.texels_per_meter {
        Some(texels) => {
            let sides = 2.0 * scene.total_area() * texels * texels / FILLED;
            of_page * (sides / of_page).ceil()
        }
        None => f64::from(lightmap.pages) * of_page,
    };
    let per_texel = TEXEL_BYTES[0] + usize::from(lightmap.direct) * TEXEL_BYTES[1];
    let sides: usize = scene.triangle_ids().map(|t| mesh.sides_of(t).len()).sum();
    texels as usize * per_texel + sides * UNFOLD_BYTES
}

/// Reports the peak memory of a run. Returns an error if it exceeds the available memory.
pub(crate) fn check_memory(
    prepared: &Prepared,
    pipeline: &Pipeline,
    progress: &dyn Progress,
) -> Result<(), Error> {
    let (parts, most) = memory(prepared, pipeline);
    progress.note(&format!("Memory: {} at most", bytes(most)));
    memory::refuse_more_than_available(needed_besides_model(&parts))
}

/// Returns the memory that a run needs in addition to its scene, patches and acceleration structure \[bytes\], from the
/// result of `memory`.
pub(super) fn needed_besides_model(memory: &[(&'static str, usize)]) -> usize {
    memory.iter().skip(3).map(|part| part.1).max().unwrap_or(0)
}

/// Returns the size of the file of a light group \[bytes\]; zero without light groups.
pub(super) fn group_file_bytes(prepared: &Prepared, pipeline: &Pipeline) -> usize {
    if prepared.groups.is_empty() {
        return 0;
    }
    let Model { scene, mesh, .. } = &prepared.model;
    let colors = 2 + usize::from(pipeline.shows_direct());
    // At most two sides of each triangle have a row in a table; few materials and groups do.
    let of_triangles = pipeline.parts_of_tables().into_iter().filter(|per| *per < Per::Material).count();
    let rows = 2 * scene.triangles().len() * of_triangles;
    let light = mesh.side_count() * colors * size_of::<Rgb>() + rows * size_of::<[Rgb; 2]>();
    let measured = prepared.placed.values().map(|placed| match placed {
        Placed::Sensors(layout) => layout.sensors.len() * size_of::<Measurement>(),
        Placed::Probes(grid) => grid.valid.len() * size_of::<ProbeMeasurement>(),
    });
    results(pipeline) * light + measured.sum::<usize>()
}

/// Returns the number of stages after which the light is shown or measured.
fn results(pipeline: &Pipeline) -> usize {
    let has_lines = |stage: &Stage| stage.action.lines() > 0;
    let stages = pipeline.stages.iter().zip(pipeline.stages.iter().skip(1).map(Some).chain([None]));
    stages.filter(|(stage, next)| has_lines(stage) && !next.is_some_and(has_lines)).count()
}

/// Returns the memory of a run per part, and its peak \[bytes\].
pub(super) fn memory(prepared: &Prepared, pipeline: &Pipeline) -> (Vec<(&'static str, usize)>, usize) {
    let Model { scene, mesh, accel } = &prepared.model;
    let sides = mesh.side_count();
    let solution = 2 * size_of::<Rgb>();
    let has_surfaces = |stage: &Stage| match &stage.action {
        Action::Subdivide(subdivide) => matches!(subdivide.subdivision(), Subdivision::Surfaces(_)),
        _ => false,
    };
    let surfaces = usize::from(pipeline.stages.iter().any(has_surfaces));
    // The light is summed over repeats wherever it is shown or measured.
    let results = results(pipeline);
    let used = results + usize::from(pipeline.shows_direct());
    let page = usize::from(pipeline.has_page());
    // The pilot of a `Solve` keeps its first shot, before anything is summed.
    let pilot = usize::from(pipeline.flat_stages().any(|stage| matches!(stage.action, Action::Solve(_))));
    let tracing = LINES_BYTES + (pilot * POWER_BYTES).max(used * Repeats::BYTES_PER_SIDE);
    // Sums of tables: at most two sides of each triangle have one, and a piece of each patch is usual.
    let sums = pipeline.parts_of_tables().into_iter().map(|per| {
        let most = if per < Per::Material { 2 * scene.triangles().len() } else { 0 };
        let pieces = sides + 2 * scene.triangles().len();
        used * most * Repeats::BYTES_PER_PART + pieces * SideSums::BYTES_PER_PIECE
    });
    // Measurements are kept until the end, beside the light.
    let measured = prepared.placed.values().map(|placed| match placed {
        Placed::Sensors(layout) => layout.sensors.len() * RepeatedMeasurements::BYTES_PER_SENSOR,
        Placed::Probes(grid) => {
            grid.len() * size_of::<Option<f64>>() + grid.valid.len() * RepeatedProbes::BYTES_PER_PROBE
        }
    });
    let measured: usize = measured.sum();
    let shown = pipeline.outputs().any(|o| !matches!(o, Output::Table(_)));
    // EXR images need a display mesh of standard errors, too.
    let has_errors =
        pipeline.outputs().any(|o| o.path().extension().is_some_and(|e| e.eq_ignore_ascii_case("exr")));
    // Denoised images need a display mesh of their own. Making it takes less memory than the mesh itself.
    let denoise = pipeline.outputs().any(is_denoised);
    let displays = usize::from(shown) + usize::from(has_errors) + usize::from(denoise);
    let pixels = pipeline.outputs().filter_map(|o| match o {
        Output::Image(image) => {
            // Only its shape matters.
            let camera = chosen_camera(image, scene, DVec3::Y);
            let size = settings(image, camera.as_ref(), 1);
            Some(size.width as usize * size.height as usize)
        }
        _ => None,
    });
    let lightmaps = pipeline.outputs().filter_map(|output| match output {
        Output::Lightmap(lightmap) => Some(lightmap_bytes(lightmap, &prepared.model)),
        _ => None,
    });
    // The light of a group, read from its file, is added to that of the others.
    let mixing = 2 * group_file_bytes(prepared, pipeline) / results.max(1);
    let memory = vec![
        (
            "scene",
            size_of_val(scene.vertices())
                + size_of_val(scene.triangles())
                + scene.appearance_bytes()
                + scene.lights().len() * LIGHT_BYTES
                + size_of_val(prepared.sources.as_slice()),
        ),
        ("patches", mesh.bytes() + mesh.paint_bytes() + surfaces * SURFACE_BYTES * scene.triangles().len()),
        ("acceleration structure", accel.bytes()),
        ("computing the light", sides * tracing + sums.sum::<usize>() + measured),
        (
            "pictures, lit meshes, lightmaps and pages",
            sides * displays.min(1) * solution
                + mixing
                + sides * displays * DISPLAY_BYTES[surfaces]
                + sides * page * PAGE_BYTES
                + (pixels.max().unwrap_or(0) * PIXEL_BYTES).max(lightmaps.max().unwrap_or(0)),
        ),
    ];
    // The last two parts are not needed at the same time.
    let [scene, patches, accel, light, display] = [0, 1, 2, 3, 4].map(|i: usize| memory[i].1);
    (memory, PROGRAM_BYTES + scene + patches + accel + light.max(display))
}
