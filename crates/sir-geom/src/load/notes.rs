//! Collection of warnings, where any number of one kind make one line.

use std::borrow::Cow;
use std::collections::HashSet;

use crate::builder::SceneBuilder;
use crate::load::files::shortened;
use crate::warning::Warning;

/// Maximum number of names in a line; further ones are only counted.
const MAX_NAMES: usize = 5;

/// Things that a reader left out or replaced, by kind, in the order of the first of each kind.
#[derive(Debug, Default)]
pub(super) struct Notes {
    kinds: Vec<Note>,
}

#[derive(Debug)]
struct Note {
    what: Cow<'static, str>,
    count: usize,
    /// The first few names.
    names: Vec<String>,
    seen: HashSet<String>,
}

impl Notes {
    /// Adds `count` things of the kind `what`, a phrase that follows a number.
    pub(super) fn count(&mut self, what: impl Into<Cow<'static, str>>, count: usize) {
        if count > 0 {
            self.kind(what).count += count;
        }
    }

    /// Adds a thing of the kind `what` by name, unless it was added before.
    pub(super) fn name(&mut self, what: impl Into<Cow<'static, str>>, name: impl Into<String>) {
        let note = self.kind(what);
        note.count += usize::from(note.remember(name.into()));
    }

    #[cfg(feature = "obj")]
    /// Adds one thing of the kind `what` that belongs to something with a name.
    pub(super) fn count_in(&mut self, what: impl Into<Cow<'static, str>>, name: impl Into<String>) {
        let note = self.kind(what);
        note.count += 1;
        note.remember(name.into());
    }

    fn kind(&mut self, what: impl Into<Cow<'static, str>>) -> &mut Note {
        let what = what.into();
        let i = self.kinds.iter().position(|n| n.what == what).unwrap_or_else(|| {
            self.kinds.push(Note { what, count: 0, names: Vec::new(), seen: HashSet::new() });
            self.kinds.len() - 1
        });
        &mut self.kinds[i]
    }

    /// Returns a summary of the skipped geometry, which explains why a scene is empty.
    pub(super) fn skipped(&self) -> String {
        let skipped = self.kinds.iter().filter(|note| note.what.ends_with("were skipped"));
        skipped.map(|note| format!("{} {}", note.count, note.what)).collect::<Vec<_>>().join(" and ")
    }

    /// Adds all notes to the builder as warnings.
    pub(super) fn warn(self, builder: &mut SceneBuilder) {
        for Note { what, count, names, seen } in self.kinds {
            let mut line = format!("{count} {what}");
            if !names.is_empty() {
                line = format!("{line}: {}", names.join(", "));
            }
            if seen.len() > names.len() {
                line = format!("{line} and {} more", seen.len() - names.len());
            }
            builder.warn(Warning::Ignored { what: line });
        }
    }
}

impl Note {
    /// Adds a name; returns false if it was added before.
    fn remember(&mut self, name: String) -> bool {
        if self.seen.contains(&name) {
            return false;
        }
        if self.names.len() < MAX_NAMES {
            self.names.push(if name.is_empty() { "(no name)".to_owned() } else { shortened(&name, 120) });
        }
        self.seen.insert(name)
    }
}

/// Returns a name from a file in quotes.
pub(super) fn quoted(name: &str) -> String {
    format!("\"{name}\"")
}

/// Keeps the first few warnings about clamped reflectances, and replaces the others by their number.
pub(super) fn shorten(warnings: &mut Vec<Warning>) {
    let mut clamped = 0;
    warnings.retain(|w| {
        clamped += usize::from(matches!(w, Warning::ClampedReflectance { .. }));
        !matches!(w, Warning::ClampedReflectance { .. }) || clamped <= MAX_NAMES
    });
    if clamped > MAX_NAMES {
        let what = format!(
            "{} more materials reflect all light or more; their reflectances were clamped, too",
            clamped - MAX_NAMES
        );
        warnings.push(Warning::Ignored { what });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_is_one_line_however_often_it_comes_up() {
        let mut notes = Notes::default();
        for i in 0..100 {
            notes.name("textures are missing", format!("t{}.png", i % 50));
            notes.count("points were skipped", 2);
        }
        notes.count("lines were skipped", 0);
        let mut builder = SceneBuilder::new();
        notes.warn(&mut builder);
        let m = builder.add_material(crate::material::Material::diffuse("m", crate::color::Rgb::splat(0.5)));
        let z = glam::DVec3::ZERO;
        crate::shapes::quad(&mut builder, [z, glam::DVec3::X, glam::DVec3::ONE, glam::DVec3::Y], m);
        let lines: Vec<String> = builder.build().unwrap().warnings.iter().map(ToString::to_string).collect();
        assert_eq!(
            lines,
            [
                "50 textures are missing: t0.png, t1.png, t2.png, t3.png, t4.png and 45 more",
                "200 points were skipped"
            ]
        );
    }
}
