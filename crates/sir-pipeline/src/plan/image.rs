//! Images of the solution.

use std::path::PathBuf;

use glam::DVec3;
use sir_geom::Projection;
use sir_view::Exposure;

use crate::plan::show::{ColorScale, Limits, SCALE, SHOW, Show};
use crate::text::field::Format;
use crate::text::formats::{Count, Direction, Flag, Vector, count, positive, quoted};
use crate::text::paths::OutputFile;
use crate::text::reader::{Fields, Reader};
use crate::text::record::{Body as _, record};
use crate::text::ron_tree::{Node, Value};
use crate::text::span::{Spanned, WithSpan};

record! {
    /// Image of the solution.
    pub struct Image, check Image::check {
        /// `.png`: 8 bits per channel, for viewing. `.exr`: linear radiance in W/(m² sr), 32-bit floats, without
        /// exposure and tone curve, in the channels `R`, `G`, `B`; its standard error is in `error.R`, `error.G`,
        /// `error.B`.
        pub path: PathBuf = OutputFile { extensions: &["png", "exr"], example: "view.png" }.required();
        /// Width of the image.
        pub width: u32 = pixels(800).or(800).unit("pixels");
        /// Height of the image. If omitted, it follows from the aspect ratio of the scene's camera, or is three
        /// quarters of the width.
        pub height: Option<u32> = pixels(600).optional("from the camera").unit("pixels");
        /// Number of rays per pixel along each edge: 4 means 16 rays.
        pub samples: u32 = count(1, 64, 4).or(4);
        /// Factor on the radiance in PNG images. `Auto` maps the typical brightness of the image to middle gray.
        pub exposure: Exposure = ExposureFormat.or(Exposure::Auto);
        /// True to denoise a PNG image, see below. EXR images, tables and lit scenes are never denoised.
        pub denoise: bool = Flag.or(true);
        /// What a PNG image shows: `Colors`, the scene as it looks; or in false colors with a scale `Luminance`, or
        /// `Illuminance` of the surfaces; see below.
        pub show: Show = SHOW.or(Show::Colors);
        /// Scale of false colors.
        pub scale: Option<ColorScale> = SCALE.optional("`Logarithmic` for `Luminance`, `Linear` for `Illuminance`");
        /// Values with the darkest and the lightest of the false colors, in W/(m² sr) or W/m².
        pub limits: Option<[f64; 2]> = Limits([0.0, 500.0]).optional("from the picture");
        /// Point of view, see below. If the scene has no camera, a point of view that shows much of it is chosen.
        pub camera: Option<Spanned<CameraChoice>> = WithSpan(CameraFormat).optional("the scene's first");
    }
}

impl Image {
    /// Returns the scale of false colors.
    #[must_use]
    pub fn color_scale(&self) -> ColorScale {
        self.scale.unwrap_or(self.show.usual_scale())
    }

    /// True if the file is an EXR image.
    pub(crate) fn is_exr(&self) -> bool {
        self.path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr"))
    }

    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        if self.show == Show::Colors {
            let help = "add for instance `show: Luminance`, or leave it out";
            for field in ["scale", "limits"].into_iter().filter(|field| fields.get(field).is_some()) {
                let message = format!("`{field}` has no effect (it belongs to false colors)");
                reader.problem(fields.place_of(field), message, help);
            }
            return;
        }
        if self.is_exr() {
            let message = "an EXR image has no false colors (it holds the radiance itself)";
            reader.problem(fields.place_of("show"), message, "choose a `.png` path, or leave out `show`");
        }
        if self.exposure != Exposure::Auto {
            let message = "`exposure` has no effect (false colors have a scale instead)";
            reader.problem(fields.place_of("exposure"), message, "write `limits: (0, 500)` or leave it out");
        }
        if self.color_scale() == ColorScale::Logarithmic && self.limits.is_some_and(|[low, _]| low <= 0.0) {
            let message = "a logarithmic scale cannot begin at zero";
            let help = "begin `limits` above zero, or write `scale: Linear`";
            reader.problem(fields.place_of("limits"), message, help);
        }
    }
}

fn pixels(example: u64) -> Count<u32> {
    count(1, 16_384, example)
}

/// Point of view of an image.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraChoice {
    /// Number of a camera of the scene, from 0.
    Number(u32),
    /// Name of a camera of the scene.
    Name(String),
    /// Camera described by the pipeline.
    Own(Camera),
}

record! {
    /// Camera described by a pipeline.
    pub struct Camera, check Camera::check {
        /// Position of the eye.
        pub eye: DVec3 = Vector([1.0, 2.0, 5.0]).required().unit("m");
        /// Point in the center of the image.
        pub target: DVec3 = Vector([1.0, 1.0, 0.0]).required().unit("m");
        /// Direction that is up in the image.
        pub up: Option<DVec3> = Direction([0.0, 1.0, 0.0]).optional("the up direction of the scene");
        /// Full vertical field of view.
        pub fov: f64 =
            positive(45.0).with_range(|x| 0.0 < x && x < 180.0, "above 0 and below 180").or(45.0).unit("degrees");
    }
}

impl Camera {
    /// Returns the camera in a scene with this up direction, or `None` if `eye` and `target` coincide, or `up` points
    /// along the view. A camera without `up` may look straight up or down.
    #[must_use]
    pub fn to_scene(&self, up_of_scene: DVec3) -> Option<sir_geom::Camera> {
        let with = |up| sir_geom::Camera::looking_at(self.eye, self.target, up, self.fov.to_radians());
        match self.up {
            Some(up) => with(up),
            None => with(up_of_scene).or_else(|| with(up_of_scene.any_orthogonal_vector())),
        }
    }

    /// Returns a camera of a scene, with numbers rounded to six decimals. Returns `None` if it is not in perspective.
    #[must_use]
    pub fn of_scene(camera: &sir_geom::Camera) -> Option<Self> {
        let Projection::Perspective { vertical_fov } = camera.projection else { return None };
        let rounded = |v: DVec3| DVec3::from_array(v.to_array().map(round));
        Some(Self {
            eye: rounded(camera.eye),
            target: rounded(camera.eye + camera.forward),
            up: Some(rounded(camera.up)),
            fov: round(vertical_fov.to_degrees()),
        })
    }

    /// Writes the camera as a pipeline states it.
    #[must_use]
    pub fn to_ron(&self) -> String {
        self.write("Camera")
    }

    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        if self.to_scene(DVec3::Y).is_none() {
            let message =
                "this camera has no direction: `eye` and `target` coincide, or `up` points along the view";
            let help = "move `target` away from `eye`, and choose an `up` that is not parallel to the view";
            reader.problem(fields.place, message, help);
        }
    }
}

/// Rounds a number to six decimals, so that it is written with no more.
fn round(x: f64) -> f64 {
    // The text has the nearest number to it, unlike the result of a division.
    format!("{:.6}", x + 0.0).parse().unwrap_or(x)
}

/// Format of an exposure: `Auto`, or a factor.
#[derive(Clone, Copy)]
struct ExposureFormat;

impl Format for ExposureFormat {
    type Value = Exposure;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<Exposure> {
        if node.name() == "Auto" && node.value == Value::Items(Vec::new()) {
            return Some(Exposure::Auto);
        }
        if node.value == Value::Number {
            return positive(1.5).read(reader, node, name).map(Exposure::Factor);
        }
        let message = format!("`{name}` must be `Auto` or a number, but it is {}", node.kind());
        reader.problem(node.text, message, format!("write `{name}: Auto` or for instance `{name}: 1.5`"));
        None
    }

    fn write(&self, value: &Exposure) -> String {
        match value {
            Exposure::Auto => "Auto".into(),
            Exposure::Factor(factor) => positive(1.5).write(factor),
        }
    }

    fn describe(&self) -> String {
        "`Auto` or a number above 0".into()
    }

    fn example(&self) -> String {
        "Auto".into()
    }
}

/// Format of a camera: the number or the name of a camera of the scene, or a description.
#[derive(Clone, Copy)]
struct CameraFormat;

impl CameraFormat {
    const NUMBER: fn() -> Count<u32> = || count(0, 1_000_000, 0);
}

impl Format for CameraFormat {
    type Value = CameraChoice;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<CameraChoice> {
        match (&node.value, node.name()) {
            (Value::Number, _) => Self::NUMBER().read(reader, node, name).map(CameraChoice::Number),
            (Value::Text(text), _) => Some(CameraChoice::Name(text.clone())),
            (Value::Fields(_) | Value::Items(_), "Camera") => {
                Camera::read(reader, node).map(CameraChoice::Own)
            }
            _ => {
                let what = "a `Camera(…)`, or the number or name of one";
                let example = "0` or `camera: Camera(eye: (1, 2, 5), target: (1, 1, 0))";
                reader.wrong_value(node, name, what, example);
                None
            }
        }
    }

    fn write(&self, value: &CameraChoice) -> String {
        match value {
            CameraChoice::Number(number) => Self::NUMBER().write(number),
            CameraChoice::Name(name) => quoted(name),
            CameraChoice::Own(camera) => camera.write("Camera"),
        }
    }

    fn describe(&self) -> String {
        "number, string or `Camera(…)`".into()
    }

    fn example(&self) -> String {
        "0".into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_of_a_scene_is_written_with_few_digits() {
        let eye = DVec3::new(1.0, 2.0 / 3.0, -5.0);
        let camera = sir_geom::Camera::looking_at(eye, DVec3::ZERO, DVec3::Y, 1.13).unwrap();
        let text = Camera::of_scene(&camera).unwrap().to_ron();
        assert_eq!(
            text,
            "Camera(eye: (1, 0.666667, -5), target: (0.805539, 0.537026, -4.027694), up: (0, 1, 0), fov: 64.744231)"
        );
    }
}
