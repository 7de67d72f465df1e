//! Scenes with analytic solutions.

use glam::DVec3;
use sir_geom::{Built, Camera, Material, Rgb, SceneBuilder, SceneError, shapes, shapes::Facing};

/// Returns a white furnace: a closed cube with corners at 0 and `edge` \[m\] whose faces all have the exitance
/// `exitance` \[W/m²\] and the reflectance `reflectance`.
///
/// Every point receives the same radiance from all directions. The radiosity is therefore [`furnace_answer`]
/// everywhere, for any form factors. A solver that finds another value loses or creates light.
///
/// # Errors
///
/// If `edge` is zero or a color is negative or not finite.
pub fn furnace(edge: f64, reflectance: Rgb, exitance: Rgb) -> Result<Built, SceneError> {
    let mut b = SceneBuilder::new();
    let wall = b.add_material(Material::diffuse("glowing wall", reflectance).emitting(exitance));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::splat(edge), [wall; 6], Facing::Inward);
    add_camera(&mut b, "inside", edge * DVec3::new(0.1, 0.5, 0.9), edge * DVec3::new(0.7, 0.4, 0.1));
    b.build()
}

/// Returns the radiosity \[W/m²\] of every point of a [`furnace`]: the geometric series
/// `M (1 + ρ + ρ² + …) = M / (1 − ρ)`.
#[must_use]
pub fn furnace_answer(reflectance: Rgb, exitance: Rgb) -> Rgb {
    exitance / (Rgb::ONE - reflectance)
}

/// One of the two surfaces of [`concentric_spheres`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereShell {
    /// Radius of the sphere on which the vertices lie \[m\].
    pub radius: f64,
    /// Diffuse reflectance.
    pub reflectance: Rgb,
    /// Exitance \[W/m²\].
    pub exitance: Rgb,
}

/// Returns a sphere that faces outward, inside a larger sphere that faces inward. Both have `20 · 4^level` triangles.
///
/// The two polyhedra are scaled copies of each other, so that the ratio of their areas is exactly the ratio of the
/// squared radii. On smooth spheres, every point has the radiosity given by [`concentric_spheres_answer`]. On the
/// polyhedra, the mean radiosities are the same except for second-order terms. Single points differ from the mean by
/// the distance of a facet from the sphere, about 0.15 % at level 4.
///
/// # Errors
///
/// If a radius is zero or a color is negative or not finite.
pub fn concentric_spheres(inner: SphereShell, outer: SphereShell, level: u32) -> Result<Built, SceneError> {
    let mut b = SceneBuilder::new();
    for (name, shell, facing) in
        [("inner sphere", inner, Facing::Outward), ("outer sphere", outer, Facing::Inward)]
    {
        let m = b.add_material(Material::diffuse(name, shell.reflectance).emitting(shell.exitance));
        shapes::sphere(&mut b, DVec3::ZERO, shell.radius, level, facing, |_| m);
    }
    let between = 0.1 * inner.radius + 0.9 * outer.radius;
    add_camera(&mut b, "between the spheres", DVec3::new(0.0, 0.0, between), DVec3::ZERO);
    b.build()
}

/// Returns the radiosities \[W/m²\] of the inner and the outer of two smooth concentric spheres.
///
/// All light of the inner sphere reaches the outer one. By reciprocity (`A₁ F₁₂ = A₂ F₂₁`), a share `f = (r₁/r₂)²` of
/// the outer sphere's light reaches the inner one, and the rest returns to the outer one:
///
/// `B₁ = M₁ + ρ₁ B₂`, `B₂ = M₂ + ρ₂ (f B₁ + (1 − f) B₂)`.
#[must_use]
pub fn concentric_spheres_answer(inner: SphereShell, outer: SphereShell) -> (Rgb, Rgb) {
    let f = (inner.radius / outer.radius) * (inner.radius / outer.radius);
    let received = outer.reflectance * f;
    let b2 = (outer.exitance + received * inner.exitance)
        / (Rgb::ONE - outer.reflectance * (1.0 - f) - received * inner.reflectance);
    (inner.exitance + inner.reflectance * b2, b2)
}

/// Adds a camera with a vertical field of view of 60°. The points must be distinct and the view not vertical.
fn add_camera(builder: &mut SceneBuilder, name: &str, eye: DVec3, target: DVec3) {
    if let Some(mut camera) = Camera::looking_at(eye, target, DVec3::Y, std::f64::consts::FRAC_PI_3) {
        camera.name = name.to_owned();
        builder.add_camera(camera);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn furnace_adds_up_a_geometric_series() {
        let answer = furnace_answer(Rgb::new(0.5, 0.8, 0.9), Rgb::ONE);
        assert!(answer.abs_diff_eq(Rgb::new(2.0, 5.0, 10.0), 1e-12), "{answer}");
    }

    #[test]
    fn spheres_answer_obeys_its_equations() {
        let inner = SphereShell { radius: 1.0, reflectance: Rgb::splat(0.5), exitance: Rgb::splat(100.0) };
        let outer = SphereShell { radius: 2.0, reflectance: Rgb::splat(0.8), exitance: Rgb::ZERO };
        let (b1, b2) = concentric_spheres_answer(inner, outer);
        assert!(b1.abs_diff_eq(Rgb::splat(400.0 / 3.0), 1e-9), "{b1}");
        assert!(b2.abs_diff_eq(Rgb::splat(200.0 / 3.0), 1e-9), "{b2}");
    }

    #[test]
    fn polyhedra_keep_the_ratio_of_the_areas() {
        let inner = SphereShell { radius: 1.0, reflectance: Rgb::splat(0.5), exitance: Rgb::splat(100.0) };
        let outer = SphereShell { radius: 2.0, reflectance: Rgb::splat(0.8), exitance: Rgb::ZERO };
        let scene = concentric_spheres(inner, outer, 3).unwrap().scene;
        let area = |name: &str| -> f64 {
            scene.triangle_ids().filter(|t| scene.material(*t).name == name).map(|t| scene.area(t)).sum()
        };
        assert!((area("outer sphere") / area("inner sphere") - 4.0).abs() < 1e-12);
        assert!(scene.exitance(sir_geom::TriangleId(0), sir_geom::Side::Front) == inner.exitance);
    }

    #[test]
    fn furnace_is_a_cube_that_glows_everywhere() {
        let scene = furnace(3.0, Rgb::splat(0.5), Rgb::ONE).unwrap().scene;
        assert!((scene.total_area() - 54.0).abs() < 1e-12);
        let glows = |t| scene.exitance(t, sir_geom::Side::Front) == Rgb::ONE;
        assert!(scene.triangle_ids().all(glows));
    }
}
