//! Lightmaps of the solution.

use std::path::PathBuf;

use sir_lightmap::{LightmapOptions, LightmapSides};
use sir_view::ExrFormat;

use crate::text::field::Format as _;
use crate::text::formats::{Choice, Count, Flag, count, positive};
use crate::text::paths::OutputFile;
use crate::text::reader::{Fields, Reader};
use crate::text::record::record;

record! {
    /// Scene with lightmaps.
    pub struct Lightmap, check Lightmap::claim_files {
        /// `.glb`: the scene of the source file with lightmap coordinates and images. For `room-lit.glb`, the files
        /// `room-lit-0.exr` and `room-lit-0.png` for each page, and `room-lit.json` are written beside it.
        pub path: PathBuf = OutputFile { extensions: &["glb"], example: "room-lit.glb" }.required();
        /// Width and maximum height of a page.
        pub size: u32 = count(64, 16_384, 2048).or(1024).unit("texels");
        /// Texels per meter of surface, on as many pages as needed. If omitted, it is as high as `pages` allow.
        pub texels_per_meter: Option<f64> = positive(20.0)
            .with_range(|x| 0.0 < x && x <= 10_000.0, "above 0 and up to 10,000")
            .optional("what fits");
        /// Number of pages, if `texels_per_meter` is omitted. A mesh stays on one page.
        pub pages: u32 = count(1, 64, 2).or(1);
        /// Empty texels around each chart, which take the light of their neighbors.
        pub padding: u32 = padding().or(3).unit("texels");
        /// Surfaces of which both sides reflect: each side has its own texels, and the surface becomes two one-sided ones;
        /// or both sides show the light on the front; or the mean of both.
        pub sides: LightmapSides = SIDES.or(LightmapSides::Split);
        /// True to give each instance of a mesh its own mesh and coordinates. Otherwise instances share coordinates, and
        /// each node has a rectangle of a page.
        pub expand: bool = Flag.or(false);
        /// True to fit the texels at the edges of charts to each other, within their standard errors.
        pub seams: bool = Flag.or(true);
        /// True to denoise the light first, as in images.
        pub denoise: bool = Flag.or(false);
        /// True to write the direct light, too, in the channels `direct.R`, `direct.G`, `direct.B` of the EXR images.
        pub direct: bool = Flag.or(false);
        /// Numbers in the EXR images: 32 or 16 bits.
        pub exr: ExrFormat = EXR.or(ExrFormat::Float);
        /// True to write PNG images with a shared multiplier in alpha (RGBM), too.
        pub rgbm: bool = Flag.or(false);
        /// True to write a scene whose colors are texture times light, too, which any viewer shows lit:
        /// `room-lit-combined.glb`. Its textures have the resolution of the lightmap.
        pub combined: bool = Flag.or(false);
    }
}

const SIDES: Choice<LightmapSides> = Choice(&[
    ("Split", LightmapSides::Split),
    ("Front", LightmapSides::Front),
    ("Mean", LightmapSides::Mean),
]);

const EXR: Choice<ExrFormat> = Choice(&[("Float", ExrFormat::Float), ("Half", ExrFormat::Half)]);

fn padding() -> Count<u32> {
    count(2, 64, 4)
}

impl Lightmap {
    /// Returns the options of the lightmap, for this number of threads.
    #[must_use]
    pub fn options(&self, threads: usize) -> LightmapOptions {
        LightmapOptions {
            size: self.size,
            texels_per_meter: self.texels_per_meter,
            pages: self.pages,
            padding: self.padding,
            sides: self.sides,
            expand: self.expand,
            seams: self.seams,
            threads,
        }
    }

    /// Returns the paths of the files beside the lit scene, as far as they are known beforehand.
    pub(crate) fn files_beside(&self) -> Vec<PathBuf> {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut endings = vec![".json".to_owned()];
        for page in 0..self.pages {
            endings.extend([format!("-{page}.exr"), format!("-{page}.png")]);
            if self.rgbm {
                endings.push(format!("-{page}-rgbm.png"));
            }
        }
        if self.combined {
            endings.push("-combined.glb".to_owned());
        }
        endings.into_iter().map(|ending| self.path.with_file_name(format!("{stem}{ending}"))).collect()
    }

    /// Claims the names of the files beside the lit scene.
    fn claim_files<'a>(&self, reader: &mut Reader<'a>, fields: &Fields<'a>) {
        let Some(node) = fields.get("path") else { return };
        for file in self.files_beside() {
            if reader.claim_output(node, &file.to_string_lossy()).is_none() {
                return;
            }
        }
    }
}
