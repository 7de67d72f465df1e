//! Texels: exact means of the light over what each texel covers.
//!
//! The light is interpolated between the vertices of the display mesh, with values that keep the power of patches. Polygons
//! are cut exactly at the edges of texels; over each part, the mean of a linear function is its value at the centroid.

use std::thread;

use glam::{DAffine2, DMat2, DVec2, DVec3};
use sir_geom::{Barycentric, Rgb, Scene, Side, TriangleId};
use sir_mesh::{PatchId, PatchMesh, Piece};
use sir_view::{DisplayMesh, DisplayPiece};

use crate::clip::{Clipper, area_and_centroid, intersect};
use crate::error::LightmapError;
use crate::layout::{Layout, OnPage};
use crate::objects::Objects;
use crate::observer::{Observer, Step};
use crate::options::LightmapSides;

/// Number of sides that a thread works on at a time.
const BLOCK: usize = 2_048;

/// Least share of a patch that counts as covered, so that patches that are all gap have texels, too.
const LEAST_COVERED: f64 = 1e-6;

/// Texels of all pages, page by page and row by row.
#[derive(Clone, Debug)]
pub(crate) struct Texels {
    /// Mean irradiance \[W/m²\].
    pub(crate) light: Vec<[f32; 3]>,
    /// Standard error of the irradiance \[W/m²\].
    pub(crate) error: Vec<[f32; 3]>,
    /// Area that is covered by surfaces that stop light \[m²\].
    pub(crate) area: Vec<f32>,
    /// Share of the texel that is covered by charts.
    pub(crate) coverage: Vec<f32>,
    /// Mean opacity; empty unless radiosity is shown.
    pub(crate) opacity: Vec<f32>,
    /// Area that has no texels, because it cannot be unfolded \[m²\].
    pub(crate) lost: f64,
}

/// What the texels show.
pub(crate) struct Light<'a> {
    pub(crate) display: &'a DisplayMesh<'a>,
    /// Irradiance at the vertices of the display mesh \[W/m²\].
    pub(crate) vertices: &'a [Rgb],
    /// Standard errors there \[W/m²\].
    pub(crate) errors: &'a [Rgb],
    /// True to show the radiosity, with textures, in place of the irradiance.
    pub(crate) is_radiosity: bool,
}

/// Light that a patch gives to a texel.
#[derive(Clone, Copy)]
struct Contribution {
    texel: u32,
    coverage: f64,
    /// Covered area \[m²\].
    area: f64,
    /// Part of it that is opaque \[m²\], if radiosity is shown.
    opaque: f64,
    /// Power \[W\].
    power: Rgb,
    /// Standard error of the power \[W\].
    deviation: Rgb,
}

/// Returns the texels of a layout.
pub(crate) fn fill(
    objects: &Objects,
    layout: &Layout,
    light: &Light<'_>,
    sides: LightmapSides,
    threads: usize,
    observer: &dyn Observer,
) -> Result<Texels, LightmapError> {
    let count = layout.pages as usize * layout.width as usize * layout.height as usize;
    let mut texels = Texels {
        light: vec![[0.0; 3]; count],
        error: vec![[0.0; 3]; count],
        area: vec![0.0; count],
        coverage: vec![0.0; count],
        opacity: vec![0.0; if light.is_radiosity { count } else { 0 }],
        lost: 0.0,
    };
    // The pieces of a side may be shown with several triangles.
    let mut pieces: Vec<DisplayPiece<'_>> = light.display.pieces().collect();
    pieces.sort_by_key(|piece| piece.id);
    let groups: Vec<&[DisplayPiece<'_>]> = pieces.chunk_by(|a, b| a.id == b.id).collect();
    let (scene, mesh) = (light.display.scene(), light.display.mesh());
    let threads = threads.max(1);
    for (number, blocks) in groups.chunks(threads * BLOCK).enumerate() {
        let work = |groups: &[&[DisplayPiece<'_>]]| {
            let mut filler = Filler::new(scene, mesh, objects, layout, light, sides);
            groups.iter().for_each(|group| filler.add(group));
            (filler.contributions, filler.lost)
        };
        let found: Vec<(Vec<Contribution>, f64)> = thread::scope(|scope| {
            let all: Vec<_> = blocks.chunks(BLOCK).map(|block| scope.spawn(move || work(block))).collect();
            // A panic of a thread goes on here.
            all.into_iter()
                .map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
                .collect()
        });
        // In this order the sums do not depend on the number of threads.
        for (contributions, lost) in found {
            contributions.iter().for_each(|contribution| texels.add(contribution));
            texels.lost += lost;
        }
        let done = (number * threads * BLOCK + blocks.len()) as u64;
        if !observer.progress(Step::Filling, done, Some(groups.len() as u64)) {
            return Err(LightmapError::Stopped);
        }
    }
    texels.finish();
    Ok(texels)
}

impl Texels {
    fn add(&mut self, contribution: &Contribution) {
        let Contribution { texel, coverage, area, opaque, power, deviation } = *contribution;
        // Patches have independent errors.
        let variance = deviation * deviation;
        let i = texel as usize;
        self.area[i] += area as f32;
        self.coverage[i] += coverage as f32;
        if let Some(opacity) = self.opacity.get_mut(i) {
            *opacity += opaque as f32;
        }
        for band in 0..3 {
            self.light[i][band] += power[band] as f32;
            self.error[i][band] += variance[band] as f32;
        }
    }

    /// Turns sums into means.
    fn finish(&mut self) {
        for (i, &area) in self.area.iter().enumerate().filter(|(_, area)| **area > 0.0) {
            self.light[i] = self.light[i].map(|power| power / area);
            self.error[i] = self.error[i].map(|variance| variance.sqrt() / area);
            if let Some(opacity) = self.opacity.get_mut(i) {
                *opacity /= area;
            }
        }
    }

    /// Returns true if a texel is covered, at least in part.
    pub(crate) fn is_covered(&self, texel: usize) -> bool {
        self.area[texel] > 0.0
    }
}

/// Part of a patch in one triangle of the scene and one triangle of the display mesh.
struct Part {
    triangle: TriangleId,
    /// Range of its corners in `Filler::corners`, which are barycentric coordinates.
    corners: std::ops::Range<usize>,
    /// Interpolated irradiance as a function of barycentric coordinates.
    light: Linear,
    /// Its standard error, likewise.
    error: Linear,
    /// Area \[m²\].
    area: f64,
}

/// Irradiance as a linear function in the plane.
#[derive(Clone, Copy)]
struct Linear {
    start: Rgb,
    slope: [Rgb; 2],
}

impl Linear {
    /// Returns the function with these values at three points.
    fn through([a, b, c]: [DVec2; 3], values: [Rgb; 3]) -> Self {
        let inverse = DMat2::from_cols(b - a, c - a).inverse();
        let (b, c) = (values[1] - values[0], values[2] - values[0]);
        let slope =
            [b * inverse.x_axis.x + c * inverse.x_axis.y, b * inverse.y_axis.x + c * inverse.y_axis.y];
        Self { start: values[0] - slope[0] * a.x - slope[1] * a.y, slope }
    }

    /// Returns the value at a point, which is not below zero.
    fn at(&self, p: DVec2) -> Rgb {
        (self.start + self.slope[0] * p.x + self.slope[1] * p.y).max(Rgb::ZERO)
    }
}

struct Filler<'a> {
    scene: &'a Scene,
    mesh: &'a PatchMesh,
    objects: &'a Objects,
    layout: &'a Layout,
    light: &'a Light<'a>,
    sides: LightmapSides,
    contributions: Vec<Contribution>,
    /// Area without texels \[m²\].
    lost: f64,
    parts: Vec<Part>,
    corners: Vec<DVec2>,
    clipper: Clipper,
    polygon: Vec<DVec2>,
    spare: Vec<DVec2>,
}

impl<'a> Filler<'a> {
    fn new(
        scene: &'a Scene,
        mesh: &'a PatchMesh,
        objects: &'a Objects,
        layout: &'a Layout,
        light: &'a Light<'a>,
        sides: LightmapSides,
    ) -> Self {
        Self {
            scene,
            mesh,
            objects,
            layout,
            light,
            sides,
            contributions: Vec::new(),
            lost: 0.0,
            parts: Vec::new(),
            corners: Vec::new(),
            clipper: Clipper::default(),
            polygon: Vec::new(),
            spare: Vec::new(),
        }
    }

    /// Adds the light of one side of a patch.
    fn add(&mut self, group: &[DisplayPiece<'_>]) {
        let Some(&DisplayPiece { triangle, side, id, .. }) = group.first() else { return };
        // Without a second chart, the back is left out, or has the texels of the front.
        let texels_of = match (side, self.sides) {
            (Side::Back, LightmapSides::Front) => return,
            (_, LightmapSides::Mean) => Side::Front,
            _ => side,
        };
        let patch = self.mesh.patch_of_side(triangle, id);
        self.parts.clear();
        self.corners.clear();
        for piece in group {
            self.collect(piece, patch);
        }
        let covered = self.mesh.covered_area(triangle, patch) / self.mesh.patch_area(triangle, patch);
        let covered = covered.max(LEAST_COVERED);
        let first = self.contributions.len();
        let parts = std::mem::take(&mut self.parts);
        let mut on_page: Option<(TriangleId, Option<OnPage>)> = None;
        for part in &parts {
            let place = match on_page {
                Some((of, place)) if of == part.triangle => place,
                _ => self.layout.locate(self.objects, self.scene, part.triangle, texels_of),
            };
            on_page = Some((part.triangle, place));
            match place {
                Some(place) => self.distribute(part, &place, covered, side),
                None if self.layout.has(self.objects, part.triangle, texels_of) => self.lost += part.area,
                None => {}
            }
        }
        self.parts = parts;
        self.merge(first);
    }

    /// Collects the parts of a piece of the display mesh in the pieces of the patch.
    fn collect(&mut self, piece: &DisplayPiece<'_>, patch: PatchId) {
        let is_cell = self.mesh.divisions(piece.triangle).is_none();
        let of_patch: Vec<Piece> = self
            .mesh
            .pieces(piece.triangle, patch)
            .filter(|of| is_cell || of.triangle == piece.triangle)
            .collect();
        let Light { display, vertices, errors, .. } = *self.light;
        let position = |v: u32| display.positions()[display.vertices()[v as usize].position as usize];
        for of in &of_patch {
            let flat = Flat::new(self.scene.corners(of.triangle));
            for t in piece.triangles {
                let light = t.map(|v| vertices[v as usize]);
                let error = t.map(|v| errors[v as usize]);
                self.cut(of, t.map(|v| flat.place(position(v))), light, error);
            }
        }
    }

    /// Adds the common part of a piece of a patch and a triangle in the same plane.
    fn cut(&mut self, piece: &Piece, triangle: [DVec2; 3], light: [Rgb; 3], error: [Rgb; 3]) {
        self.polygon.clear();
        self.polygon.extend(piece.corners().iter().map(|p| DVec2::new(p.v, p.w)));
        let [a, b, c] = triangle;
        if (b - a).perp_dot(c - a) == 0.0 {
            return;
        }
        intersect(&mut self.polygon, triangle, &mut self.spare);
        let (area, centroid) = area_and_centroid(&self.polygon);
        let (light, error) = (Linear::through(triangle, light), Linear::through(triangle, error));
        if area > 0.0 && light.at(centroid).is_finite() {
            let start = self.corners.len();
            self.corners.extend_from_slice(&self.polygon);
            self.parts.push(Part {
                triangle: piece.triangle,
                corners: start..self.corners.len(),
                light,
                error,
                area: 2.0 * self.scene.area(piece.triangle) * area,
            });
        }
    }

    /// Adds the light of a part to its texels.
    fn distribute(&mut self, part: &Part, place: &OnPage, covered: f64, side: Side) {
        let [a, b, c] = place.corners;
        let to_page = DAffine2::from_cols(b - a, c - a, a);
        let determinant = to_page.matrix2.determinant();
        if determinant == 0.0 || !determinant.is_finite() {
            return;
        }
        let to_triangle = to_page.inverse();
        // Area on the surface for each unit of area on the page.
        let spread = 2.0 * self.scene.area(part.triangle) / determinant.abs();
        let corners = &self.corners[part.corners.clone()];
        self.polygon.clear();
        self.polygon.extend(corners.iter().map(|&p| to_page.transform_point2(p)));
        let Layout { width, height, .. } = *self.layout;
        let page = i64::from(place.page) * i64::from(height);
        // Where two sides share texels, each covers them.
        let counts = side == Side::Front || self.sides != LightmapSides::Mean;
        let (scene, light) = (self.scene, self.light);
        let width_of_texel = spread.sqrt();
        let contributions = &mut self.contributions;
        self.clipper.for_each_texel(&self.polygon, |x, y, area, centroid| {
            // Rounding may put a corner on the far edge of the page.
            let (x, y) = (x.clamp(0, i64::from(width) - 1), y.clamp(0, i64::from(height) - 1));
            let on_surface = covered * spread * area;
            let at = to_triangle.transform_point2(centroid);
            let irradiance = part.light.at(at);
            let (shown, opacity) = if light.is_radiosity {
                let point = Barycentric { v: at.x, w: at.y };
                let of = (part.triangle, point);
                (
                    light.display.radiosity_at(of.0, of.1, side, irradiance, width_of_texel),
                    scene.opacity_at(part.triangle, point),
                )
            } else {
                (irradiance, 1.0)
            };
            contributions.push(Contribution {
                texel: ((page + y) * i64::from(width) + x) as u32,
                coverage: if counts { area } else { 0.0 },
                area: on_surface,
                opaque: on_surface * opacity,
                power: on_surface * shown,
                deviation: on_surface * part.error.at(at),
            });
        });
    }

    /// Adds up what one side gives to each texel, from the contribution `first` on.
    fn merge(&mut self, first: usize) {
        self.contributions[first..].sort_by_key(|contribution| contribution.texel);
        let mut kept = first;
        for i in first..self.contributions.len() {
            let next = self.contributions[i];
            if kept > first && self.contributions[kept - 1].texel == next.texel {
                let known = &mut self.contributions[kept - 1];
                known.coverage += next.coverage;
                known.area += next.area;
                known.opaque += next.opaque;
                known.power += next.power;
                known.deviation += next.deviation;
            } else {
                self.contributions[kept] = next;
                kept += 1;
            }
        }
        self.contributions.truncate(kept);
    }
}

/// Barycentric coordinates of points in the plane of a triangle.
struct Flat {
    corner: DVec3,
    v: DVec3,
    w: DVec3,
}

impl Flat {
    fn new([a, b, c]: [DVec3; 3]) -> Self {
        let normal = (b - a).cross(c - a);
        let scale = 1.0 / normal.length_squared();
        Self { corner: a, v: scale * (c - a).cross(normal), w: scale * normal.cross(b - a) }
    }

    fn place(&self, p: DVec3) -> DVec2 {
        DVec2::new((p - self.corner).dot(self.v), (p - self.corner).dot(self.w))
    }
}
