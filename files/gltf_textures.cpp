#include "files/gltf_textures.h"

#include "files/gltf_added.h"
#include "files/gltf_json.h"
#include "files/maker_mark.h"

#include <map>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

using nlohmann::json;

/// Adds up how often each material is used by anything in the meshes.
void count_uses(const json& value, std::map<std::size_t, std::size_t>& uses_of)
{
    for (const auto& [key, inner] : value.items()) {
        if (key == "material" && inner.is_number_unsigned())
            ++uses_of[inner.get<std::size_t>()];
        else if (inner.is_structured())
            count_uses(inner, uses_of);
    }
}

/// As specified for primitives without a material, but no metal.
json plain_material()
{
    return {{"name", kAddedMaterial}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}};
}

std::size_t append(json& document, const char* list, json value)
{
    json& entries = document[list];
    if (!entries.is_array())
        entries = json::array();
    entries.push_back(std::move(value));
    return entries.size() - 1;
}

}  // namespace

std::size_t add_occlusion_texture(json& document, json image, json sampler)
{
    image["name"] = sampler["name"] = kAddedPicture;
    const std::size_t source = append(document, "images", std::move(image));
    const std::size_t filter = append(document, "samplers", std::move(sampler));
    return append(document, "textures",
                  {{"source", source}, {"sampler", filter}, {"name", kAddedPicture}});
}

std::size_t show_occlusion_texture(json& document, std::size_t texture,
                                   std::span<const Occluded> primitives)
{
    std::map<std::size_t, std::size_t> uses_of;
    count_uses(document["meshes"], uses_of);
    std::map<std::pair<json, std::size_t>, std::vector<json*>> primitives_of;
    for (const Occluded& occluded : primitives)
        primitives_of[{member(*occluded.primitive, "material"), occluded.set}].push_back(
            occluded.primitive);
    std::size_t replaced = 0;
    for (const auto& [material_and_set, of_material] : primitives_of) {
        const auto& [material, set] = material_and_set;
        json info = {{"index", texture}, {"texCoord", set}};
        const bool is_bare = material.is_null();
        json copy = is_bare ? plain_material() : entry(document, "materials", material);
        const bool has_other = copy.contains("occlusionTexture");
        replaced += has_other ? 1 : 0;
        if (!is_bare && !has_other && uses_of[material.get<std::size_t>()] == of_material.size()) {
            document["materials"][material.get<std::size_t>()]["occlusionTexture"] = info;
            continue;
        }
        if (!is_bare)
            info["extras"] = {{kMarkKey, material}};
        copy["occlusionTexture"] = info;
        const std::size_t added = append(document, "materials", copy);
        for (json* const primitive : of_material)
            (*primitive)["material"] = added;
    }
    return replaced;
}

void set_blended_material(json& document, const json& material, json blended,
                          std::span<json* const> primitives)
{
    json copy = material.is_null() ? plain_material() : entry(document, "materials", material);
    if (!member(copy, "extras").is_object())
        copy["extras"] = json::object();
    copy["extras"][kMarkKey] = {{"blended", std::move(blended)}};
    if (!material.is_null())
        copy["extras"][kMarkKey]["original"] = material;
    const std::size_t added = append(document, "materials", std::move(copy));
    for (json* const primitive : primitives)
        (*primitive)["material"] = added;
}

void set_plain_material(json& document, std::span<json* const> primitives)
{
    const std::size_t plain = append(document, "materials", plain_material());
    for (json* const primitive : primitives)
        (*primitive)["material"] = plain;
}

}  // namespace surfelao
