//! The texts that `sir compare` prints.

use serde_json::{Value, json};
use sir_view::{BandComparison, Comparison};

/// Formats a comparison as text.
#[must_use]
pub fn text(c: &Comparison) -> String {
    let [red, green, blue] = c.bands;
    let mut out = format!(
        "{} rows, one per {}; differences of the radiosity, second minus first, weighted by area\n\n",
        c.rows,
        row_name(c)
    );
    out += "            mean of first   relative RMS   relative bias\n";
    for (name, band) in [("luminance", c.luminance), ("red", red), ("green", green), ("blue", blue)] {
        let BandComparison { mean, relative_rms, relative_bias } = band;
        out += &format!(
            "{name:<10} {mean:>14.6} {:>12.3} % {:>13.3} %\n",
            100.0 * relative_rms,
            100.0 * relative_bias
        );
    }
    match c.largest_z {
        Some(z) => out += &format!("\nlargest difference of a row in standard errors: {z:.1}\n"),
        None => out += "\nno differences in standard errors: at least one table does not state them\n",
    }
    if !c.worst.is_empty() {
        out += "\nrows that contribute most to the difference in luminance:\n";
        // Triangles are what they are, and materials and groups have many.
        let has_triangle = ["patch", "face"].contains(&c.of);
        let triangle = |text: String| if has_triangle { format!(" {text:>10}") } else { String::new() };
        let head = triangle("triangle".into());
        out += &format!("       row {:>10}{head}          first         second      z\n", c.of);
        for w in &c.worst {
            let [first, second] = w.luminance;
            let z = w.z.map_or("-".into(), |z| format!("{z:.1}"));
            out += &format!(
                "{:>10} {:>10}{} {first:>14.6} {second:>14.6} {z:>6}\n",
                w.row,
                w.part,
                triangle(w.triangle.to_string())
            );
        }
    }
    out
}

/// Returns what a row of the tables is.
fn row_name(c: &Comparison) -> String {
    if ["material", "group"].contains(&c.of) { c.of.into() } else { format!("side of a {}", c.of) }
}

/// Returns a comparison as JSON. Non-finite numbers are `null`.
#[must_use]
pub fn to_json(c: &Comparison) -> Value {
    let band = |b: &BandComparison| json!({"mean": b.mean, "relative_rms": b.relative_rms, "relative_bias": b.relative_bias});
    let worst: Vec<Value> = c
        .worst
        .iter()
        .map(|w| {
            json!({
                "row": w.row, "part": w.part, "triangle": w.triangle,
                "luminance": w.luminance, "z": w.z,
            })
        })
        .collect();
    json!({
        "version": 2,
        "of": c.of,
        "rows": c.rows,
        "luminance": band(&c.luminance),
        "red": band(&c.bands[0]),
        "green": band(&c.bands[1]),
        "blue": band(&c.bands[2]),
        "largest_z": c.largest_z,
        "worst": worst,
    })
}
