#include "files/gltf_added.h"

#include "files/gltf_accessor.h"
#include "files/gltf_json.h"

#include <algorithm>
#include <utility>

namespace surfelao {
namespace {

using nlohmann::json;

constexpr int kArrayBuffer = 34962;

constexpr std::string_view kAdded = "surfelao ";

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

AddedData::AddedData(json& document)
    : document_(document), first_view_(member(document, "bufferViews").size())
{
}

std::size_t AddedData::add_floats(std::size_t dimension, std::span<const float> values,
                                  const char* name)
{
    json accessor = {{"componentType", static_cast<int>(GltfComponent::float32)}};
    if (name)
        accessor["name"] = name;
    return add_accessor(dimension, as_bytes(values), dimension * sizeof(float),
                        std::move(accessor));
}

std::size_t AddedData::add_accessor(std::size_t dimension, std::string_view bytes,
                                    std::size_t stride, json accessor)
{
    const auto view = std::ranges::find(views_, stride, &View::stride);
    const auto index = static_cast<std::size_t>(view - views_.begin());
    if (view == views_.end())
        views_.push_back({stride, {}});
    accessor["bufferView"] = first_view_ + index;
    accessor["byteOffset"] = views_[index].bytes.size();
    accessor["count"] = bytes.size() / stride;
    accessor["type"] = dimension == 1 ? "SCALAR" : "VEC" + std::to_string(dimension);
    views_[index].bytes += bytes;
    document_["accessors"].push_back(std::move(accessor));
    return document_["accessors"].size() - 1;
}

std::size_t AddedData::add_bytes(std::string_view bytes)
{
    views_.push_back({0, std::string(bytes)});
    return first_view_ + views_.size() - 1;
}

std::string AddedData::finish(std::size_t buffer, std::size_t offset)
{
    std::string all;
    for (const View& view : views_) {
        json entry = {{"buffer", buffer},
                      {"byteOffset", offset + all.size()},
                      {"byteLength", view.bytes.size()}};
        if (view.stride != 0) {
            entry["byteStride"] = view.stride;
            entry["target"] = kArrayBuffer;
        }
        document_["bufferViews"].push_back(std::move(entry));
        all += view.bytes;
        all.resize((all.size() + 3) / 4 * 4);
    }
    return all;
}

}  // namespace surfelao
