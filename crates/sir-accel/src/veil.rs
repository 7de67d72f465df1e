//! Surfaces that let some of the lines pass.

use sir_geom::{Line, Opacities, Scene, TriangleId};

use crate::hit::Hit;
use crate::triangle::Crossing;

/// Decides which lines pass.
///
/// A crossing stops its line with a probability equal to the opacity there. What decides is no random number but a hash
/// of line and triangle: so a line meets the same surfaces whoever traces it, alone or among others, for its closest hit or
/// for all of them.
#[derive(Clone, Debug)]
pub(crate) struct Veil(Opacities);

impl Veil {
    /// That of a scene, unless all of it is opaque.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        Opacities::of(scene).map(Self)
    }

    pub(crate) fn stops(&self, line: &Line, hit: &Hit) -> bool {
        self.0.at(hit.triangle, hit.point).is_none_or(|opacity| share(line, hit.triangle) < opacity)
    }

    #[inline(never)]
    pub(crate) fn stops_at(&self, line: &Line, crossing: &Crossing) -> bool {
        self.0.at(crossing.id, crossing.point).is_none_or(|opacity| share(line, crossing.id) < opacity)
    }

    /// Memory in use \[bytes\].
    pub(crate) fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

/// A number in `[0, 1)`, uniform and independent for every line and triangle as far as anyone can tell.
fn share(line: &Line, triangle: TriangleId) -> f64 {
    let numbers = [line.origin, line.direction].map(|v| v.to_array().map(f64::to_bits));
    let hash = |hash, number| mix(hash ^ number);
    let hash = numbers.as_flattened().iter().fold(mix(triangle.0.into()), |h, &number| hash(h, number));
    // The upper 53 bits: as many as a double has.
    (hash >> 11) as f64 / (1u64 << 53) as f64
}

/// A step of SplitMix64 (Steele, Lea and Flood 2014): every bit of the result depends on every bit of the number.
fn mix(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}
