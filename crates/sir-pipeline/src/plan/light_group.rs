//! Light groups: lights whose light is kept apart, so that it can be dimmed after a run.

use crate::text::field::{Format, Optional};
use crate::text::formats::{Text, quoted};
use crate::text::reader::Reader;
use crate::text::record::record;
use crate::text::ron_tree::{Node, Value};
use crate::text::span::{Spanned, WithSpan};

/// Name of the group of all lights that are in no other group.
pub const OTHER: &str = "other";

record! {
    /// Lights of the scene file that are in a light group.
    pub struct FileLights as "Group" {
        /// Name of the group; the lamps with this `group` belong to it, too.
        pub name: String = Text("ceiling").required();
        /// Names of emitting materials of the scene file.
        pub materials: Vec<Spanned<String>> = Names("Lamp").or(Vec::new());
        /// Names of lights of the scene file.
        pub lights: Vec<Spanned<String>> = Names("Spot").or(Vec::new());
    }
}

/// Returns the part for the light group of a lamp, which all kinds of lamps have as field `group`.
pub(crate) fn group() -> Optional<Text> {
    Text("desk").optional("`other`")
}

/// Format of a list of names. The field is an example of one.
#[derive(Clone, Copy)]
struct Names(&'static str);

impl Format for Names {
    type Value = Vec<Spanned<String>>;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<Self::Value> {
        let Value::List(items) = &node.value else {
            reader.wrong_value(node, name, "a list of names", self.example());
            return None;
        };
        let names: Vec<_> =
            items.iter().map(|item| WithSpan(Text(self.0)).read(reader, item, name)).collect();
        names.into_iter().collect()
    }

    fn write(&self, names: &Self::Value) -> String {
        let names: Vec<String> = names.iter().map(|name| quoted(&name.value)).collect();
        format!("[{}]", names.join(", "))
    }

    fn describe(&self) -> String {
        "list of strings".into()
    }

    fn example(&self) -> String {
        format!("[{}]", quoted(self.0))
    }
}
