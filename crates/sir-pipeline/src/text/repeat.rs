//! The fields of a `Repeat` stage.

use crate::plan::pipeline::{Repeat, Until};
use crate::text::decode::Decoder;
use crate::text::order::check_repeated;
use crate::text::reader::ABSURD;
use crate::text::ron_tree::{Node, Value};

const REPEATED: [&str; 3] = ["FirstShot", "SecondShot", "Multipath"];

impl<'a> Decoder<'a> {
    pub(crate) fn repeat(&mut self, node: Node<'a>) -> Option<Repeat> {
        let place = node.name();
        let mut fields = self.reader.fields(node, "Repeat", &["times", "until", "at_most", "stages"]);
        let until = match (fields.take("times"), fields.take("until")) {
            (Some(times), None) => self.reader.count(&times, "times", (1, ABSURD), "16").map(Until::Times),
            (None, Some(until)) => self.until(until),
            (both, _) => {
                let message = match both {
                    Some(_) => "`Repeat` has both `times` and `until`",
                    None => "`Repeat` does not say how often",
                };
                let help = "write one of `times: 16`, `until: RelativeError(0.01)` or `until: Seconds(60)`";
                self.reader.problem(place, message, help);
                None
            }
        };
        let at_most = match fields.take("at_most") {
            Some(node) => self.reader.count(&node, "at_most", (1, ABSURD), "100").map(Some),
            None => Some(None),
        };
        let list = self.reader.required(&mut fields, "stages", "[FirstShot(lines: 1_000_000), …]")?;
        let Value::List(nodes) = list.value else {
            let message = format!("`stages` must be a list, but it is {}", list.kind());
            self.reader.problem(list.text, message, "write `stages: [FirstShot(…), …]`");
            return None;
        };
        let (stages, order) = self.stages(nodes, "repeated stage", &REPEATED);
        if let Some(order) = order {
            check_repeated(&mut self.reader, &order, list.text);
        }
        Some(Repeat { until: until?, at_most: at_most?, stages })
    }

    fn until(&mut self, node: Node<'a>) -> Option<Until> {
        let name = self.name_of(&node, "target", &["RelativeError", "Seconds"])?;
        let (example, target): (_, fn(f64) -> Until) = match name {
            "Seconds" => ("Seconds(60)", Until::Seconds),
            _ => ("RelativeError(0.01)", Until::RelativeError),
        };
        if let Value::Items(items) = &node.value
            && let [number] = items.as_slice()
        {
            return self.reader.positive(number, "until", example).map(target);
        }
        let message = format!("`{name}` takes one number, but this is {}", node.kind());
        self.reader.problem(node.text, message, format!("write `until: {example}`"));
        None
    }
}
