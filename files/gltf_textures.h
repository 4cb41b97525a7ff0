/// gltf_textures.h: textures of occlusion in a glTF's materials. Internal to the glTF writer.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <span>

namespace surfelao {

/// A primitive that looks its occlusion up in a texture.
struct Occluded {
    nlohmann::json* primitive;
    std::size_t set;  ///< n of TEXCOORD_n
};

/// Adds a texture with this image and sampler, named as ours (gltf_added.h), and returns its index.
[[nodiscard]] std::size_t add_occlusion_texture(nlohmann::json& document, nlohmann::json image,
                                                nlohmann::json sampler);

/// Makes the texture the occlusionTexture of the primitives' materials. A material that something
/// else uses too, or that has another occlusionTexture, stays as it is: the primitives get a copy,
/// which says in the extras of its occlusionTexture whose it is, so that gltf_old_results.h finds
/// the way back. Primitives without a material get a plain one. Their materials must be objects, or
/// none. Returns how many materials had another occlusionTexture.
[[nodiscard]] std::size_t show_occlusion_texture(nlohmann::json& document, std::size_t texture,
                                                 std::span<const Occluded> primitives);

/// Gives the primitives a copy of this material (null: a plain one) that names the textures of a
/// blended map in its extras: {"surfelao": {"blended": [...], "original": material}}.
void set_blended_material(nlohmann::json& document, const nlohmann::json& material,
                          nlohmann::json blended, std::span<nlohmann::json* const> primitives);

/// Gives them all one material: white and no metal.
void set_plain_material(nlohmann::json& document, std::span<nlohmann::json* const> primitives);

}  // namespace surfelao
