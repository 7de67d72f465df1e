//! Positions of the sensors of a stage.

use glam::{DVec2, DVec3};
use sir_accel::Tracer;
use sir_geom::{BoundingBox, Scene, Side};
use sir_radiosity::{Model, Sensor, SensorStart};

use crate::plan::{Border, Grid, Measure, Place, Plane, Sensors};
use crate::prepare::probe_grid::ProbeGrid;
use crate::prepare::standard_grid;

/// Maximum number of cells of a grid.
const MAX_CELLS: f64 = 1e6;

/// What a stage `Sensors` measures.
#[derive(Clone, Debug, PartialEq)]
pub enum Placed {
    /// Irradiance at sensors.
    Sensors(Layout),
    /// Irradiance in all directions at probes.
    Probes(ProbeGrid),
}

/// Sensors of a stage, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Sensors, at least one.
    pub sensors: Vec<Sensor>,
    /// Cells of the sensors, if they are on a grid.
    pub cells: Option<Cells>,
}

/// Cells of a grid, numbered row by row from the lower left.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    /// Number of cells in a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Width and height of the grid \[m\].
    pub size: DVec2,
    /// Estimate of the area of the room, with its border \[m²\], if the grid covers one.
    pub room: Option<f64>,
    /// Number of the cell of each sensor. Cells without a sensor are outside of the room.
    pub of: Vec<usize>,
}

impl Placed {
    /// Places the sensors or probes. The error has a message, which says why there are none, and a suggested fix.
    pub(crate) fn new(
        sensors: &Sensors,
        model: &Model,
        up: DVec3,
        focus: Option<BoundingBox>,
    ) -> Result<Self, (String, String)> {
        let place = &sensors.at.value;
        let layout = match place {
            Place::Points(_) | Place::File(_) => {
                Layout { sensors: place.listed().unwrap_or_default(), cells: None }
            }
            Place::Grid(grid) => grid.layout(&mut |_| true)?,
            Place::Plane(plane) => plane.layout(model, up)?,
            Place::Probes(probes) => return ProbeGrid::new(probes, model, focus).map(Self::Probes),
        };
        let axis = match place {
            Place::Plane(plane) => plane.up.unwrap_or(up),
            _ => up,
        };
        layout.measuring(&sensors.measure, axis).map(Self::Sensors)
    }

    /// Returns the number of hemispheres of rays: a sensor has one or four, a valid probe six.
    #[must_use]
    pub fn hemispheres(&self) -> u64 {
        match self {
            Self::Sensors(layout) => layout.sensors.iter().map(Sensor::hemispheres).sum(),
            Self::Probes(grid) => 6 * grid.valid.len() as u64,
        }
    }
}

impl Layout {
    /// Returns sensors at the same positions that measure a kind of irradiance, with cylinders around `axis`.
    fn measuring(self, measure: &Measure, axis: DVec3) -> Result<Self, (String, String)> {
        let convert = |sensor: &Sensor| match measure {
            Measure::Planar => Some(*sensor),
            Measure::Cylindrical => Sensor::cylindrical(sensor.position(), axis),
            Measure::SemiCylindrical(half) => {
                let direction = half.direction.unwrap_or(sensor.direction());
                Sensor::semi_cylindrical(sensor.position(), axis, direction)
            }
        };
        let sensors = self.sensors.iter().map(convert).collect::<Option<Vec<_>>>().ok_or_else(|| {
            let message = "a half cylinder faces along its axis, the up direction of the scene or plane";
            let help = "give `SemiCylindrical` a horizontal `direction`, as in `SemiCylindrical(direction: (1, 0, 0))`";
            (message.to_owned(), help.to_owned())
        })?;
        Ok(Self { sensors, ..self })
    }
}

impl Grid {
    /// Places a sensor at the center of every cell for which `wanted` returns true.
    fn layout(&self, wanted: &mut dyn FnMut(&Sensor) -> bool) -> Result<Layout, (String, String)> {
        let Self { corner, along, across, spacing, direction } = *self;
        let direction = direction.unwrap_or_else(|| along.cross(across));
        let size = DVec2::new(along.length(), across.length());
        let counts = match spacing {
            Some(spacing) => (size / spacing).round().max(DVec2::ONE),
            None => standard_grid::counts(size),
        };
        if counts.x * counts.y > MAX_CELLS {
            let message = format!("a grid of {:.0} by {:.0} sensors is too fine", counts.x, counts.y);
            let help = match spacing {
                Some(_) => "choose a larger `spacing`",
                None => "choose a smaller area, or state a `spacing`",
            };
            return Err((message, help.into()));
        }
        let (columns, rows) = (counts.x as usize, counts.y as usize);
        let (mut sensors, mut of) = (Vec::new(), Vec::new());
        for cell in 0..columns * rows {
            let [x, y] =
                [(cell % columns, counts.x), (cell / columns, counts.y)].map(|(i, n)| (i as f64 + 0.5) / n);
            let Some(sensor) = Sensor::new(corner + x * along + y * across, direction) else { continue };
            if wanted(&sensor) {
                sensors.push(sensor);
                of.push(cell);
            }
        }
        Ok(Layout { sensors, cells: Some(Cells { columns, rows, size, room: None, of }) })
    }
}

impl Plane {
    fn layout(&self, model: &Model, scene_up: DVec3) -> Result<Layout, (String, String)> {
        let up = self.up.unwrap_or(scene_up).normalize();
        // The plane as seen from above, with x from left to right unless x is up.
        let guide = if up.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
        let along = guide.reject_from_normalized(up).normalize();
        let across = up.cross(along);
        let [[left, right], [bottom, top], [lowest, _]] =
            [along, across, up].map(|axis| extent(&model.scene, axis));
        let all = DVec2::new(right - left, top - bottom);
        let border = match self.border {
            Border::Standard => standard_grid::border(all),
            Border::Width(width) => width,
        };
        let size = all - 2.0 * border;
        if size.min_element() <= 0.0 {
            let message = format!(
                "nothing is left of the scene, {:.3} by {:.3} m, inside a border of {border} m",
                all.x, all.y
            );
            return Err((message, "choose a smaller `border`".into()));
        }
        let corner = (left + border) * along + (bottom + border) * across + (lowest + self.height) * up;
        let (along, across) = (size.x * along, size.y * across);
        let direction = Some(self.direction.unwrap_or(up));
        let grid = Grid { corner, along, across, spacing: self.spacing, direction };
        let mut tracer = model.accel.tracer();
        let mut layout = grid.layout(&mut |sensor| is_inside(sensor.position(), up, model, &mut tracer))?;
        if layout.sensors.is_empty() {
            let message =
                format!("no point of the plane at the height {} m lies inside the room", self.height);
            let help = "choose another `height`, above the lowest point of the scene, or `up`; points from which backs of \
                        surfaces are seen are outside";
            return Err((message, help.into()));
        }
        if let Some(cells) = &mut layout.cells {
            let share = cells.of.len() as f64 / (cells.columns * cells.rows) as f64;
            cells.room = Some(all.x * all.y * share);
        }
        Ok(layout)
    }
}

/// Returns the smallest and the largest coordinate of a scene along a direction.
fn extent(scene: &Scene, axis: DVec3) -> [f64; 2] {
    let coordinates = scene.vertices().iter().map(|vertex| vertex.dot(axis));
    coordinates.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| [least.min(x), most.max(x)])
}

/// Returns true if a point is in the room, and not inside of a piece of furniture. There must be a surface below the
/// point, and the first surfaces below and above must not show the back of a one-sided surface. (The sky may be above.)
pub(super) fn is_inside(point: DVec3, up: DVec3, model: &Model, tracer: &mut Tracer<'_>) -> bool {
    let Some(sensor) = Sensor::new(point, up) else { return false };
    let start = SensorStart::of(&sensor, model, tracer);
    let is_active = |triangle, side| model.scene.is_active(triangle, side);
    let mut sees =
        |direction| tracer.closest(&start.ray(direction)).map(|hit| is_active(hit.triangle, hit.side));
    let below = match start.surface {
        Some(surface) if model.scene.normal(surface).dot(up) > 0.0 => Some(is_active(surface, Side::Front)),
        Some(surface) => Some(is_active(surface, Side::Back)),
        None => sees(-up),
    };
    below == Some(true) && sees(up) != Some(false)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::SemiCylindrical;
    use sir_geom::shapes::{self, Facing};
    use sir_geom::{Material, Rgb, SceneBuilder};
    use sir_mesh::Subdivision;

    /// A room of 4 by 3 m in an L shape, 2 m high, with a table 0.7 m high, y up.
    fn room() -> Model {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("", Rgb::splat(0.5)));
        let outline = [(0., 0.), (4., 0.), (4., 1.), (2., 1.), (2., 3.), (0., 3.)];
        let corner = |i: usize, y: f64| {
            let (x, z): (f64, f64) = outline[i % outline.len()];
            DVec3::new(x, y, z)
        };
        for i in 0..outline.len() {
            shapes::quad(&mut b, [corner(i, 0.0), corner(i + 1, 0.0), corner(i + 1, 2.0), corner(i, 2.0)], m);
        }
        for (y, turned) in [(0.0, true), (2.0, false)] {
            for (x, z) in [([0., 2.], [0., 1.]), ([2., 4.], [0., 1.]), ([0., 2.], [1., 3.])] {
                let at = |i: usize, k: usize| DVec3::new(x[i], y, z[k]);
                let mut corners = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
                if turned {
                    corners.reverse();
                }
                shapes::quad(&mut b, corners, m);
            }
        }
        shapes::cuboid(&mut b, DVec3::new(0.5, 0.0, 1.5), DVec3::new(1.5, 0.7, 2.5), [m; 6], Facing::Outward);
        Model::new(b.build().unwrap().scene, Subdivision::PerTriangle).unwrap()
    }

    #[test]
    fn a_plane_stays_in_the_room_and_out_of_the_furniture() {
        let (model, plane) = (
            room(),
            Plane { height: 0.3, spacing: Some(0.1), border: Border::Width(0.0), direction: None, up: None },
        );
        let count = |plane: &Plane| plane.layout(&model, DVec3::Y).map(|layout| layout.sensors.len());
        // 8 m² without the square meter of the table; all 8 m² on and above its top.
        assert_eq!(count(&plane), Ok(700));
        assert_eq!(count(&Plane { height: 0.7, ..plane }), Ok(800));
        assert_eq!(count(&Plane { height: 1.0, ..plane }), Ok(800));
        // Half a meter from the outline: 1.5 by 2 m and 1.5 by 0.5 m, without the table.
        assert_eq!(count(&Plane { border: Border::Width(0.5), ..plane }), Ok(275));
        for bad in [
            Plane { height: 2.5, ..plane },
            Plane { border: Border::Width(1.5), ..plane },
            Plane { spacing: Some(1e-3), ..plane },
        ] {
            assert!(count(&bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn a_plane_without_a_spacing_has_the_grid_and_the_border_of_the_standard() {
        let plane = Plane { height: 1.0, spacing: None, border: Border::Standard, direction: None, up: None };
        let cells = plane.layout(&room(), DVec3::Y).unwrap().cells.unwrap();
        // 15 % of 3 m.
        assert!((cells.size - DVec2::new(3.1, 2.1)).length() < 1e-12);
        // p(3.1 m) = 0.44 m: 7 cells of 0.443 m, and 5 across.
        assert_eq!((cells.columns, cells.rows), (7, 5));
    }

    #[test]
    fn sensors_of_a_plane_may_look_elsewhere() {
        let plane = Plane {
            height: 1.0,
            spacing: Some(1.0),
            border: Border::Width(0.0),
            direction: Some(DVec3::X),
            up: None,
        };
        let layout = plane.layout(&room(), DVec3::Y).unwrap();
        assert!(layout.sensors.len() == 8 && layout.sensors.iter().all(|s| s.direction() == DVec3::X));
        let half = Measure::SemiCylindrical(SemiCylindrical { direction: None });
        assert!(layout.clone().measuring(&half, DVec3::X).is_err());
        let layout = layout.measuring(&half, DVec3::Y).unwrap();
        assert!(layout.sensors.iter().all(|s| s.direction() == DVec3::X && s.hemispheres() == 4));
    }

    #[test]
    fn cells_are_numbered_from_the_lower_left_as_seen_from_above() {
        let layout =
            Plane { height: 1.0, spacing: Some(1.0), border: Border::Width(0.0), direction: None, up: None }
                .layout(&room(), DVec3::Y)
                .unwrap();
        let cells = layout.cells.unwrap();
        assert_eq!((cells.columns, cells.rows, cells.size), (4, 3, DVec2::new(4.0, 3.0)));
        // −z is at the top.
        assert_eq!(layout.sensors[0].position(), DVec3::new(0.5, 1.0, 2.5));
        assert_eq!(cells.of, [0, 1, 4, 5, 8, 9, 10, 11]);
    }
}
