//! Layout of a lightmap: where each side of each triangle has its texels.

use glam::DVec2;
use sir_geom::{Scene, Side, TriangleId};

use crate::objects::{Objects, Place};

/// Chart number of triangles without texels.
pub(crate) const NO_CHART: u32 = u32::MAX;

/// Vertices of a triangle that a sheet does not have.
pub(crate) const ABSENT: [u32; 3] = [0; 3];

/// Layout of all sheets on pages.
#[derive(Debug, Default)]
pub(crate) struct Layout {
    /// Width of a page \[texels\].
    pub(crate) width: u32,
    /// Height of a page \[texels\].
    pub(crate) height: u32,
    pub(crate) pages: u32,
    /// Texels per meter of charts.
    pub(crate) texels_per_meter: f64,
    pub(crate) charts: u32,
    pub(crate) sheets: Vec<Sheet>,
    /// Sheets of the front and the back of each mesh.
    pub(crate) of_mesh: Vec<[Option<usize>; 2]>,
    /// Where the front and the back of each instance lie.
    pub(crate) rectangles: Vec<[Option<Rectangle>; 2]>,
}

/// One side of those triangles of a mesh that have it, unfolded.
#[derive(Debug)]
pub(crate) struct Sheet {
    /// Index in `Objects::meshes`.
    pub(crate) mesh: usize,
    pub(crate) side: Side,
    /// For each primitive of the mesh; without triangles if it does not have this side.
    pub(crate) primitives: Vec<Unfolded>,
    /// Instances of the mesh.
    pub(crate) instances: Vec<usize>,
    /// Set of texture coordinates of the file that is the layout, if it is one.
    pub(crate) existing: Option<u32>,
}

/// A primitive with texture coordinates.
#[derive(Debug, Default)]
pub(crate) struct Unfolded {
    /// Vertex of the primitive that each vertex is a copy of.
    pub(crate) origin: Vec<u32>,
    /// Coordinates in the rectangle of an instance, in `[0, 1]`.
    pub(crate) coordinates: Vec<[f32; 2]>,
    /// Vertices of its triangles, in the order of the corners of the primitive for both sides.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Chart of each triangle.
    pub(crate) charts: Vec<u32>,
}

/// Rectangle of a page, in fractions of its width and height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rectangle {
    pub(crate) page: u32,
    pub(crate) min: DVec2,
    pub(crate) max: DVec2,
}

impl Rectangle {
    /// A whole page.
    pub(crate) fn whole(page: u32) -> Self {
        Self { page, min: DVec2::ZERO, max: DVec2::ONE }
    }

    /// Returns the place on the page of coordinates in the rectangle.
    pub(crate) fn place(&self, coordinates: [f32; 2]) -> DVec2 {
        self.min + DVec2::from_array(coordinates.map(f64::from)) * (self.max - self.min)
    }
}

/// Texels of one side of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnPage {
    pub(crate) page: u32,
    /// Corners of the triangle \[texels\]; the first row of the page is `0 ≤ y < 1`.
    pub(crate) corners: [DVec2; 3],
}

impl Layout {
    /// Returns where a side of a triangle of the scene lies; `None` if it has no texels.
    pub(crate) fn locate(
        &self,
        objects: &Objects,
        scene: &Scene,
        t: TriangleId,
        side: Side,
    ) -> Option<OnPage> {
        let (mesh, primitive, number) = objects.locate(t)?;
        let Place { instance, .. } = objects.places[t.index()];
        let sheet = &self.sheets[self.of_mesh[mesh][usize::from(side == Side::Back)]?];
        let unfolded = &sheet.primitives[primitive];
        if *unfolded.charts.get(number)? == NO_CHART {
            return None;
        }
        let rectangle = self.rectangle(instance as usize, side)?;
        let size = DVec2::new(f64::from(self.width), f64::from(self.height));
        let [a, b, c] =
            unfolded.triangles[number].map(|v| rectangle.place(unfolded.coordinates[v as usize]) * size);
        let corners = objects.corners_in_source(scene, t)?.map(|p| a + p.x * (b - a) + p.y * (c - a));
        Some(OnPage { page: rectangle.page, corners })
    }

    /// Returns true if a side of a triangle of the scene is in the layout, with or without texels.
    pub(crate) fn has(&self, objects: &Objects, t: TriangleId, side: Side) -> bool {
        let Some((mesh, primitive, number)) = objects.locate(t) else { return false };
        let sheet = self.of_mesh[mesh][usize::from(side == Side::Back)];
        let triangles = sheet.map(|sheet| &self.sheets[sheet].primitives[primitive].triangles);
        triangles.and_then(|triangles| triangles.get(number)).is_some_and(|&triangle| triangle != ABSENT)
    }

    /// Returns where a side of an instance lies.
    pub(crate) fn rectangle(&self, instance: usize, side: Side) -> Option<Rectangle> {
        self.rectangles[instance][usize::from(side == Side::Back)]
    }
}

impl Unfolded {
    /// Adds the triangles of another part of the primitive.
    pub(crate) fn join(&mut self, other: Self) {
        if self.triangles.is_empty() {
            *self = other;
            return;
        }
        let first = self.origin.len() as u32;
        self.origin.extend(other.origin);
        self.coordinates.extend(other.coordinates);
        for (i, (triangle, chart)) in other.triangles.into_iter().zip(other.charts).enumerate() {
            if triangle != ABSENT {
                self.triangles[i] = triangle.map(|v| v + first);
                self.charts[i] = chart;
            }
        }
    }
}
