//! Photometric files of luminaires, and the luminous intensity that they describe.
//!
//! # Design
//!
//! A photometric file is a table of luminous intensity over two angles, with factors, a few facts about the luminaire, and
//! conventions that differ between formats, versions and types. This crate resolves the conventions once:
//!
//! * **Readers.** `ies` reads IES LM-63 of 1986 to 2019 in the types A, B and C, `eulumdat` reads EULUMDAT. Both return a
//!   [`Photometry`]. The contents decide the format. A file is read if it has one meaning; what had to be guessed or left
//!   out stands in [`Photometry::warnings`], one sentence each. Otherwise there is one [`PhotometryError`] with the line, what
//!   was found, what was expected, and what to do.
//! * **One frame.** All distributions are functions of a direction in the frame of the luminaire (below), so that the same lamp
//!   is the same function, whatever file it comes from. A renderer rotates directions, never angles: azimuths cannot get
//!   lost.
//! * **One table.** [`IntensityDistribution`] is the bilinear interpolation of the table in its own angles. It is not
//!   resampled, so no value is changed, and types A and B keep the resolution of their beam. Symmetries are expanded by
//!   mirroring planes, which costs a few thousand numbers and removes all special cases from evaluation.
//! * **Exact flux and samples.** The interpolated function is integrated in closed form, and [`IntensityDistribution::sample`]
//!   inverts its distribution function. So samples have no rejection, a weight of exactly the flux, and keep the order of
//!   low-discrepancy points. Normalizing by sums over samples, as some renderers do, would make the flux noisy.
//! * **Hostile files.** Memory grows with the size of a file, not with the counts it states; numbers are finite and limited.
//!   A file of tilt factors is looked for in the folder of the file only.
//!
//! # The frame of the luminaire
//!
//! The luminaire is aimed at −z, its length is along x, and its width along y.
//!
//! | direction | type C | EULUMDAT | type B | type A |
//! |---|---|---|---|---|
//! | −z, the photometric zero | vertical 0° | γ = 0° | vertical 0°, horizontal 0° | vertical −90° |
//! | +x, the photometric horizontal | vertical 90°, horizontal 0° | γ = 90°, C90 | vertical 90°, horizontal 0° | vertical 0°, horizontal 0° |
//! | +y | vertical 90°, horizontal 90° | γ = 90°, C180 | horizontal −90° | vertical 0°, horizontal −90° |
//! | −x | vertical 90°, horizontal 180° | γ = 90°, C270 | vertical −90°, horizontal 0° | vertical 0°, horizontal 180° |
//! | −y | vertical 90°, horizontal 270° | γ = 90°, C0 | horizontal 90° | vertical 0°, horizontal 90° |
//! | +z | vertical 180° | γ = 180° | vertical 180°, horizontal 0° | vertical 90° |
//!
//! The beam of a headlight in type A is along +x, because the photometric zero of type A is below it. The lamps of a
//! luminaire are along the plane 0° of IES and across the plane C0 of EULUMDAT: the horizontal angle of IES is C − 90°.
//!
//! # Example
//!
//! ```
//! use glam::DVec3;
//! use sir_photometry::Photometry;
//!
//! let file = b"IESNA:LM-63-2002
//! [LUMINAIRE] Downlight
//! TILT=NONE
//! 1 -1 1 3 1 1 2 -0.2 -0.2 0
//! 1 1 12
//! 0 45 90
//! 0
//! 300 200 0";
//! let downlight = Photometry::parse(file)?;
//! assert_eq!((downlight.name.as_str(), downlight.watts), ("Downlight", Some(12.0)));
//!
//! let light = &downlight.distribution;
//! assert_eq!(light.intensity(DVec3::NEG_Z), 300.0);
//! assert_eq!(light.intensity(DVec3::Z), 0.0);
//! assert!((light.flux() - 850.6).abs() < 0.1);
//! // A direction whose density is the intensity over the flux.
//! assert!(light.sample([0.25, 0.5]).z < 0.0);
//!
//! let error = Photometry::parse(b"TILT=NONE\n1 -1 one").unwrap_err();
//! assert_eq!(
//!     error.to_string(),
//!     "line 2, column 6: the candela multiplier is \"one\" (expected a number above 0); correct it, or export the file \
//!      again"
//! );
//! # Ok::<(), sir_photometry::PhotometryError>(())
//! ```
//!
//! # Sources
//!
//! * ANSI/IES LM-63-19 and its predecessors of 1986, 1991, 1995 and 2002. *Standard File Format for the Electronic Transfer of
//!   Photometric Data.*
//! * IES LM-75-01. *Goniophotometer Types and Photometric Coordinates.*
//! * Stockmar, A. W. (1990). *EULUMDAT – ein Leuchtendatenformat für den europäischen Beleuchtungsplaner.* Tagungsband Licht
//!   '90, 641–644.
//! * CIE 121-1996. *The Photometry and Goniophotometry of Luminaires.*

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod bits;
mod distribution;
mod emission;
mod error;
mod eulumdat;
mod faces;
mod ies;
mod opening;
mod photometry;
mod planes;
mod read;
mod span;
mod text;
mod tilt;

pub use distribution::{Coordinates, IntensityDistribution};
pub use emission::OpeningLight;
pub use error::{PhotometryError, TableError};
pub use faces::OpeningFace;
pub use opening::{Along, Opening, Outline};
pub use photometry::Photometry;
pub use read::PhotometryOptions;
pub use tilt::{LampGeometry, Tilt};
