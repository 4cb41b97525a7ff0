#include "files/import/materials.h"

#include "files/gltf_buffer.h"
#include "files/gltf_uri.h"
#include "files/import/names.h"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// The first texture of a kind, as the file names it.
struct NamedTexture {
    std::string name;
    unsigned int uv_set = 0;
    std::array<aiTextureMapMode, 2> modes{aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
};

std::optional<NamedTexture> texture_of(const aiMaterial& material, aiTextureType type)
{
    NamedTexture texture;
    aiString name;
    if (material.GetTexture(type, 0, &name, nullptr, &texture.uv_set, nullptr, nullptr,
                            texture.modes.data()) != aiReturn_SUCCESS ||
        name.length == 0)
        return std::nullopt;
    texture.name = name.C_Str();
    return texture;
}

std::optional<NamedTexture> texture_of(const aiMaterial& material, aiTextureType type,
                                       aiTextureType otherwise)
{
    std::optional<NamedTexture> texture = texture_of(material, type);
    return texture ? texture : texture_of(material, otherwise);
}

/// What glTF calls a file of these first bytes; empty for what it does not know.
std::string media_type_of(std::string_view bytes)
{
    if (bytes.starts_with("\x89PNG"))
        return "image/png";
    return bytes.starts_with("\xff\xd8\xff") ? "image/jpeg" : "";
}

int wrap_of(aiTextureMapMode mode)
{
    switch (mode) {
        case aiTextureMapMode_Clamp:
        case aiTextureMapMode_Decal:
            return TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        case aiTextureMapMode_Mirror:
            return TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
        default:
            return TINYGLTF_TEXTURE_WRAP_REPEAT;
    }
}

/// The file as its user has it, seen from the folder. Names are often those of another machine's
/// folders: then a file of the same name beside the model is meant.
std::string file_beside(const fs::path& folder, std::string name)
{
    std::ranges::replace(name, '\\', '/');
    // X3D has a list of them in quotes, the best first
    name.erase(0, std::min(name.find_first_not_of('"'), name.size()));
    name.erase(std::min(name.find('"'), name.size()));
    const fs::path path = fs::path(name).lexically_normal();
    std::error_code error;
    const bool is_found = path.is_relative() && fs::exists(folder / path, error);
    return (is_found ? path : path.filename()).generic_string();
}

class Textures {
public:
    Textures(const aiScene& scene, const fs::path& folder, tinygltf::Model& model)
        : scene_(scene), folder_(folder), model_(model)
    {
    }

    /// The number of the glTF's texture; -1 where it cannot be kept.
    int add(const NamedTexture& named)
    {
        tinygltf::Texture texture;
        texture.source = image_of(named.name);
        texture.sampler = sampler_of(named.modes);
        if (texture.source < 0)
            return -1;
        model_.textures.push_back(std::move(texture));
        return static_cast<int>(model_.textures.size()) - 1;
    }

    [[nodiscard]] std::size_t lost_count() const { return lost_; }

private:
    int image_of(const std::string& name)
    {
        const auto known = std::ranges::find(images_, name, &std::pair<std::string, int>::first);
        if (known != images_.end())
            return known->second;
        int number = -1;
        if (std::optional<tinygltf::Image> image = make_image(name)) {
            model_.images.push_back(std::move(*image));
            number = static_cast<int>(model_.images.size()) - 1;
        } else {
            ++lost_;
        }
        images_.emplace_back(name, number);
        return number;
    }

    std::optional<tinygltf::Image> make_image(const std::string& name)
    {
        tinygltf::Image image;
        const aiTexture* const embedded = scene_.GetEmbeddedTexture(name.c_str());
        if (!embedded) {
            image.uri = encode_uri(file_beside(folder_, name));
            return image.uri.empty() ? std::nullopt : std::optional(std::move(image));
        }
        if (embedded->mHeight != 0)  // bare texels
            return std::nullopt;
        const std::string_view bytes(reinterpret_cast<const char*>(embedded->pcData),
                                     embedded->mWidth);
        image.mimeType = media_type_of(bytes);
        if (image.mimeType.empty())
            return std::nullopt;
        image.name = to_utf8(fs::path(file_beside(folder_, name)).stem().string());
        image.bufferView = add_view(model_, std::as_bytes(std::span(bytes)), 0);
        return image;
    }

    int sampler_of(const std::array<aiTextureMapMode, 2>& modes)
    {
        tinygltf::Sampler sampler;
        sampler.wrapS = wrap_of(modes[0]);
        sampler.wrapT = wrap_of(modes[1]);
        const auto known = std::ranges::find_if(model_.samplers, [&](const auto& other) {
            return other.wrapS == sampler.wrapS && other.wrapT == sampler.wrapT;
        });
        const auto number = known - model_.samplers.begin();
        if (known == model_.samplers.end())
            model_.samplers.push_back(sampler);
        return static_cast<int>(number);
    }

    const aiScene& scene_;
    const fs::path& folder_;
    tinygltf::Model& model_;
    std::vector<std::pair<std::string, int>> images_;
    std::size_t lost_ = 0;
};

double number_of(const aiMaterial& material, const char* key, double otherwise)
{
    ai_real value = 0;
    return material.Get(key, 0, 0, value) == aiReturn_SUCCESS ? static_cast<double>(value)
                                                              : otherwise;
}

std::array<double, 3> color_of(const aiMaterial& material, const char* key, double otherwise)
{
    aiColor3D value;
    if (material.Get(key, 0, 0, value) != aiReturn_SUCCESS)
        return {otherwise, otherwise, otherwise};
    const auto part = [](ai_real x) { return std::clamp(static_cast<double>(x), 0.0, 1.0); };
    return {part(value.r), part(value.g), part(value.b)};
}

bool is_written_as_clear(const aiMaterial& material)
{
    return number_of(material, "$mat.opacity", 1.0) <= 0.0;
}

/// FBX and COLLADA say 0 for the opacity of what their programs show as solid: some of these count
/// transparency the other way round.
bool means_what_it_says(const SourceFile& file)
{
    return file.format == "3DS" || file.format == "X3D";
}

/// In these formats a texture stands in place of the colour.
void set_base_color(const aiMaterial& material, bool is_solid, Textures& textures,
                    tinygltf::Material& to)
{
    tinygltf::PbrMetallicRoughness& pbr = to.pbrMetallicRoughness;
    const std::array<double, 3> diffuse = color_of(material, "$clr.diffuse", 1.0);
    aiColor3D base;
    const std::array<double, 3> color = material.Get(AI_MATKEY_BASE_COLOR, base) == aiReturn_SUCCESS
                                            ? color_of(material, "$clr.base", 1.0)
                                            : diffuse;
    const double opacity = number_of(material, "$mat.opacity", 1.0);
    const double alpha = !is_solid && opacity >= 0.0 && opacity < 1.0 ? opacity : 1.0;
    pbr.baseColorFactor = {color[0], color[1], color[2], alpha};
    if (alpha < 1.0)
        to.alphaMode = "BLEND";
    const auto texture = texture_of(material, aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE);
    if (!texture)
        return;
    pbr.baseColorTexture.index = textures.add(*texture);
    pbr.baseColorTexture.texCoord = static_cast<int>(texture->uv_set);
    if (pbr.baseColorTexture.index < 0)
        return;
    pbr.baseColorFactor = {1.0, 1.0, 1.0, alpha};
    const auto opacity_texture = texture_of(material, aiTextureType_OPACITY);
    if (opacity_texture && opacity_texture->name == texture->name)
        to.alphaMode = "MASK";
}

/// is_solid: whatever its opacity is.
tinygltf::Material material_of(const aiMaterial& material, bool is_solid, Textures& textures)
{
    tinygltf::Material to;
    aiString name;
    if (material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS)
        to.name = to_utf8(name.C_Str());
    set_base_color(material, is_solid, textures, to);
    to.pbrMetallicRoughness.metallicFactor = number_of(material, "$mat.metallicFactor", 0.0);
    to.pbrMetallicRoughness.roughnessFactor = number_of(material, "$mat.roughnessFactor", 1.0);
    int is_two_sided = 0;
    to.doubleSided =
        material.Get(AI_MATKEY_TWOSIDED, is_two_sided) == aiReturn_SUCCESS && is_two_sided != 0;
    const std::array<double, 3> emission = color_of(material, "$clr.emissive", 0.0);
    to.emissiveFactor = {emission[0], emission[1], emission[2]};
    if (const auto texture =
            texture_of(material, aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE)) {
        to.emissiveTexture.index = textures.add(*texture);
        to.emissiveTexture.texCoord = static_cast<int>(texture->uv_set);
        if (to.emissiveTexture.index >= 0)
            to.emissiveFactor = {1.0, 1.0, 1.0};
    }
    if (const auto texture =
            texture_of(material, aiTextureType_NORMAL_CAMERA, aiTextureType_NORMALS)) {
        to.normalTexture.index = textures.add(*texture);
        to.normalTexture.texCoord = static_cast<int>(texture->uv_set);
    }
    return to;
}

/// Of each material: how many sets of texture coordinates all its meshes have.
std::vector<int> uv_set_counts(const aiScene& scene)
{
    std::vector<int> counts(scene.mNumMaterials, AI_MAX_NUMBER_OF_TEXTURECOORDS);
    for (const aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes)) {
        if (mesh->mMaterialIndex < counts.size())
            counts[mesh->mMaterialIndex] =
                std::min(counts[mesh->mMaterialIndex], static_cast<int>(mesh->GetNumUVChannels()));
    }
    return counts;
}

}  // namespace

void add_materials(const aiScene& scene, const SourceFile& file, tinygltf::Model& model,
                   std::vector<std::string>& notes)
{
    const fs::path folder = file.path.parent_path();
    Textures textures(scene, folder, model);
    std::size_t solid_count = 0;
    const std::vector<int> sets = uv_set_counts(scene);
    for (unsigned int i = 0; i < scene.mNumMaterials; ++i) {
        const bool is_solid =
            is_written_as_clear(*scene.mMaterials[i]) && !means_what_it_says(file);
        solid_count += is_solid ? 1 : 0;
        tinygltf::Material material = material_of(*scene.mMaterials[i], is_solid, textures);
        if (i + 1 == scene.mNumMaterials && material.name == AI_DEFAULT_MATERIAL_NAME)
            break;  // assimp's own
        for (int* const set :
             {&material.pbrMetallicRoughness.baseColorTexture.texCoord,
              &material.emissiveTexture.texCoord, &material.normalTexture.texCoord}) {
            if (*set >= sets[i])  // numbered as in a file that has others, which were not read
                *set = 0;
        }
        model.materials.push_back(std::move(material));
    }
    if (textures.lost_count() > 0)
        notes.push_back("textures in the file that are neither PNG nor JPEG and are left out: " +
                        std::to_string(textures.lost_count()));
    if (solid_count > 0)
        notes.push_back(
            "materials with an opacity of 0, which " + file.format +
            " has of solid ones too, are taken as solid: " + std::to_string(solid_count));
}

}  // namespace surfelao
