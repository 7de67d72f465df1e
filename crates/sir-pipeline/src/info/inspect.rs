//! Inspection of a scene file.

use std::mem::discriminant;
use std::path::Path;

use glam::DVec3;
use sir_geom::{LoadOptions, Scene, Sides, Warning};
use sir_mesh::{PatchMesh, Subdivision};
use sir_radiosity::{ModelError, Source, build_accel, sources};

use crate::error::Error;
use crate::fingerprint::PROGRAM;
use crate::info::advice;
use crate::info::choices::Choices;
use crate::info::facts::{Group, Info, Lights, MaterialInfo, Textures};
use crate::info::lines;
use crate::info::shape;
use crate::info::shape::sums;
use crate::info::survey::Survey;
use crate::prepare::sources::kinds;
use crate::prepare::up::Up;

/// Version of the JSON layout.
const VERSION: u32 = 1;

/// Reads a scene file and returns its contents, with notes and suggested settings.
///
/// # Errors
///
/// If the file cannot be read; see [`sir_geom::load`].
pub fn inspect(path: &Path) -> Result<Info, Error> {
    inspect_for(path, &path.display().to_string())
        .map(|(info, choices)| Info { settings: choices.special(), ..info })
}

/// Reads a scene file, like [`inspect`]. Returns its contents without settings, and the choices for a pipeline that finds
/// the file at `path_in_pipeline`.
pub(crate) fn inspect_for(path: &Path, path_in_pipeline: &str) -> Result<(Info, Choices), Error> {
    let built = sir_geom::load(path, &LoadOptions::default())?;
    let scene = &built.scene;
    let mesh = PatchMesh::new(scene, Subdivision::PerTriangle).map_err(ModelError::from)?;
    let accel = build_accel(scene).map_err(ModelError::from)?;
    let sources = sources(scene, &mesh);
    let dropped = built.warnings.iter().map(|warning| match warning {
        Warning::DroppedTriangles { count } => *count,
        _ => 0,
    });
    let Up { direction: up, why: up_from, doubt } = Up::of(path, scene, None);
    let lines = lines::affordable(scene, &accel);
    let survey = Survey::new(scene, &accel, &sources, up, lines);
    let extent = survey.extent;
    let area = scene.total_area();
    let largest = scene.triangle_ids().map(|id| scene.area(id)).fold(0.0, f64::max);
    let mut info = Info {
        version: VERSION,
        program: PROGRAM,
        scene: path.display().to_string(),
        warnings: built.warnings.iter().map(ToString::to_string).collect(),
        triangles: scene.triangles().len(),
        dropped_triangles: dropped.sum(),
        vertices: scene.vertices().len(),
        // The triangles of a polygon are consecutive.
        polygons: scene.triangles().chunk_by(|a, b| a.face == b.face).count(),
        textures: Textures {
            images: scene.textures().len(),
            texels: scene.textures().iter().map(|texture| texture.texels().len()).sum(),
            triangles: scene.triangle_ids().filter(|&id| scene.is_varied(id)).count(),
        },
        area,
        largest_triangle: largest / area,
        extent,
        distance_from_origin: extent.center().length(),
        up: up.into(),
        up_from,
        doubt_of_up: doubt,
        materials: materials(scene),
        groups: groups(scene),
        sources: by_kind(&sources),
        cameras: scene.cameras().iter().map(|camera| camera.name.clone()).collect(),
        twins: shape::twins(scene),
        dominant: survey.dominant.clone(),
        lines: lines::trace(scene, &accel, &sources, lines),
        findings: Vec::new(),
        settings: Vec::new(),
    };
    info.findings = advice::findings(&info, &survey);
    info.findings.extend(info.doubt_of_up.clone());
    let choices = Choices::new(&info, &survey, path_in_pipeline);
    Ok((info, choices))
}

fn materials(scene: &Scene) -> Vec<MaterialInfo> {
    let counts = sums(scene, |t| t.material.index(), |_| 1);
    let areas = sums(scene, |t| t.material.index(), |id| scene.area(id));
    let mut materials: Vec<MaterialInfo> = std::iter::zip(counts, areas)
        .zip(scene.materials())
        .filter(|((triangles, _), _)| *triangles > 0)
        .map(|((triangles, area), material)| {
            let two_sided = material.sides == Sides::Both;
            let emitting_sides = if two_sided && material.back_emits { 2.0 } else { 1.0 };
            MaterialInfo {
                name: material.name.clone(),
                triangles,
                area,
                reflectance: material.reflectance.into(),
                exitance: material.exitance.into(),
                power: (material.exitance * area * emitting_sides).into(),
                two_sided,
            }
        })
        .collect();
    materials.sort_by(|a, b| b.area.total_cmp(&a.area));
    materials
}

fn groups(scene: &Scene) -> Vec<Group> {
    let counts = sums(scene, |t| t.group.index(), |_| 1);
    let areas = sums(scene, |t| t.group.index(), |id| scene.area(id));
    std::iter::zip(counts, areas)
        .zip(scene.groups())
        .filter(|((triangles, _), name)| *triangles > 0 && !name.is_empty())
        .map(|((triangles, area), name)| Group { name: name.clone(), triangles, area })
        .collect()
}

fn by_kind(sources: &[Source]) -> Vec<Lights> {
    let mut of_kinds: Vec<Vec<Source>> = Vec::new();
    for source in sources {
        let is_alike = |of_kind: &Vec<Source>| {
            of_kind.first().is_some_and(|first| discriminant(&first.emitter) == discriminant(&source.emitter))
        };
        match of_kinds.iter_mut().find(|of_kind| is_alike(of_kind)) {
            Some(of_kind) => of_kind.push(source.clone()),
            None => of_kinds.push(vec![source.clone()]),
        }
    }
    let lights = of_kinds.iter().map(|of_kind| {
        let power: DVec3 = of_kind.iter().map(|source| source.power).sum();
        Lights { what: kinds(of_kind), power: power.into() }
    });
    lights.collect()
}
