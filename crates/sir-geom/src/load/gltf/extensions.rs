//! Extensions of glTF: what a scene lacks without them.
//!
//! The table covers the registry of Khronos, its drafts and archive, and other extensions that are common in files.
//! `docs/formats.md` has it, too; a test compares both.

use std::collections::BTreeSet;
use std::path::Path;

use crate::load::error::LoadError;
use crate::load::files;
use crate::load::gltf::document::Document;
use crate::load::notes::Notes;

/// Maximum number of unsupported extensions that an error names.
const MAX_NAMES: usize = 8;

/// Maximum length of the name of an extension in a message \[characters\].
const MAX_NAME_LENGTH: usize = 60;

/// Effect of an extension on the scene that is computed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Effect {
    /// It is read.
    Read,
    /// It changes neither surfaces nor light.
    None,
    /// It offers another version of something that is read.
    Alternative,
    /// It stores data in another way. Without a plain copy, the reader reports the accessor, buffer or texture.
    Encoding,
    /// It changes the directions of reflected light only.
    Gloss,
    /// It lets light through surfaces.
    Transmission,
    /// It changes the color of surfaces.
    Color,
    /// It adds, removes, moves or changes surfaces.
    Geometry,
    /// It adds or changes light sources.
    Light,
    /// It is not in the table.
    Unknown,
}

impl Effect {
    fn of(name: &str) -> Self {
        let row = EXTENSIONS.iter().find(|(_, names)| names.contains(&name));
        row.map_or(Self::Unknown, |&(effect, _)| effect)
    }

    /// Returns the warning about an extension that is not read, a phrase that follows a number; `None` if nothing is
    /// missing, or the reader finds out what is.
    fn warning(self) -> Option<&'static str> {
        Some(match self {
            Self::Read | Self::None | Self::Encoding => return None,
            Self::Alternative => {
                "glTF extensions offer alternatives, which were ignored: the defaults of the file are used"
            }
            Self::Gloss => {
                "glTF extensions describe gloss, which diffuse surfaces do not have, and were ignored"
            }
            Self::Transmission => {
                "glTF extensions describe transmission and were ignored: light passes only where alpha lets it"
            }
            Self::Color => {
                "glTF extensions change colors of surfaces and are not supported: reflectances may be wrong"
            }
            Self::Geometry => {
                "glTF extensions change geometry and are not supported: surfaces may be missing, superfluous or in a \
                 wrong place"
            }
            Self::Light => {
                "glTF extensions describe light sources and are not supported: their light is missing; add it with \
                 `Light`"
            }
            Self::Unknown => {
                "glTF extensions are unknown and were ignored: if they add or remove surfaces or light, the scene is \
                 wrong"
            }
        })
    }

    /// Returns true if a file that requires the extension can be read all the same.
    fn is_dispensable(self) -> bool {
        matches!(self, Self::Read | Self::None | Self::Alternative | Self::Gloss)
    }
}

/// Refuses a document that requires an extension without which its scene would be wrong, and warns of all others that
/// leave something out.
pub(super) fn check(path: &Path, document: &Document, notes: &mut Notes) -> Result<(), LoadError> {
    let mut refused = BTreeSet::new();
    for name in document.root.extensions_required.iter().filter(|name| !Effect::of(name).is_dispensable()) {
        refused.insert(files::shortened(name, MAX_NAME_LENGTH));
    }
    if !refused.is_empty() {
        let names = refused.into_iter().take(MAX_NAMES).collect();
        return Err(LoadError::RequiredExtensions { path: path.to_owned(), names });
    }
    // Some files do not list all extensions that they use.
    for name in document.root.extensions_used.iter().chain(&document.extensions) {
        if let Some(what) = Effect::of(name).warning() {
            notes.name(what, files::shortened(name, MAX_NAME_LENGTH));
        }
    }
    Ok(())
}

/// Names of extensions by their effect.
const EXTENSIONS: [(Effect, &[&str]); 9] = [
    (
        Effect::Read,
        &[
            "EXT_lights_ies",
            "EXT_mesh_gpu_instancing",
            "KHR_lights_punctual",
            "KHR_materials_emissive_strength",
            "KHR_materials_pbrSpecularGlossiness",
            "KHR_materials_unlit",
            "KHR_mesh_quantization",
            "KHR_node_visibility",
            "KHR_texture_transform",
        ],
    ),
    (
        Effect::None,
        &[
            "ADOBE_render_order",
            "AGI_articulations",
            "AGI_stk_metadata",
            "BENTLEY_materials_planar_fill",
            "BENTLEY_materials_point_style",
            "CESIUM_primitive_outline",
            "CESIUM_tile_edges",
            "CVTOOLS_unity_metadata",
            "EXT_camera_physical",
            "EXT_feature_metadata",
            "EXT_instance_features",
            "EXT_mesh_features",
            "EXT_mesh_manifold",
            "EXT_mesh_primitive_edge_visibility",
            "EXT_property_animation",
            "EXT_structural_metadata",
            "FB_geometry_metadata",
            "FB_ngon_encoding",
            "GODOT_single_root",
            "GRIFFEL_bim_data",
            "KHR_animation_pointer",
            "KHR_audio",
            "KHR_audio_emitter",
            "KHR_audio_environment",
            "KHR_audio_graph",
            "KHR_collision_shapes",
            "KHR_implicit_shapes",
            "KHR_interactivity",
            "KHR_node_hoverability",
            "KHR_node_selectability",
            "KHR_physics_rigid_bodies",
            "KHR_xmp",
            "KHR_xmp_json_ld",
            "MPEG_animation_timing",
            "MPEG_audio_spatial",
            "MPEG_haptic",
            "MPEG_media",
            "MPEG_viewport_recommended",
            "MSFT_audio_emitter",
            "OMI_audio_emitter",
            "OMI_collider",
            "OMI_link",
            "OMI_physics_body",
            "OMI_physics_joint",
            "OMI_physics_shape",
            "OMI_seat",
            "OMI_spawn_point",
            "VRM",
            "VRMC_node_constraint",
            "VRMC_springBone",
            "VRMC_vrm",
            // Lightmaps have light that is computed here.
            "FB_materials_lightmap",
            "MOZ_lightmap",
        ],
    ),
    (
        Effect::Alternative,
        &[
            "FB_asset_variants",
            "FB_material_variants",
            "KHR_materials_variants",
            "MAXAR_mesh_variants",
            "MOZ_alt_materials",
            "MSFT_lod",
        ],
    ),
    (
        Effect::Encoding,
        &[
            "EXT_image_webp",
            "EXT_meshopt_compression",
            "EXT_texture_astc",
            "EXT_texture_avif",
            "EXT_texture_qoi",
            "EXT_texture_svg",
            "EXT_texture_webp",
            "GOOGLE_texture_basis",
            "KHR_accessor_float16",
            "KHR_accessor_float64",
            "KHR_draco_mesh_compression",
            "KHR_image_ktx2",
            "KHR_meshopt_compression",
            "KHR_texture_basisu",
            "MESHOPT_compression",
            "MOZ_texture_rgbe",
            "MSFT_texture_dds",
        ],
    ),
    (
        Effect::Gloss,
        &[
            "ADOBE_materials_clearcoat_specular",
            "ADOBE_materials_clearcoat_tint",
            "EXT_materials_anisotropy_openpbr",
            "EXT_materials_bump",
            "EXT_materials_clearcoat_color",
            "EXT_materials_clearcoat_darkening",
            "EXT_materials_diffuse_roughness",
            "EXT_materials_specular_edge_color",
            "EXT_materials_specular_openpbr",
            "KHR_materials_anisotropy",
            "KHR_materials_clearcoat",
            "KHR_materials_coat",
            "KHR_materials_diffuse_roughness",
            "KHR_materials_dispersion",
            "KHR_materials_fuzz",
            "KHR_materials_ior",
            "KHR_materials_iridescence",
            "KHR_materials_sheen",
            "KHR_materials_specular",
            "MSFT_packing_normalRoughnessMetallic",
            "MSFT_packing_occlusionRoughnessMetallic",
        ],
    ),
    (
        Effect::Transmission,
        &[
            "ADOBE_materials_thin_transparency",
            "EXT_blend",
            "KHR_blend",
            "KHR_materials_diffuse_transmission",
            "KHR_materials_sss",
            "KHR_materials_subsurface",
            "KHR_materials_transmission",
            "KHR_materials_volume",
            "KHR_materials_volume_scatter",
        ],
    ),
    (
        Effect::Color,
        &[
            "EXT_texture_procedurals_mx_1_39",
            "FB_materials_modmap",
            "KHR_materials_common",
            "KHR_techniques_webgl",
            "KHR_texture_procedurals",
            "KHR_texture_video",
            "MPEG_texture_video",
            "NV_materials_mdl",
            "VRMC_materials_mtoon",
        ],
    ),
    (
        Effect::Geometry,
        &[
            "BENTLEY_primitive_restart",
            "CESIUM_RTC",
            "CESIUM_z_up",
            "EXT_implicit_cylinder_region",
            "EXT_implicit_ellipsoid_region",
            "EXT_mesh_lod",
            "EXT_mesh_opacity_micromap",
            "EXT_mesh_polygon",
            "EXT_mesh_primitive_restart",
            "EXT_node_lod",
            "EXT_primitive_voxels",
            "FRAUNHOFER_external_model",
            "KHR_billboard",
            "KHR_gaussian_splatting",
            "KHR_instancing",
            "KHR_mesh_instancing",
            "KHR_mesh_primitive_restart",
            "KITTYCAD_boundary_representation",
            "MANYFOLD_mesh_progressive",
            "MPEG_accessor_timed",
            "MPEG_buffer_circular",
            "MPEG_mesh_linking",
            "MPEG_scene_dynamic",
            "MSFT_minecraftMesh",
            "WEB3D_quantized_attributes",
        ],
    ),
    (
        Effect::Light,
        &[
            "EXT_lights_area",
            "EXT_lights_environment",
            "EXT_lights_image_based",
            "INTEL_lights_sunsky",
            "KHR_environment_map",
            "KHR_lights",
            "KHR_lights_area",
            "KHR_lights_common",
            "KHR_lights_dome",
            "KHR_lights_environment",
            "KHR_lights_ies",
            "KHR_lights_image_based",
            "KHR_lights_photometric",
            "KHR_lights_rect_area",
            "MOZ_hubs_components",
            "MPEG_lights_texture_based",
            "OMI_environment_sky",
            "VRMC_materials_hdr_emissiveMultiplier",
        ],
    ),
];
