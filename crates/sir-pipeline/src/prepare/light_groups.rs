//! Light groups of a scene: which materials and lights belong to each of them.

use std::collections::BTreeMap;

use sha2::{Digest, Sha256};
use sir_geom::{Dimming, Material, MaterialId, Rgb, Scene};
use sir_radiosity::{Model, SolveError, sources, total_power};

use crate::format::list;
use crate::plan::scene_light::Added;
use crate::plan::{Action, FileLights, Lamp, OTHER, Pipeline};
use crate::text::diagnostic::Diagnostic;
use crate::text::span::{Span, Spanned};
use crate::text::suggest::did_you_mean;

/// Largest number of names that a message lists.
const MAX_NAMES: usize = 20;

/// Lights whose light is computed and kept apart.
#[derive(Clone, Debug, PartialEq)]
pub struct LightGroup {
    /// Name, unique in a pipeline.
    pub name: String,
    /// Emitted power per band \[W\].
    pub power: Rgb,
    /// What emits, and is part of the group.
    emitters: Vec<Added>,
}

impl LightGroup {
    /// Returns the seed of the group in a run with this seed. It depends on no other group, and is that of the run for the
    /// group [`OTHER`], so that a group has the same light as in a run in which its lights are the only ones.
    pub(crate) fn seed(&self, seed: u64) -> u64 {
        if self.name == OTHER {
            return seed;
        }
        let mut hash = Sha256::new();
        hash.update("light group");
        hash.update(seed.to_le_bytes());
        hash.update(&self.name);
        let bytes: [u8; 32] = hash.finalize().into();
        bytes.iter().take(8).fold(0, |seed, &byte| seed << 8 | u64::from(byte))
    }
}

/// Returns the dimming of a scene in which each group has a factor.
pub(crate) fn dimming(scene: &Scene, groups: &[LightGroup], factors: &[Rgb]) -> Dimming {
    let mut dimming = Dimming::uniform(scene, Rgb::ONE);
    for (group, &factor) in groups.iter().zip(factors) {
        for emitter in &group.emitters {
            match *emitter {
                Added::Material(material) => dimming.materials[material.index()] = factor,
                Added::Light(light) => dimming.lights[light] = factor,
                Added::Sky => dimming.sky = factor,
            }
        }
    }
    dimming
}

/// Returns the factors of groups with which only one of them is lit.
pub(crate) fn only(number: usize, groups: usize) -> Vec<Rgb> {
    (0..groups).map(|group| if group == number { Rgb::ONE } else { Rgb::ZERO }).collect()
}

/// Returns the light groups of a pipeline in the order in which it names them, and then [`OTHER`] if anything that is in no
/// group emits; none if the pipeline names none. `added` is what each of its lamps has added to the scene.
///
/// # Errors
///
/// If it names what the scene does not have, or a group emits nothing.
pub(crate) fn light_groups(
    pipeline: &Pipeline,
    model: &Model,
    added: &[Vec<Added>],
) -> Result<Vec<LightGroup>, Vec<Diagnostic>> {
    let Some((lamps, span)) = pipeline.stages.iter().find_map(|stage| match &stage.action {
        Action::Light(light) if light.lamps.iter().any(|lamp| lamp.group().is_some()) => {
            Some((&light.lamps, &stage.span))
        }
        _ => None,
    }) else {
        return Ok(Vec::new());
    };
    let mut sorting = Sorting::new(&model.scene, added.concat());
    for (lamp, added) in lamps.iter().zip(added) {
        let Some(group) = lamp.group().map(|name| sorting.number(name)) else { continue };
        match lamp {
            Lamp::Group(lights) => sorting.add_file_lights(group, lights),
            _ => sorting.group_of.extend(added.iter().map(|&emitter| (emitter, group))),
        }
    }
    sorting.groups(model, lamps, span)
}

/// Groups, as far as they are known.
struct Sorting<'s> {
    scene: &'s Scene,
    /// Materials and lights that lamps of the pipeline have added. They have no names in the scene file.
    added: Vec<Added>,
    names: Vec<String>,
    /// Number of the group of what emits.
    group_of: BTreeMap<Added, usize>,
    problems: Vec<Diagnostic>,
}

impl<'s> Sorting<'s> {
    fn new(scene: &'s Scene, added: Vec<Added>) -> Self {
        Self { scene, added, names: Vec::new(), group_of: BTreeMap::new(), problems: Vec::new() }
    }

    /// Returns the number of the group with this name.
    fn number(&mut self, name: &str) -> usize {
        self.names.iter().position(|known| known == name).unwrap_or_else(|| {
            self.names.push(name.to_owned());
            self.names.len() - 1
        })
    }

    /// Adds named lights of the scene file to a group.
    fn add_file_lights(&mut self, group: usize, FileLights { materials, lights, .. }: &FileLights) {
        let scene = self.scene;
        let all = scene.materials().iter().enumerate();
        let materials_of_scene: Vec<(Added, &str, bool)> = all
            .map(|(i, m)| (Added::Material(MaterialId::new(i)), m.name.as_str(), emits(m)))
            .filter(|(place, ..)| !self.added.contains(place))
            .collect();
        let all = scene.lights().iter().enumerate();
        let lights_of_scene: Vec<(Added, &str, bool)> = all
            .map(|(i, light)| (Added::Light(i), light.name.as_str(), true))
            .filter(|(place, ..)| !self.added.contains(place))
            .collect();
        for name in materials {
            self.add_named(group, name, &materials_of_scene, ["material", "emitting materials"]);
        }
        for name in lights {
            self.add_named(group, name, &lights_of_scene, ["light", "lights"]);
        }
    }

    /// Adds all with a name to a group. `known` are all that the scene file has, with their names, and whether they emit.
    fn add_named(
        &mut self,
        group: usize,
        Spanned { value: name, span }: &Spanned<String>,
        known: &[(Added, &str, bool)],
        [what, all]: [&str; 2],
    ) {
        let named: Vec<_> = known.iter().filter(|(_, known, _)| known == name).collect();
        let emitting: Vec<_> = named.iter().filter(|(.., emits)| *emits).map(|(place, ..)| *place).collect();
        if emitting.is_empty() {
            let message = match named.is_empty() {
                true => format!("the scene file has no {what} with the name \"{name}\""),
                false => format!("the {what} \"{name}\" emits nothing"),
            };
            let names = known.iter().filter(|(.., emits)| *emits).map(|(_, name, _)| *name);
            let help = names_help(name, names.collect(), all);
            self.problem(span, message, help);
        }
        for place in emitting {
            if let Some(other) = self.group_of.insert(place, group).filter(|other| *other != group) {
                let (other, this) = (&self.names[other], &self.names[group]);
                let message = format!("the {what} \"{name}\" is in the groups \"{other}\" and \"{this}\"");
                self.problem(span, message, "keep it in one of them".into());
            }
        }
    }

    fn problem(&mut self, span: &Span, message: String, help: String) {
        self.problems.push(Diagnostic { span: span.0.clone(), message, help });
    }

    /// Returns the groups. `lamps` are those of the stage `Light`, and `span` is its place.
    fn groups(
        mut self,
        model: &Model,
        lamps: &[Lamp],
        span: &Span,
    ) -> Result<Vec<LightGroup>, Vec<Diagnostic>> {
        // A group may be empty only because of these problems.
        if !self.problems.is_empty() {
            return Err(self.problems);
        }
        let other = self.number(OTHER);
        let scene = self.scene;
        let materials = scene.materials().iter().enumerate().filter(|(_, material)| emits(material));
        let materials = materials.map(|(i, _)| Added::Material(MaterialId::new(i)));
        let lights = (0..scene.lights().len()).map(Added::Light);
        let mut emitters = vec![Vec::new(); self.names.len()];
        for emitter in materials.chain(lights).chain(scene.sky().map(|_| Added::Sky)) {
            let group = self.group_of.get(&emitter).copied().unwrap_or(other);
            emitters[group].push(emitter);
        }
        let parts = std::mem::take(&mut self.names).into_iter().zip(emitters);
        let mut groups: Vec<_> =
            parts.map(|(name, emitters)| LightGroup { name, power: Rgb::ZERO, emitters }).collect();
        // The order does not depend on whether the group has been named.
        groups.sort_by_key(|group| group.name == OTHER);
        let powers: Vec<_> = (0..groups.len())
            .map(|number| {
                let scene = scene.dimmed(&dimming(scene, &groups, &only(number, groups.len())));
                total_power(&sources(&scene, &model.mesh))
            })
            .collect();
        let mut lit = Vec::new();
        for (group, power) in groups.into_iter().zip(powers) {
            match power {
                Ok(power) => lit.push(LightGroup { power, ..group }),
                Err(SolveError::NoLight) if group.name == OTHER => {}
                Err(SolveError::NoLight) => {
                    let name = &group.name;
                    let off = lamps.iter().find_map(|lamp| match lamp {
                        Lamp::Luminaire(luminaire) if lamp.group() == Some(name) => {
                            Some(&luminaire.dimming).filter(|dimming| dimming.value == 0.0)
                        }
                        _ => None,
                    });
                    let (span, why, help) = match off {
                        Some(dimming) => (
                            &dimming.span,
                            " (the `dimming` of this luminaire is 0)",
                            "choose a `dimming` above 0",
                        ),
                        None => (span, "", "give one of its lights a power above zero"),
                    };
                    let message = format!("the light group \"{name}\" emits nothing{why}");
                    self.problem(span, message, format!("{help}, or leave the group out"));
                }
                Err(error) => self.problem(
                    span,
                    format!("the light group \"{}\" has an impossible power", group.name),
                    error.to_string(),
                ),
            }
        }
        if self.problems.is_empty() { Ok(lit) } else { Err(self.problems) }
    }
}

fn emits(material: &Material) -> bool {
    material.exitance != Rgb::ZERO
}

/// Returns what to write instead of an unknown name.
fn names_help(name: &str, mut known: Vec<&str>, what: &str) -> String {
    known.retain(|name| !name.is_empty());
    known.sort_unstable();
    known.dedup();
    if known.is_empty() {
        return format!("the scene file has no {what} with names; leave the name out");
    }
    if let Some(help) = did_you_mean(name, &known) {
        return help;
    }
    let others = known.len().saturating_sub(MAX_NAMES);
    known.truncate(MAX_NAMES);
    match others {
        0 => format!("its {what} are {}", list(&known, "and")),
        _ => format!("its {what} are {} and {others} others", known.join(", ")),
    }
}
