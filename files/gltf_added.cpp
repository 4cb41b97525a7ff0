#include "files/gltf_added.h"

#include "files/gltf_accessor.h"
#include "files/gltf_json.h"
#include "files/maker_mark.h"

#include <algorithm>
#include <utility>

namespace surfelao {
namespace {

using nlohmann::json;

constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

constexpr std::string_view kAdded = "surfelao ";
constexpr const char* kReplacement = "replacement";

/// The largest index of 16 bits would restart the primitive.
constexpr std::size_t kMostOfShorts = 0xFFFF;

template <typename T>
std::string_view as_bytes(std::span<const T> values)
{
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

bool is_added(const json& entry)
{
    const json& name = member(entry, "name");
    return name.is_string() && name.get_ref<const std::string&>().starts_with(kAdded);
}

void mark_replacement(json& accessor)
{
    if (!member(accessor, "extras").is_object())
        accessor["extras"] = json::object();
    accessor["extras"][kMarkKey] = kReplacement;
}

bool is_replacement(const json& accessor)
{
    const json& mark = member(member(accessor, "extras"), kMarkKey);
    return mark.is_string() && mark == kReplacement;
}

std::size_t free_set(const json& attributes)
{
    std::size_t set = 0;
    while (attributes.contains("TEXCOORD_" + std::to_string(set)))
        ++set;
    return set;
}

AddedData::AddedData(json& document)
    : document_(document), first_view_(member(document, "bufferViews").size())
{
}

std::size_t AddedData::add_floats(std::size_t dimension, std::span<const float> values,
                                  const char* name)
{
    json accessor = {{"componentType", static_cast<int>(GltfComponent::float32)},
                     {"type", dimension == 1 ? "SCALAR" : "VEC" + std::to_string(dimension)}};
    if (name)
        accessor["name"] = name;
    return add_elements(std::move(accessor), as_bytes(values), dimension * sizeof(float));
}

std::size_t AddedData::add_elements(json accessor, std::string_view bytes, std::size_t size)
{
    const std::size_t stride = (size + 3) / 4 * 4;
    accessor["count"] = bytes.size() / size;
    return add_accessor(std::move(accessor), kArrayBuffer, stride, [&](std::string& all) {
        if (stride == size) {
            all += bytes;
            return;
        }
        for (std::size_t begin = 0; begin < bytes.size(); begin += size)
            all.append(bytes.substr(begin, size)).append(stride - size, '\0');
    });
}

std::size_t AddedData::add_indices(std::span<const std::uint32_t> indices, std::size_t vertices)
{
    const bool is_short = vertices <= kMostOfShorts;
    const GltfComponent component = is_short ? GltfComponent::uint16 : GltfComponent::uint32;
    return add_accessor(
        {{"componentType", static_cast<int>(component)},
         {"type", "SCALAR"},
         {"count", indices.size()}},
        kElementArrayBuffer, size_of(component), [&](std::string& all) {
            if (!is_short)
                all += as_bytes(indices);
            for (const std::uint32_t index : indices.first(is_short ? indices.size() : 0))
                all.append({static_cast<char>(index), static_cast<char>(index >> 8)});
        });
}

template <class Append>
std::size_t AddedData::add_accessor(json accessor, int target, std::size_t stride,
                                    const Append& append)
{
    const auto view = std::ranges::find_if(views_, [&](const View& known) {
        return known.target == target && known.stride == stride;
    });
    const auto index = static_cast<std::size_t>(view - views_.begin());
    if (view == views_.end())
        views_.push_back({target, stride, {}});
    accessor["bufferView"] = first_view_ + index;
    accessor["byteOffset"] = views_[index].bytes.size();
    append(views_[index].bytes);
    document_["accessors"].push_back(std::move(accessor));
    return document_["accessors"].size() - 1;
}

std::size_t AddedData::add_bytes(std::string_view bytes)
{
    views_.push_back({0, 0, std::string(bytes)});
    return first_view_ + views_.size() - 1;
}

std::string AddedData::finish(std::size_t buffer, std::size_t offset)
{
    std::string all;
    for (const View& view : views_) {
        json entry = {{"buffer", buffer},
                      {"byteOffset", offset + all.size()},
                      {"byteLength", view.bytes.size()}};
        if (view.target != 0)
            entry["target"] = view.target;
        if (view.target == kArrayBuffer)
            entry["byteStride"] = view.stride;
        document_["bufferViews"].push_back(std::move(entry));
        all += view.bytes;
        all.resize((all.size() + 3) / 4 * 4);
    }
    return all;
}

}  // namespace surfelao
