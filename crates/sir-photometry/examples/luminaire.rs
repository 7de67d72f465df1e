//! Shows what a photometric file says, and the light of the luminaire on a floor below it.
//!
//!     cargo run -p sir-photometry --example luminaire -- lamp.ies
//!
//! Without an argument it reads one of the files of our tests.

#![allow(clippy::print_stdout, reason = "a program's output")]

use std::error::Error;
use std::path::PathBuf;

use glam::DVec3;
use sir_photometry::Photometry;

/// Height of the luminaire above the floor \[m\].
const HEIGHT: f64 = 3.0;

fn main() -> Result<(), Box<dyn Error>> {
    let ours = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/files/half-2002.ies");
    let path = std::env::args_os().nth(1).map_or(ours.into(), PathBuf::from);
    let file = Photometry::read(&path)?;
    println!("{} ({})", file.name, file.format);
    println!("{:?}", file.opening);
    println!(
        "flux           {:.0} lm, {:.0} cd at most",
        file.distribution.flux(),
        file.distribution.largest()
    );
    if let Some(flux) = file.lamp_flux {
        println!("rated flux     {flux:.0} lm");
    }
    if let Some(watts) = file.watts {
        println!("efficacy       {:.0} lm/W", file.distribution.flux() / watts);
    }
    for warning in &file.warnings {
        println!("warning: {warning}");
    }
    println!("\nIlluminance {HEIGHT} m below [lx], 1 m apart, the length of the luminaire to the right:");
    for y in -3..=3 {
        for x in -3..=3 {
            let way = DVec3::new(f64::from(x), f64::from(-y), -HEIGHT);
            let direction = way.normalize();
            print!("{:8.1}", file.distribution.intensity(direction) * -direction.z / way.length_squared());
        }
        println!();
    }
    Ok(())
}
