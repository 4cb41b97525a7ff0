#include "files/gltf_links.h"

#include "files/file_contents.h"
#include "files/gltf_added.h"
#include "files/gltf_strings.h"
#include "files/gltf_uri.h"
#include "files/sidecars.h"
#include "surfels/errors.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string_view>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Extensions of a bufferView that name a buffer and an offset of their own.
constexpr const char* kBufferViewExtensions[] = {"EXT_meshopt_compression",
                                                 "KHR_meshopt_compression"};

void pad(std::string& bytes)
{
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
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

/// Calls embed(image, type, bytes) for each image that stands in a file of its own, in the model's
/// folder.
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
        pad(bin);
        bases[i] = bin.size();
        bin += buffers_as_read[i].bytes;
    }
    pad(bin);
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

bool in_one_folder(const fs::path& a, const fs::path& b)
{
    std::error_code error;
    return fs::equivalent(fs::absolute(a).parent_path(), fs::absolute(b).parent_path(), error);
}

/// Turns the URIs in a value, from one folder to another.
class UriTurner {
public:
    UriTurner(const fs::path& model, const fs::path& path)
        : model_(model), path_(path), same_folder_(in_one_folder(model, path))
    {
    }

    void turn_all(json& value)
    {
        for (const auto& [key, inner] : value.items()) {
            if (key == "uri" && inner.is_string())
                turn(inner);
            else if (inner.is_structured() && key != "extras")
                turn_all(inner);
        }
    }

    std::vector<std::string> absent;

private:
    void turn(json& uri)
    {
        const auto& text = uri.get_ref<const std::string&>();
        if (is_data_uri(text))
            return;
        const std::optional<fs::path> file = locate_uri(model_.parent_path(), text);
        if (!file)
            return;  // absolute: it names the same file from everywhere
        std::error_code error;
        if (!fs::is_regular_file(*file, error))
            absent.push_back(shortened(text));
        else if (!same_folder_ || text.find_first_of("\\ ") != text.npos)
            uri = encode_uri(path_from(fs::absolute(path_).parent_path(), *file));
    }

    const fs::path& model_;
    const fs::path& path_;
    bool same_folder_;
};

}  // namespace

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
            pad(bin);
        });
    return bin;
}

std::vector<std::string> turn_uris(json& document, const fs::path& model, const fs::path& path)
{
    UriTurner turner(model, path);
    turner.turn_all(document);
    return turner.absent;
}

bool names_our_picture(const fs::path& path, const std::string& uri)
{
    bool is_ours = false, found = false;
    visit_gltf_strings(path, [&](std::span<const std::string> keys, const std::string& text) {
        if (keys.size() != 3 || keys[0] != "images")
            return true;
        if (keys[2] == "name")  // the writer sorts keys: in front of the uri
            is_ours = text == kAddedPicture;
        found = keys[2] == "uri" && is_ours && text == uri;
        return !found;
    });
    return found;
}

void embed_buffers(json& document, std::span<const GltfBuffer> buffers, const fs::path& path)
{
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        json& buffer = document["buffers"][i];
        const auto found = buffer.find("uri");
        const std::string uri = found == buffer.end() ? "" : found->get<std::string>();
        if (!buffers[i].bytes.empty() && !is_data_uri(uri) &&
            !resolve_buffer_uri(path.parent_path(), uri))
            buffer["uri"] = make_data_uri("application/octet-stream", buffers[i].bytes);
    }
}

}  // namespace surfelao
