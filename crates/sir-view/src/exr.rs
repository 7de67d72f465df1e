//! OpenEXR pictures, for measurement.

use std::io;
use std::path::Path;

use exr::meta::attribute::{Chromaticities, Text};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec, Vec2,
    WritableImage, f16,
};

use crate::atomic_file::write_atomically;
use crate::error::ViewError;
use crate::picture::Picture;

/// Rec. 709 primaries and D65 white, CIE 1931 xy.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Largest 16-bit float.
const MAX_HALF: f32 = 65_504.0;

/// Writes a picture as OpenEXR: linear radiance \[W/(m² sr)\] in the 32-bit float channels `R`, `G`, `B`, with lossless
/// compression.
///
/// `more` holds further pictures of the same size, each with a name. Their channels are `name.R`, `name.G` and
/// `name.B`, the usual way to store layers in one part.
///
/// # Errors
///
/// If the file cannot be written, or the pictures differ in size.
pub fn write_exr(path: &Path, picture: &Picture, more: &[(&str, &Picture)]) -> Result<(), ViewError> {
    let mut channels = Vec::new();
    for (prefix, layer) in std::iter::once((String::new(), picture))
        .chain(more.iter().map(|(name, layer)| (format!("{name}."), *layer)))
    {
        if (layer.width, layer.height) != (picture.width, picture.height) {
            return Err(ViewError::PictureSize { width: layer.width, height: layer.height });
        }
        channels.extend(color_channels(&prefix, &layer.radiance));
    }
    write_exr_channels(path, [picture.width, picture.height], channels, ExrFormat::Float)
}

/// Number format of the channels of an OpenEXR file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ExrFormat {
    /// 32 bits: seven digits.
    #[default]
    Float,
    /// 16 bits: three digits, up to 65,504.
    Half,
}

/// Returns the channels `R`, `G` and `B` of colors, with a prefix to their names.
pub fn color_channels(prefix: &str, colors: &[[f32; 3]]) -> impl Iterator<Item = (String, Vec<f32>)> {
    ["R", "G", "B"]
        .iter()
        .enumerate()
        .map(move |(i, band)| (format!("{prefix}{band}"), colors.iter().map(|color| color[i]).collect()))
}

/// Writes channels of numbers as OpenEXR, with lossless compression. Each has a name, and one number per pixel, row by row
/// from the top. Colors are linear Rec. 709.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_exr_channels(
    path: &Path,
    [width, height]: [u32; 2],
    channels: Vec<(String, Vec<f32>)>,
    format: ExrFormat,
) -> Result<(), ViewError> {
    let channel = |(name, values): (String, Vec<f32>)| {
        let samples = match format {
            ExrFormat::Float => FlatSamples::F32(values),
            // Beyond the largest number, 16 bits would be infinite.
            ExrFormat::Half => {
                FlatSamples::F16(values.iter().map(|x| f16::from_f32(x.clamp(-MAX_HALF, MAX_HALF))).collect())
            }
        };
        AnyChannel::new(Text::from(name.as_str()), samples)
    };
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = channels.into_iter().map(channel).collect();
    let size = Vec2(width as usize, height as usize);
    let attributes = LayerAttributes { software_name: Some(Text::from("SIR")), ..LayerAttributes::default() };
    let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels));
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = Some(REC_709);
    write_atomically(path, |file| {
        image.write().non_parallel().to_buffered(file).map_err(|error| io::Error::other(error.to_string()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::read_first_rgba_layer_from_file;

    #[test]
    fn an_exr_is_read_back_without_loss() {
        let radiance: Vec<[f32; 3]> =
            (0..15u16).map(|i| [f32::from(i) * 1e3, 1.0 / f32::from(i + 1), 1e-6]).collect();
        let picture = Picture { width: 5, height: 3, radiance, shown: Vec::new(), surface: Vec::new() };
        let error = Picture { radiance: vec![[7.0; 3]; 15], ..picture.clone() };
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.exr");
        write_exr(&path, &picture, &[("error", &error)]).unwrap();
        let read = read_first_rgba_layer_from_file(
            &path,
            |size, _| vec![vec![[0f32; 3]; size.width()]; size.height()],
            |pixels, at, (r, g, b, _): (f32, f32, f32, f32)| pixels[at.y()][at.x()] = [r, g, b],
        )
        .unwrap();
        assert_eq!(read.layer_data.channel_data.pixels.concat(), picture.radiance);
        assert_eq!(read.attributes.chromaticities, Some(REC_709));
        let meta = exr::meta::MetaData::read_from_file(&path, true).unwrap();
        let names: Vec<String> = meta.headers[0].channels.list.iter().map(|c| c.name.to_string()).collect();
        assert_eq!(names, ["B", "G", "R", "error.B", "error.G", "error.R"]);
    }
}
