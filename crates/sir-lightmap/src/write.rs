//! Files of a lightmap.

use std::ffi::OsStr;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use sir_view::{
    ExrFormat, color_channels, srgb, tone_map, write_atomically, write_exr_channels, write_glb_file,
};

use crate::encode::{png_rgba, png_rgbm, png_srgb, scale};
use crate::error::LightmapError;
use crate::lightmap::{Lightmap, open};
use crate::lit::{Lit, light};
use crate::observer::Observer;
use crate::options::LightmapSides;
use crate::variants::{PageImage, Style};

/// Files to write.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightmapFiles {
    /// Number format of the EXR images.
    pub exr: ExrFormat,
    /// True to write images with a shared multiplier (RGBM), too.
    pub rgbm: bool,
    /// True to write a scene whose colors are texture times light, too.
    pub combined: bool,
    /// Unit of irradiance, for the manifest: `W/m²` or `lx`.
    pub unit: &'static str,
}

impl Lightmap<'_> {
    /// Writes the lit scene to `path`, which ends in `.glb`, and beside it the pages and the manifest. Returns the paths of all
    /// files, the lit scene last.
    ///
    /// For `room-lit.glb` and page 0 these are `room-lit-0.exr`, `room-lit-0.png`, `room-lit-0-rgbm.png`,
    /// `room-lit-combined.glb`, `room-lit.json` and `room-lit.glb`. Each is written completely or not at all.
    ///
    /// # Errors
    ///
    /// If a file cannot be written, the glTF file cannot be read again, or `observer` stops the work.
    pub fn write(
        self,
        path: &Path,
        files: LightmapFiles,
        observer: &dyn Observer,
    ) -> Result<Vec<PathBuf>, LightmapError> {
        let stem = path.file_stem().and_then(OsStr::to_str).unwrap_or("lightmap").to_owned();
        let beside = |ending: &str| path.with_file_name(format!("{stem}{ending}"));
        let name = |path: &Path| path.file_name().and_then(OsStr::to_str).unwrap_or_default().to_owned();
        let ([width, height], pages) = self.size();
        let count = width as usize * height as usize;
        let scale = scale(&self.texels.light, |i| self.texels.is_covered(i));
        let peak = self.texels.light.iter().flatten().fold(0.0f32, |a, &b| a.max(b));
        let rgbm_scale = if peak > 0.0 { f64::from(peak) } else { 1.0 };
        let (mut written, mut images, mut listed) = (Vec::new(), Vec::new(), Vec::new());
        for page in 0..pages as usize {
            let of = page * count..(page + 1) * count;
            let light = &self.texels.light[of.clone()];
            let mut channels: Vec<_> = color_channels("", light).collect();
            channels.extend(color_channels("error.", &self.texels.error[of.clone()]));
            channels.push(("coverage".to_owned(), self.texels.coverage[of.clone()].to_vec()));
            if let Some(direct) = &self.direct {
                channels.extend(color_channels("direct.", &direct[of.clone()]));
            }
            let exr = beside(&format!("-{page}.exr"));
            write_exr_channels(&exr, [width, height], channels, files.exr)?;
            let png = beside(&format!("-{page}.png"));
            let bytes = png_srgb(light, scale, [width, height]);
            write_atomically(&png, |file| file.write_all(&bytes))?;
            let mut entry = json!({ "exr": name(&exr), "png": name(&png) });
            written.extend([exr, png]);
            if files.rgbm {
                let rgbm = beside(&format!("-{page}-rgbm.png"));
                let bytes = png_rgbm(light, rgbm_scale, [width, height]);
                write_atomically(&rgbm, |file| file.write_all(&bytes))?;
                entry["rgbm"] = json!(name(&rgbm));
                written.push(rgbm);
            }
            listed.push(entry);
            images.push(PageImage { png: bytes, intensity: scale * self.exposure });
        }
        if files.combined {
            let combined = beside("-combined.glb");
            self.write_combined(&combined, observer)?;
            written.push(combined);
        }
        let mut manifest = self.manifest(files, scale, rgbm_scale);
        manifest["pages"] = json!(listed);
        let Self { mut document, objects, layout, options, exposure, .. } = self;
        let is_split = options.sides == LightmapSides::Split;
        let style = Style::Lightmap { expand: options.expand };
        let lit = light(&mut document, &objects, &layout, &images, style, is_split)?;
        let shown = json!({ "exposure": exposure, "scale": scale, "unit": files.unit });
        document.add_scene_extras("lightmap", shown);
        manifest["scene"] = json!(name(path));
        manifest["objects"] = lit.iter().map(|lit| object(&document.json, lit)).collect();
        let manifest_path = beside(".json");
        let text = format!("{manifest:#}\n");
        write_atomically(&manifest_path, |file| file.write_all(text.as_bytes()))?;
        written.push(manifest_path);
        let (json, binary) = document.into_parts();
        write_glb_file(path, &json, &binary)?;
        written.push(path.to_owned());
        Ok(written)
    }

    /// Writes a scene whose colors are texture times light, as any viewer shows them.
    fn write_combined(&self, path: &Path, observer: &dyn Observer) -> Result<(), LightmapError> {
        let texels = self.radiosity(observer)?;
        let ([width, height], pages) = self.size();
        let count = width as usize * height as usize;
        let factor = self.exposure / std::f64::consts::PI;
        let color = |i: usize| {
            let radiosity = sir_geom::Rgb::from_array(texels.light[i].map(f64::from));
            let [r, g, b] = tone_map(factor * radiosity).to_array().map(|x| (255.0 * srgb(x) + 0.5) as u8);
            let opacity = if texels.is_covered(i) { texels.opacity[i] } else { 1.0 };
            [r, g, b, (255.0 * opacity + 0.5) as u8]
        };
        let page = |page: usize| {
            let colors: Vec<[u8; 4]> = (page * count..(page + 1) * count).map(color).collect();
            PageImage { png: png_rgba(&colors, [width, height]), intensity: 1.0 }
        };
        let images: Vec<PageImage> = (0..pages as usize).map(page).collect();
        // Meshes and materials are changed, so the document is read again.
        let (mut document, objects) = open(&self.solution)?;
        let is_split = self.options.sides == LightmapSides::Split;
        light(&mut document, &objects, &self.layout, &images, Style::Combined, is_split)?;
        let (json, binary) = document.into_parts();
        Ok(write_glb_file(path, &json, &binary)?)
    }

    /// Returns the manifest without what the single files need.
    fn manifest(&self, files: LightmapFiles, scale: f64, rgbm_scale: f64) -> Value {
        let covered = |i: &usize| self.texels.is_covered(*i);
        let all = || (0..self.texels.light.len()).filter(covered);
        let mean = |color: &[f32; 3]| f64::from(color[0] + color[1] + color[2]) / 3.0;
        let (mut area, mut light, mut squares, mut clipped) = (0.0, 0.0, 0.0, 0usize);
        for i in all() {
            let of = f64::from(self.texels.area[i]);
            area += of;
            light += of * mean(&self.texels.light[i]);
            squares += of * mean(&self.texels.error[i]).powi(2);
            clipped += usize::from(self.texels.light[i].iter().any(|&x| f64::from(x) > scale));
        }
        let level = light / area.max(f64::MIN_POSITIVE);
        let noise = (squares / area.max(f64::MIN_POSITIVE)).sqrt();
        let count = all().count();
        let mut manifest = json!({
            "version": 1,
            "generator": concat!("SIR ", env!("CARGO_PKG_VERSION")),
            "unit": files.unit,
            "quantity": "irradiance",
            "color": "linear Rec. 709 in EXR images",
            "width": self.layout.width,
            "height": self.layout.height,
            "texels_per_meter": self.layout.texels_per_meter,
            "charts": self.layout.charts,
            "padding": self.options.padding,
            "dilation": self.options.padding,
            "sides": format!("{:?}", self.options.sides),
            "area": area,
            "area_without_texels": self.texels.lost,
            "mean": level,
            "error": noise,
            "relative_error": if level > 0.0 { noise / level } else { 0.0 },
            "denoised": self.solution.is_denoised,
            "png": {
                "encoding": "sRGB",
                "decode": "irradiance = scale * linear(rgb)",
                "scale": scale,
                "clipped": clipped as f64 / count.max(1) as f64,
            },
            "exposure": self.exposure,
            "exr_channels": {
                "R, G, B": "mean irradiance of the texel",
                "error.R, error.G, error.B": "its standard error",
                "coverage": "share of the texel that is covered",
            },
            "notes": self.notes,
        });
        if self.direct.is_some() {
            manifest["exr_channels"]["direct.R, direct.G, direct.B"] =
                json!("part that comes from sources without a reflection");
        }
        if files.rgbm {
            manifest["rgbm"] = json!({
                "decode": "irradiance = scale * (rgb * a)^2",
                "scale": rgbm_scale,
            });
        }
        if let Some(steps) = self.steps {
            manifest["seams"] = json!({
                "before": steps.before, "after": steps.after, "inside": steps.inside, "points": steps.points,
            });
        }
        if self.has_common_sides() {
            manifest["two_sided"] = json!("both sides of two-sided surfaces show the same texels");
        }
        manifest
    }
}

/// Returns the entry of an instance of a mesh in the manifest.
fn object(document: &Value, lit: &Lit) -> Value {
    let Lit { node, mesh, of_node, page, uv_rect, set, is_existing } = lit;
    let mut entry = json!({
        "node": node, "mesh": mesh, "page": page, "uv_rect": uv_rect, "uv_set": set, "own_layout": is_existing,
    });
    if let Some(name) = document["nodes"][node]["name"].as_str() {
        entry["name"] = json!(name);
    }
    if *of_node > 0 {
        entry["instance"] = json!(of_node);
    }
    entry
}
