//! Positions of the probes in a box.

use glam::DVec3;
use sir_geom::BoundingBox;
use sir_radiosity::{Model, share_of_backs};

use crate::format::grouped;
use crate::plan::Probes;

/// Maximum number of probes. They need about 0.6 GB, a file of some 200 MB, and the time of six sensors each.
const MAX_PROBES: f64 = 1e5;

/// Least distance of a valid probe from surfaces, in spacings.
const CLEARANCE: f64 = 1e-3;

/// Probes in the centers of the cells of a box. The first coordinate of their positions varies fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbeGrid {
    /// Position of the first probe \[m\].
    pub first: DVec3,
    /// Distances of neighboring probes along x, y and z \[m\].
    pub steps: DVec3,
    /// Numbers of probes along x, y and z.
    pub counts: [usize; 3],
    /// Share of the surfaces in view of each probe that show the backs of one-sided surfaces; `None` if the probe lies on a
    /// surface.
    pub backs: Vec<Option<f64>>,
    /// Positions of the valid probes \[m\], in order, at least one.
    pub valid: Vec<DVec3>,
    /// Share of backs above which a probe is invalid.
    max_backs: f64,
}

impl ProbeGrid {
    /// Places the probes. The error has a message, which says why there are none, and a suggested fix.
    pub(crate) fn new(
        probes: &Probes,
        model: &Model,
        focus: Option<BoundingBox>,
    ) -> Result<Self, (String, String)> {
        let around = focus.unwrap_or_else(|| model.scene.bounding_box());
        let (min, max) = (probes.min.unwrap_or(around.min), probes.max.unwrap_or(around.max));
        if !min.cmple(max).all() {
            let message = format!("the box of these probes, from {min:.4} to {max:.4}, is empty");
            let help = format!(
                "give both `min` and `max`; without them, the box is {:.4} to {:.4}",
                around.min, around.max
            );
            return Err((message, help));
        }
        let size = max - min;
        let cells = (size / probes.spacing).round().max(DVec3::ONE);
        if cells.element_product() > MAX_PROBES {
            let digits = |n: f64| if n < 1e9 { format!("{n:.0}") } else { format!("{n:.1e}") };
            let [x, y, z] = cells.to_array().map(digits);
            let most = grouped(MAX_PROBES as u64);
            let message = format!("a grid of {x} by {y} by {z} probes is too fine: there may be {most}");
            // The cube root of what is too much, with two digits, rounded up.
            let least = (size.element_product() / MAX_PROBES).cbrt();
            let help = if least.is_finite() && least > probes.spacing {
                format!("choose a `spacing` of at least {:.2} m, or a smaller box", 1.05 * least)
            } else {
                "choose a larger `spacing`, or a smaller box".into()
            };
            return Err((message, help));
        }
        let steps = size / cells;
        let counts = cells.to_array().map(|count| count as usize);
        let mut grid = Self {
            first: min + 0.5 * steps,
            steps,
            counts,
            backs: Vec::new(),
            valid: Vec::new(),
            max_backs: probes.backs,
        };
        let (mut tracer, clearance) = (model.accel.tracer(), probes.spacing * CLEARANCE);
        let backs = |i: usize| share_of_backs(grid.position(i), clearance, model, &mut tracer);
        grid.backs = (0..counts.iter().product()).map(backs).collect();
        grid.valid = (0..grid.len()).filter(|&i| grid.is_valid(i)).map(|i| grid.position(i)).collect();
        if grid.valid.is_empty() {
            let message = format!("none of these {} probes is valid", grouped(grid.len() as u64));
            let help = "choose a smaller `spacing` or another box: probes on surfaces, and probes that see much of the backs of \
                        one-sided surfaces, as those in solids and behind walls do, are invalid";
            return Err((message, help.into()));
        }
        Ok(grid)
    }

    /// Returns the number of probes, valid or not.
    #[must_use]
    pub fn len(&self) -> usize {
        self.backs.len()
    }

    /// True if there are no probes, which [`prepare`](crate::prepare::prepare) excludes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.backs.is_empty()
    }

    /// Returns the position of a probe.
    #[must_use]
    pub fn position(&self, probe: usize) -> DVec3 {
        let [columns, rows, _] = self.counts;
        let cell = [probe % columns, probe / columns % rows, probe / (columns * rows)];
        self.first + self.steps * DVec3::from_array(cell.map(|i| i as f64))
    }

    /// True if a probe is neither on a surface, nor inside a solid, nor behind a wall.
    #[must_use]
    pub fn is_valid(&self, probe: usize) -> bool {
        self.backs[probe].is_some_and(|share| share <= self.max_backs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_geom::shapes::{self, Facing};
    use sir_geom::{Material, Rgb, SceneBuilder};
    use sir_mesh::Subdivision;

    /// A room of 4 by 3 by 2 m with a solid box in one corner.
    fn room() -> Model {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("", Rgb::splat(0.5)));
        shapes::cuboid(&mut b, DVec3::ZERO, DVec3::new(4.0, 3.0, 2.0), [m; 6], Facing::Inward);
        shapes::cuboid(&mut b, DVec3::splat(0.1), DVec3::new(1.1, 1.1, 1.1), [m; 6], Facing::Outward);
        Model::new(b.build().unwrap().scene, Subdivision::PerTriangle).unwrap()
    }

    const PROBES: Probes = Probes { spacing: 1.0, min: None, max: None, backs: 0.25 };

    #[test]
    fn probes_fill_the_scene_or_the_focus_or_a_box() {
        let model = room();
        let grid = ProbeGrid::new(&PROBES, &model, None).unwrap();
        assert_eq!((grid.counts, grid.len(), grid.valid.len()), ([4, 3, 2], 24, 23));
        assert_eq!((grid.first, grid.steps), (DVec3::splat(0.5), DVec3::ONE));
        assert_eq!(grid.position(1), DVec3::new(1.5, 0.5, 0.5));
        assert_eq!(grid.position(4), DVec3::new(0.5, 1.5, 0.5));
        assert_eq!(grid.position(23), DVec3::new(3.5, 2.5, 1.5));
        // The first one is in the box.
        assert!(!grid.is_valid(0) && grid.is_valid(1) && grid.backs[0] == Some(1.0));
        let focus = BoundingBox { min: DVec3::new(2.0, 0.0, 0.0), max: DVec3::new(4.0, 3.0, 2.0) };
        assert_eq!(ProbeGrid::new(&PROBES, &model, Some(focus)).unwrap().counts, [2, 3, 2]);
        let flat =
            Probes { min: Some(DVec3::new(2.0, 1.0, 1.0)), max: Some(DVec3::new(3.0, 3.0, 1.0)), ..PROBES };
        let grid = ProbeGrid::new(&flat, &model, Some(focus)).unwrap();
        assert_eq!((grid.counts, grid.first), ([1, 2, 1], DVec3::new(2.5, 1.5, 1.0)));
    }

    /// A grid through the corners of the room: all probes on its surfaces are invalid, and so are those outside.
    #[test]
    fn probes_on_surfaces_and_outside_are_invalid() {
        let model = room();
        let corners =
            Probes { min: Some(DVec3::splat(-0.5)), max: Some(DVec3::new(4.5, 3.5, 2.5)), ..PROBES };
        let grid = ProbeGrid::new(&corners, &model, None).unwrap();
        assert_eq!((grid.counts, grid.position(0)), ([5, 4, 3], DVec3::ZERO));
        // Inside are 3 by 2 by 1 probes, of which one is in the corner of the box, but not in it.
        let inside = |p: &DVec3| p.cmpgt(DVec3::ZERO).all() && p.cmplt(DVec3::new(4.0, 3.0, 2.0)).all();
        assert!(grid.valid.iter().all(inside), "{:?}", grid.valid);
        assert_eq!(grid.valid.len(), 5);
        assert_eq!(grid.backs.iter().filter(|share| share.is_none()).count(), 54);
        let outside = Probes { min: Some(DVec3::splat(-0.9)), max: Some(DVec3::splat(-0.1)), ..PROBES };
        assert!(ProbeGrid::new(&outside, &model, None).is_err());
    }

    #[test]
    fn impossible_grids_are_refused() {
        let model = room();
        let too_fine = ProbeGrid::new(&Probes { spacing: 0.01, ..PROBES }, &model, None).unwrap_err();
        assert_eq!(too_fine.0, "a grid of 400 by 300 by 200 probes is too fine: there may be 100_000");
        assert_eq!(too_fine.1, "choose a `spacing` of at least 0.07 m, or a smaller box");
        assert!(ProbeGrid::new(&Probes { spacing: 0.2, ..PROBES }, &model, None).is_ok());
        let tiny = ProbeGrid::new(&Probes { spacing: 1e-300, ..PROBES }, &model, None).unwrap_err();
        assert!(tiny.0.ends_with("is too fine: there may be 100_000"), "{}", tiny.0);
        let beyond = Probes { min: Some(DVec3::new(5.0, 0.0, 0.0)), ..PROBES };
        let (message, help) = ProbeGrid::new(&beyond, &model, None).unwrap_err();
        assert!(message.contains("is empty") && help.contains("give both"), "{message} {help}");
        let solid = Probes { min: Some(DVec3::splat(0.2)), max: Some(DVec3::splat(1.0)), ..PROBES };
        assert_eq!(ProbeGrid::new(&solid, &model, None).unwrap_err().0, "none of these 1 probes is valid");
    }
}
