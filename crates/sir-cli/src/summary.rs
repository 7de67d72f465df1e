//! The summary that `sir run` prints at the end.

use sir_pipeline::format::{duration, grouped};
use sir_pipeline::report::{FILE_NAME, GroupReport, LinesReport, Report, StageReport, installed_watts};
use sir_pipeline::run::absolute;
use sir_pipeline::{RunResult, Units};

/// Returns the paths of a run's files, pages and images first, and a summary of each stage that traces lines.
#[must_use]
pub fn summary(result: &RunResult) -> String {
    let RunResult { directory, report } = result;
    let mut files: Vec<&str> = ["report", "image", "map", "gltf", "table", "sensors"]
        .iter()
        .flat_map(|kind| report.outputs.iter().filter(move |o| o.kind == *kind).map(|o| o.path.as_str()))
        .collect();
    files.push(FILE_NAME);
    let mut text = String::new();
    for file in files {
        text += &format!("{}\n", absolute(&directory.join(file)).display());
    }
    text += &format!(
        "\n{} triangles, {} patches; {} in all\n",
        grouped(report.scene.triangles as u64),
        grouped(report.scene.patches as u64),
        duration(report.time.seconds)
    );
    match (&report.groups[..], &report.mixed_from) {
        ([], _) => text += &stages(&report.stages, report.units),
        (groups, mixed_from) => {
            for group in groups {
                text += &light_group(group, report.units);
                // A mix has traced no lines.
                if mixed_from.is_none() {
                    text += &stages(&group.stages, report.units);
                }
            }
        }
    }
    for luminaires in &report.scene.luminaires {
        text += &format!("luminaires {}\n", luminaires.in_short());
    }
    if let Some(watts) = installed_watts(&report.scene.luminaires) {
        text += &format!("           {watts:.1} W of installed electric power in all\n");
    }
    let sensors = report.stages.iter().filter_map(|stage| stage.sensors.as_ref());
    text.extend(sensors.map(|sensors| {
        let points = grouped(sensors.points as u64);
        let points = match sensors.invalid {
            Some(invalid) => {
                format!(
                    "{points} valid probes of {}, over all directions",
                    grouped((sensors.points + invalid) as u64)
                )
            }
            None => format!("{points} points"),
        };
        let requirements = sensors.requirements.iter();
        let requirements = requirements.map(|r| format!("           {}\n", r.in_short(report.units)));
        let all: String = requirements.collect();
        format!("{}: {points}, {}\n{all}", sensors.name, sensors.in_short(report.units))
    }));
    text + &error(report)
}

/// Returns the energy balance of a stage, as shares of the power of all bands: their sum in watts, their mean weighted for
/// luminance in lumens, as lumens of different colors do not add up.
fn balance(lines: &LinesReport, units: Units) -> String {
    let sum = |bands: [f64; 3]| match units {
        Units::Radiometric => bands.iter().sum::<f64>(),
        Units::Photometric => sir_geom::luminance(bands.into()),
    };
    let b = &lines.balance;
    let emitted = sum(b.emitted);
    let share = |bands| {
        let percent = if emitted > 0.0 { 100.0 * sum(bands) / emitted } else { 0.0 };
        // No minus sign before a zero.
        if percent.abs() < 0.005 { 0.0 } else { percent }
    };
    format!(
        "           {emitted:.6} {} sent = {:.2} % absorbed + {:.2} % blocked + {:.2} % escaped + {:.2} % unshot\n",
        units.power(),
        share(b.absorbed),
        share(b.blocked),
        share(b.escaped),
        share(b.unshot),
    )
}

/// Returns a line about a light group: its power and, unless it is one, its factor.
fn light_group(group: &GroupReport, units: Units) -> String {
    let factor = match group.factor {
        [1.0, 1.0, 1.0] => String::new(),
        [r, g, b] if r == g && g == b => format!(" × {r}"),
        [r, g, b] => format!(" × ({r}, {g}, {b})"),
    };
    let [r, g, b] = group.power;
    format!("light group {}: {r:.6} + {g:.6} + {b:.6} {}{factor}\n", group.name, units.power())
}

/// Returns a summary of each stage that traces lines.
fn stages(all: &[StageReport], units: Units) -> String {
    let mut text = String::new();
    for stage in all.iter().flat_map(|stage| std::iter::once(stage).chain(&stage.stages)) {
        if let (Some(repeats), false) = (stage.repeats, stage.stages.is_empty()) {
            text += &format!(
                "{:<10} {} times in {}; lines of its stages are totals, balances are means\n",
                stage.name,
                grouped(repeats),
                duration(stage.time.seconds),
            );
        }
        if let Some(lines) = &stage.lines {
            let rate = stage.time.lines_per_second.unwrap_or_default();
            let through = lines.domain.as_ref().map_or(String::new(), |domain| {
                format!(" through the {} ({:.6} m²)", domain.kind.to_lowercase(), domain.surface)
            });
            let shared = stage.repeats.map_or(String::new(), |repeats| format!(", {repeats} repeats"));
            text += &format!(
                "{:<10} {} lines{through} in {}, {} lines/s{shared}, {:.1} % empty, {:.1} % odd\n",
                stage.name,
                grouped(lines.lines),
                duration(stage.time.seconds),
                grouped(rate as u64),
                100.0 * lines.empty_share,
                100.0 * lines.odd_lines as f64 / lines.lines.max(1) as f64,
            );
            // Shadow rays carry no power.
            if lines.balance.emitted != [0.0; 3] {
                text += &balance(lines, units);
            }
        }
    }
    text
}

/// Returns the relative error of all light.
fn error(report: &Report) -> String {
    let last = report.stages.iter().rev().find_map(|s| s.light.as_ref());
    last.map_or(String::new(), |light| {
        let [r, g, b] = light.relative_error.map(|e| 100.0 * e);
        format!(
            "estimated relative error of a patch's {}: {r:.2} % red, {g:.2} % green, {b:.2} % blue\n",
            report.units.irradiance_name()
        )
    })
}
