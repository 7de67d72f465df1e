//! The stage `Sensors`: irradiance at points, on grids and at probes.

use std::path::{Path, PathBuf};

use glam::DVec3;
use sir_radiosity::{Sensor, SensorSettings};

use crate::plan::border::{Border, BorderFormat};
use crate::plan::measure::Measure;
use crate::plan::points_file::PointsFile;
use crate::plan::probes::Probes;
use crate::plan::require::Require;
use crate::text::field::Format as _;
use crate::text::formats::{Direction, Flag, Text, Vector, count, number, positive};
use crate::text::reader::{Fields, Reader, inside};
use crate::text::record::{Body, choice, list_items, named, nested, record};
use crate::text::ron_tree::Node;
use crate::text::span::{Spanned, WithSpan};

const DEFAULT_RAYS: u64 = 16_384;
/// Largest number of rays of a sensor: all patches that they hit are stored to compute the error.
const MAX_RAYS: u64 = 10_000_000;

record! {
    /// Stage that measures irradiance at points.
    pub struct Sensors, check Sensors::check {
        /// Name of the sensors, and of their files in the run directory.
        pub name: String = Text("desk").required();
        /// Positions of the sensors.
        pub at: Spanned<Place> = WithSpan(named("Plane(height: 0.75, spacing: 0.25)")).required();
        /// Kind of irradiance that is measured, see below.
        pub measure: Measure = named("Cylindrical").or(Measure::Planar);
        /// Number of rays of each sensor over its hemisphere, rounded up to a multiple of 32. The same number is aimed
        /// at emitting surfaces, if there are any. A cylinder has four sensors, a probe six.
        pub rays: u64 = count(1, MAX_RAYS, DEFAULT_RAYS).or(DEFAULT_RAYS);
        /// Relative standard error at which a sensor stops early, after at least 2,048 rays; `0.005` is 0.5 %. The
        /// errors of patches are ignored.
        pub error: Option<f64> = positive(0.005).optional("none");
        /// True to state daylight factors, too, see below.
        pub daylight_factor: bool = Flag.or(false);
        /// True to measure glare: the unified glare rating of an eye at each sensor that looks where the sensor looks, see below.
        pub ugr: bool = Flag.or(false);
        /// Limits that are required, see below.
        pub require: Option<Box<Require>> = nested("(mean: 500, uniformity: 0.6)").optional("none");
    }
}

choice! {
    /// Positions of sensors.
    pub enum Place as "place" {
        /// Points listed in the pipeline.
        Points(Points),
        /// Points listed in a file.
        File(PointsFile),
        /// Centers of the cells of a parallelogram.
        Grid(Grid),
        /// Centers of the cells of a horizontal plane through a room.
        Plane(Plane),
        /// Points in a box, with the irradiance in all directions.
        Probes(Probes),
    }
}

/// Points listed in the pipeline, at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct Points(pub Vec<SensorPoint>);

record! {
    /// Point at which irradiance is measured.
    pub struct SensorPoint as "point" {
        /// Position of the sensor.
        pub position: DVec3 = Vector([1.0, 0.75, 2.0]).required().unit("m");
        /// Normal of the surface whose irradiance is measured.
        pub direction: DVec3 = Direction([0.0, 1.0, 0.0]).required();
    }
}

record! {
    /// Parallelogram, divided into cells.
    pub struct Grid, check Grid::check {
        /// One of its corners.
        pub corner: DVec3 = Vector([0.0, 0.75, 2.0]).required().unit("m");
        /// Edge from the corner that is shown from left to right.
        pub along: DVec3 = Vector([2.0, 0.0, 0.0]).required().unit("m");
        /// Edge from the corner that is shown from bottom to top.
        pub across: DVec3 = Vector([0.0, 0.0, -1.0]).required().unit("m");
        /// Approximate distance of neighboring sensors: edges are divided into whole cells. Without it, EN 12464-1 gives
        /// the number of cells, see below.
        pub spacing: Option<f64> = positive(0.25).optional("by EN 12464-1").unit("m");
        /// Direction in which the sensors look.
        pub direction: Option<DVec3> = Direction([0.0, 1.0, 0.0]).optional("the normal `along × across`");
    }
}

record! {
    /// Work plane of a room.
    pub struct Plane {
        /// Height above the lowest point of the scene.
        pub height: f64 = number(0.75).required().unit("m");
        /// Approximate distance of neighboring sensors: edges are divided into whole cells. Without it, EN 12464-1 gives
        /// the number of cells, see below.
        pub spacing: Option<f64> = positive(0.25).optional("by EN 12464-1").unit("m");
        /// Width of the border along the outline of the scene without sensors. `Standard` is that of EN 12464-1: 0.5 m, or
        /// 15 % of the shorter side of the plane if that is less.
        pub border: Border = BorderFormat.or(Border::Width(0.0)).unit("m");
        /// Direction in which the sensors look, for instance a horizontal one for vertical irradiance.
        pub direction: Option<DVec3> = Direction([1.0, 0.0, 0.0]).optional("`up`");
        /// Direction that is up, perpendicular to the plane.
        pub up: Option<DVec3> = Direction([0.0, 1.0, 0.0]).optional("the up direction of the scene");
    }
}

impl Sensors {
    /// Returns the path of the table of the sensors in the run directory.
    #[must_use]
    pub fn table(&self) -> PathBuf {
        self.output("csv")
    }

    /// Returns the path of the spherical harmonics in the run directory, if the sensors are probes.
    #[must_use]
    pub fn harmonics(&self) -> Option<PathBuf> {
        matches!(self.at.value, Place::Probes(_)).then(|| self.output("json"))
    }

    /// Returns the path of the false-color image in the run directory, if the sensors are on a grid.
    #[must_use]
    pub fn map(&self) -> Option<PathBuf> {
        matches!(self.at.value, Place::Grid(_) | Place::Plane(_)).then(|| self.output("png"))
    }

    /// Returns the number of rays and the target error.
    #[must_use]
    pub fn settings(&self) -> SensorSettings {
        SensorSettings::new(self.rays, self.error.unwrap_or(0.0))
    }

    fn output(&self, extension: &str) -> PathBuf {
        inside(Path::new(&format!("{}.{extension}", self.name)))
    }

    fn check<'a>(&self, reader: &mut Reader<'a>, fields: &Fields<'a>) {
        self.claim_outputs(reader, fields);
        if self.require.as_ref().is_some_and(|r| r.daylight_factor.is_some()) && !self.daylight_factor {
            let message = "a daylight factor is required, but not measured";
            reader.problem(fields.place_of("require"), message, "add `daylight_factor: true`");
        }
        if self.require.as_ref().is_some_and(|r| r.ugr.is_some()) && !self.ugr {
            reader.problem(
                fields.place_of("require"),
                "a UGR is required, but not measured",
                "add `ugr: true`",
            );
        }
        if self.ugr && self.measure != Measure::Planar {
            let message =
                "`ugr` needs the irradiance of a plane (that of the pupil), but `measure` is another";
            reader.problem(fields.place_of("measure"), message, "leave out `measure` or `ugr`");
        }
        if !matches!(self.at.value, Place::Probes(_)) {
            return;
        }
        for (field, is_given, message) in [
            (
                "measure",
                self.measure != Measure::Planar,
                "probes measure the irradiance of planes in all directions, and no other kind",
            ),
            (
                "require",
                self.require.is_some(),
                "probes have no requirements (standards state them for planes)",
            ),
            (
                "daylight_factor",
                self.daylight_factor,
                "probes have no daylight factor (it belongs to planes)",
            ),
            ("ugr", self.ugr, "probes have no UGR (it needs a line of sight)"),
        ] {
            if is_given {
                let help = format!("leave out `{field}`, or use `Points`, `Grid` or `Plane`");
                reader.problem(fields.place_of(field), message, help);
            }
        }
    }

    fn claim_outputs<'a>(&self, reader: &mut Reader<'a>, fields: &Fields<'a>) {
        let Some(node) = fields.get("name") else { return };
        if Path::new(&self.name).file_name().is_none() || self.name.ends_with(['/', '.']) {
            let message =
                format!("`name` must be the name of a file without extension, but it is {:?}", self.name);
            reader.problem(node.text, message, "write for instance `name: \"desk\"`");
            return;
        }
        let extensions: &[&str] = match self.at.value {
            Place::Grid(_) | Place::Plane(_) => &["csv", "png"],
            Place::Probes(_) => &["csv", "json"],
            Place::Points(_) | Place::File(_) => &["csv"],
        };
        for extension in extensions {
            reader.claim_output(node, &format!("{}.{extension}", self.name));
        }
    }
}

impl Place {
    /// Returns the points that the pipeline or a file lists, or `None` for a grid, a plane or probes.
    #[must_use]
    pub fn listed(&self) -> Option<Vec<Sensor>> {
        match self {
            Self::Points(Points(points)) => {
                Some(points.iter().filter_map(|p| Sensor::new(p.position, p.direction)).collect())
            }
            Self::File(file) => Some(file.sensors.clone()),
            Self::Grid(_) | Self::Plane(_) | Self::Probes(_) => None,
        }
    }
}

impl Body for Points {
    fn read<'a>(reader: &mut Reader<'a>, node: &Node<'a>) -> Option<Self> {
        let items = list_items(reader, node, "points", "(position: (1, 0.75, 2), direction: (0, 1, 0))")?;
        let points: Vec<_> = items.iter().map(|item| SensorPoint::read(reader, item)).collect();
        points.into_iter().collect::<Option<_>>().map(Self)
    }

    fn write(&self, name: &str) -> String {
        let points: Vec<String> = self.0.iter().map(|point| point.write("")).collect();
        format!("{name}([{}])", points.join(", "))
    }
}

impl Grid {
    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        if self.along.cross(self.across).try_normalize().is_none() {
            let help = "give `along` and `across` different directions and nonzero lengths";
            reader.problem(fields.place, "this grid has no area", help);
        }
    }
}
