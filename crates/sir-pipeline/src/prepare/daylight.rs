//! Daylight factors: which scenes have them, and the irradiance to which they refer.

use sir_geom::luminance;
use sir_radiosity::{Emitter, Source};

use crate::plan::{Action, Cie, Lamp, Pipeline, Sky, SkyModel};
use crate::prepare::sources::kinds;

/// Largest type of the CIE general sky that is overcast.
const LAST_OVERCAST: u8 = 5;

/// Returns the luminance-weighted irradiance of an unobstructed horizontal surface by the sky \[W/m²\]. The error has a
/// message, which says why there are no daylight factors, and a suggested fix.
pub(super) fn outdoor(pipeline: &Pipeline, sources: &[Source]) -> Result<f64, (String, String)> {
    let lamps = pipeline.stages.iter().flat_map(|stage| match &stage.action {
        Action::Light(light) => light.lamps.as_slice(),
        _ => &[],
    });
    let sky = lamps.filter_map(|lamp| if let Lamp::Sky(sky) = lamp { Some(sky) } else { None }).next();
    let add = "add `Light([Sky(model: Overcast, horizontal: 10_000)])`";
    let Some(Sky { model, horizontal, .. }) = sky else {
        return Err(("`daylight_factor` needs a `Sky`, but the pipeline has none".into(), add.into()));
    };
    if let SkyModel::Cie(Cie { kind, .. }) = model
        && *kind > LAST_OVERCAST
    {
        let message = format!("the sky of CIE type {kind} has no daylight factor (it is not overcast)");
        return Err((message, "choose `model: Overcast`, or a type from 1 to 5".into()));
    }
    let is_other = |source: &&Source| !matches!(source.emitter, Emitter::Dome(_) | Emitter::Ground(_));
    let others: Vec<Source> = sources.iter().filter(is_other).cloned().collect();
    if !others.is_empty() {
        let message = format!(
            "`daylight_factor` needs the sky as the only source, but there is more: {}",
            kinds(&others)
        );
        let help = "leave out the other sources, or measure their light in a pipeline of its own";
        return Err((message, help.into()));
    }
    let outdoor = luminance(*horizontal);
    if outdoor > 0.0 {
        Ok(outdoor)
    } else {
        Err(("`daylight_factor` has nothing to refer to (the sky is black)".into(), add.into()))
    }
}
