//! Lights with photometric files (`EXT_lights_ies`).

use std::collections::btree_map::Entry;

use ::gltf::json::Index;
use ::gltf::json::scene::Node;
use glam::{DAffine3, DMat3, DVec3};
use sir_photometry::Photometry;

use crate::color::Rgb;
use crate::light::{Light, LightKind, Spread, Tabulated};
use crate::load::error::LoadError;
use crate::load::files;
use crate::load::gltf::data::Data;
use crate::load::gltf::known::KnownProfile;
use crate::load::gltf::reader::{Reader, label};
use crate::load::gltf::uri::{self, Reference};

impl Reader<'_> {
    /// Adds the light of a node with a photometric file, if it has one. The file aims at −z and has its horizontal angle 0 at +x.
    /// Intensities in cd are taken as W/sr in every band, times the color and the multiplier.
    pub(super) fn luminaire(
        &mut self,
        number: usize,
        node: &Node,
        to_world: &DAffine3,
    ) -> Result<(), LoadError> {
        let Some(light) = self.data.document.nodes.get(&number).and_then(|node| node.luminaire) else {
            return Ok(());
        };
        let known = match self.profiles.entry(light.profile) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(place) => {
                let name = || label("light profile", light.profile, "");
                let bytes = profile_bytes(&self.data, light.profile)
                    .map_err(|why| self.data.invalid(format!("{}: {why}", name())))?;
                let contents = Photometry::parse(&bytes)
                    .map_err(|error| self.data.invalid(format!("{}: {error}", name())))?;
                for warning in contents.warnings {
                    self.notes.name("remarks on light profiles", warning);
                }
                let largest = contents.distribution.largest();
                let name = self.data.document.profiles[light.profile].name.clone();
                place.insert(KnownProfile {
                    name,
                    shape: Tabulated::new(contents.distribution, DMat3::IDENTITY),
                    largest,
                })
            }
        };
        let name = node.name.as_deref().unwrap_or(&known.name);
        let Some(frame) = rotation(to_world) else {
            let label = label("node", number, name);
            self.notes.name("lights have no valid direction or cone and were ignored", label);
            return Ok(());
        };
        let kind = LightKind::Point {
            position: to_world.translation,
            intensity: Rgb::from_array(light.factor) * known.largest,
            spread: Spread::Tabulated(known.shape.turned(frame)),
        };
        if let Err((what, rule)) = kind.check() {
            return Err(self
                .data
                .invalid(format!("{} has a bad {what}: {rule}", label("node", number, name))));
        }
        self.builder.add_light(Light { name: name.to_owned(), kind });
        Ok(())
    }
}

/// Returns the contents of a photometric file.
fn profile_bytes(data: &Data<'_>, index: usize) -> Result<Vec<u8>, String> {
    let profile = data.document.profiles.get(index).ok_or("it does not exist")?;
    match (&profile.uri, profile.view) {
        (Some(uri), _) => match uri::resolve(data.path, uri)? {
            Reference::Data(bytes) => Ok(bytes),
            Reference::File(path) => {
                files::read(&path).map_err(|source| format!("{}: {source}", path.display()))
            }
        },
        (None, Some(view)) => match data.view(Index::new(view), "a light profile") {
            Ok((bytes, _)) => Ok(bytes.to_vec()),
            Err(LoadError::Gltf { what, .. }) => Err(what),
            Err(other) => Err(other.to_string()),
        },
        (None, None) => Err("it has neither a `uri` nor a `bufferView`".to_owned()),
    }
}

/// Returns the rotation of a transform. Scale is left out, and a reflection turns the light as it turns its z and x axes.
fn rotation(transform: &DAffine3) -> Option<DMat3> {
    let matrix = transform.matrix3;
    let z = matrix.z_axis.try_normalize()?;
    let x = matrix.x_axis.reject_from_normalized(z).try_normalize()?;
    let y: DVec3 = z.cross(x);
    Some(DMat3::from_cols(x, y, z))
}
