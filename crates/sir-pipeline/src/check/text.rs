//! Formats an estimate as text.

use std::fmt;

use sir_geom::{Rgb, Scene};

use crate::check::estimate::Estimate;
use crate::check::probe::StageEstimate;
use crate::format::{bytes, duration, grouped};
use crate::plan::{Ending, Until};
use crate::prepare::layout::Placed;
use crate::prepare::light_groups::LightGroup;
use crate::prepare::prepared::Prepared;
use crate::prepare::sources::kinds;
use crate::prepare::up::name;
use crate::report::luminaires::installed_watts;

impl Ending {
    /// Returns the cost of all repeats, if one takes `once` seconds: whether the time is exact or a bound, the time in
    /// seconds, and a description of the number of repeats.
    fn cost(self, once: f64) -> (&'static str, f64, Option<String>) {
        let most = self.at_most.map_or(f64::INFINITY, |most| most as f64);
        let limited_seconds = self.at_most_seconds.unwrap_or(f64::INFINITY).max(once);
        let in_time = self.at_most_seconds.map(|most| format!(", for {} at most", duration(most)));
        let in_time = in_time.unwrap_or_default();
        let in_number = self.at_most.map(|most| format!(", {} times at most", grouped(most)));
        let limit = in_number.unwrap_or_default() + &in_time;
        match self.until {
            Until::Times(times) => {
                let times = most.min(times as f64);
                let bound = if self.at_most_seconds.is_some() { " at most" } else { " in total" };
                let seconds = (times * once).min(limited_seconds);
                (bound, seconds, Some(format!("{} times{in_time}", grouped(times as u64))))
            }
            Until::Seconds(budget) => {
                let seconds = budget.min(most * once).min(limited_seconds).max(once);
                let how = format!("for {}{limit}", duration(budget));
                (" in total", seconds, Some(how))
            }
            Until::RelativeError(target) => {
                let how = format!("until the relative error is {} %{limit}", 100.0 * target);
                match (most * once).min(limited_seconds) {
                    seconds if seconds.is_finite() => (" at most", seconds, Some(how)),
                    _ => (" or more", once, Some(how)),
                }
            }
        }
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Prepared { model, up, up_from, sources, load_seconds, build_seconds, .. } = &self.prepared;
        let scene: &Scene = &model.scene;
        let count = |n: usize| grouped(n as u64);
        let size = scene.bounding_box().size();
        let power: Rgb = sources.iter().map(|s| s.power).sum();
        writeln!(f, "triangles  {}", count(scene.triangles().len()))?;
        writeln!(f, "patches    {}", count(model.mesh.patch_count()))?;
        writeln!(f, "sides      {}", count(model.mesh.side_count()))?;
        writeln!(f, "area       {:.6} m²", scene.total_area())?;
        writeln!(
            f,
            "extent     {:.4} × {:.4} × {:.4} m, up is {} ({up_from})",
            size.x,
            size.y,
            size.z,
            name(*up)
        )?;
        writeln!(f, "cameras    {}", scene.cameras().len())?;
        writeln!(
            f,
            "sources    {}, {:.6} + {:.6} + {:.6} {} (red, green, blue)",
            kinds(sources),
            power.x,
            power.y,
            power.z,
            self.units.power()
        )?;
        let luminaires = &self.prepared.luminaires;
        for luminaire in luminaires {
            writeln!(f, "luminaires {}", luminaire.in_short())?;
        }
        if let Some(watts) = installed_watts(luminaires) {
            writeln!(f, "installed  {watts:.1} W of electric power")?;
        }
        let groups = &self.prepared.groups;
        for LightGroup { name, power, .. } in groups {
            let unit = self.units.power();
            writeln!(f, "group      {name}: {:.6} + {:.6} + {:.6} {unit}", power.x, power.y, power.z)?;
        }
        for placed in self.prepared.placed.values() {
            if let Placed::Probes(grid) = placed {
                writeln!(f, "probes     {}, {} of them valid", count(grid.len()), count(grid.valid.len()))?;
            }
        }
        writeln!(f, "memory     {} at most:", bytes(self.peak_memory))?;
        for (part, size) in &self.memory {
            writeln!(f, "           {:>9}  {part}", bytes(*size))?;
        }
        if self.group_file > 0 {
            writeln!(
                f,
                "disk       {} for the light groups, of {} each",
                bytes(groups.len() * self.group_file),
                bytes(self.group_file)
            )?;
        }
        let once: f64 = self.stages.iter().map(|s| s.lines as f64 / s.rate).sum();
        let (bound, of_group, repeats) =
            self.repeat.map_or((" in total", once, None), |repeat| repeat.cost(once));
        let tracing = of_group * groups.len().max(1) as f64;
        writeln!(
            f,
            "time       {}{bound}, without outputs:",
            duration(load_seconds + build_seconds + tracing)
        )?;
        writeln!(f, "           {:>9}  Load", duration(*load_seconds))?;
        writeln!(f, "           {:>9}  patches and acceleration structure", duration(*build_seconds))?;
        if !groups.is_empty() {
            let count = groups.len();
            writeln!(
                f,
                "           {:>9}  {count} light groups, each with all lines; for each",
                duration(tracing)
            )?;
        }
        if let Some(repeats) = repeats {
            writeln!(f, "           {:>9}  Repeat: {repeats}; each time", duration(of_group))?;
        }
        for StageEstimate { name, lines, rate } in &self.stages {
            let time = duration(*lines as f64 / rate);
            writeln!(
                f,
                "           {time:>9}  {name}: {} lines at {} lines/s",
                grouped(*lines),
                grouped(*rate as u64)
            )?;
        }
        Ok(())
    }
}
