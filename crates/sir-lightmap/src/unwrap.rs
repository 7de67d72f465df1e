//! Unwrapping: unfolds meshes into charts, and places them on pages.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{DVec2, DVec3};
use sir_geom::Side;
use uvunwrap::{Atlas, Density, Error, MeshInput, Options, OutputMesh, Packing, Stage};

use crate::document::Document;
use crate::error::LightmapError;
use crate::existing::{self, Existing};
use crate::layout::{Layout, NO_CHART, Rectangle, Sheet, Unfolded};
use crate::objects::{Mesh, Objects};
use crate::options::{LightmapOptions, LightmapSides};
use crate::{Observer, Step};

/// Number of charts from which they are placed by the faster, less dense method.
const MANY_CHARTS: u32 = 4_000;

/// Share of a page that charts fill, at least, if they are placed by the faster method.
const FILLED: f64 = 0.4;

/// Cosine of the largest bend of a surface across which light continues: 30°, as in pictures.
const SMOOTH: f64 = 0.866;

/// Factor of the size of surfaces without light, of which a texel shows all that there is.
const DARK_SCALE: f32 = 0.01;

/// Number of attempts to find the density for several pages.
const ATTEMPTS: usize = 8;

/// A sheet before it is unfolded: positions and triangles of one side of a mesh.
struct Input {
    mesh: usize,
    side: Side,
    positions: Vec<[f32; 3]>,
    indices: Vec<u32>,
    /// Primitive of each triangle, and its number there.
    triangles: Vec<(u32, u32)>,
    primitives: Vec<u32>,
    /// For each edge of each triangle, true if the surface has a crease there.
    creases: Vec<[bool; 3]>,
    /// Number of the first vertex of each primitive.
    first_vertices: Vec<u32>,
    /// Instances of the mesh, and their sizes relative to the first.
    instances: Vec<usize>,
    scales: Vec<f32>,
    /// Factor of its size on the page.
    scale: f32,
    /// Layout of the file, if it is used.
    existing: Option<Rc<Existing>>,
}

/// Unfolds all meshes. Adds to `notes` why layouts of the file are not used.
pub(crate) fn unwrap(
    document: &Document,
    objects: &Objects,
    is_dark: &IsDark<'_>,
    options: &LightmapOptions,
    notes: &mut Vec<String>,
    observer: &dyn Observer,
) -> Result<Layout, LightmapError> {
    let mut existing = Vec::with_capacity(objects.meshes.len());
    for (number, mesh) in objects.meshes.iter().enumerate() {
        let is_split =
            options.sides == LightmapSides::Split && mesh.primitives.iter().any(|p| p.is_two_sided);
        let first = objects.instances.iter().find(|instance| instance.mesh == number);
        existing.push(match first.filter(|_| !is_split) {
            Some(instance) => existing::of_mesh(document, mesh, instance.area, notes)?.map(Rc::new),
            None => None,
        });
    }
    loop {
        let layout = pack(objects, &existing, is_dark, options, observer)?;
        let Some((sheet, why)) = existing::too_coarse(&layout) else { return Ok(layout) };
        let mesh = layout.sheets[sheet].mesh;
        notes.push(existing::note(&objects.meshes[mesh], &why));
        existing[mesh] = None;
    }
}

/// Returns true if a side of a triangle of a mesh has no light: of the mesh, the primitive and the number in it.
pub(crate) type IsDark<'a> = dyn Fn(usize, Side, usize, usize) -> bool + 'a;

/// Collects the sides of all meshes. With `is_dark`, those without light are apart, where a mesh has one instance.
fn inputs(
    objects: &Objects,
    existing: &[Option<Rc<Existing>>],
    is_dark: Option<&IsDark<'_>>,
    options: &LightmapOptions,
) -> Vec<Input> {
    let mut inputs = Vec::new();
    for (number, mesh) in objects.meshes.iter().enumerate() {
        let instances: Vec<usize> =
            (0..objects.instances.len()).filter(|&i| objects.instances[i].mesh == number).collect();
        for side in [Side::Front, Side::Back] {
            let is_split = options.sides == LightmapSides::Split;
            let has_side =
                |primitive: usize| side == Side::Front || is_split && mesh.primitives[primitive].is_two_sided;
            let is_apart = is_dark.filter(|_| instances.len() == 1 && existing[number].is_none());
            let lit = |p: usize, t: usize| {
                has_side(p) && !is_apart.is_some_and(|is_dark| is_dark(number, side, p, t))
            };
            let dark = |p: usize, t: usize| {
                has_side(p) && is_apart.is_some_and(|is_dark| is_dark(number, side, p, t))
            };
            let of = |has: &dyn Fn(usize, usize) -> bool| {
                Input::new(objects, number, side, instances.clone(), has)
            };
            let lit = Input { existing: existing[number].clone(), ..of(&lit) };
            let dark = Input { scale: DARK_SCALE, ..of(&dark) };
            inputs.extend([lit, dark].into_iter().filter(|input| !input.triangles.is_empty()));
        }
    }
    inputs
}

/// Places all sheets on pages.
fn pack(
    objects: &Objects,
    existing: &[Option<Rc<Existing>>],
    is_dark: &IsDark<'_>,
    options: &LightmapOptions,
    observer: &dyn Observer,
) -> Result<Layout, LightmapError> {
    let one_page = match options.texels_per_meter {
        Some(texels) => Density::Fixed { texels_per_unit: texels as f32, page_size: None },
        None => Density::Auto { page_size: options.size },
    };
    let fits = |atlas: &Atlas| atlas.page_count <= 1 && atlas.width.max(atlas.height) <= options.size;
    if options.texels_per_meter.is_some() || options.pages == 1 {
        let inputs = inputs(objects, existing, Some(is_dark), options);
        let sizes = Sizes { objects, inputs: &inputs, options, observer };
        match sizes.generate(one_page, false) {
            Ok(atlas) if fits(&atlas) => return Ok(sizes.layout(&atlas)),
            Ok(atlas) if options.texels_per_meter.is_none() => return Err(sizes.too_small(&atlas, None)),
            // With a density there are as many pages as needed.
            Ok(_) | Err(Error::AtlasTooLarge { .. }) => {}
            Err(error) => return Err(sizes.error(error)),
        }
    }
    let inputs = inputs(objects, existing, None, options);
    let sizes = Sizes { objects, inputs: &inputs, options, observer };
    if let Some(texels) = options.texels_per_meter {
        let density = Density::Fixed { texels_per_unit: texels as f32, page_size: Some(options.size) };
        let atlas = sizes.generate(density, true).map_err(|error| sizes.error(error))?;
        return Ok(sizes.layout(&atlas));
    }
    // The density at which the charts of all sheets fill the pages, lowered until they fit.
    let area: f64 = inputs.iter().map(Input::area).sum();
    let texels = f64::from(options.pages) * f64::from(options.size) * f64::from(options.size);
    let mut density = (0.8 * texels / area.max(f64::MIN_POSITIVE)).sqrt();
    let (mut fitting, mut too_high, mut refusal) = (None, f64::INFINITY, None);
    for _ in 0..ATTEMPTS {
        let fixed = Density::Fixed { texels_per_unit: density as f32, page_size: Some(options.size) };
        match sizes.generate(fixed, true) {
            Ok(atlas) if atlas.page_count <= options.pages => {
                fitting = Some((density, atlas));
            }
            Ok(atlas) => {
                too_high = density;
                refusal = Some(sizes.too_small(&atlas, Some(atlas.page_count)));
            }
            Err(error @ (Error::ChartTooLarge { .. } | Error::AtlasTooLarge { .. })) => {
                too_high = density;
                refusal = Some(sizes.error(error));
            }
            Err(error) => return Err(sizes.error(error)),
        }
        density = match &fitting {
            Some((low, _)) if too_high < 1.03 * low => break,
            Some((low, _)) => (low * too_high).sqrt().min(1.2 * low),
            None => 0.8 * density,
        };
    }
    match fitting {
        Some((_, atlas)) => Ok(sizes.layout(&atlas)),
        None => Err(refusal.unwrap_or(LightmapError::Stopped)),
    }
}

/// Sheets that are placed on pages.
struct Sizes<'a> {
    objects: &'a Objects,
    inputs: &'a [Input],
    options: &'a LightmapOptions,
    observer: &'a dyn Observer,
}

impl Sizes<'_> {
    /// Unfolds and places all sheets. With `is_whole`, each sheet stays on one page.
    fn generate(&self, density: Density, is_whole: bool) -> Result<Atlas, Error> {
        let single = [1.0];
        let meshes: Vec<MeshInput<'_>> = self
            .inputs
            .iter()
            .map(|input| {
                let is_instanced = input.instances.len() > 1;
                let scales: &[f32] = match is_instanced {
                    true => &input.scales,
                    false if is_whole => &single,
                    false => &[],
                };
                match &input.existing {
                    Some(existing) => MeshInput {
                        instance_scales: scales,
                        ..MeshInput::new(&existing.frame, &existing::FRAME_TRIANGLES)
                    },
                    None => MeshInput {
                        face_materials: Some(&input.primitives),
                        seams: Some(&input.creases),
                        scale: input.scale,
                        instance_scales: scales,
                        ..MeshInput::new(&input.positions, &input.indices)
                    },
                }
            })
            .collect();
        let options =
            |packing| Options { density, padding: self.options.padding, packing, ..Options::default() };
        let report = |progress: uvunwrap::Progress| {
            let total = progress.total.map(|total| total as u64);
            match progress.stage {
                // Meshes are counted first, in little time.
                Stage::Segmenting => self.observer.progress(Step::Unwrapping, 0, None),
                Stage::Parameterizing => {
                    self.observer.progress(Step::Unwrapping, progress.done as u64, total)
                }
                _ => self.observer.progress(Step::Packing, progress.done as u64, None),
            }
        };
        let triangles: usize = self.inputs.iter().map(|input| input.triangles.len()).sum();
        let packing = if triangles > 10 * MANY_CHARTS as usize { Packing::Fast } else { Packing::Shape };
        let generate = || uvunwrap::generate_with_progress(&meshes, &options(packing), report);
        // Without a pool, all processors would work.
        match rayon::ThreadPoolBuilder::new().num_threads(self.options.threads.max(1)).build() {
            Ok(pool) => pool.install(generate),
            Err(_) => generate(),
        }
    }

    /// Returns the layout of an atlas.
    fn layout(&self, atlas: &Atlas) -> Layout {
        let Objects { meshes, instances, .. } = self.objects;
        let mut layout = Layout {
            width: atlas.width,
            height: atlas.height,
            pages: atlas.page_count.max(1),
            texels_per_meter: f64::from(atlas.texels_per_unit),
            charts: atlas.chart_count,
            sheets: Vec::with_capacity(self.inputs.len()),
            of_mesh: vec![[None; 2]; meshes.len()],
            rectangles: vec![[None; 2]; instances.len()],
        };
        for (input, output) in self.inputs.iter().zip(&atlas.meshes) {
            let mesh = &meshes[input.mesh];
            let primitives = match &input.existing {
                Some(existing) => existing.unfolded(output, &mut layout.charts),
                None => input.unfolded(mesh, output),
            };
            let back = usize::from(input.side == Side::Back);
            if let Some(sheet) = layout.of_mesh[input.mesh][back] {
                // The part without light joins the other one.
                let sheet: &mut Sheet = &mut layout.sheets[sheet];
                sheet.primitives.iter_mut().zip(primitives).for_each(|(of, dark)| of.join(dark));
                continue;
            }
            let rectangles = output.instances.iter().map(|place| {
                let [min, max] = [place.min, place.max].map(|p| DVec2::from_array(p.map(f64::from)));
                Rectangle { page: place.page, min, max }
            });
            let rectangles =
                if output.instances.is_empty() { vec![Rectangle::whole(0)] } else { rectangles.collect() };
            for (&instance, rectangle) in input.instances.iter().zip(rectangles) {
                layout.rectangles[instance][back] = Some(rectangle);
            }
            layout.of_mesh[input.mesh][back] = Some(layout.sheets.len());
            layout.sheets.push(Sheet {
                mesh: input.mesh,
                side: input.side,
                primitives,
                instances: input.instances.clone(),
                existing: input.existing.as_ref().map(|existing| existing.set),
            });
        }
        layout
    }

    fn too_small(&self, atlas: &Atlas, pages: Option<u32>) -> LightmapError {
        let margin = 2.0 * f64::from(self.options.padding) + 1.0;
        // Every chart needs a texel and its padding.
        let texels = f64::from(atlas.chart_count) * margin * margin / FILLED;
        let per_page = texels / f64::from(self.options.pages);
        let why = match pages {
            Some(pages) => format!("they need {pages}"),
            None => format!("each needs {margin} × {margin} with its padding"),
        };
        self.refusal(crate::text::grouped(u64::from(atlas.chart_count)), per_page.sqrt(), why)
    }

    fn refusal(&self, charts: String, size: f64, why: String) -> LightmapError {
        let pages = match self.options.pages {
            1 => "a page".to_owned(),
            pages => format!("{pages} pages"),
        };
        let needed = (size.max(1.2 * f64::from(self.options.size)) as u32).next_multiple_of(64);
        let or = if self.options.texels_per_meter.is_some() {
            ", or a smaller `texels_per_meter`"
        } else {
            ", or a smaller `padding`"
        };
        LightmapError::TooSmall { charts, pages, size: self.options.size, why, needed, or }
    }

    fn error(&self, error: Error) -> LightmapError {
        match error {
            Error::Cancelled => LightmapError::Stopped,
            Error::ChartTooLarge { width, height, .. } => {
                let why = format!("one mesh needs {width} × {height} texels, and a mesh stays on one page");
                self.refusal("placed".to_owned(), f64::from(width.max(height)), why)
            }
            Error::AtlasTooLarge { texels } => {
                let why = format!("they need {} texels", crate::text::grouped(texels));
                self.refusal("placed".to_owned(), (texels as f64).sqrt(), why)
            }
            other => LightmapError::Unwrap(other),
        }
    }
}

impl Input {
    /// Collects one side of those triangles of a mesh for which `has` is true, by primitive and number. Positions are those
    /// of the first instance in the scene, relative to their middle.
    fn new(
        objects: &Objects,
        mesh: usize,
        side: Side,
        instances: Vec<usize>,
        has: &dyn Fn(usize, usize) -> bool,
    ) -> Self {
        let first = &objects.instances[instances[0]];
        let relative = |&i: &usize| (objects.instances[i].area / first.area).sqrt() as f32;
        let usable = |scale: f32| if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        let mut input = Self {
            mesh,
            side,
            positions: Vec::new(),
            indices: Vec::new(),
            triangles: Vec::new(),
            primitives: Vec::new(),
            creases: Vec::new(),
            first_vertices: Vec::new(),
            scales: instances.iter().map(|i| usable(relative(i))).collect(),
            instances,
            scale: 1.0,
            existing: None,
        };
        let of: &Mesh = &objects.meshes[mesh];
        let middle = middle(of);
        for (number, primitive) in (0u32..).zip(&of.primitives) {
            let start = input.positions.len() as u32;
            input.first_vertices.push(start);
            let own = (0u32..).zip(&primitive.triangles).filter(|(i, _)| has(number as usize, *i as usize));
            let own: Vec<(u32, &[u32; 3])> = own.collect();
            if own.is_empty() {
                continue;
            }
            input.positions.extend(primitive.positions.iter().map(|p| {
                let p = first.to_world.transform_vector3(DVec3::from_array(*p) - middle).as_vec3();
                if p.is_finite() { p.to_array() } else { [0.0; 3] }
            }));
            for (i, &[a, b, c]) in own {
                // Seen from the back, the corners run the other way.
                let corners = if side == Side::Front { [a, b, c] } else { [a, c, b] };
                input.indices.extend(corners.map(|v| v + start));
                input.triangles.push((number, i));
                input.primitives.push(number);
            }
        }
        input.creases = creases(&input.positions, &input.indices);
        input
    }

    /// Returns the area of all instances \[m²\].
    fn area(&self) -> f64 {
        let place = |i: u32| DVec3::from_array(self.positions[i as usize].map(f64::from));
        let areas = self.indices.chunks_exact(3).map(|t| {
            let [a, b, c] = [t[0], t[1], t[2]].map(place);
            0.5 * (b - a).cross(c - a).length()
        });
        let squares: f64 = self.scales.iter().map(|&scale| f64::from(scale).powi(2)).sum();
        areas.sum::<f64>() * squares
    }

    /// Returns the primitives of the sheet from the output of the unwrapper.
    fn unfolded(&self, mesh: &Mesh, output: &OutputMesh) -> Vec<Unfolded> {
        let mut all: Vec<Unfolded> = mesh.primitives.iter().map(|_| Unfolded::default()).collect();
        let mut known: Vec<HashMap<u32, u32>> = vec![HashMap::new(); all.len()];
        for (&(primitive, number), corners) in self.triangles.iter().zip(output.indices.chunks_exact(3)) {
            let primitive = primitive as usize;
            let (of, known) = (&mut all[primitive], &mut known[primitive]);
            if of.triangles.is_empty() {
                let count = mesh.primitives[primitive].triangles.len();
                (of.triangles, of.charts) = (vec![[0; 3]; count], vec![NO_CHART; count]);
            }
            let [a, b, c] = [corners[0], corners[1], corners[2]].map(|v| {
                *known.entry(v).or_insert_with(|| {
                    let vertex = &output.vertices[v as usize];
                    of.origin.push(vertex.xref - self.first_vertices[primitive]);
                    of.coordinates.push(vertex.uv);
                    of.origin.len() as u32 - 1
                })
            });
            let number = number as usize;
            of.triangles[number] = if self.side == Side::Front { [a, b, c] } else { [a, c, b] };
            let chart = output.vertices[corners[0] as usize].chart.unwrap_or(NO_CHART);
            let [a, b, c] = [a, b, c].map(|v| of.coordinates[v as usize]);
            let is_collapsed = a == b || b == c || c == a;
            of.charts[number] = if is_collapsed { NO_CHART } else { chart };
        }
        all
    }
}

/// Returns true for each edge of each triangle at which two triangles meet at an angle. Charts end there: light differs on
/// both sides, and a texel must not mix it.
fn creases(positions: &[[f32; 3]], indices: &[u32]) -> Vec<[bool; 3]> {
    // Vertices at equal positions are one, as for the unwrapper.
    let mut known: HashMap<[u32; 3], u32> = HashMap::new();
    let bits = |p: &[f32; 3]| p.map(|x| (x + 0.0).to_bits());
    let numbers: Vec<u32> = positions
        .iter()
        .map(|p| {
            let next = known.len() as u32;
            *known.entry(bits(p)).or_insert(next)
        })
        .collect();
    let normals: Vec<DVec3> = indices
        .chunks_exact(3)
        .map(|t| {
            let [a, b, c] =
                [t[0], t[1], t[2]].map(|i| DVec3::from_array(positions[i as usize].map(f64::from)));
            (b - a).cross(c - a).normalize_or_zero()
        })
        .collect();
    let ends = |t: &[u32], k: usize| {
        let [a, b] = [t[k], t[(k + 1) % 3]].map(|i| numbers[i as usize]);
        (a.min(b), a.max(b))
    };
    let mut first: HashMap<(u32, u32), u32> = HashMap::new();
    let mut flags = vec![[false; 3]; normals.len()];
    for (i, t) in indices.chunks_exact(3).enumerate() {
        for k in 0..3 {
            let other = *first.entry(ends(t, k)).or_insert(i as u32) as usize;
            // Triangles without an area have no normal, and no crease.
            let (a, b) = (normals[i], normals[other]);
            flags[i][k] = a != DVec3::ZERO && b != DVec3::ZERO && a.dot(b) < SMOOTH;
        }
    }
    flags
}

/// Returns the middle of the bounding box of a mesh.
fn middle(mesh: &Mesh) -> DVec3 {
    let all = || mesh.primitives.iter().flat_map(|p| &p.positions).map(|p| DVec3::from_array(*p));
    let finite = || all().filter(|p| p.is_finite());
    let (low, high) =
        (finite().fold(DVec3::INFINITY, DVec3::min), finite().fold(DVec3::NEG_INFINITY, DVec3::max));
    let middle = 0.5 * (low + high);
    if middle.is_finite() { middle } else { DVec3::ZERO }
}
