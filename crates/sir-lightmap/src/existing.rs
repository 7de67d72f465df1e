//! Layouts that a file already has: a second set of texture coordinates.

use std::collections::BTreeMap;

use glam::{DAffine2, DVec2, DVec3};
use uvunwrap::OutputMesh;

use crate::clip::Clipper;
use crate::connected::{Sets, numbers};
use crate::document::Document;
use crate::error::LightmapError;
use crate::layout::{Layout, NO_CHART, Rectangle, Unfolded};
use crate::objects::{Mesh, Primitive};

/// The set of texture coordinates that engines use for lightmaps.
pub(crate) const LIGHTMAP_SET: u32 = 1;

/// Triangles of the frame of a layout.
pub(crate) const FRAME_TRIANGLES: [u32; 6] = [0, 1, 2, 0, 2, 3];

/// How far coordinates may lie outside of the unit square.
const OUTSIDE: f64 = 1e-4;

/// Number of sample points along an edge of the unit square, to find overlaps.
const SAMPLES: usize = 1024;

/// Share of the samples that may lie in two triangles, because of rounding at their edges.
const OVERLAP: f64 = 2e-3;

/// Share of the area of a mesh that may have no area in the layout.
const COLLAPSED: f64 = 1e-4;

/// A layout of a file that is used.
pub(crate) struct Existing {
    /// Set of texture coordinates.
    pub(crate) set: u32,
    /// Corners of the bounding box of the layout, as a rectangle in the plane with the density of the mesh \[m\].
    pub(crate) frame: Vec<[f32; 3]>,
    low: DVec2,
    size: DVec2,
    primitives: Vec<Unfolded>,
}

/// Returns the layout of a mesh if it has one that can be used; otherwise adds the reason to `notes`. `area` is that of the
/// mesh in the scene \[m²\].
pub(crate) fn of_mesh(
    document: &Document,
    mesh: &Mesh,
    area: f64,
    notes: &mut Vec<String>,
) -> Result<Option<Existing>, LightmapError> {
    let Some(file) = document.file() else { return Ok(None) };
    let mut sets = Vec::with_capacity(mesh.primitives.len());
    for (i, primitive) in mesh.primitives.iter().enumerate() {
        if primitive.triangles.is_empty() {
            sets.push(Vec::new());
            continue;
        }
        match file.coordinates(mesh.index, i, LIGHTMAP_SET)? {
            Some(set) if set.len() >= primitive.positions.len() => sets.push(set),
            _ => return Ok(None),
        }
    }
    match Existing::new(mesh, &sets, area) {
        Ok(existing) => Ok(Some(existing)),
        Err(why) => {
            notes.push(note(mesh, &why));
            Ok(None)
        }
    }
}

/// Returns a note that the layout of a mesh is not used.
pub(crate) fn note(mesh: &Mesh, why: &str) -> String {
    let name =
        if mesh.name.is_empty() { format!("mesh {}", mesh.index) } else { format!("mesh \"{}\"", mesh.name) };
    format!("{name}: its second set of texture coordinates is not used for the lightmap, because {why}")
}

impl Existing {
    /// Checks the coordinates of all primitives of a mesh. The error says why they cannot be used.
    fn new(mesh: &Mesh, sets: &[Vec<[f32; 2]>], area_in_scene: f64) -> Result<Self, String> {
        let place = |set: &[[f32; 2]], v: u32| DVec2::from_array(set[v as usize].map(f64::from));
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (mut area, mut collapsed, mut unfolded) = (0.0, 0.0, 0.0);
        let mut triangles = Vec::new();
        for (primitive, set) in mesh.primitives.iter().zip(sets) {
            for t in &primitive.triangles {
                let [a, b, c] = t.map(|v| place(set, v));
                if ![a, b, c].iter().all(|p| p.is_finite()) {
                    return Err("some are not numbers".into());
                }
                low = low.min(a).min(b).min(c);
                high = high.max(a).max(b).max(c);
                let own = 0.5 * (b - a).perp_dot(c - a).abs();
                let of = area_of(primitive, t);
                area += of;
                unfolded += own;
                if own == 0.0 {
                    collapsed += of;
                } else {
                    triangles.push([a, b, c]);
                }
            }
        }
        if low.min_element() < -OUTSIDE || high.max_element() > 1.0 + OUTSIDE {
            return Err(format!(
                "they reach from ({:.3}, {:.3}) to ({:.3}, {:.3}), beyond the square from 0 to 1",
                low.x, low.y, high.x, high.y
            ));
        }
        if collapsed > COLLAPSED * area || unfolded == 0.0 {
            return Err(format!("{:.1} % of its surface has no area in them", 100.0 * collapsed / area));
        }
        let overlap = overlap(&triangles);
        if overlap > OVERLAP {
            return Err(format!("triangles overlap in them ({:.1} % of their area)", 100.0 * overlap));
        }
        let size = high - low;
        let scale = (area_in_scene / unfolded).sqrt();
        let corner =
            |x: f64, y: f64| DVec3::new(scale * size.x * x, scale * size.y * y, 0.0).as_vec3().to_array();
        let frame = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        let primitives = mesh.primitives.iter().zip(sets).map(|(primitive, set)| Unfolded {
            origin: (0..set.len() as u32).collect(),
            coordinates: set.clone(),
            triangles: primitive.triangles.clone(),
            charts: Vec::new(),
        });
        let mut primitives: Vec<Unfolded> = primitives.collect();
        number_charts(&mut primitives);
        Ok(Self { set: LIGHTMAP_SET, frame, low, size, primitives })
    }

    /// Returns the primitives with coordinates in the rectangle that the frame was given, and adds the number of charts to
    /// `charts`.
    pub(crate) fn unfolded(&self, frame: &OutputMesh, charts: &mut u32) -> Vec<Unfolded> {
        let mut corners = [DVec2::ZERO; 4];
        for (corner, &v) in FRAME_TRIANGLES.iter().zip(&frame.indices) {
            corners[*corner as usize] = DVec2::from_array(frame.vertices[v as usize].uv.map(f64::from));
        }
        let [origin, along, _, across] = corners;
        let to_rectangle = DAffine2::from_cols(along - origin, across - origin, origin)
            * DAffine2::from_scale(1.0 / self.size)
            * DAffine2::from_translation(-self.low);
        let numbers = self.primitives.iter().flat_map(|p| &p.charts).filter(|&&chart| chart != NO_CHART);
        *charts += numbers.max().map_or(0, |last| last + 1);
        let placed = |uv: &[f32; 2]| {
            to_rectangle.transform_point2(DVec2::from_array(uv.map(f64::from))).as_vec2().to_array()
        };
        let of = |primitive: &Unfolded| Unfolded {
            origin: primitive.origin.clone(),
            coordinates: primitive.coordinates.iter().map(placed).collect(),
            triangles: primitive.triangles.clone(),
            charts: primitive.charts.clone(),
        };
        self.primitives.iter().map(of).collect()
    }
}

/// Returns the first sheet with a layout of the file in which charts share texels, and says so.
pub(crate) fn too_coarse(layout: &Layout) -> Option<(usize, String)> {
    let size = DVec2::new(f64::from(layout.width), f64::from(layout.height));
    let mut clipper = Clipper::default();
    for (number, sheet) in layout.sheets.iter().enumerate().filter(|(_, sheet)| sheet.existing.is_some()) {
        // The smallest instance has the fewest texels.
        let extent = |r: &Rectangle| (r.max - r.min).element_product();
        let rectangles =
            sheet.instances.iter().filter_map(|&instance| layout.rectangle(instance, sheet.side));
        let smallest = rectangles.min_by(|a, b| extent(a).total_cmp(&extent(b)));
        let Some(rectangle) = smallest else { continue };
        let mut owners: BTreeMap<(i64, i64), u32> = BTreeMap::new();
        let mut shared = 0;
        for primitive in &sheet.primitives {
            for (t, &chart) in primitive.triangles.iter().zip(&primitive.charts) {
                let corners = t.map(|v| rectangle.place(primitive.coordinates[v as usize]) * size);
                clipper.for_each_texel(&corners, |x, y, area, _| {
                    if area > 1e-6 {
                        shared += usize::from(*owners.entry((x, y)).or_insert(chart) != chart);
                    }
                });
            }
        }
        if shared > 0 {
            let texels = (rectangle.max - rectangle.min) * size;
            return Some((
                number,
                format!(
                    "charts would share texels: they have {:.0} × {:.0} texels for the whole square; set a larger `size` to use them",
                    texels.x, texels.y
                ),
            ));
        }
    }
    None
}

/// Numbers the charts: triangles that are connected by equal coordinates.
fn number_charts(primitives: &mut [Unfolded]) {
    let bits = |uv: &[f32; 2]| uv.map(|x| (x + 0.0).to_bits());
    let (points, count) = numbers(primitives.iter().flat_map(|p| &p.coordinates).map(bits));
    let mut sets = Sets::new(count);
    let starts: Vec<usize> = primitives
        .iter()
        .scan(0, |next, p| Some(std::mem::replace(next, *next + p.coordinates.len())))
        .collect();
    for (primitive, &start) in primitives.iter().zip(&starts) {
        primitive.triangles.iter().for_each(|t| sets.join(t.map(|v| points[start + v as usize])));
    }
    let roots = primitives
        .iter()
        .zip(&starts)
        .flat_map(|(primitive, &start)| primitive.triangles.iter().map(move |t| start + t[0] as usize));
    let (charts, _) = numbers(roots.map(|corner| sets.root(points[corner])));
    let mut charts = charts.into_iter();
    for primitive in primitives {
        let place = |v: u32| DVec2::from_array(primitive.coordinates[v as usize].map(f64::from));
        let has_area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(place);
            (b - a).perp_dot(c - a) != 0.0
        };
        let chart = |(t, chart)| if has_area(t) { chart } else { NO_CHART };
        primitive.charts = primitive.triangles.iter().zip(&mut charts).map(chart).collect();
    }
}

/// Returns the share of the points of the unit square in a triangle that lie in more than one.
fn overlap(triangles: &[[DVec2; 3]]) -> f64 {
    let mut counts = vec![0u8; SAMPLES * SAMPLES];
    // Off the coordinates that edges like to have.
    let offset = DVec2::new(0.377, 0.619);
    for &[a, b, c] in triangles {
        let grid = |p: DVec2| p * SAMPLES as f64 - offset;
        let (low, high) = (grid(a.min(b).min(c)).ceil(), grid(a.max(b).max(c)).floor());
        let sign = (b - a).perp_dot(c - a).signum();
        let limit = (SAMPLES - 1) as f64;
        for y in (low.y.max(0.0) as usize)..=(high.y.min(limit).max(-1.0) + 0.0) as usize {
            for x in (low.x.max(0.0) as usize)..=(high.x.min(limit).max(-1.0) + 0.0) as usize {
                let p = (DVec2::new(x as f64, y as f64) + offset) / SAMPLES as f64;
                let inside = |from: DVec2, to: DVec2| sign * (to - from).perp_dot(p - from) > 0.0;
                if inside(a, b) && inside(b, c) && inside(c, a) {
                    let count = &mut counts[y * SAMPLES + x];
                    *count = count.saturating_add(1);
                }
            }
        }
    }
    let covered = counts.iter().filter(|&&count| count > 0).count();
    let twice = counts.iter().filter(|&&count| count > 1).count();
    twice as f64 / covered.max(1) as f64
}

fn area_of(primitive: &Primitive, t: &[u32; 3]) -> f64 {
    let [a, b, c] = t.map(|v| DVec3::from_array(primitive.positions[v as usize]));
    0.5 * (b - a).cross(c - a).length()
}
