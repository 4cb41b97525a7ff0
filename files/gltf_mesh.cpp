#include "files/gltf_mesh.h"

#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

#include <map>

namespace surfelao {
namespace {

constexpr int kNone = -1;

/// The accessor of an attribute, or kNone.
int attribute(const std::map<std::string, int>& attributes, const std::string& name)
{
    const auto found = attributes.find(name);
    return found == attributes.end() ? kNone : found->second;
}

/// How many of JOINTS_0, JOINTS_1, ... there are.
std::size_t influence_set_count(const tinygltf::Primitive& primitive)
{
    std::size_t count = 0;
    while (primitive.attributes.contains("JOINTS_" + std::to_string(count)))
        ++count;
    return count;
}

/// All accessors that a group's vertices come from: equal lists, equal vertices.
std::vector<int> vertex_accessors(const tinygltf::Primitive& primitive)
{
    std::vector<int> accessors;
    for (const char* name : {"POSITION", "NORMAL", "TANGENT"}) {
        accessors.push_back(attribute(primitive.attributes, name));
        for (const auto& target : primitive.targets)
            accessors.push_back(attribute(target, name));
    }
    for (std::size_t set = 0; set < influence_set_count(primitive); ++set) {
        for (const char* name : {"JOINTS_", "WEIGHTS_"})
            accessors.push_back(attribute(primitive.attributes, name + std::to_string(set)));
    }
    accessors.push_back(static_cast<int>(primitive.targets.size()));
    return accessors;
}

class MeshResolver {
public:
    MeshResolver(const tinygltf::Model& model, std::size_t mesh, const GltfAsset& asset,
                 std::map<std::size_t, GltfAccessor>& colors,
                 std::vector<std::int32_t>& group_of_primitive)
        : model_(model),
          mesh_(mesh),
          resolver_(asset),
          colors_(colors),
          group_of_primitive_(group_of_primitive)
    {
    }

    std::vector<Group> resolve()
    {
        std::vector<Group> groups;
        std::map<std::vector<int>, std::size_t> known;
        const std::vector<tinygltf::Primitive>& primitives = model_.meshes[mesh_].primitives;
        group_of_primitive_.assign(primitives.size(), kNone);
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const tinygltf::Primitive& source = primitives[p];
            const std::string element = numbered("mesh", mesh_) + numbered(" primitive", p);
            if (source.mode > TINYGLTF_MODE_TRIANGLE_FAN)
                resolver_.fail(element, "has the unknown mode " + std::to_string(source.mode));
            // without positions there is nothing to draw, says the specification
            if (source.mode < TINYGLTF_MODE_TRIANGLES || !source.attributes.contains("POSITION"))
                continue;
            const auto [entry, is_new] = known.try_emplace(vertex_accessors(source), groups.size());
            if (is_new)
                groups.push_back(resolve_vertices(source, element));
            Group& group = groups[entry->second];
            group.primitives.push_back(
                resolve_primitive(source, p, group.positions.accessor.count, element));
            add_uvs(source, element, group, group.primitives.back());
            group_of_primitive_[p] = static_cast<std::int32_t>(group.primitives.front().index);
            find_colors(source, group.positions.accessor.count, element);
        }
        return groups;
    }

private:
    Group resolve_vertices(const tinygltf::Primitive& source, const std::string& element) const
    {
        Group group{
            positions(attribute(source.attributes, "POSITION"), element), {}, {}, {}, {}, {}, {}};
        const std::size_t count = group.positions.accessor.count;
        group.normals = directions("NORMAL", 3, source.attributes, count, element);
        group.tangents = directions("TANGENT", 4, source.attributes, count, element);
        for (std::size_t t = 0; t < source.targets.size(); ++t) {
            const std::string place = element + numbered(" target", t);
            MorphTarget target;
            if (const int index = attribute(source.targets[t], "POSITION"); index != kNone) {
                target.positions = positions(index, place);
                resolver_.check_count(*target.positions, count);
            }
            target.normals = directions("NORMAL", 3, source.targets[t], count, place);
            target.tangents = directions("TANGENT", 3, source.targets[t], count, place);
            group.targets.push_back(std::move(target));
        }
        for (std::size_t set = 0; set < influence_set_count(source); ++set)
            group.influences.push_back(influences(source, set, count, element));
        return group;
    }

    NamedAccessor positions(int index, const std::string& element) const
    {
        NamedAccessor named = resolver_.resolve(index, element + " POSITION");
        if (named.accessor.dimension != 3)
            resolver_.fail(named.element, "is not of type VEC3");
        if (named.accessor.component == GltfComponent::uint32)
            resolver_.fail(named.element,
                           "has componentType 5125 (unsigned int), which no position may have");
        return named;
    }

    /// Normals or tangents.
    std::optional<NamedAccessor> directions(const std::string& name, int dimension,
                                            const std::map<std::string, int>& attributes,
                                            std::size_t count, const std::string& element) const
    {
        const int index = attribute(attributes, name);
        if (index == kNone)
            return std::nullopt;
        NamedAccessor named = resolver_.resolve(index, element + ' ' + name);
        if (named.accessor.dimension != dimension)
            resolver_.fail(named.element, "is not of type VEC" + std::to_string(dimension));
        if (is_index_type(named.accessor.component))
            resolver_.fail(named.element, "is of an unsigned type, which no direction may be");
        resolver_.check_count(named, count);
        return named;
    }

    InfluenceSet influences(const tinygltf::Primitive& source, std::size_t set, std::size_t count,
                            const std::string& element) const
    {
        const std::string number = '_' + std::to_string(set);
        const int weights = attribute(source.attributes, "WEIGHTS" + number);
        if (weights == kNone)
            resolver_.fail(element, "has JOINTS" + number + " but no WEIGHTS" + number);
        const int joints = attribute(source.attributes, "JOINTS" + number);
        InfluenceSet influences{resolver_.resolve(joints, element + " JOINTS" + number),
                                resolver_.resolve(weights, element + " WEIGHTS" + number)};
        for (const NamedAccessor* named : {&influences.joints, &influences.weights}) {
            if (named->accessor.dimension != 4)
                resolver_.fail(named->element, "is not of type VEC4");
            resolver_.check_count(*named, count);
        }
        if (!is_index_type(influences.joints.accessor.component) ||
            influences.joints.accessor.normalized)
            resolver_.fail(influences.joints.element, "does not hold whole numbers from 0");
        const GltfComponent component = influences.weights.accessor.component;
        if (component != GltfComponent::float32 && component != GltfComponent::uint8 &&
            component != GltfComponent::uint16)
            resolver_.fail(influences.weights.element,
                           "is neither float nor a byte or short from 0");
        return influences;
    }

    void add_uvs(const tinygltf::Primitive& source, const std::string& element, Group& group,
                 Primitive& primitive) const
    {
        for (std::size_t set = 0; set < kMostUvSets; ++set) {
            const std::string name = "TEXCOORD_" + std::to_string(set);
            const int index = attribute(source.attributes, name);
            if (index == kNone)
                continue;
            NamedAccessor named = resolver_.resolve(index, element + ' ' + name);
            if (named.accessor.dimension != 2)
                resolver_.fail(named.element, "is not of type VEC2");
            resolver_.check_count(named, group.positions.accessor.count);
            primitive.uvs[set] = index;
            group.uvs[set].try_emplace(index, std::move(named));
        }
    }

    Primitive resolve_primitive(const tinygltf::Primitive& source, std::size_t index,
                                std::size_t vertex_count, const std::string& element) const
    {
        Primitive primitive{index, {}, source.mode, 0, {}};
        primitive.uvs.fill(kNoUvs);
        std::size_t count = vertex_count;
        if (source.indices >= 0) {
            primitive.indices = resolver_.resolve(source.indices, element + " indices");
            const NamedAccessor& indices = *primitive.indices;
            if (indices.accessor.dimension != 1)
                resolver_.fail(indices.element, "is not of type SCALAR");
            if (!is_index_type(indices.accessor.component))
                resolver_.fail(indices.element, "is not of an unsigned integer type");
            count = indices.accessor.count;
        }
        if (source.mode == TINYGLTF_MODE_TRIANGLES)
            primitive.triangle_count = count / 3;
        else
            primitive.triangle_count = count < 3 ? 0 : count - 2;
        return primitive;
    }

    /// Leaves word of existing vertex colours for the writer.
    void find_colors(const tinygltf::Primitive& primitive, std::size_t vertex_count,
                     const std::string& element)
    {
        const int index = attribute(primitive.attributes, "COLOR_0");
        if (index == kNone)
            return;
        const NamedAccessor named = resolver_.resolve(index, element + " COLOR_0");
        if (named.accessor.dimension != 3 && named.accessor.dimension != 4)
            resolver_.fail(named.element, "is neither of type VEC3 nor VEC4");
        resolver_.check_count(named, vertex_count);
        colors_.insert_or_assign(static_cast<std::size_t>(index), named.accessor);
    }

    const tinygltf::Model& model_;
    std::size_t mesh_;
    AccessorResolver resolver_;
    std::map<std::size_t, GltfAccessor>& colors_;
    std::vector<std::int32_t>& group_of_primitive_;
};

}  // namespace

std::size_t Primitive::corner_count() const
{
    if (mode == TINYGLTF_MODE_TRIANGLES)
        return 3 * triangle_count;
    return triangle_count == 0 ? 0 : triangle_count + 2;
}

std::vector<Group> resolve_mesh(const tinygltf::Model& model, std::size_t mesh, GltfAsset& asset)
{
    return MeshResolver(model, mesh, asset, asset.colors, asset.group_of_primitive[mesh]).resolve();
}

std::vector<Group> resolve_mesh(const tinygltf::Model& model, std::size_t mesh,
                                const GltfAsset& asset)
{
    std::map<std::size_t, GltfAccessor> colors;
    std::vector<std::int32_t> group_of_primitive;
    return MeshResolver(model, mesh, asset, colors, group_of_primitive).resolve();
}

}  // namespace surfelao
