#include "files/gltf_extensions.h"

#include "files/gltf_asset.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace surfelao {
namespace {

using nlohmann::json;

/// For is_listed(). From the Khronos registry and from
/// the lists of vendors (Cesium, VRM, OMI, Microsoft, Babylon, Hubs).
constexpr std::string_view kHarmlessExtensions[] = {
    // read here
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "EXT_mesh_gpu_instancing",
    // materials, textures, lights
    "KHR_materials_",
    "EXT_materials_",
    "ADOBE_materials_",
    "BENTLEY_materials_",
    "MOZ_HUBS_texture_basis",
    "MSFT_packing_",
    "MSFT_texture_",
    "NV_materials_",
    "KHR_techniques_webgl",
    "KHR_technique_webgl",
    "KHR_texture_",
    "EXT_texture_",
    "MPEG_texture_video",
    "MOZ_lightmap",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_environment_map",
    "MAXAR_temporal_light_traits",
    "MAXAR_image_ortho",
    // other poses, behaviour, sound: the default pose stands
    "KHR_animation_pointer",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "KHR_rigid_bodies",
    "KHR_collision_shapes",
    "KHR_implicit_shapes",
    "KHR_audio",
    "KHR_audio_",
    "AGI_articulations",
    "MOZ_hubs_components",
    "MPEG_animation_timing",
    "MPEG_audio_spatial",
    "MPEG_media",
    "MPEG_viewport_recommended",
    "MSFT_audio_emitter",
    "MSFT_physics_rigid_bodies",
    "MSFT_collision_primitives",
    "OMI_",
    "VRM",
    "VRMC_",
    // words about what is there
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "AGI_stk_metadata",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "EXT_feature_metadata",
    "EXT_property_animation",
    "FB_geometry_metadata",
    "GODOT_single_root",
    "GRIFFEL_bim_data",
    // the same triangles with something beside them: quads, outlines, a closed twin, coarser levels
    "FB_ngon_encoding",
    "CESIUM_primitive_outline",
    "EXT_mesh_manifold",
    "EXT_mesh_primitive_edge_visibility",
    "MSFT_lod",  // the node itself is level 0
    // moves everything alike: the centre is left out, the scene stands round its own origin
    "CESIUM_RTC",
};

}  // namespace

void check_required_extensions(const json& document, const std::filesystem::path& path)
{
    const auto required = document.find("extensionsRequired");
    if (required == document.end())
        return;
    if (!required->is_array())
        fail_gltf(path, "extensionsRequired", "is not an array");
    for (const json& entry : *required) {
        if (!entry.is_string())
            fail_gltf(path, "extensionsRequired", "holds something that is not a string");
        const auto& name = entry.get_ref<const std::string&>();
        if (!is_listed(name, kHarmlessExtensions))
            fail_gltf(path, "",
                      "requires the extension " + shortened(name) + ", which is not supported");
    }
}

}  // namespace surfelao
