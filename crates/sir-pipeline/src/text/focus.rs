//! The stage `Focus`.

use glam::DVec3;
use sir_geom::BoundingBox;

use crate::plan::pipeline::{Action, Stage};
use crate::plan::transport::Transport;
use crate::text::decode::Decoder;
use crate::text::diagnostic::Diagnostic;
use crate::text::ron_tree::Node;

/// Share of the lines unless another is given.
const SHARE: f64 = 0.75;

/// The largest share: what is not in the focus must get lines, too.
const MOST: f64 = 0.95;

impl<'a> Decoder<'a> {
    pub(crate) fn focus(&mut self, node: Node<'a>) -> Option<Action> {
        let place = node.name();
        let mut fields = self.reader.fields(node, "Focus", &["min", "max", "share"]);
        let [min, max] = [("min", "(0, 0, 0)"), ("max", "(5, 3, 4)")].map(|(name, example)| {
            let node = self.reader.required(&mut fields, name, example)?;
            self.reader.vector(&node, name, example).map(DVec3::from)
        });
        let share = match fields.take("share") {
            Some(node) => {
                let share = self.reader.number(&node, "share", "0.75")?;
                if !(0.0..=MOST).contains(&share) {
                    let message = format!("`share` must be from 0 to {MOST}, but it is {share}");
                    self.reader.problem(
                        node.text,
                        message,
                        "0.75 draws three quarters of the lines through the box",
                    );
                }
                share
            }
            None => SHARE,
        };
        let bounds = BoundingBox { min: min?, max: max? };
        if !bounds.min.cmple(bounds.max).all() {
            let message = "`min` must not be larger than `max` in any coordinate";
            self.reader.problem(place, message, "give the corner with the smallest coordinates as `min`");
        }
        Some(Action::Focus { bounds, share })
    }

    /// In replicas a line takes along all that a side holds, and so must not be aimed.
    pub(crate) fn check_focus(&mut self, stages: &[Stage]) {
        if !stages.iter().any(|stage| matches!(stage.action, Action::Focus { .. })) {
            return;
        }
        let inner = stages.iter().flat_map(|stage| match &stage.action {
            Action::Repeat(repeat) => repeat.stages.as_slice(),
            _ => std::slice::from_ref(stage),
        });
        for stage in inner {
            if let Action::Multipath { transport: Transport::Replicas { .. }, .. } = stage.action {
                self.reader.problems.push(Diagnostic {
                    span: stage.span.clone(),
                    message: "the transport `Replicas` cannot have a `Focus`: each line takes along all that a surface \
                              holds, so lines must be the same everywhere"
                        .into(),
                    help: "write `transport: Batches`, or leave `Focus` out".into(),
                });
            }
        }
    }
}
