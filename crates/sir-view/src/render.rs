//! Rendering of pictures by rays from the camera.

use std::thread;

use sir_accel::{Accel, Hit, Ray, Tracer};
use sir_geom::{Camera, Line, Rgb, Scene, luminance};
use sir_lines::{Purpose, Streams};

use crate::camera_rays::CameraRays;
use crate::display::DisplayMesh;
use crate::error::ViewError;
use crate::exposure::Exposure;
use crate::picture::{Picture, PictureSettings};

/// Renders what a camera sees.
///
/// Backs of one-sided surfaces are transparent to the camera, although they are opaque to light: a closed room seen
/// from outside looks as if the walls in front were cut away. A ray that meets nothing sees the sky of the scene, or
/// black. Surfaces with gaps are composited front to back, without noise: each contributes its opacity times what the
/// surfaces before it let through. Textures are filtered to the size of a pixel. A picture of errors adds up the errors
/// of everything that is seen.
///
/// The camera's vertical field of view is kept for any aspect ratio of the picture.
///
/// # Errors
///
/// If the picture is empty, or larger than 65,535 pixels in one direction.
pub fn render(
    display: &DisplayMesh<'_>,
    accel: &Accel,
    camera: &Camera,
    settings: PictureSettings,
) -> Result<Picture, ViewError> {
    draw(display, accel, camera, settings, Quantity::Radiance)
}

/// Renders the irradiance \[W/m²\] of the surfaces that a camera sees, in place of their radiance. A ray that meets nothing
/// has zero.
///
/// # Errors
///
/// As [`render`].
pub fn render_irradiance(
    display: &DisplayMesh<'_>,
    accel: &Accel,
    camera: &Camera,
    settings: PictureSettings,
) -> Result<Picture, ViewError> {
    draw(display, accel, camera, settings, Quantity::Irradiance)
}

/// Quantity that a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    Radiance,
    Irradiance,
}

fn draw(
    display: &DisplayMesh<'_>,
    accel: &Accel,
    camera: &Camera,
    settings: PictureSettings,
    quantity: Quantity,
) -> Result<Picture, ViewError> {
    settings.check()?;
    let PictureSettings { width, height, threads, .. } = settings;
    let shader = Shader {
        display,
        rays: CameraRays::new(camera, f64::from(width) / f64::from(height)),
        settings,
        quantity,
        knee: 1.0 / Exposure::Auto.factor_for_mesh(display),
    };
    let mut pixels = vec![Pixel::default(); width as usize * height as usize];
    // Rows are assigned to threads in turn, because some parts of a picture take longer than others.
    let count = threads.clamp(1, height as usize);
    let mut rows_of_threads: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
    for (y, row) in (0..).zip(pixels.chunks_exact_mut(width as usize)) {
        rows_of_threads[y as usize % count].push((y, row));
    }
    thread::scope(|scope| {
        for rows in rows_of_threads {
            scope.spawn(|| {
                let mut tracer = accel.tracer();
                for (y, row) in rows {
                    for (x, pixel) in (0..).zip(row) {
                        *pixel = shader.pixel(&mut tracer, x, y);
                    }
                }
            });
        }
    });
    let radiance = pixels.iter().map(|p| p.radiance).collect();
    let shown = pixels.iter().map(|p| p.shown).collect();
    let surface = pixels.iter().map(|p| p.surface).collect();
    Ok(Picture { width, height, radiance, shown, surface })
}

#[derive(Clone, Copy, Default)]
struct Pixel {
    radiance: [f32; 3],
    shown: [f32; 3],
    surface: f32,
}

struct Shader<'a> {
    display: &'a DisplayMesh<'a>,
    rays: CameraRays,
    settings: PictureSettings,
    quantity: Quantity,
    /// Luminance above which a ray has less weight in `Pixel::shown` \[W/(m² sr)\].
    knee: f64,
}

impl Shader<'_> {
    fn pixel(&self, tracer: &mut Tracer<'_>, x: u32, y: u32) -> Pixel {
        let PictureSettings { width, height, grid, .. } = self.settings;
        let index = u64::from(y) * u64::from(width) + u64::from(x);
        let mut stream = Streams::new(0, Purpose::PICTURE).line(index);
        let grid = grid.max(1);
        let (mut sum, mut weighted, mut weights, mut covered) = (Rgb::ZERO, Rgb::ZERO, 0.0, 0.0);
        let rays: Vec<Line> = (0..grid * grid)
            .map(|cell| {
                let within = |k: u32, random: f64| (f64::from(k) + random) / f64::from(grid);
                let right = (f64::from(x) + within(cell % grid, stream.unit())) / f64::from(width);
                let down = (f64::from(y) + within(cell / grid, stream.unit())) / f64::from(height);
                self.rays.ray(right, down)
            })
            .collect();
        self.trace(tracer, &rays, |ray, RaySample { radiance, coverage }| {
            covered += coverage;
            let shows_sky = self.display.emits && self.quantity == Quantity::Radiance;
            let sky = self.display.scene.sky().filter(|_| shows_sky);
            let sky = || sky.map_or(Rgb::ZERO, |sky| sky.radiance(ray.direction));
            let radiance = if coverage < 1.0 { radiance + (1.0 - coverage) * sky() } else { radiance };
            sum += radiance;
            let weight = 1.0 / (1.0 + luminance(radiance) / self.knee);
            weighted += weight * radiance;
            weights += weight;
        });
        Pixel {
            radiance: (sum / f64::from(grid * grid)).as_vec3().to_array(),
            shown: (weighted / weights).as_vec3().to_array(),
            surface: (covered / f64::from(grid * grid)) as f32,
        }
    }
}

/// Surfaces seen along a ray.
#[derive(Clone, Copy)]
struct RaySample {
    /// Radiance \[W/(m² sr)\].
    radiance: Rgb,
    /// Share of the ray that ends at one of the surfaces.
    coverage: f64,
}

/// Largest number of surfaces with gaps that are composited along a ray.
const MAX_LAYERS: usize = 64;

impl Shader<'_> {
    /// Traces rays, in order, and calls `visit` with each of them and the surfaces that it sees.
    fn trace(&self, tracer: &mut Tracer<'_>, rays: &[Line], mut visit: impl FnMut(&Line, RaySample)) {
        if tracer.accel().has_transparency() {
            let mut next = 0;
            tracer.all_crossings_each(rays, |crossings| {
                for (range, ray) in crossings.lines().zip(&rays[next..]) {
                    visit(ray, self.composite(ray, &crossings.hits()[range]));
                    next += 1;
                }
            });
            return;
        }
        let from: Vec<Ray> = rays.iter().map(|&ray| ray.into()).collect();
        let mut firsts = vec![None; rays.len()];
        tracer.closest_each(&from, |i, first| firsts[i] = first);
        for (ray, first) in rays.iter().zip(firsts) {
            let hit = first_visible(self.display.scene, tracer, ray, first);
            let radiance = hit.map(|hit| self.radiance(ray, &hit));
            visit(
                ray,
                RaySample {
                    radiance: radiance.unwrap_or(Rgb::ZERO),
                    coverage: f64::from(u8::from(hit.is_some())),
                },
            );
        }
    }

    /// Composites surfaces with gaps front to back: each contributes its opacity times what those before it let
    /// through.
    fn composite(&self, ray: &Line, crossings: &[Hit]) -> RaySample {
        let scene = self.display.scene;
        let visible = |hit: &&Hit| hit.t >= 0.0 && scene.is_active(hit.triangle, hit.side);
        let opacity = |hit: &Hit| scene.opacity_at(hit.triangle, hit.point);
        let layers = crossings.iter().filter(visible).map(|hit| (hit, opacity(hit)));
        let (mut radiance, mut transmittance) = (Rgb::ZERO, 1.0);
        for (hit, opacity) in layers.filter(|layer| layer.1 > 0.0).take(MAX_LAYERS) {
            radiance += transmittance * opacity * self.radiance(ray, hit);
            transmittance *= 1.0 - opacity;
            if transmittance == 0.0 {
                break;
            }
        }
        RaySample { radiance, coverage: 1.0 - transmittance }
    }

    /// Returns the radiance \[W/(m² sr)\] of a side that a ray meets, `B/π` unless its own light is directional; or its
    /// irradiance \[W/m²\].
    fn radiance(&self, ray: &Line, hit: &Hit) -> Rgb {
        let Self { display, rays, settings, .. } = self;
        let Hit { t, triangle, point, side } = *hit;
        let Some(e) = display.irradiance_at(triangle, point, side) else { return Rgb::ZERO };
        if self.quantity == Quantity::Irradiance {
            return e;
        }
        let slant = display.scene.normal(triangle).dot(ray.direction).abs().max(1e-3);
        // Square root of the surface area that the ray covers.
        let width = rays.spacing(t) / f64::from(settings.height * settings.grid.max(1)) / slant.sqrt();
        let radiosity = display.radiosity_at(triangle, point, side, e, width);
        let relative = display.scene.relative_radiance(triangle, -ray.direction);
        let excess =
            if relative == 1.0 { Rgb::ZERO } else { (relative - 1.0) * display.emitted(triangle, side) };
        (radiosity + excess) / std::f64::consts::PI
    }
}

/// Returns the first hit of a ray that is not on the back of a one-sided surface, given its first hit.
fn first_visible(scene: &Scene, tracer: &mut Tracer<'_>, ray: &Line, first: Option<Hit>) -> Option<Hit> {
    let is_visible = |hit: &Hit| scene.is_active(hit.triangle, hit.side);
    let first = first?;
    if is_visible(&first) {
        return Some(first);
    }
    tracer.all_hits(ray).iter().find(|hit| hit.t >= first.t && is_visible(hit)).copied()
}
