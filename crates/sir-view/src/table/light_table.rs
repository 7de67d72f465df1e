//! Creation of tables: the light of patches, or of parts of a scene.

use glam::DVec3;
use sir_geom::{Rgb, Scene, Side};
use sir_mesh::{PatchMesh, Per, SideSums};

use crate::table::row::{Columns, Row, Table};

impl Table {
    /// Creates the table of a solution: the irradiance `E` \[W/m²\] of every [`SideId`](sir_mesh::SideId), and its
    /// standard error.
    ///
    /// A two-sided patch has two rows with opposite normals. A patch in several triangles has its center and mean normal, and
    /// the number of the first one.
    ///
    /// # Panics
    ///
    /// If there is not exactly one irradiance and one error for every side.
    #[must_use]
    pub fn new(scene: &Scene, mesh: &PatchMesh, irradiance: &[Rgb], error: &[Rgb]) -> Self {
        assert_one_per_side(mesh, irradiance, error);
        let mut rows: Vec<Row> = Vec::with_capacity(mesh.side_count());
        mesh.for_each_side(|t, patch, side, id| {
            let (e, se) = (irradiance[id.index()], error[id.index()]);
            let reflectance = mesh.reflectance(scene, t, patch);
            let (center, normal) = mesh.center_and_normal(scene, t, patch);
            let triangle = mesh.pieces(t, patch).next().map_or(t, |piece| piece.triangle);
            rows.push(Row {
                number: patch.0,
                triangle: scene.triangle(triangle).source,
                area: mesh.patch_area(t, patch),
                center,
                normal: if side == Side::Front { normal } else { -normal }.normalize_or_zero(),
                radiosity: mesh.exitance(scene, t, patch, side) + reflectance * e,
                irradiance: e,
                error: reflectance * se,
                irradiance_error: se,
            });
        });
        Self { per: None, rows, names: Vec::new() }
    }

    /// Creates the table of the parts of a scene: the means of the light of the patches in them, by covered area.
    ///
    /// `errors` has the standard errors of the mean irradiance and radiosity of each part \[W/m²\], which only repeats tell.
    /// Without them, the errors are those of sides with independent errors.
    ///
    /// # Panics
    ///
    /// If there is not exactly one irradiance and one error for every side, or not one pair of errors for every part.
    #[must_use]
    pub fn of_parts(
        scene: &Scene,
        mesh: &PatchMesh,
        sums: &SideSums,
        irradiance: &[Rgb],
        error: &[Rgb],
        errors: Option<&[[Rgb; 2]]>,
    ) -> Self {
        assert_one_per_side(mesh, irradiance, error);
        assert!(errors.is_none_or(|errors| errors.len() == sums.parts().len()), "one pair for every part");
        let mut means = vec![Mean::default(); sums.parts().len()];
        mesh.for_each_side(|t, patch, side, id| {
            let (e, se) = (irradiance[id.index()], error[id.index()]);
            let reflectance = mesh.reflectance(scene, t, patch);
            let radiosity = mesh.exitance(scene, t, patch, side) + reflectance * e;
            for (part, share) in sums.shares(id) {
                let covered = share * mesh.covered_area(t, patch);
                means[part].add(covered, [e, radiosity], [se, reflectance * se]);
            }
        });
        let columns = Columns::of(Some(sums.per()));
        let mut table = Self { per: Some(sums.per()), ..Self::default() };
        for (i, (part, mean)) in sums.parts().iter().zip(means).enumerate() {
            let triangle = scene.triangle(part.triangle);
            let ([irradiance, radiosity], stated) = mean.values();
            let [irradiance_error, error] = errors.map_or(stated, |errors| errors[i]);
            let place = Row {
                number: i as u32,
                triangle: 0,
                area: part.area,
                center: DVec3::ZERO,
                normal: DVec3::ZERO,
                radiosity,
                irradiance,
                error,
                irradiance_error,
            };
            let number = match sums.per() {
                Per::Triangle => triangle.source,
                Per::Face => triangle.face.0,
                Per::Material => {
                    table.names.push(scene.materials()[triangle.material.index()].name.clone());
                    i as u32
                }
                Per::Group => {
                    table.names.push(scene.groups()[triangle.group.index()].clone());
                    i as u32
                }
            };
            table.rows.push(match columns.has_names() {
                true => place,
                false => Row {
                    number,
                    triangle: triangle.source,
                    center: part.center,
                    normal: part.normal.normalize_or_zero(),
                    ..place
                },
            });
        }
        table
    }
}

fn assert_one_per_side(mesh: &PatchMesh, irradiance: &[Rgb], error: &[Rgb]) {
    assert_eq!(irradiance.len(), mesh.side_count(), "one irradiance for every side of the mesh");
    assert_eq!(error.len(), mesh.side_count(), "one error for every side of the mesh");
}

/// Means over a covered area, of irradiance and radiosity.
#[derive(Clone, Copy, Default)]
struct Mean {
    area: f64,
    /// Of irradiance and radiosity \[W\].
    sums: [Rgb; 2],
    /// Of the squares of their standard errors \[W²\].
    squares: [Rgb; 2],
}

impl Mean {
    fn add(&mut self, area: f64, values: [Rgb; 2], errors: [Rgb; 2]) {
        self.area += area;
        for i in 0..2 {
            self.sums[i] += area * values[i];
            self.squares[i] += (area * errors[i]) * (area * errors[i]);
        }
    }

    /// Returns the means and their standard errors, zero without a covered area.
    fn values(&self) -> ([Rgb; 2], [Rgb; 2]) {
        let per_area = if self.area > 0.0 { 1.0 / self.area } else { 0.0 };
        (self.sums.map(|sum| sum * per_area), self.squares.map(|sum| sum.map(f64::sqrt) * per_area))
    }
}
