//! OpenEXR pictures, for measurement.

use std::io;
use std::path::Path;

use exr::meta::attribute::{Chromaticities, Text};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec, Vec2,
    WritableImage,
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
    let mut channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = SmallVec::new();
    for (prefix, layer) in std::iter::once((String::new(), picture))
        .chain(more.iter().map(|(name, layer)| (format!("{name}."), *layer)))
    {
        if (layer.width, layer.height) != (picture.width, picture.height) {
            return Err(ViewError::PictureSize { width: layer.width, height: layer.height });
        }
        for (i, band) in ["R", "G", "B"].iter().enumerate() {
            let values = layer.radiance.iter().map(|pixel| pixel[i]).collect();
            let name = format!("{prefix}{band}");
            channels.push(AnyChannel::new(Text::from(name.as_str()), FlatSamples::F32(values)));
        }
    }
    let size = Vec2(picture.width as usize, picture.height as usize);
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
