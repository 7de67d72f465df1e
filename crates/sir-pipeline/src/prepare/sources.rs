//! Counts the light sources of a scene by kind.

use sir_radiosity::{Emitter, Source};

use crate::format::grouped;

/// Lists the number of sources of each kind, as text.
#[must_use]
pub fn kinds(sources: &[Source]) -> String {
    let count = |is: fn(&Emitter) -> bool| sources.iter().filter(|s| is(&s.emitter)).count();
    let counts = [
        ("triangle side", count(|e| matches!(e, Emitter::Surface { .. }))),
        ("point", count(|e| matches!(e, Emitter::Point { .. }))),
        ("distant light", count(|e| matches!(e, Emitter::Distant { .. }))),
        ("sky", count(|e| matches!(e, Emitter::Dome(_)))),
        ("ground", count(|e| matches!(e, Emitter::Ground(_)))),
    ];
    let named = counts.iter().filter(|(_, n)| *n > 0).map(|(name, n)| match *name {
        "sky" | "ground" => (*name).to_owned(),
        name => format!("{} {name}{}", grouped(*n as u64), if *n == 1 { "" } else { "s" }),
    });
    named.collect::<Vec<_>>().join(", ")
}
