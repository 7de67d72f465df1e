//! Luminaires with a photometric file.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use sir_geom::{Light, LightKind, Rgb, Spread, Tabulated, luminance};
use sir_photometry::OpeningLight;

use crate::plan::light_color::{TEMPERATURES, of_black_body, of_unit_luminance};
use crate::plan::light_group::group;
use crate::plan::photometric_file::{Photometric, PhotometricFile};
use crate::plan::scene_light::{PlacedLuminaire, SceneLight};
use crate::text::field::Format as _;
use crate::text::formats::{Choice, Color, Direction, Text, Vector, count, number, positive};
use crate::text::reader::{Fields, Reader};
use crate::text::record::record;
use crate::text::span::{Span, Spanned, WithSpan};

/// Largest number of luminaires along a row or column.
const MAX_COPIES: u64 = 10_000;

/// Bytes per luminaire that is a point, with its source: measured, rounded up.
const POINT_BYTES: usize = 1_000;

/// Bytes per triangle of the opening of a luminaire, with its materials, patches and sources: measured, rounded up.
const OPENING_BYTES: usize = 500;

/// The `dimming` without a position.
const FULL: Spanned<f64> = Spanned { value: 1.0, span: Span(0..0) };

const OPENINGS: Choice<OpeningChoice> =
    Choice(&[("Point", OpeningChoice::Point), ("FromFile", OpeningChoice::FromFile)]);

record! {
    /// Luminaire with a photometric file, or an array of equal ones.
    pub struct Luminaire, check Luminaire::check {
        /// Photometric file, IES LM-63 or EULUMDAT, relative to the folder of the pipeline file.
        pub file: PhotometricFile = Photometric.required();
        /// Name in reports and of the surfaces of its opening.
        pub name: Option<String> = Text("downlight").optional("name of the file");
        /// Position of the center of the luminous opening; in an array, that of the first luminaire.
        pub position: DVec3 = Vector([2.0, 2.7, 3.0]).required().unit("m");
        /// Direction of the polar angle 0 of the file.
        pub aim: Option<DVec3> = Direction([0.0, -1.0, 0.0]).optional("down");
        /// Point at which it is aimed, instead of `aim`. In an array, all are aimed at it.
        pub target: Option<DVec3> = Vector([2.0, 0.75, 3.0]).optional("none").unit("m");
        /// Rotation about the aim, counterclockwise seen from behind (from above, if it is aimed down).
        pub rotate: f64 = number(90.0).or(0.0).unit("degrees");
        /// Number of luminaires in a row.
        pub columns: u32 = count(1, MAX_COPIES, 4).or(1);
        /// Distance from one luminaire to the next in a row.
        pub column_step: DVec3 = Vector([1.8, 0.0, 0.0]).or(DVec3::ZERO).unit("m");
        /// Number of rows.
        pub rows: u32 = count(1, MAX_COPIES, 3).or(1);
        /// Distance from one row to the next.
        pub row_step: DVec3 = Vector([0.0, 0.0, 2.4]).or(DVec3::ZERO).unit("m");
        /// Flux of one luminaire before `dimming` and `maintenance`.
        pub flux: Option<f64> = positive(3600.0).optional("that of the intensities in the file").unit("lm");
        /// Factor of the light, to dim it.
        pub dimming: Spanned<f64> =
            WithSpan(number(0.8).with_range(|x| (0.0..=1.0).contains(&x), "from 0 to 1")).or(FULL);
        /// Maintenance factor: the share of the initial light that is left before maintenance.
        pub maintenance: f64 = number(0.8).with_range(|x| x > 0.0 && x <= 1.0, "above 0, at most 1").or(1.0);
        /// Color of the light; the flux is the same for all colors.
        pub color: Rgb = Color(1.0).or(Rgb::ONE);
        /// Color temperature, instead of `color`: that of a black body.
        pub temperature: Option<f64> = number(4000.0)
            .with_range(|x| TEMPERATURES.contains(&x), "from 1,700 to 25,000")
            .optional("none")
            .unit("K");
        /// Where the light comes from: a point, or the luminous opening that the file describes, see below.
        pub opening: OpeningChoice = OPENINGS.or(OpeningChoice::Point);
        /// Electric power of one luminaire.
        pub watts: Option<f64> = positive(32.0).optional("that of the file").unit("W");
        /// Light group, which `sir mix` can dim after the run.
        pub group: Option<String> = group();
    }
}

/// Origin of the light of a luminaire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpeningChoice {
    /// A point.
    Point,
    /// The luminous opening in the photometric file.
    FromFile,
}

impl Luminaire {
    /// Returns the name in reports.
    #[must_use]
    pub fn label(&self) -> String {
        self.name.clone().unwrap_or_else(|| self.file.stem())
    }

    /// Returns the number of luminaires in the array.
    #[must_use]
    pub fn count(&self) -> u64 {
        u64::from(self.columns) * u64::from(self.rows)
    }

    /// Returns an estimate of the memory that the luminaires take in a scene \[bytes\].
    pub(crate) fn bytes_in_scene(&self) -> usize {
        let of_one = match self.opening {
            OpeningChoice::Point => POINT_BYTES,
            OpeningChoice::FromFile => {
                let faces = self.file.contents.opening.faces();
                OPENING_BYTES * faces.iter().map(|face| face.corners.len().saturating_sub(2)).sum::<usize>()
            }
        };
        usize::try_from(self.count()).map_or(usize::MAX, |count| count.saturating_mul(of_one))
    }

    /// Returns the factor of its flux if its light has a factor per band.
    pub(crate) fn dimming_by(&self, factor: Rgb) -> f64 {
        self.unit_color().map_or(1.0, |color| luminance(color * factor))
    }

    /// Returns the color of its light, with a luminance of 1; `None` if it is black.
    fn unit_color(&self) -> Option<Rgb> {
        match self.temperature {
            Some(temperature) => Some(of_black_body(temperature)),
            None => of_unit_luminance(self.color),
        }
    }

    /// Returns the direction of the aim of the luminaire at a position, of unit length; `None` if that is its target.
    pub(crate) fn aim_at(&self, position: DVec3, up: DVec3) -> Option<DVec3> {
        let aim = match (self.target, self.aim) {
            (Some(target), _) => target - position,
            (None, aim) => aim.unwrap_or(-up),
        };
        aim.try_normalize()
    }

    /// Returns the positions of all luminaires of the array \[m\], row by row.
    pub fn positions(&self) -> impl Iterator<Item = DVec3> {
        let Self { position, columns, column_step, rows, row_step, .. } = *self;
        (0..rows).flat_map(move |row| {
            (0..columns)
                .map(move |column| position + f64::from(column) * column_step + f64::from(row) * row_step)
        })
    }

    /// Returns the flux of one luminaire \[lm\], with all factors.
    #[must_use]
    pub fn flux_of_one(&self) -> f64 {
        let flux = self.flux.unwrap_or_else(|| self.file.contents.distribution.flux());
        flux * self.dimming.value * self.maintenance
    }

    /// Returns the electric power of one luminaire \[W\], if it is known. Dimming does not change it.
    #[must_use]
    pub fn watts_of_one(&self) -> Option<f64> {
        self.watts.or(self.file.contents.watts)
    }

    /// Converts all luminaires for a scene with this up direction, of unit length. Returns `None` if its numbers contradict
    /// each other.
    pub(crate) fn to_scene(&self, up: DVec3) -> Option<Vec<SceneLight>> {
        let color = self.unit_color()?;
        let contents = &self.file.contents;
        // Per candela of the file.
        let factor = color * (self.flux_of_one() / contents.distribution.flux());
        let placed = self.positions().map(|position| {
            let frame = self.frame(position, up)?;
            Some(PlacedLuminaire { position, frame, factor: factor * self.tilt_factor(frame, up) })
        });
        let placed: Vec<PlacedLuminaire> = placed.collect::<Option<_>>()?;
        if self.opening == OpeningChoice::FromFile {
            let light = OpeningLight::new(contents.distribution.clone(), &contents.opening)?;
            return Some(vec![SceneLight::Openings { name: self.label(), light: Arc::new(light), placed }]);
        }
        let shape = Tabulated::new(contents.distribution.clone(), DMat3::IDENTITY);
        let largest = contents.distribution.largest();
        let to_light = |PlacedLuminaire { position, frame, factor }| {
            let intensity = factor * largest;
            let spread = Spread::Tabulated(shape.turned(frame));
            let kind = LightKind::Point { position, intensity, spread };
            SceneLight::Light(Light { name: self.label(), kind })
        };
        Some(placed.into_iter().map(to_light).collect())
    }

    /// Returns the factor of the light of a luminaire with these axes, if its lamp depends on its tilt.
    fn tilt_factor(&self, frame: DMat3, up: DVec3) -> f64 {
        let angle = libm::acos(frame.z_axis.dot(up).clamp(-1.0, 1.0));
        self.file.contents.tilt.as_ref().map_or(1.0, |tilt| tilt.factor(angle.to_degrees()))
    }

    /// Returns the axes of a luminaire at a position. Aimed down, with a rotation of 0, its length is along +x, or along +y if x
    /// is up. It is turned from there to its aim on the shortest way; to be aimed up, about its length.
    fn frame(&self, position: DVec3, up: DVec3) -> Option<DMat3> {
        let aim = self.aim_at(position, up)?;
        let guide = if up.x.abs() > 0.9 { DVec3::Y } else { DVec3::X };
        let length = guide.reject_from_normalized(up).try_normalize()?;
        let upright = DMat3::from_cols(length, up.cross(length), up);
        let (sin, cos) = libm::sincos(self.rotate.to_radians());
        let rotation = DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z);
        let turn = shortest_turn(-up, aim)
            .unwrap_or(DMat3::from_cols(length, -up.cross(length), -up) * upright.transpose());
        Some(turn * upright * rotation)
    }

    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        let mut both = |first: &str, second: &str| {
            if fields.get(first).is_some() && fields.get(second).is_some() {
                let message = format!("`Luminaire` has both `{first}` and `{second}`");
                reader.problem(fields.place_of(second), message, "keep one of them");
            }
        };
        both("aim", "target");
        both("color", "temperature");
        for (many, counts, step, name) in [
            (self.columns, "columns", self.column_step, "column_step"),
            (self.rows, "rows", self.row_step, "row_step"),
        ] {
            if many == 1 && step != DVec3::ZERO {
                let help = format!("give the number of luminaires as `{counts}`, or leave out `{name}`");
                let message = format!("`{name}` has no effect (`{counts}` is 1)");
                reader.problem(fields.place_of(name), message, help);
            }
            if many > 1 && step == DVec3::ZERO {
                let message = format!("{many} luminaires are at the same place (`{name}` is zero)");
                reader.problem(
                    fields.place,
                    message,
                    format!("give the distance between two of them as `{name}`"),
                );
            }
        }
        if of_unit_luminance(self.color).is_none() {
            let help = "choose another color, or `dimming: 0` for no light";
            reader.problem(fields.place_of("color"), "the `color` of the luminaire is black", help);
        }
        if self.target.is_some_and(|target| self.positions().any(|position| position == target)) {
            let help = "choose a `target` away from the luminaire, or a direction with `aim`";
            reader.problem(fields.place_of("target"), "the `target` is the position of a luminaire", help);
        }
        if self.opening == OpeningChoice::FromFile
            && self.file.contents.opening.faces().iter().all(|face| face.area == 0.0)
        {
            let help = "leave out `opening`: the light then comes from a point";
            let message = "the photometric file describes no luminous opening (its dimensions are zero)";
            reader.problem(fields.place_of("opening"), message, help);
        }
    }
}

/// Returns the rotation about an axis perpendicular to both that turns one unit vector to another; `None` if they are opposite,
/// so that there is no shortest one.
fn shortest_turn(from: DVec3, to: DVec3) -> Option<DMat3> {
    let (axis, cosine) = (from.cross(to), from.dot(to));
    if cosine < -1.0 + 1e-12 {
        return None;
    }
    let cross = DMat3::from_cols(
        DVec3::new(0.0, axis.z, -axis.y),
        DVec3::new(-axis.z, 0.0, axis.x),
        DVec3::new(axis.y, -axis.x, 0.0),
    );
    Some(DMat3::IDENTITY + cross + cross * cross * (1.0 / (1.0 + cosine)))
}
