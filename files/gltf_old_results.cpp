#include "files/gltf_old_results.h"

#include "files/gltf_added.h"
#include "files/gltf_cuts.h"
#include "files/gltf_json.h"
#include "files/gltf_uses.h"
#include "files/maker_mark.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace surfelao {
namespace {

using nlohmann::json;
using Indices = std::set<std::size_t>;

/// Most bytes that stand behind the last value of a buffer: a GLB has whole words.
constexpr std::size_t kPadding = 3;

bool was_baked(const json& document)
{
    const json& mark = member(member(member(document, "asset"), "extras"), kMarkKey);
    return mark.is_string() && command_of_mark(mark.get_ref<const std::string&>()) == "bake";
}

bool has_results(const json& document)
{
    const auto any = [&](const char* list, const auto& is_one) {
        const json& entries = member(document, list);
        return entries.is_array() && std::ranges::any_of(entries, is_one);
    };
    return was_baked(document) || any("materials", is_added) || any("textures", is_added) ||
           any("accessors",
               [](const json& accessor) { return is_added(accessor) || is_replacement(accessor); });
}

/// Takes the attributes of results off; returns their accessors.
Indices take_attributes(json& document, GltfElements& elements)
{
    const bool baked = was_baked(document);
    Indices accessors;
    const auto is_old = [&](const std::string& name, const json& accessor) {
        return is_added(entry(document, "accessors", accessor)) ||
               (baked && (name == "_OCCLUSION" || name == "_BENT_NORMAL"));
    };
    for (json& mesh : document["meshes"]) {
        for (json& primitive : mesh["primitives"]) {
            if (!primitive.contains("attributes"))
                continue;
            json& attributes = primitive["attributes"];
            for (auto attribute = attributes.begin(); attribute != attributes.end();) {
                if (!is_old(attribute.key(), attribute.value())) {
                    ++attribute;
                    continue;
                }
                if (attribute.value().is_number_unsigned())
                    accessors.insert(attribute.value().get<std::size_t>());
                attribute = attributes.erase(attribute);
            }
            if (attributes.contains("_OWN_COLOR")) {
                attributes["COLOR_0"] = attributes["_OWN_COLOR"];
                attributes.erase("_OWN_COLOR");
            }
            undo_cut(document, primitive, elements);
        }
    }
    const json& entries = member(document, "accessors");
    for (std::size_t accessor = 0; accessor < entries.size(); ++accessor) {
        if (is_replacement(entries[accessor]))
            accessors.insert(accessor);
    }
    return accessors;
}

void keep_first(json& list, std::size_t count)
{
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(count), list.end());
}

json without(const char* key, json material)
{
    if (material.is_object())
        material.erase(key);
    return material;
}

/// What of the material of a blended map stands for the primitives again; it loses the mark. None
/// where another program has changed it.
std::optional<json> take_blended(json& materials, std::size_t m)
{
    if (!member(member(materials[m], "extras"), kMarkKey).is_object())
        return std::nullopt;
    const json original = member(materials[m]["extras"][kMarkKey], "original");
    materials[m]["extras"].erase(kMarkKey);
    if (is_added(materials[m]))
        return json();
    if (original.is_number_unsigned() && original < m &&
        without("extras", materials[m]) ==
            without("extras", materials[original.get<std::size_t>()]))
        return original;
    return std::nullopt;
}

/// Takes occlusion textures of results off the materials, and primitives back to the materials that
/// theirs are copies of, or to none; drops what nobody uses then.
void take_materials(json& document)
{
    if (!member(document, "materials").is_array())
        return;
    json& materials = document["materials"];
    std::map<std::size_t, json> original_of;  // null: none
    for (std::size_t m = 0; m < materials.size(); ++m) {
        if (is_added(materials[m]))
            original_of[m] = nullptr;
        if (const std::optional<json> original = take_blended(materials, m))
            original_of[m] = *original;
        const json info = member(materials[m], "occlusionTexture");
        if (!is_added(entry(document, "textures", member(info, "index"))))
            continue;
        materials[m].erase("occlusionTexture");
        const json& original = member(member(info, "extras"), kMarkKey);
        // another program may have moved the materials about
        if (original.is_number_unsigned() && original < m &&
            materials[m] == without("occlusionTexture", materials[original.get<std::size_t>()]))
            original_of[m] = original;
    }
    for (json& mesh : document["meshes"]) {
        for (json& primitive : mesh["primitives"]) {
            const json& material = member(primitive, "material");
            const auto copy = material.is_number_unsigned()
                                  ? original_of.find(material.get<std::size_t>())
                                  : original_of.end();
            if (copy == original_of.end())
                continue;
            if (copy->second.is_null())
                primitive.erase("material");
            else
                primitive["material"] = copy->second;
        }
    }
    while (original_of.contains(materials.size() - 1) &&
           !uses(document["meshes"], "material", materials.size() - 1))
        keep_first(materials, materials.size() - 1);
    if (materials.empty())
        document.erase("materials");
}

/// Takes nodes back to the meshes that theirs are copies of; drops the copies.
void take_meshes(json& document)
{
    json& meshes = document["meshes"];
    std::map<std::size_t, std::size_t> original_of;
    while (!meshes.empty()) {
        const json& original = member(member(meshes.back(), "extras"), kMarkKey);
        if (!original.is_number_unsigned() || original.get<std::size_t>() >= meshes.size() - 1)
            break;
        json copy = meshes[original.get<std::size_t>()];
        mark_copy(copy, original.get<std::size_t>());
        if (copy != meshes.back())
            break;
        original_of[meshes.size() - 1] = original.get<std::size_t>();
        keep_first(meshes, meshes.size() - 1);
    }
    for (json& node : document["nodes"]) {
        if (!node.contains("mesh"))
            continue;
        for (auto copy = original_of.find(node["mesh"].get<std::size_t>());
             copy != original_of.end(); copy = original_of.find(copy->second))
            node["mesh"] = copy->second;
    }
}

/// Drops the pictures of results with their textures and samplers; returns their buffer views.
Indices take_picture(json& document)
{
    struct List {
        const char* name;
        const char* user;  ///< the list whose entries use its own,
        const char* key;   ///< under this key
    };
    constexpr List kLists[] = {{"textures", "materials", "index"},
                               {"images", "textures", "source"},
                               {"samplers", "textures", "sampler"}};
    Indices views;
    for (const List& list : kLists) {
        const json& entries = member(document, list.name);
        if (!entries.is_array())
            continue;
        while (!entries.empty() && is_added(entries.back()) &&
               !uses(member(document, list.user), list.key, entries.size() - 1)) {
            if (const json& view = member(entries.back(), "bufferView"); view.is_number_unsigned())
                views.insert(view.get<std::size_t>());
            keep_first(document[list.name], entries.size() - 1);
        }
        if (entries.empty())
            document.erase(list.name);
    }
    return views;
}

/// Whether the indices are the last ones of a list of this size.
bool are_last(const Indices& indices, std::size_t size)
{
    return !indices.empty() && *indices.rbegin() == size - 1 &&
           *indices.begin() == size - indices.size();
}

/// Those of the indices that are the last ones of a list of this size.
Indices last_of(const Indices& indices, std::size_t size)
{
    Indices last;
    while (size > 0 && indices.contains(size - 1))
        last.insert(--size);
    return last;
}

/// Whether anything has an accessor in [first, ...).
bool have_accessor(const json& value, std::size_t first)
{
    const auto is_one = [&](const json& index) {
        return index.is_number_unsigned() && index.get<std::size_t>() >= first;
    };
    constexpr std::string_view kKeys[] = {"indices", "inverseBindMatrices", "input", "output"};
    for (const auto& [key, inner] : value.items()) {
        if ((key == "attributes" || key == "targets") && inner.is_structured()) {
            if (std::ranges::any_of(inner.flatten(), is_one))
                return true;
        } else if (inner.is_structured()
                       ? have_accessor(inner, first)
                       : is_one(inner) && std::ranges::find(kKeys, key) != std::end(kKeys)) {
            return true;
        }
    }
    return false;
}

/// Drops the accessors that are the last ones, their views and these, and the bytes of the views.
void take_data(json& document, std::vector<GltfBuffer>& buffers, const Indices& added,
               Indices old_views)
{
    const Indices old_accessors = last_of(added, member(document, "accessors").size());
    if (old_accessors.empty() && old_views.empty())
        return;
    json& accessors = document["accessors"];
    json& views = document["bufferViews"];
    // a map alone comes without accessors
    const std::size_t first_accessor =
        old_accessors.empty() ? accessors.size() : *old_accessors.begin();
    if (!old_accessors.empty() && have_accessor(document, first_accessor))
        return;
    for (const std::size_t accessor : old_accessors) {
        const json& view = member(accessors[accessor], "bufferView");
        if (!view.is_number_unsigned())
            return;
        old_views.insert(view.get<std::size_t>());
    }
    if (!are_last(old_views, views.size()))
        return;
    json others = document;
    keep_first(others["accessors"], first_accessor);
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
    keep_first(accessors, first_accessor);
    keep_first(views, *old_views.begin());
    buffers[buffer].bytes = buffers[buffer].bytes.substr(0, begin);
    document["buffers"][buffer]["byteLength"] = begin;
    if (is_whole_buffer) {
        buffers.pop_back();
        keep_first(document["buffers"], buffer);
    }
}

}  // namespace

bool drop_old_results(GltfAsset& asset)
{
    json& document = *asset.document;
    if (!has_results(document))
        return false;
    GltfElements elements(asset);
    const Indices accessors = take_attributes(document, elements);
    take_materials(document);
    take_meshes(document);
    take_data(document, asset.buffers, accessors, take_picture(document));
    return true;
}

}  // namespace surfelao
