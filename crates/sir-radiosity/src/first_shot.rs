//! The first shot: local lines carry the light of the sources to the first surfaces.
//!
//! Martínez, Forés and Martín (2009), section 2; Castro, Martínez and Sbert (1998).

use sir_lines::Purpose;

use crate::emitter::Emitter;
use crate::error::SolveError;
use crate::local_shot::{LocalShot, ShotInput, ShotSources};
use crate::model::Model;
use crate::power::PowerUnit;
use crate::shot::{Shot, ShotSettings};
use crate::sources::{FocusedSources, total_power};
use crate::visitor::Visitor;
use crate::workers::Workers;

/// The first shot: lines from all light sources, in proportion to their power.
pub type FirstShot<'m> = LocalShot<'m, (), Emitter>;

impl ShotInput<Emitter> for () {
    const NAME: &'static str = "first shot";
    const KIND: u64 = 1;
    const PURPOSE: Purpose = Purpose::FIRST_SHOT;

    fn sources(
        &self,
        settings: &ShotSettings<'_>,
        _workers: &dyn Workers,
    ) -> Result<ShotSources<Emitter>, SolveError> {
        let ShotSettings { model, lines, .. } = settings;
        let sources = FocusedSources::new(model, lines.focus.as_ref(), lines.count);
        let total = total_power(&sources.sources)?;
        let reflectance = model.mesh.largest_reflectance(&model.scene);
        let unit = PowerUnit::for_total(total.max_element(), reflectance);
        let (weights, density) = (sources.weights(), sources.density);
        let (sources, powers) =
            sources.sources.into_iter().map(|source| (source.emitter, source.power)).unzip();
        Ok(ShotSources { sources, powers, weights, density, sides: Vec::new(), unit })
    }

    fn visit(&mut self, _visitor: &mut dyn Visitor) {}

    fn restore(_model: &Model, _visitor: &mut dyn Visitor) {}

    fn into_shot(self, model: &Model) -> Shot {
        Shot::dark(model)
    }
}
