//! Contents of a photometric file.

use crate::distribution::IntensityDistribution;
use crate::opening::Opening;
use crate::tilt::Tilt;

/// Contents of a photometric file, as far as they matter for light.
#[derive(Clone, Debug, PartialEq)]
pub struct Photometry {
    /// Format, such as `IES LM-63-2002 type C` or `EULUMDAT`.
    pub format: String,
    /// Name of the luminaire, with that of its manufacturer if the file states it; may be empty.
    pub name: String,
    /// Intensity \[cd\] with all factors of the file applied, except those of its tilt: that of the luminaire as it was
    /// measured.
    pub distribution: IntensityDistribution,
    /// Rated flux of all lamps together \[lm\]; `None` for absolute photometry, which has no separate lamps.
    pub lamp_flux: Option<f64>,
    /// Flux of the luminaire that the file itself states or implies \[lm\], such as the rated flux times the light output
    /// ratio of EULUMDAT. It may differ from the integral of the intensity.
    pub stated_flux: Option<f64>,
    /// Electric power with the ballast \[W\], if the file states it.
    pub watts: Option<f64>,
    /// Correlated color temperature \[K\], if the file states it.
    pub color_temperature: Option<f64>,
    /// Luminous opening.
    pub opening: Opening,
    /// Dependence of the intensity on the tilt of the luminaire, if the file has it.
    pub tilt: Option<Tilt>,
    /// What the reader had to guess or leave out, one sentence each.
    pub warnings: Vec<String>,
}
