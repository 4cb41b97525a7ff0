#include "files/gltf_io.h"

#include "files/file_contents.h"
#include "files/file_type.h"
#include "files/gltf_accessor.h"
#include "files/gltf_asset.h"
#include "files/gltf_old_results.h"
#include "files/gltf_pose.h"
#include "files/gltf_uri.h"
#include "files/gltf_uses.h"
#include "files/maker_mark.h"
#include "surfels/errors.h"

#include <nlohmann/json.hpp>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kFloat = 5126;
constexpr int kArrayBuffer = 34962;

/// Extensions of a bufferView that name a buffer and an offset of their own.
constexpr const char* kBufferViewExtensions[] = {"EXT_meshopt_compression",
                                                 "KHR_meshopt_compression"};

void pad_to_four(std::string& bytes, char filler)
{
    bytes.resize((bytes.size() + 3) / 4 * 4, filler);
}

/// New accessors, and the bytes they stand for.
///
/// All of one dimension share one buffer view: scalars first, then vectors of three, then of four.
/// Every part has the first two, so the place of each view is known beforehand.
class NewAccessors {
public:
    explicit NewAccessors(json& document)
        : document_(document), first_view_(document["bufferViews"].size())
    {
    }

    /// Adds an accessor of `dimension` (1, 3 or 4) floats per element and returns its index.
    std::size_t add(std::size_t dimension, const std::vector<float>& values)
    {
        std::string& bytes = bytes_[slot(dimension)];
        json& accessors = document_["accessors"];
        accessors.push_back(
            {{"bufferView", first_view_ + slot(dimension)},
             {"byteOffset", bytes.size()},
             {"componentType", kFloat},
             {"count", values.size() / dimension},
             {"type", dimension == 1 ? "SCALAR" : "VEC" + std::to_string(dimension)}});
        const std::size_t offset = bytes.size();
        bytes.resize(offset + values.size() * sizeof(float));
        std::memcpy(bytes.data() + offset, values.data(), values.size() * sizeof(float));
        return accessors.size() - 1;
    }

    /// Adds the buffer views and returns their bytes, which belong into `buffer` from `offset` on.
    std::string finish(std::size_t buffer, std::size_t offset)
    {
        std::string all;
        for (const std::size_t dimension : {1, 3, 4}) {
            const std::string& bytes = bytes_[slot(dimension)];
            if (bytes.empty())
                continue;
            document_["bufferViews"].push_back({{"buffer", buffer},
                                                {"byteOffset", offset + all.size()},
                                                {"byteLength", bytes.size()},
                                                {"byteStride", dimension * sizeof(float)},
                                                {"target", kArrayBuffer}});
            all += bytes;
        }
        return all;
    }

private:
    static std::size_t slot(std::size_t dimension) { return dimension == 1 ? 0 : dimension - 2; }

    json& document_;
    std::size_t first_view_;
    std::array<std::string, 3> bytes_;
};

std::vector<float> occlusion_values(std::span<const Occlusion> occlusion)
{
    std::vector<float> values;
    values.reserve(occlusion.size());
    for (const Occlusion& vertex : occlusion)
        values.push_back(vertex.occlusion);
    return values;
}

/// World directions as normals of mesh space. A normal n becomes M^-T n in the world, so what comes
/// back is M^T n.
std::vector<float> bent_normal_values(std::span<const Occlusion> occlusion, const GltfPart& part)
{
    const glm::dmat3 rigid = scaled_to_one(part.to_world);
    std::vector<float> values;
    values.reserve(3 * occlusion.size());
    for (std::size_t v = 0; v < occlusion.size(); ++v) {
        const glm::dmat3 to_world =
            part.vertices_to_world.empty() ? rigid : glm::dmat3(part.vertices_to_world[v]);
        const glm::dvec3 direction = glm::dvec3(occlusion[v].bent_normal) * to_world;
        const double length = glm::length(direction);
        const glm::vec3 unit = length > 0.0 ? glm::vec3(direction / length) : glm::vec3(0.0f);
        values.insert(values.end(), {unit.x, unit.y, unit.z});
    }
    return values;
}

/// Adds COLOR_0 to one primitive: visibility as grey, times the colours that are there.
class ColorWriter {
public:
    ColorWriter(const GltfAsset& asset, NewAccessors& accessors)
        : asset_(asset), accessors_(accessors)
    {
    }

    /// The accessor for `attributes` of a primitive. Primitives of one part that share colours
    /// share the result as well.
    std::size_t add(const json& attributes, std::span<const Occlusion> occlusion)
    {
        const auto existing = attributes.find("COLOR_0");
        std::optional<std::size_t> source;
        if (existing != attributes.end())
            source = existing->get<std::size_t>();
        const auto [entry, is_new] = added_.try_emplace(source, 0);
        if (is_new)
            entry->second = source ? add_multiplied(*source, occlusion) : add_grey(occlusion);
        return entry->second;
    }

private:
    std::size_t add_grey(std::span<const Occlusion> occlusion)
    {
        std::vector<float> values;
        for (const Occlusion& vertex : occlusion)
            values.insert(values.end(), 3, 1.0f - vertex.occlusion);
        return accessors_.add(3, values);
    }

    std::size_t add_multiplied(std::size_t source, std::span<const Occlusion> occlusion)
    {
        const GltfAccessor& accessor = asset_.colors.at(source);
        std::vector<glm::dvec4> colors;
        try {
            colors = read_colors(accessor);
        } catch (const AccessorError& error) {
            fail_gltf(asset_.path, "COLOR_0 accessor " + std::to_string(source) + ":",
                      error.what());
        }
        std::vector<float> values;
        for (std::size_t i = 0; i < colors.size(); ++i) {
            const double visibility = 1.0 - double{occlusion[i].occlusion};
            for (int k = 0; k < accessor.dimension; ++k)
                values.push_back(static_cast<float>(colors[i][k] * (k < 3 ? visibility : 1.0)));
        }
        return accessors_.add(static_cast<std::size_t>(accessor.dimension), values);
    }

    const GltfAsset& asset_;
    NewAccessors& accessors_;
    std::map<std::optional<std::size_t>, std::size_t> added_;
};

void add_attributes(json& document, const GltfAsset& asset, const Scene& scene,
                    std::span<const Occlusion> occlusion, const WriteOptions& options,
                    NewAccessors& accessors)
{
    const std::vector<std::size_t> meshes = separate_uses(document, asset.uses);
    for (std::size_t p = 0; p < scene.parts.size(); ++p) {
        const Part& part = scene.parts[p];
        if (part.vertex_count == 0)
            continue;
        const auto values = occlusion.subspan(part.first_vertex, part.vertex_count);
        const std::size_t scalar = accessors.add(1, occlusion_values(values));
        const std::size_t bent = accessors.add(3, bent_normal_values(values, asset.parts[p]));
        ColorWriter colors(asset, accessors);

        // the primitives that this part stands for: those that share its vertices
        json& primitives = document["meshes"][meshes[asset.parts[p].use]]["primitives"];
        const std::vector<std::int32_t>& groups =
            asset.group_of_primitive[static_cast<std::size_t>(part.mesh)];
        for (std::size_t i = 0; i < groups.size(); ++i) {
            if (groups[i] != part.primitive)
                continue;
            json& attributes = primitives[i]["attributes"];
            attributes["_OCCLUSION"] = scalar;
            attributes["_BENT_NORMAL"] = bent;
            if (options.colors == VertexColors::shaded)
                attributes["COLOR_0"] = colors.add(attributes, values);
        }
    }
}

/// What an image file is, by its first bytes; nothing when it is none that glTF or one of its
/// extensions knows.
std::optional<std::string> media_type(std::string_view bytes)
{
    if (bytes.starts_with("\x89PNG"))
        return "image/png";
    if (bytes.starts_with("\xFF\xD8\xFF"))
        return "image/jpeg";
    if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP"))
        return "image/webp";
    if (bytes.starts_with("\xABKTX 20\xBB"))
        return "image/ktx2";
    if (bytes.starts_with("DDS "))
        return "image/vnd-ms.dds";
    return std::nullopt;
}

/// Calls embed(image, type, bytes) for each image that stands in a file of its own and can be
/// found.
template <typename Embed>
void for_each_external_image(json& document, const fs::path& model, Embed&& embed)
{
    const auto images = document.find("images");
    if (images == document.end() || !images->is_array())
        return;
    for (json& image : *images) {
        if (!image.is_object() || !image.contains("uri") || !image["uri"].is_string())
            continue;
        const std::optional<fs::path> file =
            resolve_uri(model.parent_path(), image["uri"].get_ref<const std::string&>());
        if (!file)
            continue;
        std::string bytes;
        try {
            bytes = read_contents(*file, "image");
        } catch (const InputError&) {
            continue;  // a texture that is not there stays a texture that is not there
        }
        if (const std::optional<std::string> type = media_type(bytes))
            embed(image, *type, bytes);
    }
}

/// Makes one binary chunk of all buffers and turns the document's references to it.
std::string merge_buffers(json& document, std::span<const GltfBuffer> buffers_as_read)
{
    std::string bin;
    std::vector<std::size_t> bases(buffers_as_read.size(), 0);
    std::vector<std::size_t> kept_as(buffers_as_read.size(), 0);
    json buffers = json::array();
    buffers.push_back(buffers_as_read[0].bytes.empty() ? json::object() : document["buffers"][0]);
    buffers[0].erase("uri");
    for (std::size_t i = 0; i < buffers_as_read.size(); ++i) {
        if (buffers_as_read[i].bytes.empty()) {  // its contents come from an extension
            kept_as[i] = buffers.size();
            buffers.push_back(document["buffers"][i]);
            continue;
        }
        pad_to_four(bin, '\0');
        bases[i] = bin.size();
        bin += buffers_as_read[i].bytes;
    }
    pad_to_four(bin, '\0');
    document["buffers"] = buffers;

    const auto relocate = [&](json& place) {
        const auto buffer = place["buffer"].get<std::size_t>();
        place["buffer"] = kept_as[buffer];
        if (bases[buffer] != 0)
            place["byteOffset"] = place.value("byteOffset", std::size_t{0}) + bases[buffer];
    };
    for (json& view : document["bufferViews"]) {
        relocate(view);
        const auto extensions = view.find("extensions");
        if (extensions == view.end() || !extensions->is_object())
            continue;
        for (const char* name : kBufferViewExtensions) {
            const auto place = extensions->find(name);
            if (place != extensions->end() && place->is_object() && place->contains("buffer") &&
                (*place)["buffer"].is_number_unsigned() &&
                (*place)["buffer"].get<std::size_t>() < buffers_as_read.size())
                relocate(*place);
        }
    }
    return bin;
}

std::string make_glb(const json& document, const std::string& bin, const GltfAsset& asset,
                     const fs::path& path)
{
    std::string text = document.dump();
    pad_to_four(text, ' ');
    std::uint64_t size = 12 + 8 + text.size() + 8 + bin.size();
    for (const std::string_view chunk : asset.other_chunks)
        size += (chunk.size() + 3) / 4 * 4;
    if (size > std::numeric_limits<std::uint32_t>::max())
        throw InputError(path.string() + ": would be larger than the 4 GiB that a .glb may have");
    std::string file;
    file.reserve(size);
    const auto append_32 = [&](std::uint64_t value) {
        for (int shift = 0; shift < 32; shift += 8)
            file.push_back(static_cast<char>(value >> shift & 0xFF));
    };
    file += "glTF";
    append_32(2);
    append_32(size);
    append_32(text.size());
    file += "JSON";
    file += text;
    append_32(bin.size());
    file.append("BIN\0", 4);
    file += bin;
    for (const std::string_view chunk : asset.other_chunks) {
        file += chunk;
        pad_to_four(file, '\0');
    }
    return file;
}

/// For a .glb: all that has been a buffer or a file of its own becomes one chunk, which is
/// returned.
std::string gather(json& document, std::span<const GltfBuffer> buffers, const fs::path& model)
{
    std::string bin = merge_buffers(document, buffers);
    json& views = document["bufferViews"];
    for_each_external_image(
        document, model, [&](json& image, const std::string& type, const std::string& bytes) {
            image.erase("uri");
            image["mimeType"] = type;
            image["bufferView"] = views.size();
            views.push_back(
                {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}});
            bin += bytes;
            pad_to_four(bin, '\0');
        });
    return bin;
}

/// For a .gltf: a binary chunk, and for another folder the files too, become data URIs.
void embed(json& document, std::span<const GltfBuffer> buffers, const fs::path& model,
           bool same_folder)
{
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        json& buffer = document["buffers"][i];
        const auto uri = buffer.find("uri");
        const bool stays = buffers[i].bytes.empty() ||
                           (uri != buffer.end() &&
                            (same_folder || is_data_uri(uri->get_ref<const std::string&>())));
        if (!stays)
            buffer["uri"] = make_data_uri("application/octet-stream", buffers[i].bytes);
    }
    if (!same_folder)
        for_each_external_image(document, model,
                                [](json& image, const std::string& type, const std::string& bytes) {
                                    image["uri"] = make_data_uri(type, bytes);
                                });
}

/// Where the extras of the asset are no object, there is no place for a mark.
void set_mark(json& document, const std::string& mark)
{
    json& asset = document["asset"];
    const auto extras = asset.find("extras");
    if (extras != asset.end() && !extras->is_object())
        return;
    if (!mark.empty())
        asset["extras"][kMarkKey] = mark;
    else if (extras != asset.end())
        extras->erase(kMarkKey);
}

bool in_one_folder(const fs::path& a, const fs::path& b)
{
    std::error_code error;
    return fs::equivalent(fs::absolute(a).parent_path(), fs::absolute(b).parent_path(), error);
}

}  // namespace

std::string gltf_contents(const fs::path& path, const Scene& scene,
                          std::span<const Occlusion> occlusion, const WriteOptions& options)
{
    const auto* asset = dynamic_cast<const GltfAsset*>(scene.asset.get());
    if (asset == nullptr)
        throw InputError(path.string() +
                         ": only a scene that was read from glTF can be written as glTF");
    SURFELAO_CHECK(occlusion.size() == scene.positions.size());

    json document = *asset->document;
    std::vector<GltfBuffer> buffers_as_read = asset->buffers;
    drop_old_results(document, buffers_as_read, scene);
    const bool binary = type_of(path) == FileType::glb;
    std::string bytes;
    if (binary)
        bytes = gather(document, buffers_as_read, asset->path);
    else
        embed(document, buffers_as_read, asset->path, in_one_folder(path, asset->path));

    json& buffers = document["buffers"];
    const std::size_t buffer = binary ? 0 : buffers.size();
    set_mark(document, options.mark);
    NewAccessors accessors(document);
    add_attributes(document, *asset, scene, occlusion, options, accessors);
    bytes += accessors.finish(buffer, bytes.size());
    if (!binary)
        buffers.push_back({{"uri", make_data_uri("application/octet-stream", bytes)}});
    buffers[buffer]["byteLength"] = bytes.size();
    return binary ? make_glb(document, bytes, *asset, path) : document.dump(2) + '\n';
}

}  // namespace surfelao
