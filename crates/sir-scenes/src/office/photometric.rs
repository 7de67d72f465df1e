//! Photometric files of the luminaires in the office, computed from formulas.
//!
//! The luminaires are not those of a maker. Their intensities are smooth functions, sampled in steps of 5° and scaled
//! such that the integral over the table is the flux stated in the file.

use std::f64::consts::PI;

/// Flux of a recessed luminaire \[lm\].
pub const RECESSED_FLUX: f64 = 3700.0;
/// Flux of a downlight \[lm\].
pub const DOWNLIGHT_FLUX: f64 = 1000.0;
/// Flux of a task lamp \[lm\].
pub const TASK_FLUX: f64 = 500.0;

/// Step of the polar angle in all files \[°\].
const STEP: u32 = 5;

/// Table of intensities: planes around the axis, each from below to 90°.
struct Table {
    /// Azimuths of the planes \[°\].
    planes: Vec<f64>,
    /// Intensities \[cd\], plane by plane.
    intensities: Vec<Vec<f64>>,
}

impl Table {
    /// Returns a table of the function `shape` of polar angle and azimuth \[rad\], scaled to a flux \[lm\].
    fn new(planes: Vec<f64>, flux: f64, shape: impl Fn(f64, f64) -> f64) -> Self {
        let row = |plane: &f64| -> Vec<f64> {
            polar_angles().iter().map(|polar| shape(polar.to_radians(), plane.to_radians())).collect()
        };
        let mut table = Self { intensities: planes.iter().map(row).collect(), planes };
        let factor = flux / table.flux();
        table.intensities.iter_mut().flatten().for_each(|intensity| *intensity *= factor);
        table
    }

    /// Returns the flux: the integral of the intensity, which is linear in both angles between those of the table. The planes
    /// are mirrored into all directions.
    fn flux(&self) -> f64 {
        let angles: Vec<f64> = polar_angles().iter().map(|polar| polar.to_radians()).collect();
        // The integral of a + b γ times sin γ.
        let of_cell = |[from, to]: [f64; 2], [low, high]: [f64; 2]| {
            let slope = (high - low) / (to - from);
            low * from.cos() - high * to.cos() + slope * (to.sin() - from.sin())
        };
        let of_plane = |row: &Vec<f64>| -> f64 {
            (1..row.len()).map(|i| of_cell([angles[i - 1], angles[i]], [row[i - 1], row[i]])).sum()
        };
        let planes: Vec<f64> = self.intensities.iter().map(of_plane).collect();
        let cells = planes.len() - 1;
        match cells {
            0 => 2.0 * PI * planes[0],
            _ => (0..cells).map(|i| PI / cells as f64 * (planes[i] + planes[i + 1])).sum(),
        }
    }
}

/// Returns the polar angles of all tables \[°\].
fn polar_angles() -> Vec<f64> {
    (0..=90 / STEP).map(|i| f64::from(i * STEP)).collect()
}

/// Returns the EULUMDAT file of the recessed luminaire: 0.6 m × 0.6 m, 30 W, with a wide distribution that has little light
/// above 65°, so that it does not dazzle.
pub(crate) fn recessed_ldt() -> String {
    let planes: Vec<f64> = (0..=6).map(|i| 15.0 * f64::from(i)).collect();
    let table = Table::new(planes, RECESSED_FLUX, |polar, azimuth| {
        let wing = 0.45 + 0.25 * azimuth.cos().powi(2);
        let shield = 1.0 + (polar.to_degrees() / 56.0).powi(10);
        (1.0 + wing * (2.0 * polar).sin().powi(2)) * polar.cos() / shield
    });
    let polar = polar_angles();
    let mut text = String::new();
    let mut lines = |items: &[&str]| items.iter().for_each(|item| text += &format!("{item}\r\n"));
    // Company, type (2: any other luminaire), symmetry about two planes, 24 planes 15° apart.
    lines(&["SIR scenes", "2", "4", "24", "15"]);
    lines(&[&polar.len().to_string(), &STEP.to_string(), "none: computed from a formula"]);
    lines(&["Recessed panel 600 x 600", "recessed", "recessed.ldt", "2026"]);
    // Length, width and height of the luminaire and of its luminous area, which is flat [mm].
    lines(&["600", "600", "80", "600", "600", "0", "0", "0", "0"]);
    // Downward share [%], light output ratio [%], conversion factor, tilt.
    lines(&["100", "100", "1", "0"]);
    // One set of lamps: a negative number of lamps is absolute photometry.
    lines(&["1", "-1", "LED", &format!("{RECESSED_FLUX:.0}"), "4000 K", "80", "30"]);
    // Direct ratios for room indices from 0.6 to 5, which no program of ours reads.
    lines(&["0.55", "0.65", "0.74", "0.80", "0.85", "0.90", "0.94", "0.96", "0.98", "1.00"]);
    for plane in 0..24 {
        lines(&[&(15 * plane).to_string()]);
    }
    for angle in &polar {
        lines(&[&angle.to_string()]);
    }
    // cd per 1,000 lm.
    for intensity in table.intensities.iter().flatten() {
        lines(&[&format!("{:.2}", intensity * 1000.0 / RECESSED_FLUX)]);
    }
    text
}

/// Returns the IES file of the downlight: a disc of 0.15 m, 11 W, with half of the largest intensity at 30°.
pub(crate) fn downlight_ies() -> String {
    let exponent = 0.5f64.ln() / 30f64.to_radians().cos().ln();
    let table = Table::new(vec![0.0], DOWNLIGHT_FLUX, |polar, _| polar.cos().max(0.0).powf(exponent));
    // Negative dimensions are those of a round opening.
    ies("Downlight 150", "downlight", &table, &format!("{DOWNLIGHT_FLUX:.0}"), "-0.15 -0.15 0", "11")
}

/// Returns the IES file of the task lamp: 0.3 m × 0.05 m, 6 W, aimed forward (90°) of the vertical by 25°.
pub(crate) fn task_ies() -> String {
    let planes = (0..=12).map(|i| 90.0 + 15.0 * f64::from(i)).collect();
    let aim = 25f64.to_radians();
    let table = Table::new(planes, TASK_FLUX, |polar, azimuth| {
        let along_aim = polar.cos() * aim.cos() + polar.sin() * azimuth.sin() * aim.sin();
        // The edge of the head hides the opening near the horizon.
        along_aim.max(0.0).powi(2) * polar.cos().max(0.0)
    });
    ies("Task lamp", "task", &table, "-1", "0.05 0.3 0", "6")
}

/// Returns an IES file of type C with absolute photometry if `lumens` is −1.
fn ies(name: &str, number: &str, table: &Table, lumens: &str, opening: &str, watts: &str) -> String {
    let polar = polar_angles();
    let mut text = format!(
        "IESNA:LM-63-2002\r\n[TEST] none: computed from a formula\r\n[TESTLAB] none\r\n[ISSUEDATE] 2026\r\n\
         [MANUFAC] SIR scenes\r\n[LUMCAT] {number}\r\n[LUMINAIRE] {name}\r\n[LAMP] LED\r\nTILT=NONE\r\n"
    );
    let mut line = |items: &[String]| text += &format!("{}\r\n", items.join(" "));
    let counts = format!("{} {}", polar.len(), table.planes.len());
    // Lamps, lumens per lamp, multiplier, numbers of angles, type C, meters, opening (width, length, height).
    line(&[format!("1 {lumens} 1 {counts} 1 2 {opening}")]);
    line(&[format!("1 1 {watts}")]);
    line(&polar.iter().map(f64::to_string).collect::<Vec<_>>());
    line(&table.planes.iter().map(f64::to_string).collect::<Vec<_>>());
    for row in &table.intensities {
        line(&row.iter().map(|intensity| format!("{intensity:.1}")).collect::<Vec<_>>());
    }
    text
}
