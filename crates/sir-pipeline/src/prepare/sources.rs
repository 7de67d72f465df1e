//! Counts the light sources of a scene by kind.

use sir_radiosity::{Emitter, Source};

use crate::format::grouped;

/// Lists the number of sources of each kind, as text.
#[must_use]
pub fn kinds(sources: &[Source]) -> String {
    let mut counts: Vec<(&str, u64)> = Vec::new();
    for source in sources {
        let kind = match &source.emitter {
            Emitter::Surface { .. } => "triangle side",
            Emitter::Point { .. } => "point",
            Emitter::Distant { .. } => "distant light",
            Emitter::Dome(_) => "sky",
            Emitter::Ground(_) => "ground",
        };
        match counts.iter_mut().find(|(name, _)| *name == kind) {
            Some((_, count)) => *count += 1,
            None => counts.push((kind, 1)),
        }
    }
    let named = counts.iter().map(|(name, count)| match *name {
        "sky" | "ground" => (*name).to_owned(),
        name => format!("{} {name}{}", grouped(*count), if *count == 1 { "" } else { "s" }),
    });
    named.collect::<Vec<_>>().join(", ")
}
