//! Glare: whether it can be measured in a scene.

use glam::DVec3;
use sir_geom::{LightKind, Scene};

use crate::prepare::layout::Placed;

/// Smallest sine of the angle between a line of sight and the vertical.
const SLANTED: f64 = 0.1;

/// Checks that sensors can rate glare. The error has a message, which says why not, and a suggested fix.
pub(super) fn check(placed: &Placed, scene: &Scene, up: DVec3) -> Result<(), (String, String)> {
    if let Some(point) = scene.lights().iter().find(|light| matches!(light.kind, LightKind::Point { .. })) {
        let name = match point.name.as_str() {
            "" => String::new(),
            name => format!(" \"{name}\""),
        };
        let message = format!("`ugr` cannot rate the light{name} (it is a point, which has no luminance)");
        return Err((
            message,
            "write `opening: FromFile` in each `Luminaire`, or use panels and emitting surfaces".into(),
        ));
    }
    let Placed::Sensors(layout) = placed else { return Ok(()) };
    match layout.sensors.iter().find(|sensor| sensor.direction().cross(up).length() < SLANTED) {
        Some(_) => {
            let message = "`ugr` needs lines of sight, but sensors look straight up or down";
            let help =
                "give the place a horizontal `direction`, as in `Plane(height: 1.2, direction: (1, 0, 0))`";
            Err((message.into(), help.into()))
        }
        None => Ok(()),
    }
}
