//! The stage `Subdivide`.

use sir_mesh::Subdivision;

use crate::text::field::{Format, OneOf};
use crate::text::formats::{count, positive};
use crate::text::reader::Reader;
use crate::text::record::record;
use crate::text::ron_tree::{Node, Value};

record! {
    /// Stage that divides the triangles into patches.
    pub struct Subdivide {
        /// Size or number of patches.
        pub how: Subdivision = how();
    }
}

fn how() -> OneOf<Subdivision> {
    OneOf::new()
        .field(
            "patches",
            count::<u32>(1, u64::from(u32::MAX), 20_000),
            "",
            "Approximate number of patches, of areas as equal as possible; never less than the number of triangles.",
            |n| Subdivision::Patches(n.into()),
            |how| if let Subdivision::Patches(n) = how { u32::try_from(*n).ok() } else { None },
        )
        .field(
            "max_area",
            positive(0.01),
            "m²",
            "Maximum area of a patch.",
            Subdivision::MaxArea,
            |how| if let Subdivision::MaxArea(area) = how { Some(*area) } else { None },
        )
        .field(
            "max_edge",
            positive(0.1),
            "m",
            "Maximum edge length of a patch.",
            Subdivision::MaxEdge,
            |how| if let Subdivision::MaxEdge(edge) = how { Some(*edge) } else { None },
        )
        .field(
            "per_face",
            True,
            "",
            "One patch for every flat polygon of the file, regardless of its number of triangles; polygons that are not flat are \
             divided into their triangles.",
            |()| Subdivision::PerFace,
            |how| (*how == Subdivision::PerFace).then_some(()),
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
