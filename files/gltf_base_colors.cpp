#include "files/gltf_asset.h"
#include "files/gltf_json.h"
#include "files/gltf_uri.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace surfelao {
namespace {

using nlohmann::json;

std::size_t whole_number(const json& value, std::size_t otherwise)
{
    return value.is_number_unsigned() ? value.get<std::size_t>() : otherwise;
}

/// The bytes of a buffer view; empty where they are not there.
std::string_view bytes_of_view(const GltfAsset& asset, const json& view)
{
    const std::size_t buffer = whole_number(member(view, "buffer"), asset.buffers.size());
    if (buffer >= asset.buffers.size())
        return {};
    const std::string_view bytes = asset.buffers[buffer].bytes;
    const std::size_t offset = whole_number(member(view, "byteOffset"), 0);
    return offset < bytes.size() ? bytes.substr(offset, whole_number(member(view, "byteLength"), 0))
                                 : std::string_view();
}

double number_of(const json& value, double otherwise)
{
    return value.is_number() ? value.get<double>() : otherwise;
}

Opacity opacity_of(const json& material)
{
    const json& mode = member(material, "alphaMode");
    if (mode == "MASK")
        return Opacity::cut;
    const json& transmission = member(member(material, "extensions"), "KHR_materials_transmission");
    const bool transmits = number_of(member(transmission, "transmissionFactor"), 0.0) > 0.0;
    return mode == "BLEND" || transmits ? Opacity::clear : Opacity::solid;
}

/// KHR_texture_transform: offset + rotation * (scale * uv), the rotation counter-clockwise where v
/// runs down.
void set_transform(const json& texture, BaseColor& color)
{
    const json& transform = member(member(texture, "extensions"), "KHR_texture_transform");
    color.uv_set =
        static_cast<std::uint32_t>(whole_number(member(transform, "texCoord"), color.uv_set));
    const auto pair = [&](const char* key, double otherwise) {
        const json& list = member(transform, key);
        const bool is_pair = list.is_array() && list.size() == 2;
        return is_pair ? glm::dvec2(number_of(list[0], otherwise), number_of(list[1], otherwise))
                       : glm::dvec2(otherwise);
    };
    const double angle = number_of(member(transform, "rotation"), 0.0);
    const glm::dvec2 scale = pair("scale", 1.0);
    color.uv_matrix = glm::dmat2(scale.x * std::cos(angle), -scale.x * std::sin(angle),
                                 scale.y * std::sin(angle), scale.y * std::cos(angle));
    color.uv_offset = pair("offset", 0.0);
}

/// Each material and picture of the document once.
class Painter {
public:
    explicit Painter(const GltfAsset& asset) : asset_(asset), document_(*asset.document) {}

    /// The number of a primitive's material among the colours.
    std::uint32_t material_of(std::size_t mesh, std::size_t primitive)
    {
        const json& primitives = member(entry(document_, "meshes", mesh), "primitives");
        const json& index = member(primitives.at(primitive), "material");
        const auto [known, is_new] =
            materials_.try_emplace(index, static_cast<std::uint32_t>(colors_.materials.size()));
        if (is_new)
            colors_.materials.push_back(color_of(entry(document_, "materials", index)));
        return known->second;
    }

    BaseColors finish(std::vector<std::uint32_t> triangles)
    {
        colors_.triangles = std::move(triangles);
        return std::move(colors_);
    }

private:
    BaseColor color_of(const json& material)
    {
        BaseColor color;
        const json& looks = member(material, "pbrMetallicRoughness");
        const json& factor = member(looks, "baseColorFactor");
        for (int k = 0; k < 3 && factor.is_array() && factor.size() == 4; ++k) {
            const json& number = factor[static_cast<std::size_t>(k)];
            if (number.is_number())
                color.factor[k] = std::clamp(number.get<float>(), 0.0f, 1.0f);
        }
        const json& texture = member(looks, "baseColorTexture");
        color.uv_set = static_cast<std::uint32_t>(whole_number(member(texture, "texCoord"), 0));
        const json& image =
            member(entry(document_, "textures", member(texture, "index")), "source");
        if (entry(document_, "images", image).is_object())
            color.picture = picture_of(image.get<std::size_t>());
        if (texture.is_object())
            set_transform(texture, color);
        const json& name = member(material, "name");
        color.name = name.is_string() ? name.get<std::string>() : std::string();
        color.opacity = opacity_of(material);
        color.alpha_picture = color.picture;
        if (factor.is_array() && factor.size() == 4)
            color.alpha = std::clamp(static_cast<float>(number_of(factor[3], 1.0)), 0.0f, 1.0f);
        color.cutoff = static_cast<float>(number_of(member(material, "alphaCutoff"), 0.5));
        return color;
    }

    std::uint32_t picture_of(std::size_t image)
    {
        const auto [known, is_new] =
            pictures_.try_emplace(image, static_cast<std::uint32_t>(colors_.pictures.size()));
        if (!is_new)
            return known->second;
        PictureSource& picture = colors_.pictures.emplace_back();
        picture.name = asset_.path.filename().string() + ": image " + std::to_string(image);
        const json& entry_of_image = entry(document_, "images", image);
        if (const json& uri = member(entry_of_image, "uri"); uri.is_string()) {
            const auto& text = uri.get_ref<const std::string&>();
            if (is_data_uri(text))
                picture.bytes = decode_data_uri(text).value_or("");
            else
                picture.file = resolve_uri(asset_.path.parent_path(), text).value_or("");
        } else {
            picture.bytes = bytes_of_view(
                asset_, entry(document_, "bufferViews", member(entry_of_image, "bufferView")));
        }
        return known->second;
    }

    const GltfAsset& asset_;
    const json& document_;
    BaseColors colors_;
    std::map<json, std::uint32_t> materials_;
    std::map<std::size_t, std::uint32_t> pictures_;
};

}  // namespace

BaseColors GltfAsset::base_colors() const
{
    Painter painter(*this);
    std::vector<std::uint32_t> triangles;
    for (const GltfPart& part : parts) {
        for (const GltfTriangles& of_primitive : part.primitives)
            triangles.insert(triangles.end(), of_primitive.count,
                             painter.material_of(uses[part.use].mesh, of_primitive.primitive));
    }
    return painter.finish(std::move(triangles));
}

bool GltfAsset::has_openings() const
{
    const json& materials = member(*document, "materials");
    return materials.is_array() && std::ranges::any_of(materials, [](const json& material) {
               return opacity_of(material) != Opacity::solid;
           });
}

std::optional<std::uint32_t> GltfAsset::occlusion_uvs() const
{
    for (const GltfPart& part : parts) {
        const json& primitives =
            member(entry(*document, "meshes", uses[part.use].mesh), "primitives");
        for (const GltfTriangles& of_primitive : part.primitives) {
            const json& material = member(primitives.at(of_primitive.primitive), "material");
            const json& texture =
                member(entry(*document, "materials", material), "occlusionTexture");
            if (texture.is_object())
                return static_cast<std::uint32_t>(whole_number(member(texture, "texCoord"), 0));
        }
    }
    return {};
}

}  // namespace surfelao
