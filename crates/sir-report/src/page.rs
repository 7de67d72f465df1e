//! The page: a template, its script and style sheet, coded light and facts.

use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use sir_view::{ViewError, write_atomically};

use crate::view::View;

const TEMPLATE: &str = include_str!("../web/report.html");
const SCRIPT: &str = concat!(
    "(() => {\n'use strict';\n\n",
    include_str!("../web/script/document.js"),
    include_str!("../web/script/numbers.js"),
    include_str!("../web/script/colors.js"),
    include_str!("../web/script/vectors.js"),
    include_str!("../web/script/mesh.js"),
    include_str!("../web/script/shaders.js"),
    include_str!("../web/script/drawing.js"),
    include_str!("../web/script/cameras.js"),
    include_str!("../web/script/link.js"),
    include_str!("../web/script/values.js"),
    include_str!("../web/script/viewer.js"),
    include_str!("../web/script/controls.js"),
    include_str!("../web/script/legend.js"),
    include_str!("../web/script/picks.js"),
    include_str!("../web/script/pointer.js"),
    include_str!("../web/script/computed.js"),
    include_str!("../web/script/groups.js"),
    include_str!("../web/script/balance.js"),
    include_str!("../web/script/convergence.js"),
    include_str!("../web/script/sensors.js"),
    include_str!("../web/script/repeat.js"),
    include_str!("../web/script/live.js"),
    include_str!("../web/script/start.js"),
    "})();\n"
);
const STYLE: &str = include_str!("../web/report.css");

/// Writes a page with a lit scene and facts about it: see `web/README.md` for their fields.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_page(path: &Path, title: &str, view: &View, facts: &Value) -> Result<(), ViewError> {
    write_atomically(path, |file| fill(file, |name| content(name, title, view, facts, "")))
}

/// Returns a page for a server. If `live` is its version, it asks the server for newer ones.
pub(crate) fn served_page(title: &str, view: &View, facts: &Value, live: Option<u64>) -> String {
    let mut facts = facts.clone();
    let allowed = if live.is_some() { "; connect-src 'self'" } else { "" };
    if let Some(version) = live {
        facts["live"] = json!({ "version": version });
    }
    let mut page = Vec::new();
    // Writing to memory does not fail.
    let _ = fill(&mut page, |name| content(name, title, view, &facts, allowed));
    String::from_utf8_lossy(&page).into_owned()
}

/// Writes the template with its placeholders replaced.
fn fill<'a>(out: &mut impl Write, content: impl Fn(&str) -> Cow<'a, str>) -> io::Result<()> {
    let mut rest = TEMPLATE;
    while let Some((before, after)) = rest.split_once("{{") {
        out.write_all(before.as_bytes())?;
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        out.write_all(content(name).as_bytes())?;
        rest = after;
    }
    out.write_all(rest.as_bytes())
}

/// Returns the content of a placeholder of the template. `allowed` is added to the content security policy.
fn content<'a>(name: &str, title: &str, view: &'a View, facts: &Value, allowed: &str) -> Cow<'a, str> {
    match name {
        "title" => escaped(title).into(),
        "csp" => (policy() + allowed).into(),
        "style" => STYLE.into(),
        "script" => SCRIPT.into(),
        "facts" => script_json(facts).into(),
        "mesh" => view.coded.as_str().into(),
        _ => "".into(),
    }
}

/// Returns JSON for a script element: a string in it may hold anything, such as the end of a script.
fn script_json(value: &Value) -> String {
    value.to_string().replace('<', "\\u003c")
}

/// Returns the content security policy: nothing but the script and the style sheet of the page, and pictures that it draws.
fn policy() -> String {
    let [script, style] = [SCRIPT, STYLE].map(|text| STANDARD.encode(Sha256::digest(text.as_bytes())));
    format!(
        "default-src 'none'; script-src 'sha256-{script}'; style-src 'sha256-{style}'; img-src data: blob:"
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_template_has_each_placeholder_once() {
        for name in ["title", "csp", "style", "script", "facts", "mesh"] {
            let least = 1;
            let count = TEMPLATE.matches(&format!("{{{{{name}}}}}")).count();
            assert!(count == least || name == "title" && count > least, "{name}: {count}");
        }
        assert!(!SCRIPT.contains("</script") && !SCRIPT.contains("<!--") && !STYLE.contains("</style"));
    }
}
