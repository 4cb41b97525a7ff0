#include "files/gltf_schema.h"

#include "files/gltf_asset.h"
#include "files/gltf_extensions.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

enum class Kind {
    size,     // whole number up to 2^53
    small,    // whole number up to 2^31 - 1: tinygltf stores an int
    index,    // entry of the section Field::into
    indices,  // array of them
    numbers,  // array of Field::length numbers; of any number of them where that is 0
    flag,
    text,
};

enum class Need { optional, required };

struct Field {
    const char* key;
    Kind kind;
    Need need = Need::optional;
    const char* into = nullptr;
    std::size_t length = 0;
};

constexpr Field kBufferView[] = {
    {"buffer", Kind::index, Need::required, "buffers"},
    {"byteOffset", Kind::size},
    {"byteLength", Kind::size, Need::required},
    {"byteStride", Kind::size},
};
constexpr Field kAccessor[] = {
    {"bufferView", Kind::index, Need::optional, "bufferViews"},
    {"byteOffset", Kind::size},
    {"componentType", Kind::small, Need::required},
    {"normalized", Kind::flag},
    {"count", Kind::size, Need::required},
    {"type", Kind::text, Need::required},
};
constexpr Field kSparse[] = {{"count", Kind::small, Need::required}};
constexpr Field kSparseIndices[] = {
    {"bufferView", Kind::index, Need::required, "bufferViews"},
    {"byteOffset", Kind::small},
    {"componentType", Kind::small, Need::required},
};
constexpr Field kSparseValues[] = {
    {"bufferView", Kind::index, Need::required, "bufferViews"},
    {"byteOffset", Kind::small},
};
constexpr Field kPrimitive[] = {
    {"indices", Kind::index, Need::optional, "accessors"},
    {"mode", Kind::small},
};
constexpr Field kAccessorIndex = {"", Kind::index, Need::optional, "accessors"};
/// For is_listed().
constexpr std::string_view kAttributes[] = {"POSITION", "NORMAL",   "TANGENT",  "COLOR_0",
                                            "JOINTS_",  "WEIGHTS_", "TEXCOORD_"};
constexpr std::string_view kTargetAttributes[] = {"POSITION", "NORMAL", "TANGENT"};
constexpr Field kNode[] = {
    {"name", Kind::text},
    {"mesh", Kind::index, Need::optional, "meshes"},
    {"skin", Kind::index, Need::optional, "skins"},
    {"weights", Kind::numbers},
    {"children", Kind::indices, Need::optional, "nodes"},
    {"matrix", Kind::numbers, Need::optional, nullptr, 16},
    {"translation", Kind::numbers, Need::optional, nullptr, 3},
    {"rotation", Kind::numbers, Need::optional, nullptr, 4},
    {"scale", Kind::numbers, Need::optional, nullptr, 3},
};
constexpr Field kMesh[] = {{"name", Kind::text}, {"weights", Kind::numbers}};
constexpr Field kSkin[] = {
    {"joints", Kind::indices, Need::required, "nodes"},
    {"inverseBindMatrices", Kind::index, Need::optional, "accessors"},
};
constexpr Field kAnimation[] = {{"name", Kind::text}};
constexpr Field kSampler[] = {
    {"input", Kind::index, Need::required, "accessors"},
    {"output", Kind::index, Need::required, "accessors"},
    {"interpolation", Kind::text},
};
constexpr Field kChannel[] = {{"sampler", Kind::small, Need::required}};
constexpr Field kTarget[] = {
    {"node", Kind::index, Need::required, "nodes"},
    {"path", Kind::text, Need::required},
};
constexpr Field kVisibility[] = {{"visible", Kind::flag}};
constexpr Field kScene[] = {{"nodes", Kind::indices, Need::optional, "nodes"}};
constexpr Field kRoot[] = {{"scene", Kind::index, Need::optional, "scenes"}};

constexpr std::string_view kTypeNames[] = {"SCALAR", "VEC2", "VEC3", "VEC4",
                                           "MAT2",   "MAT3", "MAT4"};

class Checker {
public:
    Checker(const json& document, const fs::path& path) : document_(document), path_(path) {}

    /// The listed fields of one object.
    json object(const json& value, std::span<const Field> fields, const std::string& element) const
    {
        if (!value.is_object())
            fail_gltf(path_, element, "is not an object");
        json checked = json::object();
        for (const Field& field : fields) {
            const auto found = value.find(field.key);
            if (found != value.end())
                checked[field.key] = member(*found, field, element);
            else if (field.need == Need::required)
                fail_gltf(path_, element, std::string("has no ") + field.key);
        }
        return checked;
    }

    /// Those members of an object of accessor indices whose names `wanted` lists; all where it is
    /// empty.
    json attributes(const json& value, std::span<const std::string_view> wanted,
                    const std::string& element) const
    {
        json checked = json::object();
        for (const auto& [name, accessor] : value.items()) {
            if (!wanted.empty() && !is_listed(name, wanted))
                continue;
            Field field = kAccessorIndex;
            field.key = name.c_str();
            checked[name] = member(accessor, field, element);
        }
        return checked;
    }

    /// One of the document's top-level arrays; an absent one is empty.
    const json& section(const char* name) const
    {
        static const json empty = json::array();
        const auto found = document_.find(name);
        if (found == document_.end())
            return empty;
        if (!found->is_array())
            fail_gltf(path_, name, "is not an array");
        return *found;
    }

    /// A required member that is an object of its own.
    const json& child(const json& value, const char* key, const std::string& element) const
    {
        const auto found = value.find(key);
        if (found == value.end())
            fail_gltf(path_, element, std::string("has no ") + key);
        if (!found->is_object())
            fail_gltf(path_, element + ": " + key, "is not an object");
        return *found;
    }

private:
    [[noreturn]] void fail(const std::string& element, const Field& field,
                           const std::string& fault) const
    {
        fail_gltf(path_, element.empty() ? field.key : element + ": " + field.key, fault);
    }

    json member(const json& value, const Field& field, const std::string& element) const
    {
        switch (field.kind) {
            case Kind::size:
                return whole(value, field, element, std::uint64_t{1} << 53);
            case Kind::small:
                return whole(value, field, element, std::numeric_limits<int>::max());
            case Kind::index:
                return index(value, field, element);
            case Kind::indices:
                return array(value, field, element);
            case Kind::numbers:
                return array(value, field, element);
            case Kind::flag:
                if (!value.is_boolean())
                    fail(element, field, "is not true or false");
                return value;
            case Kind::text:
                if (!value.is_string())
                    fail(element, field, "is not a string");
                return value;
        }
        return {};
    }

    std::uint64_t whole(const json& value, const Field& field, const std::string& element,
                        std::uint64_t limit) const
    {
        std::uint64_t number = 0;
        if (value.is_number_unsigned()) {
            number = value.get<std::uint64_t>();
        } else if (value.is_number_float()) {  // 3.0 and 3e0 are whole numbers too
            const double real = value.get<double>();
            if (real < 0.0 || real != std::floor(real) || real > 9.0e15)
                fail(element, field, "is not a whole number from 0");
            number = static_cast<std::uint64_t>(real);
        } else {
            fail(element, field, "is not a whole number from 0");
        }
        if (number > limit)
            fail(element, field, std::to_string(number) + " is too large");
        return number;
    }

    std::uint64_t index(const json& value, const Field& field, const std::string& element) const
    {
        const std::uint64_t number = whole(value, field, element, std::numeric_limits<int>::max());
        const std::size_t count = section(field.into).size();
        if (number >= count)
            fail(element, field,
                 std::to_string(number) + " is out of range, there are " + std::to_string(count) +
                     ' ' + field.into);
        return number;
    }

    json array(const json& value, const Field& field, const std::string& element) const
    {
        if (!value.is_array())
            fail(element, field, "is not an array");
        if (field.kind == Kind::numbers && field.length != 0 && value.size() != field.length)
            fail(element, field,
                 "has " + std::to_string(value.size()) + " numbers instead of " +
                     std::to_string(field.length));
        json checked = json::array();
        for (const json& entry : value) {
            if (field.kind == Kind::indices)
                checked.push_back(index(entry, field, element));
            else if (entry.is_number())
                checked.push_back(entry);
            else
                fail(element, field, "holds something that is not a number");
        }
        return checked;
    }

    const json& document_;
    const fs::path& path_;
};

json checked_accessor(const Checker& check, const json& value, const std::string& element,
                      const fs::path& path)
{
    json accessor = check.object(value, kAccessor, element);
    const auto& type = accessor["type"].get_ref<const std::string&>();
    if (std::ranges::find(kTypeNames, type) == std::end(kTypeNames))
        fail_gltf(path, element, "has the unknown type \"" + shortened(type) + '"');
    const auto component_type = accessor["componentType"].get<std::uint64_t>();
    if (component_type < 5120 || component_type > 5126 || component_type == 5124)
        fail_gltf(path, element, "has the unknown componentType " + std::to_string(component_type));
    if (value.contains("sparse")) {
        const json& sparse = check.child(value, "sparse", element);
        json& checked = accessor["sparse"] = check.object(sparse, kSparse, element + " sparse");
        checked["indices"] = check.object(check.child(sparse, "indices", element + " sparse"),
                                          kSparseIndices, element + " sparse indices");
        checked["values"] = check.object(check.child(sparse, "values", element + " sparse"),
                                         kSparseValues, element + " sparse values");
    }
    return accessor;
}

bool has_extension(const json& entry, const char* name)
{
    const auto extensions = entry.find("extensions");
    return extensions != entry.end() && extensions->is_object() && extensions->contains(name);
}

json checked_targets(const Checker& check, const json& value, const std::string& element,
                     const fs::path& path)
{
    if (!value.is_array())
        fail_gltf(path, element + ": targets", "is not an array");
    json targets = json::array();
    for (const json& entry : value) {
        const std::string place = element + " target " + std::to_string(targets.size());
        if (!entry.is_object())
            fail_gltf(path, place, "is not an object");
        targets.push_back(check.attributes(entry, kTargetAttributes, place));
    }
    return targets;
}

/// The extensions that say whether and where a node's mesh stands.
json checked_node(const Checker& check, const json& value, const std::string& element)
{
    json node = check.object(value, kNode, element);
    if (has_extension(value, "KHR_node_visibility"))
        node["extensions"]["KHR_node_visibility"] =
            check.object(value["extensions"]["KHR_node_visibility"], kVisibility,
                         element + " KHR_node_visibility");
    if (has_extension(value, "EXT_mesh_gpu_instancing")) {
        const std::string place = element + " EXT_mesh_gpu_instancing";
        const json& instances =
            check.child(value["extensions"], "EXT_mesh_gpu_instancing", element);
        node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] =
            check.attributes(check.child(instances, "attributes", place), {}, place);
    }
    return node;
}

json checked_mesh(const Checker& check, const json& value, const std::string& element,
                  const fs::path& path)
{
    json mesh = check.object(value, kMesh, element);
    json& primitives = mesh["primitives"] = json::array();
    const auto found = value.find("primitives");
    if (found == value.end())
        fail_gltf(path, element, "has no primitives");
    if (!found->is_array())
        fail_gltf(path, element + ": primitives", "is not an array");
    for (const json& entry : *found) {
        const std::string place = element + " primitive " + std::to_string(primitives.size());
        json primitive = check.object(entry, kPrimitive, place);
        // tinygltf would refuse it too, but not say where
        const auto indices = primitive.find("indices");
        if (indices != primitive.end() &&
            !check.section("accessors")[indices->get<std::size_t>()].contains("bufferView"))
            fail_gltf(path, place + " indices accessor " + indices->dump(), "has no bufferView");
        primitive["attributes"] = json::object();
        if (entry.contains("attributes"))
            primitive["attributes"] =
                check.attributes(check.child(entry, "attributes", place), kAttributes, place);
        if (entry.contains("targets"))
            primitive["targets"] = checked_targets(check, entry["targets"], place, path);
        // even where plain accessors stand beside it: decoders may number its vertices otherwise
        if (has_extension(entry, "KHR_draco_mesh_compression"))
            fail_gltf(path, place,
                      "is compressed by KHR_draco_mesh_compression, which is not supported");
        primitives.push_back(std::move(primitive));
    }
    return mesh;
}

/// A required member that is an array.
const json& list_of(const json& value, const char* key, const std::string& element,
                    const fs::path& path)
{
    const auto found = value.find(key);
    if (found == value.end() || !found->is_array())
        fail_gltf(path, element, std::string("has no list of ") + key);
    return *found;
}

/// Channels that move no node (their target is an extension's matter) are left out.
json checked_animation(const Checker& check, const json& value, const std::string& element,
                       const fs::path& path)
{
    json animation = check.object(value, kAnimation, element);
    json& samplers = animation["samplers"] = json::array();
    json& channels = animation["channels"] = json::array();
    for (const json& entry : list_of(value, "samplers", element, path))
        samplers.push_back(
            check.object(entry, kSampler, element + " sampler " + std::to_string(samplers.size())));
    std::size_t number = 0;
    for (const json& entry : list_of(value, "channels", element, path)) {
        const std::string place = element + " channel " + std::to_string(number++);
        json channel = check.object(entry, kChannel, place);
        if (channel["sampler"].get<std::size_t>() >= samplers.size())
            fail_gltf(path, place + ": sampler",
                      channel["sampler"].dump() + " is out of range, there are " +
                          std::to_string(samplers.size()) + " samplers");
        const json& target = check.child(entry, "target", place);
        if (!target.contains("node"))
            continue;
        channel["target"] = check.object(target, kTarget, place + " target");
        channels.push_back(std::move(channel));
    }
    return animation;
}

}  // namespace

std::string geometry_text(const json& document, const fs::path& path, Animations animations)
{
    check_required_extensions(document, path);
    const Checker check(document, path);

    json geometry = check.object(document, kRoot, "");
    geometry["asset"] = {{"version", "2.0"}};

    // calls f(value, "element 7") for each entry of a section and collects what it returns
    const auto collect = [&](const char* name, const char* element, auto&& f) {
        json& list = geometry[name] = json::array();
        for (const json& value : check.section(name))
            list.push_back(f(value, std::string(element) + ' ' + std::to_string(list.size())));
    };
    collect("bufferViews", "bufferView", [&](const json& value, const std::string& element) {
        json view = check.object(value, kBufferView, element);
        view.erase("byteStride");  // tinygltf takes fewer than there are; AccessorResolver does it
        return view;
    });
    collect("accessors", "accessor", [&](const json& value, const std::string& element) {
        return checked_accessor(check, value, element, path);
    });
    collect("meshes", "mesh", [&](const json& value, const std::string& element) {
        return checked_mesh(check, value, element, path);
    });
    collect("nodes", "node", [&](const json& value, const std::string& element) {
        return checked_node(check, value, element);
    });
    collect("skins", "skin", [&](const json& value, const std::string& element) {
        return check.object(value, kSkin, element);
    });
    collect("scenes", "scene", [&](const json& value, const std::string& element) {
        return check.object(value, kScene, element);
    });
    if (animations == Animations::kept)
        collect("animations", "animation", [&](const json& value, const std::string& element) {
            return checked_animation(check, value, element, path);
        });
    return geometry.dump();
}

}  // namespace surfelao
