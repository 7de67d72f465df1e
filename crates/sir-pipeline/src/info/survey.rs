//! What is suspicious about a scene: said by `sir info`, `sir check` and `sir run` alike.

use glam::DVec3;
use sir_accel::Accel;
use sir_geom::{Scene, TriangleId};
use sir_radiosity::Source;

use crate::format::{dimensions, grouped, length, percent};
use crate::info::lamp_place::LampPlace;
use crate::info::lamps::{Cover, LampLight, describe, lamp_light};
use crate::info::shape;
use crate::info::shape::{Dominant, Extent};

/// Share of the light of lamps above which a cover is mentioned.
const COVERED: f64 = 0.1;

/// Share of the light of lamps above which light that backs absorb is mentioned.
const ABSORBED: f64 = 0.5;

/// Share of the light of lamps above which the loss of light is mentioned.
const LOST: f64 = 0.95;

/// Distance below which a lamp and its cover are said to lie in one plane \[m\].
const IN_PLANE: f64 = 1e-5;

/// Largest step of the grid, as a share of the distance that light travels.
const COARSE: f64 = 1e-4;

/// Smallest distance of a triangle that makes the grid coarse, in sizes of the lit part of the scene.
const FAR: f64 = 100.0;

/// Numbers from which suspicions follow. They take time in proportion to the number of triangles, and some lines.
#[derive(Clone, Debug)]
pub(crate) struct Survey {
    /// Bounding box \[m\].
    pub extent: Extent,
    /// Up direction.
    pub up: DVec3,
    /// Part that dwarfs the rest of the scene, if there is one.
    pub dominant: Option<Dominant>,
    /// Light of lamps; `None` if there are none.
    pub lamps: Option<LampLight>,
    /// Place for a lamp; `None` if there is light.
    pub lamp_place: Option<LampPlace>,
    /// Triangle that is so far away that the grid is coarse, if there is one.
    pub remote: Option<Remote>,
}

/// A triangle that makes the integer grid coarse.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Remote {
    /// Description of the triangle.
    what: String,
    /// Its corner that is farthest away \[m\].
    place: DVec3,
    /// Distance of that corner from the lit part of the scene \[m\].
    distance: f64,
    /// Step of the grid \[m\].
    step: f64,
    /// Size of the lit part of the scene \[m\].
    lit: f64,
}

/// A unit of length that a file may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LikelyUnit {
    /// Name of the unit.
    pub name: &'static str,
    /// Length of the unit \[m\], as a pipeline has it.
    pub scale: f64,
}

impl Survey {
    /// Surveys a scene with a number of lines from its lamps.
    pub(crate) fn new(scene: &Scene, accel: &Accel, sources: &[Source], up: DVec3, lines: u64) -> Self {
        let dominant = shape::dominant(scene);
        let lamps = lamp_light(scene, accel, sources, lines);
        let by_lamps = lamps.as_ref().and_then(|lamps| Some((lamps.center, lamps.reach?)));
        let rest = dominant.as_ref().map(|part| (part.rest.center(), part.rest.size().length()));
        // Where the grid is so coarse that light passes through walls, light travels too far.
        let lit = by_lamps.into_iter().chain(rest).min_by(|a, b| a.1.total_cmp(&b.1));
        let remote = lit.and_then(|(center, size)| remote(scene, accel.grid_step(), center, size));
        let extent: Extent = scene.bounding_box().into();
        let room = dominant.as_ref().map_or(extent, |dominant| dominant.rest);
        let lamp_place = sources.is_empty().then(|| LampPlace::find(scene, accel, up, room));
        Self { extent, up, dominant, lamps, lamp_place, remote }
    }

    /// Returns what is suspicious, one line each. `has_focus` is true if a focus makes up for a part that dwarfs the
    /// rest.
    pub(crate) fn suspicions(&self, has_focus: bool) -> Vec<String> {
        let dominated = self.dominant.as_ref().filter(|_| !has_focus).map(dominated);
        [self.unit(), self.far_from_origin(), self.remote.as_ref().map(coarse), dominated]
            .into_iter()
            .flatten()
            .chain(self.lamp_suspicions(false))
            .collect()
    }

    /// Returns the unit that the file probably has, if that is not the meter.
    pub(crate) fn likely_unit(&self) -> Option<LikelyUnit> {
        let height = self.height()?;
        match height {
            h if h > 1000.0 => Some(LikelyUnit { name: "millimeters", scale: 0.001 }),
            h if h > 200.0 => Some(LikelyUnit { name: "centimeters", scale: 0.01 }),
            h if h > 100.0 => Some(LikelyUnit { name: "inches", scale: 0.0254 }),
            _ => None,
        }
    }

    /// Returns what is suspicious about the light of lamps, one line each. If a pipeline makes backs reflect, they absorb
    /// nothing.
    pub(crate) fn lamp_suspicions(&self, backs_reflect: bool) -> impl Iterator<Item = String> {
        [self.covered(), self.absorbed().filter(|_| !backs_reflect), self.lost()].into_iter().flatten()
    }

    /// Returns the height of the scene, if it may be a room: as high as wide, about, while a landscape is flat.
    fn height(&self) -> Option<f64> {
        let size = self.extent.size();
        let height = size.dot(self.up.abs());
        (self.dominant.is_none() && height > 0.05 * size.max_element()).then_some(height)
    }

    /// Returns what is suspicious about the size of the scene.
    pub(crate) fn unit(&self) -> Option<String> {
        let most = self.dominant.as_ref().map_or(self.extent, |dominant| dominant.rest).size().max_element();
        let lengths = "powers and distances of lights assume meters";
        match (self.likely_unit(), self.height()) {
            (Some(LikelyUnit { name, scale }), Some(height)) => Some(format!(
                "a height of {} m looks like {name}, if this is a room; {lengths}; set `Load(scale: {scale})`",
                length(height)
            )),
            _ if most > 1000.0 => Some(format!("an extent of {} m; {lengths}", length(most))),
            _ if most < 0.05 => Some(format!(
                "an extent of {} m looks like kilometers or a wrong scale; {lengths}; set `scale` in `Load`",
                length(most)
            )),
            _ => None,
        }
    }

    fn far_from_origin(&self) -> Option<String> {
        let distance = self.extent.center().length();
        let times = distance / self.extent.size().length();
        // Most files store single-precision numbers, with a relative step of 2⁻²⁴.
        let step = distance / f64::from(1 << 24);
        (times > 100.0).then(|| {
            format!(
                "the scene is far from the origin, {} times its size (single-precision coordinates have steps of {} m \
                 there); move it to the origin",
                grouped(times as u64),
                length(step)
            )
        })
    }

    /// Returns true if most of the light of lamps ends on surfaces that cover them.
    pub(crate) fn are_lamps_covered(&self) -> bool {
        self.lamps.as_ref().is_some_and(|lamps| lamps.covered > COVERED)
    }

    fn covered(&self) -> Option<String> {
        let LampLight { covered, cover, .. } = self.lamps.as_ref()?;
        let Cover { lamp, by, distance } = cover.as_ref().filter(|_| *covered > COVERED)?;
        let place = match distance {
            // Rounding keeps coplanar surfaces from a distance of exactly zero.
            gap if *gap < IN_PLANE => "lies in its plane".into(),
            gap => format!("lies {} mm in front of it", length(1000.0 * gap)),
        };
        Some(format!(
            "{} of the light of lamps ends where it begins: {lamp} is covered by {by}, which {place}; move the lamp in front \
             of that surface, or remove the part of the surface that covers it",
            percent(*covered)
        ))
    }

    /// Returns a warning if almost all light of lamps meets nothing that reflects, for reasons that are not mentioned
    /// elsewhere.
    fn lost(&self) -> Option<String> {
        let LampLight { covered, absorbed, escaped, .. } = *self.lamps.as_ref()?;
        let is_mentioned = covered > COVERED || absorbed > ABSORBED;
        (!is_mentioned && covered + absorbed + escaped > LOST).then(|| {
            format!(
                "{} of the light of lamps leaves the scene, and {} falls on backs, which absorb it: are the lamps outside of \
                 the room, or turned the wrong way?",
                percent(escaped),
                percent(absorbed)
            )
        })
    }

    fn absorbed(&self) -> Option<String> {
        let absorbed = self.lamps.as_ref()?.absorbed;
        (absorbed > ABSORBED).then(|| {
            format!(
                "{} of the light of lamps falls on backs, which absorb it: are the lamps turned the wrong way, or the surfaces? \
                 `Load(sides: Both)` makes backs reflect",
                percent(absorbed)
            )
        })
    }
}

/// Returns the triangle farthest from the lit part of a scene, if it makes the grid coarse. `step` is the step of
/// the grid, and `size` the size of the lit part.
fn remote(scene: &Scene, step: f64, center: DVec3, size: f64) -> Option<Remote> {
    if step <= COARSE * size {
        return None;
    }
    let corners = |id: TriangleId| scene.corners(id).map(|corner| (corner.distance(center), corner, id));
    let farthest = scene.triangle_ids().flat_map(corners).max_by(|a, b| a.0.total_cmp(&b.0));
    let (distance, place, id) = farthest.filter(|(distance, ..)| *distance > FAR * size)?;
    Some(Remote { what: describe(scene, id), place, distance, step, lit: size })
}

fn coarse(remote: &Remote) -> String {
    let Remote { what, place, distance, step, lit } = remote;
    let [x, y, z] = place.to_array().map(length);
    format!(
        "{what} reaches to ({x}, {y}, {z}), {} m from the lamps, whose light travels {} m; crossings are computed in steps \
         of {} mm because of it; leave out what is far away",
        length(*distance),
        length(*lit),
        length(1000.0 * step)
    )
}

fn dominated(dominant: &Dominant) -> String {
    format!(
        "{} has {} of the area, and everything else fits into {} (most global lines meet nothing else); leave it out of the \
         file, or set `{}`",
        dominant.what,
        percent(dominant.share),
        dimensions(dominant.rest.size()),
        dominant.rest.focus()
    )
}
