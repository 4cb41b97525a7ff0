#include "files/gltf_old_results.h"

#include "files/maker_mark.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <set>

namespace surfelao {
namespace {

using nlohmann::json;
using Indices = std::set<std::size_t>;

/// Most bytes that stand behind the last value of a buffer: a GLB has whole words.
constexpr std::size_t kPadding = 3;

bool was_baked(const json& document)
{
    const json::json_pointer place = json::json_pointer("/asset/extras") / kMarkKey;
    return document.contains(place) && document[place].is_string() &&
           command_of_mark(document[place].get_ref<const std::string&>()) == "bake";
}

/// Accessors of results; nothing when a mesh that the scene does not use has some.
std::optional<Indices> old_accessors(const json& document, const Scene& scene)
{
    std::set<std::int32_t> used;
    for (const Part& part : scene.parts)
        used.insert(part.mesh);
    Indices accessors;
    std::int32_t index = 0;
    for (const json& mesh : document.value("meshes", json::array())) {
        const bool is_used = used.contains(index++);
        for (const json& primitive : mesh.value("primitives", json::array())) {
            const json attributes = primitive.value("attributes", json::object());
            for (const char* name : {"_OCCLUSION", "_BENT_NORMAL"}) {
                const auto accessor = attributes.find(name);
                if (accessor == attributes.end())
                    continue;
                if (!is_used || !accessor->is_number_unsigned())
                    return std::nullopt;
                accessors.insert(accessor->get<std::size_t>());
            }
        }
    }
    return accessors;
}

/// Whether the indices are the last ones of a list of this size.
bool are_last(const Indices& indices, std::size_t size)
{
    return !indices.empty() && *indices.rbegin() == size - 1 &&
           *indices.begin() == size - indices.size();
}

/// Whether a number in [first, ...) stands under this key anywhere in the value.
bool uses(const json& value, const std::string& key, std::size_t first)
{
    for (const auto& [name, member] : value.items()) {
        if (name == key && member.is_number_unsigned() && member.get<std::size_t>() >= first)
            return true;
        if (member.is_structured() && uses(member, key, first))
            return true;
    }
    return false;
}

void keep_first(json& list, std::size_t count)
{
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(count), list.end());
}

}  // namespace

void drop_old_results(json& document, std::vector<GltfBuffer>& buffers, const Scene& scene)
{
    if (!was_baked(document) || !document.contains("accessors") ||
        !document.contains("bufferViews"))
        return;
    const std::optional<Indices> old = old_accessors(document, scene);
    json& accessors = document["accessors"];
    json& views = document["bufferViews"];
    if (!old || !are_last(*old, accessors.size()))
        return;

    // their views: the last ones, and nobody else's
    Indices old_views;
    for (const std::size_t accessor : *old) {
        const json& view = accessors[accessor].value("bufferView", json());
        if (!view.is_number_unsigned())
            return;
        old_views.insert(view.get<std::size_t>());
    }
    if (!are_last(old_views, views.size()))
        return;
    json others = document;
    keep_first(others["accessors"], *old->begin());
    if (uses(others, "bufferView", *old_views.begin()))
        return;

    // their bytes: the end of one buffer
    const json& first_view = views[*old_views.begin()];
    const std::size_t buffer = first_view.value("buffer", std::size_t{0});
    const std::size_t begin = first_view.value("byteOffset", std::size_t{0});
    std::size_t end = 0;
    for (std::size_t view = 0; view < views.size(); ++view) {
        const bool is_old = view >= *old_views.begin();
        const bool is_there = views[view].value("buffer", std::size_t{0}) == buffer;
        const std::size_t view_end = views[view].value("byteOffset", std::size_t{0}) +
                                     views[view].value("byteLength", std::size_t{0});
        if (is_old ? !is_there : is_there && view_end > begin)
            return;
        if (is_old)
            end = std::max(end, view_end);
    }
    const bool is_whole_buffer = begin == 0;
    if (buffer >= buffers.size() || begin > buffers[buffer].bytes.size() ||
        end + kPadding < buffers[buffer].bytes.size() ||
        (is_whole_buffer && (buffer == 0 || buffer != buffers.size() - 1)))
        return;
    keep_first(accessors, *old->begin());
    keep_first(views, *old_views.begin());
    buffers[buffer].bytes = buffers[buffer].bytes.substr(0, begin);
    if (is_whole_buffer) {
        buffers.pop_back();
        keep_first(document["buffers"], buffer);
    }
}

}  // namespace surfelao
