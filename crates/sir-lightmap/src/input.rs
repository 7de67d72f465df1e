//! One side of a mesh, ready to be unfolded.

use std::collections::HashMap;
use std::rc::Rc;

use glam::DVec3;
use sir_geom::Side;
use uvunwrap::OutputMesh;

use crate::connected::numbers;
use crate::existing::Existing;
use crate::layout::{ABSENT, NO_CHART, Unfolded};
use crate::objects::{Mesh, Objects};

/// Cosine of the largest bend of a surface across which light continues: 30°, as in pictures.
const SMOOTH: f64 = 0.866;

/// A sheet before it is unfolded: positions and triangles of one side of a mesh.
pub(crate) struct Input {
    pub(crate) mesh: usize,
    pub(crate) side: Side,
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) indices: Vec<u32>,
    /// Primitive of each triangle, and its number there.
    pub(crate) triangles: Vec<(u32, u32)>,
    pub(crate) primitives: Vec<u32>,
    /// For each edge of each triangle, true if the surface has a crease there.
    pub(crate) creases: Vec<[bool; 3]>,
    /// Number of the first vertex of each primitive.
    pub(crate) first_vertices: Vec<u32>,
    /// Instances of the mesh, and their sizes relative to the first.
    pub(crate) instances: Vec<usize>,
    pub(crate) scales: Vec<f32>,
    /// Factor of its size on the page.
    pub(crate) scale: f32,
    /// Layout of the file, if it is used.
    pub(crate) existing: Option<Rc<Existing>>,
}

impl Input {
    /// Collects one side of those triangles of a mesh for which `has` is true, by primitive and number. Positions are those
    /// of the first instance in the scene, relative to their middle.
    pub(crate) fn new(
        objects: &Objects,
        mesh: usize,
        side: Side,
        instances: Vec<usize>,
        has: &dyn Fn(usize, usize) -> bool,
    ) -> Self {
        let first = &objects.instances[instances[0]];
        let relative = |&i: &usize| (objects.instances[i].area / first.area).sqrt() as f32;
        let usable = |scale: f32| if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        let mut input = Self {
            mesh,
            side,
            positions: Vec::new(),
            indices: Vec::new(),
            triangles: Vec::new(),
            primitives: Vec::new(),
            creases: Vec::new(),
            first_vertices: Vec::new(),
            scales: instances.iter().map(|i| usable(relative(i))).collect(),
            instances,
            scale: 1.0,
            existing: None,
        };
        let of: &Mesh = &objects.meshes[mesh];
        let middle = middle(of);
        for (number, primitive) in (0u32..).zip(&of.primitives) {
            let start = input.positions.len() as u32;
            input.first_vertices.push(start);
            let own = (0u32..).zip(&primitive.triangles).filter(|(i, _)| has(number as usize, *i as usize));
            let own: Vec<(u32, &[u32; 3])> = own.collect();
            if own.is_empty() {
                continue;
            }
            input.positions.extend(primitive.positions.iter().map(|p| {
                let p = first.to_world.transform_vector3(DVec3::from_array(*p) - middle).as_vec3();
                if p.is_finite() { p.to_array() } else { [0.0; 3] }
            }));
            for (i, &[a, b, c]) in own {
                // Seen from the back, the corners run the other way.
                let corners = if side == Side::Front { [a, b, c] } else { [a, c, b] };
                input.indices.extend(corners.map(|v| v + start));
                input.triangles.push((number, i));
                input.primitives.push(number);
            }
        }
        input.creases = creases(&input.positions, &input.indices);
        input
    }

    /// Returns the area of all instances \[m²\].
    pub(crate) fn area(&self) -> f64 {
        let place = |i: u32| DVec3::from_array(self.positions[i as usize].map(f64::from));
        let areas = self.indices.chunks_exact(3).map(|t| {
            let [a, b, c] = [t[0], t[1], t[2]].map(place);
            0.5 * (b - a).cross(c - a).length()
        });
        let squares: f64 = self.scales.iter().map(|&scale| f64::from(scale).powi(2)).sum();
        areas.sum::<f64>() * squares
    }

    /// Returns the primitives of the sheet from the output of the unwrapper.
    pub(crate) fn unfolded(&self, mesh: &Mesh, output: &OutputMesh) -> Vec<Unfolded> {
        let mut all: Vec<Unfolded> = mesh.primitives.iter().map(|_| Unfolded::default()).collect();
        let mut known: Vec<HashMap<u32, u32>> = vec![HashMap::new(); all.len()];
        for (&(primitive, number), corners) in self.triangles.iter().zip(output.indices.chunks_exact(3)) {
            let primitive = primitive as usize;
            let (of, known) = (&mut all[primitive], &mut known[primitive]);
            if of.triangles.is_empty() {
                let count = mesh.primitives[primitive].triangles.len();
                (of.triangles, of.charts) = (vec![ABSENT; count], vec![NO_CHART; count]);
            }
            let [a, b, c] = [corners[0], corners[1], corners[2]].map(|v| {
                *known.entry(v).or_insert_with(|| {
                    let vertex = &output.vertices[v as usize];
                    of.origin.push(vertex.xref - self.first_vertices[primitive]);
                    of.coordinates.push(vertex.uv);
                    of.origin.len() as u32 - 1
                })
            });
            let number = number as usize;
            of.triangles[number] = if self.side == Side::Front { [a, b, c] } else { [a, c, b] };
            let chart = output.vertices[corners[0] as usize].chart.unwrap_or(NO_CHART);
            let [a, b, c] = [a, b, c].map(|v| of.coordinates[v as usize]);
            let is_collapsed = a == b || b == c || c == a;
            of.charts[number] = if is_collapsed { NO_CHART } else { chart };
        }
        all
    }
}

/// Returns true for each edge of each triangle at which two triangles meet at an angle. Charts end there: light differs on
/// both sides, and a texel must not mix it.
fn creases(positions: &[[f32; 3]], indices: &[u32]) -> Vec<[bool; 3]> {
    // Vertices at equal positions are one, as for the unwrapper.
    let (numbers, _) = numbers(positions.iter().map(|p| p.map(|x| (x + 0.0).to_bits())));
    let normals: Vec<DVec3> = indices
        .chunks_exact(3)
        .map(|t| {
            let [a, b, c] =
                [t[0], t[1], t[2]].map(|i| DVec3::from_array(positions[i as usize].map(f64::from)));
            (b - a).cross(c - a).normalize_or_zero()
        })
        .collect();
    let ends = |t: &[u32], k: usize| {
        let [a, b] = [t[k], t[(k + 1) % 3]].map(|i| numbers[i as usize]);
        (a.min(b), a.max(b))
    };
    let mut first: HashMap<(u32, u32), u32> = HashMap::new();
    let mut flags = vec![[false; 3]; normals.len()];
    for (i, t) in indices.chunks_exact(3).enumerate() {
        flags[i] = [0, 1, 2].map(|k| {
            let other = *first.entry(ends(t, k)).or_insert(i as u32) as usize;
            // Triangles without an area have no normal, and no crease.
            let (a, b) = (normals[i], normals[other]);
            a != DVec3::ZERO && b != DVec3::ZERO && a.dot(b) < SMOOTH
        });
    }
    flags
}

/// Returns the middle of the bounding box of a mesh.
fn middle(mesh: &Mesh) -> DVec3 {
    let all = || mesh.primitives.iter().flat_map(|p| &p.positions).map(|p| DVec3::from_array(*p));
    let finite = || all().filter(|p| p.is_finite());
    let (low, high) =
        (finite().fold(DVec3::INFINITY, DVec3::min), finite().fold(DVec3::NEG_INFINITY, DVec3::max));
    let middle = 0.5 * (low + high);
    if middle.is_finite() { middle } else { DVec3::ZERO }
}
