#include "files/gltf_looks.h"

#include "files/gltf_json.h"
#include "surfels/srgb.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace surfelao {
namespace {

using nlohmann::json;

constexpr int kLinear = 9729;
constexpr int kClampToEdge = 33071;

/// A PNG of 256 x 4 texels of grey, 0 to 255 from left to right in each row. Four rows, because
/// programs that compress textures do it in blocks of 4 x 4.
constexpr unsigned char kGradient[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x04, 0x08, 0x00, 0x00, 0x00, 0x00, 0x44, 0xff, 0xbe,
    0x18, 0x00, 0x00, 0x00, 0x17, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x64, 0x60, 0x1c, 0xd9,
    0x80, 0x89, 0x61, 0x84, 0x83, 0xd1, 0x00, 0x18, 0xe9, 0x01, 0x00, 0x00, 0x93, 0xbe, 0x01, 0x07,
    0xde, 0x33, 0x72, 0x17, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
constexpr float kGradientWidth = 256.0f;

/// Where a filter between texels, with centres at (i + .5) / width, gives exactly the visibility.
float gradient_coordinate(float visibility)
{
    return (visibility * (kGradientWidth - 1.0f) + 0.5f) / kGradientWidth;
}

/// Whether a texture stands anywhere in the material that a colour would tint, or that shows
/// occlusion already.
bool is_textured(const json& material)
{
    constexpr std::string_view kKeys[] = {"baseColorTexture", "diffuseTexture", "emissiveTexture",
                                          "occlusionTexture"};
    for (const auto& [key, value] : material.items()) {
        if (std::ranges::find(kKeys, key) != std::end(kKeys) ||
            (value.is_structured() && is_textured(value)))
            return true;
    }
    return false;
}

}  // namespace

GltfLooks::GltfLooks(json& document, const GltfAsset& asset, const WriteOptions& options,
                     AddedData& added)
    : document_(document), asset_(asset), options_(options), added_(added)
{
}

void GltfLooks::add(std::span<json* const> primitives, std::span<const Occlusion> values)
{
    std::map<std::optional<std::size_t>, std::size_t> colors;  // by those they are made from
    std::optional<std::size_t> coordinates;
    for (json* const primitive : primitives) {
        json& attributes = (*primitive)["attributes"];
        std::optional<std::size_t> own;
        if (attributes.contains("COLOR_0"))
            own = attributes["COLOR_0"].get<std::size_t>();
        const VertexColors what = decide(*primitive, own);
        if (what != VertexColors::keep) {
            const auto [made, is_new] = colors.try_emplace(own, 0);
            if (is_new)
                made->second = add_colors(what, own, values);
            if (own)
                attributes["_OWN_COLOR"] = *own;
            attributes["COLOR_0"] = made->second;
            if (!primitive->contains("material"))
                bare_.push_back(primitive);
            continue;
        }
        const json& index = member(*primitive, "material");
        const json& material = entry(document_, "materials", index);
        if (options_.colors == VertexColors::keep || (!index.is_null() && !material.is_object()))
            continue;
        if (material.contains("occlusionTexture")) {
            ++kept_textures_;
            continue;
        }
        if (!coordinates) {
            std::vector<float> at;
            for (const Occlusion& value : values)
                at.insert(at.end(), {gradient_coordinate(1.0f - value.occlusion), 0.5f});
            coordinates = added_.add_floats(2, at, kAddedCoordinates);
        }
        const std::size_t set = free_set(attributes);
        attributes["TEXCOORD_" + std::to_string(set)] = *coordinates;
        textured_.push_back({primitive, set});
    }
}

VertexColors GltfLooks::decide(const json& primitive, std::optional<std::size_t> own)
{
    if (options_.colors != VertexColors::automatic)
        return options_.colors;
    const bool has_colors = own && !is_white(*own);
    kept_colors_ += has_colors ? 1 : 0;
    const json& material = entry(document_, "materials", member(primitive, "material"));
    return has_colors || is_textured(material) ? VertexColors::keep : VertexColors::grey;
}

bool GltfLooks::is_white(std::size_t accessor)
{
    const auto [known, is_new] = white_.try_emplace(accessor, false);
    if (is_new) {
        try {
            known->second = std::ranges::all_of(
                read_colors(asset_.colors.at(accessor)),
                [](const glm::dvec4& color) { return glm::dvec3(color) == glm::dvec3(1.0); });
        } catch (const AccessorError&) {  // whatever stands there: it is not white
        }
    }
    return known->second;
}

std::size_t GltfLooks::add_colors(VertexColors what, std::optional<std::size_t> own,
                                  std::span<const Occlusion> values)
{
    std::vector<glm::dvec4> own_colors(values.size(), glm::dvec4(1.0));
    if (own) {
        try {
            own_colors = read_colors(asset_.colors.at(*own));
        } catch (const AccessorError& error) {
            if (what == VertexColors::shaded)
                fail_gltf(asset_.path, "COLOR_0 accessor " + std::to_string(*own) + ":",
                          error.what());
        }
    }
    std::vector<float> numbers;
    numbers.reserve(4 * values.size());
    for (std::size_t v = 0; v < values.size(); ++v) {
        const glm::vec3 color = color_of(what, values[v], glm::vec3(own_colors[v]));
        for (int k = 0; k < 3; ++k)
            numbers.push_back(options_.encoding == Encoding::srgb ? srgb_encode(color[k])
                                                                  : color[k]);
        numbers.push_back(static_cast<float>(own_colors[v].a));
    }
    return added_.add_floats(4, numbers, kAddedColors);
}

void GltfLooks::finish()
{
    if (!textured_.empty()) {
        const std::string_view png(reinterpret_cast<const char*>(kGradient), sizeof kGradient);
        const std::size_t texture = add_occlusion_texture(
            document_, {{"bufferView", added_.add_bytes(png)}, {"mimeType", "image/png"}},
            {{"magFilter", kLinear},
             {"minFilter", kLinear},
             {"wrapS", kClampToEdge},
             {"wrapT", kClampToEdge}});
        static_cast<void>(show_occlusion_texture(document_, texture, textured_));
    }
    if (!bare_.empty())
        set_plain_material(document_, bare_);
}

std::vector<std::string> GltfLooks::notes() const
{
    if (textured_.empty() && kept_textures_ == 0)
        return {};
    const auto counted_as = [](std::size_t count, const char* one, const char* many) {
        return std::to_string(count) + (count == 1 ? one : many);
    };
    std::string note = "primitives with looks of their own: ";
    if (!textured_.empty())
        note +=
            counted_as(textured_.size(), " gets an occlusionTexture", " get an occlusionTexture");
    if (!textured_.empty() && kept_textures_ > 0)
        note += ", ";
    if (kept_textures_ > 0)
        note += counted_as(kept_textures_, " keeps the occlusionTexture it has",
                           " keep the occlusionTexture they have");
    if (kept_colors_ > 0)
        note +=
            counted_as(kept_colors_, " of them keeps its colours", " of them keep their colours")
                .insert(0, "; ");
    return {note + " (--colors grey or shaded shows the visibility as colours)"};
}

}  // namespace surfelao
