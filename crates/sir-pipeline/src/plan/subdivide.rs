//! The stage `Subdivide`.

use sir_mesh::{PatchSize, Subdivision};

use crate::text::field::{Format, OneOf};
use crate::text::formats::{Choice, count, positive};
use crate::text::reader::Reader;
use crate::text::record::record;
use crate::text::ron_tree::{Node, Value};

record! {
    /// Stage that divides the surfaces into patches.
    pub struct Subdivide {
        /// Size or number of patches.
        pub how: Division = division();
        /// What is divided: flat surfaces, whatever their triangles, into square cells; or each triangle into congruent
        /// triangles. It has no effect on `per_face`. See below.
        pub of: Divided = DIVIDED.or(Divided::Surfaces);
    }
}

/// Size or number of patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Division {
    /// Patches of this size.
    Into(PatchSize),
    /// One patch for every flat polygon.
    PerFace,
}

/// What is divided into patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Divided {
    /// Surfaces.
    Surfaces,
    /// Triangles.
    Triangles,
}

const DIVIDED: Choice<Divided> =
    Choice(&[("Surfaces", Divided::Surfaces), ("Triangles", Divided::Triangles)]);

impl Subdivide {
    /// Returns the rule.
    #[must_use]
    pub fn subdivision(&self) -> Subdivision {
        match (self.how, self.of) {
            (Division::PerFace, _) => Subdivision::PerFace,
            (Division::Into(size), Divided::Surfaces) => Subdivision::Surfaces(size),
            (Division::Into(size), Divided::Triangles) => Subdivision::Triangles(size),
        }
    }
}

fn division() -> OneOf<Division> {
    OneOf::new()
        .field(
            "patches",
            count::<u32>(1, u64::from(u32::MAX), 20_000),
            "",
            "Approximate number of patches, of areas as equal as possible.",
            |n| Division::Into(PatchSize::Count(n.into())),
            |how| if let Division::Into(PatchSize::Count(n)) = how { u32::try_from(*n).ok() } else { None },
        )
        .field(
            "max_area",
            positive(0.01),
            "m²",
            "Maximum area of a patch.",
            |area| Division::Into(PatchSize::MaxArea(area)),
            |how| if let Division::Into(PatchSize::MaxArea(area)) = how { Some(*area) } else { None },
        )
        .field(
            "max_edge",
            positive(0.1),
            "m",
            "Maximum edge length of a patch.",
            |edge| Division::Into(PatchSize::MaxEdge(edge)),
            |how| if let Division::Into(PatchSize::MaxEdge(edge)) = how { Some(*edge) } else { None },
        )
        .field(
            "per_face",
            True,
            "",
            "One patch for every flat polygon of the file, regardless of its number of triangles; polygons that are not flat are \
             divided into their triangles.",
            |()| Division::PerFace,
            |how| (*how == Division::PerFace).then_some(()),
        )
}

/// Format that accepts only `true`.
#[derive(Clone, Copy)]
struct True;

impl Format for True {
    type Value = ();

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<()> {
        if node.value == Value::Bool(true) {
            return Some(());
        }
        let message = format!("`{name}` can only be `true`, but it is {}", node.kind());
        reader.problem(node.text, message, format!("write `{name}: true`, or leave it out"));
        None
    }

    fn write(&self, (): &()) -> String {
        "true".into()
    }

    fn describe(&self) -> String {
        "`true`".into()
    }

    fn example(&self) -> String {
        "true".into()
    }
}
