//! Colors.

/// A color or a spectral quantity in three bands: linear Rec. 709 red, green and blue.
///
/// The unit is that of the quantity: 1 for a reflectance, W/m² for a radiosity, W for a power.
pub type Rgb = glam::DVec3;

/// Returns the luminance `Y` of a linear Rec. 709 color, weighted as by the eye: `0.2126 R + 0.7152 G + 0.0722 B`.
#[must_use]
pub fn luminance(rgb: Rgb) -> f64 {
    rgb.dot(Rgb::new(0.2126, 0.7152, 0.0722))
}
