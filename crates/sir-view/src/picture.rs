//! Pictures: the radiance that a camera sees.

use std::thread;

use glam::DVec3;
use sir_accel::{Accel, Hit, Ray, Tracer};
use sir_geom::{Camera, Line, Projection, Rgb, Scene};
use sir_lines::{Stage, Streams};

use crate::display::DisplayMesh;
use crate::error::ViewError;
use crate::tone::Exposure;
use sir_geom::luminance;

/// A picture of linear radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Radiance `L` \[W/(m² sr)\] in linear Rec. 709 bands, row by row from the top left.
    pub radiance: Vec<[f32; 3]>,
    /// The same for a screen: a mean of the rays of a pixel in which those much brighter than what is typical for
    /// the scene count less. It differs from `radiance` only where lamps are partly seen: a pixel a tenth of which
    /// is lamp would be as white as the lamp, and the edge a staircase.
    pub shown: Vec<[f32; 3]>,
    /// Share of the rays of each pixel that met a surface: what the others saw is sky.
    pub surface: Vec<f32>,
}

/// Size and effort of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureSettings {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Rays per pixel in each direction: a pixel is the mean of `grid²` rays, one in each cell of a square grid.
    pub grid: u32,
    /// Threads to use; the picture is the same for any number.
    pub threads: usize,
}

impl PictureSettings {
    /// The largest width and height that every file format can hold.
    const MAX: u32 = 65_535;

    fn check(&self) -> Result<(), ViewError> {
        let fits = |x: u32| (1..=Self::MAX).contains(&x);
        if fits(self.width) && fits(self.height) {
            Ok(())
        } else {
            Err(ViewError::PictureSize { width: self.width, height: self.height })
        }
    }
}

/// Draws what a camera sees.
///
/// Backs of one-sided surfaces are transparent to the camera, though they are opaque to light: one looks into a
/// closed room from outside as if the walls in front were cut away. Where a ray meets nothing it sees the sky of the scene, or black.
/// Surfaces with gaps are seen through without noise: each shows its share of what those before it let through. Textures are
/// shown as fine as pixels are. A picture of errors adds up those of all that is seen.
///
/// The camera's vertical field of view is kept whatever the shape of the picture.
///
/// # Errors
///
/// If the picture is empty or larger than 65,535 pixels in one direction.
pub fn render(
    display: &DisplayMesh<'_>,
    accel: &Accel,
    camera: &Camera,
    settings: PictureSettings,
) -> Result<Picture, ViewError> {
    settings.check()?;
    let PictureSettings { width, height, threads, .. } = settings;
    let shader = Shader {
        display,
        rays: CameraRays::new(camera, f64::from(width) / f64::from(height)),
        settings,
        knee: 1.0 / Exposure::Auto.factor_for_mesh(display),
    };
    let mut pixels = vec![Pixel::default(); width as usize * height as usize];
    // Rows are dealt out in turn, since some parts of a picture take longer than others.
    let count = threads.clamp(1, height as usize);
    let mut hands: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
    for (y, row) in (0..).zip(pixels.chunks_exact_mut(width as usize)) {
        hands[y as usize % count].push((y, row));
    }
    thread::scope(|scope| {
        for hand in hands {
            scope.spawn(|| {
                let mut tracer = accel.tracer();
                for (y, row) in hand {
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
    /// Radiance above which a ray counts less for the screen.
    knee: f64,
}

impl Shader<'_> {
    fn pixel(&self, tracer: &mut Tracer<'_>, x: u32, y: u32) -> Pixel {
        let PictureSettings { width, height, grid, .. } = self.settings;
        let index = u64::from(y) * u64::from(width) + u64::from(x);
        let mut stream = Streams::new(0, Stage::PICTURE).line(index);
        let grid = grid.max(1);
        let (mut sum, mut weighted, mut weights, mut met) = (Rgb::ZERO, Rgb::ZERO, 0.0, 0.0);
        let rays: Vec<Line> = (0..grid * grid)
            .map(|cell| {
                let within = |k: u32, random: f64| (f64::from(k) + random) / f64::from(grid);
                let right = (f64::from(x) + within(cell % grid, stream.unit())) / f64::from(width);
                let down = (f64::from(y) + within(cell / grid, stream.unit())) / f64::from(height);
                self.rays.ray(right, down)
            })
            .collect();
        self.see(tracer, &rays, |ray, Seen { radiance, stopped }| {
            met += stopped;
            let sky = self.display.scene.sky().filter(|_| self.display.emits);
            let sky = || sky.map_or(Rgb::ZERO, |sky| sky.radiance(ray.direction));
            let radiance = if stopped < 1.0 { radiance + (1.0 - stopped) * sky() } else { radiance };
            sum += radiance;
            let weight = 1.0 / (1.0 + luminance(radiance) / self.knee);
            weighted += weight * radiance;
            weights += weight;
        });
        Pixel {
            radiance: (sum / f64::from(grid * grid)).as_vec3().to_array(),
            shown: (weighted / weights).as_vec3().to_array(),
            surface: (met / f64::from(grid * grid)) as f32,
        }
    }
}

/// What a ray sees of surfaces.
#[derive(Clone, Copy)]
struct Seen {
    /// Radiance \[W/(m² sr)\].
    radiance: Rgb,
    /// The share of the ray that ends at one of them.
    stopped: f64,
}

/// As many surfaces with gaps are seen through one another.
const LAYERS: usize = 64;

impl Shader<'_> {
    /// Looks along rays, in order.
    fn see(&self, tracer: &mut Tracer<'_>, rays: &[Line], mut visit: impl FnMut(&Line, Seen)) {
        if tracer.lets_lines_pass() {
            let mut next = 0;
            tracer.all_crossings_each(rays, |crossings| {
                for (range, ray) in crossings.lines().zip(&rays[next..]) {
                    visit(ray, self.through(ray, &crossings.hits()[range]));
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
                Seen { radiance: radiance.unwrap_or(Rgb::ZERO), stopped: f64::from(u8::from(hit.is_some())) },
            );
        }
    }

    /// Looks through the gaps of surfaces: each shows its share of what the ones before it let through.
    fn through(&self, ray: &Line, crossings: &[Hit]) -> Seen {
        let scene = self.display.scene;
        let visible = |hit: &&Hit| hit.t >= 0.0 && scene.is_active(hit.triangle, hit.side);
        let opacity = |hit: &Hit| scene.opacity_at(hit.triangle, hit.point);
        let layers = crossings.iter().filter(visible).map(|hit| (hit, opacity(hit)));
        let (mut radiance, mut left) = (Rgb::ZERO, 1.0);
        for (hit, opacity) in layers.filter(|layer| layer.1 > 0.0).take(LAYERS) {
            radiance += left * opacity * self.radiance(ray, hit);
            left *= 1.0 - opacity;
            if left == 0.0 {
                break;
            }
        }
        Seen { radiance, stopped: 1.0 - left }
    }

    /// Radiance `B/π` of a side that a ray meets.
    fn radiance(&self, ray: &Line, hit: &Hit) -> Rgb {
        let Self { display, rays, settings, .. } = self;
        let Hit { t, triangle, point, side } = *hit;
        let Some(e) = display.irradiance_at(triangle, point, side) else { return Rgb::ZERO };
        let slant = display.scene.normal(triangle).dot(ray.direction).abs().max(1e-3);
        // The root of the area that the ray stands for.
        let width = rays.spacing(t) / f64::from(settings.height * settings.grid.max(1)) / slant.sqrt();
        display.radiosity_at(triangle, point, side, e, width) / std::f64::consts::PI
    }
}

/// The first side along a ray that is not the back of a one-sided surface, given its first hit.
fn first_visible(scene: &Scene, tracer: &mut Tracer<'_>, ray: &Line, first: Option<Hit>) -> Option<Hit> {
    let is_visible = |hit: &Hit| scene.is_active(hit.triangle, hit.side);
    let first = first?;
    if is_visible(&first) {
        return Some(first);
    }
    tracer.all_hits(ray).iter().find(|hit| hit.t >= first.t && is_visible(hit)).copied()
}

/// The rays of a camera.
pub(crate) struct CameraRays {
    eye: DVec3,
    forward: DVec3,
    /// From the middle of the picture to its right and upper edge, at distance one from the eye; for a parallel
    /// projection, in scene units.
    right: DVec3,
    up: DVec3,
    is_parallel: bool,
}

impl CameraRays {
    /// `aspect` is width over height.
    pub(crate) fn new(camera: &Camera, aspect: f64) -> Self {
        let (right, up) = camera_axes(camera);
        let (half, is_parallel) = match camera.projection {
            Projection::Perspective { vertical_fov } => ((0.5 * vertical_fov).tan(), false),
            Projection::Orthographic { height } => (0.5 * height, true),
        };
        Self {
            eye: camera.eye,
            forward: camera.forward,
            right: half * aspect * right,
            up: half * up,
            is_parallel,
        }
    }

    /// The ray through a point of the picture: `(0, 0)` is the upper left corner, `(1, 1)` the lower right.
    pub(crate) fn ray(&self, right: f64, down: f64) -> Line {
        let shift = (2.0 * right - 1.0) * self.right + (1.0 - 2.0 * down) * self.up;
        if self.is_parallel {
            Line { origin: self.eye + shift, direction: self.forward }
        } else {
            Line { origin: self.eye, direction: (self.forward + shift).normalize() }
        }
    }

    /// How far apart two rays are at a distance along them, if one is at the upper edge of the picture and one at the lower.
    fn spacing(&self, t: f64) -> f64 {
        2.0 * self.up.length() * if self.is_parallel { 1.0 } else { t }
    }
}

/// Unit vectors to the right and upwards in the picture of a camera.
pub(crate) fn camera_axes(camera: &Camera) -> (DVec3, DVec3) {
    let right = camera.forward.cross(camera.up);
    // A camera whose `up` is its `forward` may be turned about its axis at will.
    let right = right.try_normalize().unwrap_or_else(|| camera.forward.any_orthonormal_vector());
    (right, right.cross(camera.forward))
}
