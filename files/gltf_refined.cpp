#include "files/gltf_refined.h"

#include "files/gltf_cuts.h"
#include "files/gltf_json.h"
#include "files/gltf_pose.h"
#include "files/gltf_uses.h"

#include <glm/geometric.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace surfelao {
namespace {

using nlohmann::json;

/// New vertices by the numbers that they and their parents have in their parts.
struct PartMiddles {
    PartMiddles(const Scene& scene, const Refinement& refinement)
        : of_part(scene.parts.size()),
          number_of(scene.positions.size()),
          part_of(scene.positions.size())
    {
        for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
            const Part& part = scene.parts[p];
            for (std::uint32_t v = 0; v < part.vertex_count; ++v) {
                part_of[part.first_vertex + v] = p;
                number_of[part.first_vertex + v] = v;
            }
        }
        for (const glm::uvec2& of : refinement.parents) {
            const std::uint32_t part = part_of[of.x];
            part_of.push_back(part);
            number_of.push_back(scene.parts[part].vertex_count +
                                static_cast<std::uint32_t>(of_part[part].size()));
            of_part[part].emplace_back(number_of[of.x], number_of[of.y]);
        }
    }

    std::vector<std::vector<glm::uvec2>> of_part;
    std::vector<std::uint32_t> number_of, part_of;  ///< per vertex of the refined scene
};

/// World directions at the vertices as normals of each part's mesh space. A normal n becomes M^-T n
/// in the world, so what comes back is M^T n. A part has none where all of its are zero, else
/// vertices without (no triangle uses them) have some.
std::vector<std::vector<float>> part_normals(const GltfAsset& asset, const PartMiddles& middles,
                                             std::span<const glm::vec3> normals)
{
    std::vector<glm::dmat3> to_world;
    for (const GltfPart& part : asset.parts)
        to_world.push_back(scaled_to_one(part.to_world));
    std::vector<std::vector<float>> of_part(asset.parts.size());
    std::vector<bool> has_any(asset.parts.size(), false);
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const std::uint32_t p = middles.part_of[v];
        const glm::dvec3 direction = glm::dvec3(normals[v]) * to_world[p];
        const double length = glm::length(direction);
        const glm::vec3 unit = length > 0.0 ? glm::vec3(direction / length) : glm::vec3(0, 0, 1);
        has_any[p] = has_any[p] || length > 0.0;
        of_part[p].insert(of_part[p].end(), {unit.x, unit.y, unit.z});
    }
    for (std::size_t p = 0; p < of_part.size(); ++p) {
        if (!has_any[p])
            of_part[p].clear();
    }
    return of_part;
}

/// The numbers of an element as they stand in the file.
using Components = std::array<double, 4>;

template <class Number>
double load_component(const char* at)
{
    Number number;
    std::memcpy(&number, at, sizeof number);
    return number;
}

template <class Number>
void store_component(std::string& bytes, double value)
{
    const auto number = static_cast<Number>(value);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

Components load(const GltfAccessor& accessor, const char* at)
{
    Components numbers{};
    for (int k = 0; k < accessor.dimension; ++k, at += size_of(accessor.component)) {
        double& number = numbers[static_cast<std::size_t>(k)];
        switch (accessor.component) {
            case GltfComponent::int8:
                number = load_component<std::int8_t>(at);
                break;
            case GltfComponent::uint8:
                number = load_component<std::uint8_t>(at);
                break;
            case GltfComponent::int16:
                number = load_component<std::int16_t>(at);
                break;
            case GltfComponent::uint16:
                number = load_component<std::uint16_t>(at);
                break;
            case GltfComponent::uint32:
                number = load_component<std::uint32_t>(at);
                break;
            case GltfComponent::float32:
                number = load_component<float>(at);
                break;
        }
    }
    return numbers;
}

void store(std::string& bytes, const GltfAccessor& accessor, const Components& numbers)
{
    for (int k = 0; k < accessor.dimension; ++k) {
        const double number = numbers[static_cast<std::size_t>(k)];
        switch (accessor.component) {
            case GltfComponent::int8:
                store_component<std::int8_t>(bytes, std::round(number));
                break;
            case GltfComponent::uint8:
                store_component<std::uint8_t>(bytes, std::round(number));
                break;
            case GltfComponent::int16:
                store_component<std::int16_t>(bytes, std::round(number));
                break;
            case GltfComponent::uint16:
                store_component<std::uint16_t>(bytes, std::round(number));
                break;
            case GltfComponent::uint32:
                store_component<std::uint32_t>(bytes, std::round(number));
                break;
            case GltfComponent::float32:
                store_component<float>(bytes, number);
                break;
        }
    }
}

/// What is meant by the middle of two elements of an attribute.
enum class Meaning { number, direction, identity };

Meaning meaning_of(std::string_view attribute)
{
    if (attribute == "NORMAL" || attribute == "TANGENT")
        return Meaning::direction;
    for (const std::string_view name : {"_FEATURE_ID_", "JOINTS_", "WEIGHTS_"}) {
        if (attribute.starts_with(name))
            return Meaning::identity;
    }
    return Meaning::number;
}

/// The last number of a TANGENT, a sign, is the first one's.
Components middle_of(const Components& a, const Components& b, Meaning meaning)
{
    Components middle = a;
    if (meaning == Meaning::number) {
        for (std::size_t k = 0; k < middle.size(); ++k)
            middle[k] = 0.5 * a[k] + 0.5 * b[k];
    } else if (meaning == Meaning::direction) {
        const glm::dvec3 direction = middle_direction({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
        std::copy_n(&direction.x, 3, middle.begin());
    }
    return middle;
}

class MeshRefiner {
public:
    MeshRefiner(json& document, const GltfAsset& asset, const Scene& scene,
                const Refinement& refinement, std::span<const glm::vec3> normals, AddedData& added)
        : document_(document),
          asset_(asset),
          scene_(scene),
          refinement_(refinement),
          added_(added),
          elements_(asset),
          middles_(scene, refinement),
          normals_(part_normals(asset, middles_, normals))
    {
    }

    void refine()
    {
        const std::vector<std::size_t> meshes =
            separate_uses(document_, asset_.uses, uses_to_cut());
        for (std::size_t p = 0; p < scene_.parts.size(); ++p) {
            if (!is_changed(p))
                continue;
            refine_part(p, document_["meshes"][meshes[asset_.parts[p].use]]["primitives"]);
        }
    }

private:
    [[nodiscard]] bool is_changed(std::size_t part) const
    {
        return !middles_.of_part[part].empty() || !normals_[part].empty();
    }

    /// Those of which a part is cut, and the other instances of their nodes, which stay in order.
    [[nodiscard]] std::vector<bool> uses_to_cut() const
    {
        std::vector<bool> wanted(asset_.uses.size(), false);
        std::set<std::size_t> nodes;
        for (std::size_t p = 0; p < scene_.parts.size(); ++p) {
            if (is_changed(p))
                nodes.insert(asset_.uses[asset_.parts[p].use].node);
        }
        for (std::size_t u = 0; u < wanted.size(); ++u)
            wanted[u] = nodes.contains(asset_.uses[u].node);
        return wanted;
    }

    /// primitives: of the mesh. Those that share the part's vertices go on sharing them.
    void refine_part(std::size_t p, json& primitives)
    {
        const Part& part = scene_.parts[p];
        extended_.clear();
        std::optional<std::size_t> normals;
        if (!normals_[p].empty())
            normals = added_.add_floats(3, normals_[p]);
        const std::vector<std::int32_t>& groups =
            asset_.group_of_primitive[static_cast<std::size_t>(part.mesh)];
        for (std::size_t i = 0; i < groups.size(); ++i) {
            if (groups[i] != part.primitive)
                continue;
            const std::string name =
                numbered("mesh", static_cast<std::size_t>(part.mesh)) + numbered(" primitive", i);
            json& primitive = primitives[i];
            extend(primitive["attributes"], name, p, /*is_base=*/true);
            if (normals)
                primitive["attributes"]["NORMAL"] = *normals;
            if (primitive.contains("targets")) {
                for (json& target : primitive["targets"])
                    extend(target, name + " target", p, /*is_base=*/false);
            }
        }
        for (const GltfTriangles& triangles : asset_.parts[p].primitives) {
            if (triangles.count > 0)
                set_indices(primitives[triangles.primitive], p, triangles);
        }
    }

    /// is_base: not displacements, which are no directions.
    void extend(json& attributes, const std::string& user, std::size_t p, bool is_base)
    {
        if (!attributes.is_object())
            return;
        for (auto& [name, index] : attributes.items()) {
            if (index.is_null())
                continue;
            const auto known = index.is_number_unsigned()
                                   ? extended_.find({index.get<std::size_t>(), name})
                                   : extended_.end();
            if (known != extended_.end()) {
                index = known->second;
                continue;
            }
            const Meaning meaning = is_base ? meaning_of(name) : Meaning::number;
            const json old = index;
            index = extended(old, user + ' ' + name, p, meaning, name == "POSITION");
            extended_[{old.get<std::size_t>(), name}] = index;
        }
    }

    std::size_t extended(const json& index, const std::string& user, std::size_t p, Meaning meaning,
                         bool is_position)
    {
        GltfElements::Bytes read = elements_.read(index, user);
        elements_.check_count(read.named, scene_.parts[p].vertex_count);
        json entry = document_["accessors"][index.get<std::size_t>()];
        for (const char* key : {"bufferView", "byteOffset", "sparse"})
            entry.erase(key);
        GltfAccessor& accessor = read.named.accessor;
        if (is_position && accessor.component != GltfComponent::float32)
            make_floats(read, entry);
        else if (!is_position)
            entry.erase("min"), entry.erase("max");
        const std::size_t size = accessor.element_bytes;
        const bool is_vector =
            accessor.dimension <= 4 &&
            size == static_cast<std::size_t>(accessor.dimension) * size_of(accessor.component);
        for (const glm::uvec2& of : middles_.of_part[p]) {
            if (is_vector)
                store(read.bytes, accessor,
                      middle_of(load(accessor, read.bytes.data() + of.x * size),
                                load(accessor, read.bytes.data() + of.y * size), meaning));
            else
                read.bytes.append(read.bytes, of.x * size, size);
        }
        return added_.add_elements(std::move(entry), read.bytes, size);
    }

    /// Of positions that are whole numbers.
    static void make_floats(GltfElements::Bytes& read, json& entry)
    {
        GltfAccessor& accessor = read.named.accessor;
        const std::size_t size = accessor.element_bytes;
        GltfAccessor floats;
        floats.component = GltfComponent::float32;
        floats.dimension = accessor.dimension;
        floats.element_bytes = 4 * static_cast<std::size_t>(accessor.dimension);
        GltfAccessor one = accessor;  // element by element, as they lie close together now
        one.count = 1;
        one.stride = size;
        one.zero = false;
        one.sparse_count = 0;
        std::string bytes;
        std::array<double, 3> low{}, high{};
        for (std::size_t v = 0; v < accessor.count; ++v) {
            one.bytes = std::string_view(read.bytes).substr(v * size, size);
            const std::vector<double> numbers = read_numbers(one);
            Components components{};
            for (std::size_t k = 0; k < 3; ++k) {
                components[k] = static_cast<float>(numbers[k]);
                low[k] = v == 0 ? components[k] : std::min(low[k], components[k]);
                high[k] = v == 0 ? components[k] : std::max(high[k], components[k]);
            }
            store(bytes, floats, components);
        }
        entry.erase("normalized");
        entry["componentType"] = static_cast<int>(GltfComponent::float32);
        entry["min"] = low;
        entry["max"] = high;
        read.bytes = std::move(bytes);
        accessor = floats;
    }

    void set_indices(json& primitive, std::size_t p, const GltfTriangles& triangles)
    {
        const Part& part = scene_.parts[p];
        std::vector<std::uint32_t> indices;
        for (std::uint32_t t = triangles.first; t < triangles.first + triangles.count; ++t) {
            const bool turned = asset_.parts[p].turned[t - part.first_triangle];
            for (const glm::uvec3& piece : refinement_.pieces_of(t)) {
                const glm::uvec3 wound = turned ? glm::uvec3(piece.x, piece.z, piece.y) : piece;
                for (int k = 0; k < 3; ++k)
                    indices.push_back(middles_.number_of[wound[k]]);
            }
        }
        primitive["indices"] =
            added_.add_indices(indices, part.vertex_count + middles_.of_part[p].size());
        primitive.erase("mode");  // triangles
    }

    json& document_;
    const GltfAsset& asset_;
    const Scene& scene_;
    const Refinement& refinement_;
    AddedData& added_;
    GltfElements elements_;
    PartMiddles middles_;
    std::vector<std::vector<float>> normals_;  ///< of each part that gets some
    /// Of the part at hand: by accessor and attribute.
    std::map<std::pair<std::size_t, std::string>, std::size_t> extended_;
};

}  // namespace

void refine_meshes(json& document, const GltfAsset& asset, const Scene& scene,
                   const Refinement& refinement, std::span<const glm::vec3> normals,
                   AddedData& added)
{
    MeshRefiner(document, asset, scene, refinement, normals, added).refine();
}

}  // namespace surfelao
