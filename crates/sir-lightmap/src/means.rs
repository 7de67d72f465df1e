//! Interpolated irradiance that keeps the power of patches.
//!
//! The display mesh has at each vertex a mean of the patches around it. Where the light is curved, the mean of the
//! interpolation over a patch differs a little from the patch. What is missing is given back to the vertices, after it was
//! averaged over the patches around. So the power around each patch is kept, and all power is kept exactly, and the noise of
//! patches, which interpolation has smoothed, does not come back.

use sir_geom::Rgb;
use sir_view::DisplayMesh;

/// Number of times that what is missing is given back.
const ROUNDS: usize = 2;

/// Number of times that what is missing is averaged over the patches around.
const AVERAGES: usize = 2;

/// Returns the irradiance \[W/m²\] of the vertices of a display mesh, for this irradiance of the sides of patches, and the mean
/// standard error of the sides around each vertex.
pub(crate) fn keep_power(display: &DisplayMesh<'_>, irradiance: &[Rgb], errors: &[Rgb]) -> [Vec<Rgb>; 2] {
    let mut light: Vec<Rgb> =
        display.vertices().iter().map(|v| Rgb::from_array(v.irradiance.map(f64::from))).collect();
    let shares = Shares::new(display, irradiance.len());
    for _ in 0..ROUNDS {
        let means = shares.to_sides(&light);
        let mut missing: Vec<Rgb> = irradiance.iter().zip(&means).map(|(&goal, &mean)| goal - mean).collect();
        for _ in 0..AVERAGES {
            missing = shares.to_sides(&shares.to_vertices(&missing));
        }
        let change = shares.to_vertices(&missing);
        light.iter_mut().zip(&change).for_each(|(light, &change)| *light = (*light + change).max(Rgb::ZERO));
    }
    shares.set_centers(&mut light);
    // Where light would have become negative, power is left over: a thousandth of it or less.
    let power =
        |sides: &[Rgb]| -> Rgb { sides.iter().zip(&shares.of_sides).map(|(&e, &area)| e * area).sum() };
    let (goal, found) = (power(irradiance), power(&shares.to_sides(&light)));
    let factor =
        Rgb::from_array(std::array::from_fn(|k| if found[k] > 0.0 { goal[k] / found[k] } else { 1.0 }));
    light.iter_mut().for_each(|light| *light *= factor);
    let mut errors = shares.to_vertices(errors);
    shares.set_centers(&mut errors);
    [light, errors]
}

/// Returns the center of triangles that are a fan around their last vertex.
pub(crate) fn center_of_fan(triangles: &[[u32; 3]]) -> Option<u32> {
    let &[.., center] = triangles.first()?;
    (triangles.len() > 3 && triangles.iter().all(|t| t[2] == center)).then_some(center)
}

/// Areas that connect sides of patches and vertices.
struct Shares {
    /// Side, vertex, and the area \[m²\] with which the vertex counts in the mean over the side.
    links: Vec<(u32, u32, f64)>,
    /// Centers of polygons, each with the range of its vertices in `rings`.
    centers: Vec<(u32, std::ops::Range<usize>)>,
    rings: Vec<u32>,
    of_sides: Vec<f64>,
    of_vertices: Vec<f64>,
}

impl Shares {
    fn new(display: &DisplayMesh<'_>, sides: usize) -> Self {
        let mut shares = Self {
            links: Vec::new(),
            centers: Vec::new(),
            rings: Vec::new(),
            of_sides: vec![0.0; sides],
            of_vertices: vec![0.0; display.vertices().len()],
        };
        let position = |v: u32| display.positions()[display.vertices()[v as usize].position as usize];
        for piece in display.pieces() {
            let side = piece.id.index() as u32;
            let center = center_of_fan(piece.triangles);
            let mut whole = 0.0;
            for t in piece.triangles {
                let [a, b, c] = t.map(position);
                let area = 0.5 * (b - a).cross(c - a).length();
                whole += area;
                let own = t.iter().filter(|&&v| Some(v) != center);
                shares.links.extend(own.map(|&v| (side, v, area / 3.0)));
            }
            if let Some(center) = center {
                // The center has the mean of the ring around it, so its share is theirs.
                let start = shares.rings.len();
                shares.rings.extend(piece.triangles.iter().map(|t| t[0]));
                let part = whole / (3.0 * piece.triangles.len() as f64);
                shares.links.extend(piece.triangles.iter().map(|t| (side, t[0], part)));
                shares.centers.push((center, start..shares.rings.len()));
            }
        }
        for &(side, vertex, area) in &shares.links {
            shares.of_sides[side as usize] += area;
            shares.of_vertices[vertex as usize] += area;
        }
        shares
    }

    /// Returns the mean of the sides around each vertex that is no center.
    fn to_vertices(&self, sides: &[Rgb]) -> Vec<Rgb> {
        let mut vertices = vec![Rgb::ZERO; self.of_vertices.len()];
        for &(side, vertex, area) in &self.links {
            vertices[vertex as usize] += area * sides[side as usize];
        }
        divide(&mut vertices, &self.of_vertices);
        vertices
    }

    /// Gives centers the mean of the rings around them.
    fn set_centers(&self, vertices: &mut [Rgb]) {
        for (center, ring) in &self.centers {
            let sum: Rgb = self.rings[ring.clone()].iter().map(|&v| vertices[v as usize]).sum();
            vertices[*center as usize] = sum / ring.len() as f64;
        }
    }

    /// Returns the mean over each side of what is interpolated between vertices, if centers have the mean of their rings.
    fn to_sides(&self, vertices: &[Rgb]) -> Vec<Rgb> {
        let mut sides = vec![Rgb::ZERO; self.of_sides.len()];
        for &(side, vertex, area) in &self.links {
            sides[side as usize] += area * vertices[vertex as usize];
        }
        divide(&mut sides, &self.of_sides);
        sides
    }
}

fn divide(sums: &mut [Rgb], areas: &[f64]) {
    for (sum, &area) in sums.iter_mut().zip(areas) {
        *sum = if area > 0.0 { *sum / area } else { Rgb::ZERO };
    }
}
