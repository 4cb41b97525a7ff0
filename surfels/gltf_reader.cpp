#include "surfels/gltf_io.h"

#include "surfels/errors.h"
#include "surfels/gltf_accessor.h"
#include "surfels/gltf_asset.h"
#include "surfels/gltf_schema.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <string>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// Entries of the last row of a node's matrix may be this far from 0 0 0 1 (rounding of exporters).
constexpr double kAffineTolerance = 1e-6;

constexpr std::int32_t kNoParent = -1;

/// The checked document as tinygltf's structs. tinygltf trusts what it reads and opens files, so it
/// is handed neither more than geometry_document() lets through nor any uri.
tinygltf::Model parse_model(const GltfAsset& asset)
{
    const std::string text = geometry_document(asset.document, asset.path).dump();
    if (text.size() > std::numeric_limits<unsigned int>::max())
        fail_gltf(asset.path, "JSON", "is larger than 4 GiB");
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string error;
    std::string warning;
    if (!parser.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                    static_cast<unsigned int>(text.size()), ""))
        fail_gltf(asset.path, "", error.substr(0, error.find('\n')));
    return model;
}

std::string numbered(const char* what, std::size_t index)
{
    return std::string(what) + ' ' + std::to_string(index);
}

/// Builds the scene out of the model; holds what all steps need.
class SceneBuilder {
public:
    SceneBuilder(const tinygltf::Model& model, GltfAsset& asset, Scene& scene)
        : model_(model), asset_(asset), scene_(scene)
    {
        element_limit_ =
            std::min<std::uint64_t>(kInstancingBase + kInstancingPerByte * asset.byte_count,
                                    std::numeric_limits<std::uint32_t>::max());
    }

    void build()
    {
        const std::vector<std::int32_t> parents = find_parents();
        group_primitives();
        struct Visit {
            std::size_t node;
            glm::dmat4 parent;
        };
        std::vector<Visit> pending;
        const std::vector<std::size_t> roots = find_roots(parents);
        for (auto root = roots.rbegin(); root != roots.rend(); ++root)
            pending.push_back({*root, glm::dmat4(1.0)});
        while (!pending.empty()) {
            const Visit visit = pending.back();
            pending.pop_back();
            const tinygltf::Node& node = model_.nodes[visit.node];
            const glm::dmat4 world = visit.parent * local_matrix(visit.node);
            check_finite(world, visit.node);
            if (node.mesh >= 0)
                add_mesh(visit.node, world);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                pending.push_back({static_cast<std::size_t>(*child), world});
        }
        if (scene_.triangles.empty())
            fail_gltf(asset_.path, "", "holds no triangles");
    }

private:
    /// Primitives of one mesh that share their vertices.
    struct Group {
        std::size_t position_accessor;
        std::vector<std::size_t> primitives;
    };

    [[noreturn]] void fail(const std::string& element, const std::string& fault) const
    {
        fail_gltf(asset_.path, element, fault);
    }

    /// The parent of each node. Refuses everything that is not a forest.
    std::vector<std::int32_t> find_parents() const
    {
        std::vector<std::int32_t> parents(model_.nodes.size(), kNoParent);
        for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
            for (const int child : model_.nodes[i].children) {
                std::int32_t& parent = parents[static_cast<std::size_t>(child)];
                if (parent != kNoParent)
                    fail(numbered("node", static_cast<std::size_t>(child)),
                         "is a child of node " + std::to_string(parent) + " and again of node " +
                             std::to_string(i));
                parent = static_cast<std::int32_t>(i);
            }
        }
        // with one parent each, what no root reaches is a cycle
        std::vector<bool> reached(parents.size(), false);
        std::vector<std::size_t> pending;
        for (std::size_t i = 0; i < parents.size(); ++i) {
            if (parents[i] == kNoParent)
                pending.push_back(i);
        }
        while (!pending.empty()) {
            const std::size_t node = pending.back();
            pending.pop_back();
            reached[node] = true;
            for (const int child : model_.nodes[node].children)
                pending.push_back(static_cast<std::size_t>(child));
        }
        const auto cyclic = std::find(reached.begin(), reached.end(), false);
        if (cyclic != reached.end())
            fail(numbered("node", static_cast<std::size_t>(cyclic - reached.begin())),
                 "is on or below a cycle of nodes");
        return parents;
    }

    std::vector<std::size_t> find_roots(const std::vector<std::int32_t>& parents) const
    {
        std::vector<std::size_t> roots;
        if (model_.scenes.empty()) {
            for (std::size_t i = 0; i < parents.size(); ++i) {
                if (parents[i] == kNoParent)
                    roots.push_back(i);
            }
            return roots;
        }
        const auto scene = static_cast<std::size_t>(std::max(model_.defaultScene, 0));
        std::vector<bool> listed(parents.size(), false);
        for (const int entry : model_.scenes[scene].nodes) {
            const auto node = static_cast<std::size_t>(entry);
            if (parents[node] != kNoParent)
                fail(numbered("scene", scene), "lists " + numbered("node", node) +
                                                   ", which is a child of node " +
                                                   std::to_string(parents[node]));
            if (listed[node])
                fail(numbered("scene", scene), "lists " + numbered("node", node) + " twice");
            listed[node] = true;
            roots.push_back(node);
        }
        return roots;
    }

    glm::dmat4 local_matrix(std::size_t index) const
    {
        const tinygltf::Node& node = model_.nodes[index];
        if (!node.matrix.empty()) {
            glm::dmat4 matrix;
            for (int i = 0; i < 16; ++i)
                matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
            for (int column = 0; column < 4; ++column) {
                const double expected = column == 3 ? 1.0 : 0.0;
                if (!(std::abs(matrix[column][3] - expected) <= kAffineTolerance))
                    fail(numbered("node", index) + ": matrix",
                         "does not end in the row 0 0 0 1: it is no affine transform");
                matrix[column][3] = expected;
            }
            return matrix;
        }
        glm::dmat4 matrix(1.0);
        if (!node.rotation.empty()) {
            const std::vector<double>& r = node.rotation;
            const glm::dquat rotation(r[3], r[0], r[1], r[2]);
            const double length = glm::length(rotation);
            if (!(length > 0.0) || !std::isfinite(length))
                fail(numbered("node", index) + ": rotation", "has a length of zero or infinity");
            matrix = glm::dmat4(glm::mat3_cast(rotation / length));
        }
        if (!node.scale.empty()) {
            for (int axis = 0; axis < 3; ++axis)
                matrix[axis] *= node.scale[static_cast<std::size_t>(axis)];
        }
        if (!node.translation.empty())
            matrix[3] = {node.translation[0], node.translation[1], node.translation[2], 1.0};
        return matrix;
    }

    void check_finite(const glm::dmat4& matrix, std::size_t node) const
    {
        for (int i = 0; i < 16; ++i) {
            if (!std::isfinite(matrix[i / 4][i % 4]))
                fail(numbered("node", node), "has a transform that is not finite");
        }
    }

    void group_primitives()
    {
        groups_.resize(model_.meshes.size());
        for (std::size_t m = 0; m < model_.meshes.size(); ++m) {
            std::vector<Group>& groups = groups_[m];
            std::map<int, std::size_t> group_of;
            for (std::size_t p = 0; p < model_.meshes[m].primitives.size(); ++p) {
                const tinygltf::Primitive& primitive = model_.meshes[m].primitives[p];
                if (primitive.mode < 0 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
                    fail(numbered("mesh", m) + numbered(" primitive", p),
                         "has the unknown mode " + std::to_string(primitive.mode));
                const auto position = primitive.attributes.find("POSITION");
                // without positions there is nothing to draw, says the specification
                if (primitive.mode < TINYGLTF_MODE_TRIANGLES ||
                    position == primitive.attributes.end())
                    continue;
                const auto [entry, is_new] = group_of.try_emplace(position->second, groups.size());
                if (is_new)
                    groups.push_back({static_cast<std::size_t>(position->second), {}});
                groups[entry->second].primitives.push_back(p);
            }
        }
    }

    void add_mesh(std::size_t node, const glm::dmat4& world)
    {
        const auto mesh = static_cast<std::size_t>(model_.nodes[node].mesh);
        const bool mirrored = glm::determinant(glm::dmat3(world)) < 0.0;
        for (const Group& group : groups_[mesh]) {
            Part part;
            part.name = model_.nodes[node].name.empty() ? model_.meshes[mesh].name
                                                        : model_.nodes[node].name;
            part.node = static_cast<std::int32_t>(node);
            part.mesh = static_cast<std::int32_t>(mesh);
            part.primitive = static_cast<std::int32_t>(group.primitives.front());
            part.first_vertex = static_cast<std::uint32_t>(scene_.positions.size());
            part.first_triangle = static_cast<std::uint32_t>(scene_.triangles.size());
            add_vertices(group, mesh, node, world);
            part.vertex_count =
                static_cast<std::uint32_t>(scene_.positions.size()) - part.first_vertex;
            for (const std::size_t primitive : group.primitives) {
                add_triangles(mesh, primitive, node, part, mirrored);
                find_colors(mesh, primitive, part.vertex_count);
            }
            part.triangle_count =
                static_cast<std::uint32_t>(scene_.triangles.size()) - part.first_triangle;
            scene_.parts.push_back(std::move(part));
            asset_.part_matrices.emplace_back(world);
        }
    }

    void add_vertices(const Group& group, std::size_t mesh, std::size_t node,
                      const glm::dmat4& world)
    {
        const std::string element = numbered("mesh", mesh) +
                                    numbered(" primitive", group.primitives.front()) +
                                    numbered(" POSITION accessor", group.position_accessor);
        const GltfAccessor accessor = resolve(group.position_accessor, element);
        if (accessor.dimension != 3)
            fail(element, "is not of type VEC3");
        if (accessor.component == GltfComponent::uint32)
            fail(element, "has componentType 5125 (unsigned int), which no position may have");
        if (accessor.normalized && accessor.component == GltfComponent::float32)
            fail(element, "is float and normalized at once");
        if (accessor.count > element_limit_ - scene_.positions.size())
            fail_expanded(node, "vertices");
        const std::size_t first = scene_.positions.size();
        try {
            append_vectors(accessor, scene_.positions);
        } catch (const AccessorError& error) {
            fail(element + ":", error.what());
        }
        for (std::size_t i = first; i < scene_.positions.size(); ++i) {
            glm::dvec3& position = scene_.positions[i];
            position = glm::dvec3(world * glm::dvec4(position, 1.0));
            if (!std::isfinite(position.x + position.y + position.z))
                fail(numbered("node", node), "moves vertex " + std::to_string(i - first) + " of " +
                                                 numbered("mesh", mesh) + " to infinity");
        }
    }

    void add_triangles(std::size_t mesh, std::size_t index, std::size_t node, const Part& part,
                       bool mirrored)
    {
        const tinygltf::Primitive& primitive = model_.meshes[mesh].primitives[index];
        std::vector<std::uint32_t> indices;
        if (primitive.indices >= 0)
            indices = load_indices(mesh, index, part.vertex_count);
        const std::size_t count = primitive.indices >= 0 ? indices.size() : part.vertex_count;
        const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
        const bool strip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
        const std::size_t triangle_count = list ? count / 3 : count < 3 ? 0 : count - 2;
        if (triangle_count > element_limit_ - scene_.triangles.size())
            fail_expanded(node, "triangles");

        const auto vertex = [&](std::size_t i) {
            return part.first_vertex +
                   (primitive.indices >= 0 ? indices[i] : static_cast<std::uint32_t>(i));
        };
        scene_.triangles.reserve(scene_.triangles.size() + triangle_count);
        for (std::size_t i = 0; i < triangle_count; ++i) {
            glm::uvec3 triangle;
            if (list)
                triangle = {vertex(3 * i), vertex(3 * i + 1), vertex(3 * i + 2)};
            else if (strip)
                triangle = {vertex(i), vertex(i + 1 + i % 2), vertex(i + 2 - i % 2)};
            else
                triangle = {vertex(i + 1), vertex(i + 2), vertex(0)};
            // a strip repeats vertices to jump from one row to the next: no surface is meant
            if (strip &&
                (triangle.x == triangle.y || triangle.y == triangle.z || triangle.z == triangle.x))
                continue;
            if (mirrored)
                std::swap(triangle.y, triangle.z);
            scene_.triangles.push_back(triangle);
        }
    }

    /// Leaves word of existing vertex colours for the writer.
    void find_colors(std::size_t mesh, std::size_t index, std::size_t vertex_count)
    {
        const auto& attributes = model_.meshes[mesh].primitives[index].attributes;
        const auto color = attributes.find("COLOR_0");
        if (color == attributes.end())
            return;
        const auto accessor_index = static_cast<std::size_t>(color->second);
        const std::string element = numbered("mesh", mesh) + numbered(" primitive", index) +
                                    numbered(" COLOR_0 accessor", accessor_index);
        const GltfAccessor accessor = resolve(accessor_index, element);
        if (accessor.dimension != 3 && accessor.dimension != 4)
            fail(element, "is neither of type VEC3 nor VEC4");
        if (accessor.count != vertex_count)
            fail(element, "has " + std::to_string(accessor.count) + " elements for " +
                              std::to_string(vertex_count) + " vertices");
        asset_.colors.insert_or_assign(accessor_index, accessor);
    }

    std::vector<std::uint32_t> load_indices(std::size_t mesh, std::size_t primitive,
                                            std::size_t vertex_count) const
    {
        const auto index =
            static_cast<std::size_t>(model_.meshes[mesh].primitives[primitive].indices);
        const std::string element = numbered("mesh", mesh) + numbered(" primitive", primitive) +
                                    numbered(" indices accessor", index);
        const GltfAccessor accessor = resolve(index, element);
        if (accessor.dimension != 1)
            fail(element, "is not of type SCALAR");
        std::uint32_t restart = 0;
        switch (accessor.component) {
            case GltfComponent::uint8:
                restart = std::numeric_limits<std::uint8_t>::max();
                break;
            case GltfComponent::uint16:
                restart = std::numeric_limits<std::uint16_t>::max();
                break;
            case GltfComponent::uint32:
                restart = std::numeric_limits<std::uint32_t>::max();
                break;
            default:
                fail(element, "is not of an unsigned integer type");
        }
        if (accessor.normalized)
            fail(element, "is normalized, which no index may be");
        std::vector<std::uint32_t> indices;
        try {
            indices = read_indices(accessor);
        } catch (const AccessorError& error) {
            fail(element + ":", error.what());
        }
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (indices[i] >= vertex_count)
                fail(element + ":", "index " + std::to_string(i) + " is " +
                                        std::to_string(indices[i]) + ", but there are " +
                                        std::to_string(vertex_count) + " vertices");
            if (indices[i] == restart)
                fail(element + ":", "index " + std::to_string(i) + " is " +
                                        std::to_string(restart) +
                                        ", the primitive restart value, which glTF does not allow");
        }
        return indices;
    }

    /// Where the accessor's elements lie; everything about their place is checked here.
    GltfAccessor resolve(std::size_t index, const std::string& element) const
    {
        const tinygltf::Accessor& source = model_.accessors[index];
        GltfAccessor accessor;
        accessor.count = source.count;
        accessor.component = static_cast<GltfComponent>(source.componentType);
        accessor.dimension =
            tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(source.type));
        accessor.normalized = source.normalized;
        const std::size_t size =
            size_of(accessor.component) * static_cast<std::size_t>(accessor.dimension);
        accessor.stride = size;
        accessor.zero = source.bufferView < 0;

        if (!accessor.zero) {
            const auto view = static_cast<std::size_t>(source.bufferView);
            if (model_.bufferViews[view].byteStride != 0)
                accessor.stride = model_.bufferViews[view].byteStride;
            if (accessor.stride < size)
                fail(element, "has elements of " + std::to_string(size) + " bytes, but " +
                                  numbered("bufferView", view) + " has a byteStride of " +
                                  std::to_string(accessor.stride));
            accessor.bytes =
                slice(view, source.byteOffset, accessor.stride, size, source.count, element);
        } else if (!source.sparse.isSparse) {
            fail(element, "has neither a bufferView nor sparse values");
        }
        if (source.sparse.isSparse) {
            const auto& indices = source.sparse.indices;
            const auto& values = source.sparse.values;
            accessor.sparse_count = static_cast<std::size_t>(source.sparse.count);
            accessor.sparse_component = static_cast<GltfComponent>(indices.componentType);
            if (indices.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                indices.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                indices.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
                fail(element + " sparse indices", "are not of an unsigned integer type");
            const std::size_t index_size = size_of(accessor.sparse_component);
            accessor.sparse_indices =
                slice(static_cast<std::size_t>(indices.bufferView),
                      static_cast<std::size_t>(indices.byteOffset), index_size, index_size,
                      accessor.sparse_count, element + " sparse indices");
            accessor.sparse_values = slice(static_cast<std::size_t>(values.bufferView),
                                           static_cast<std::size_t>(values.byteOffset), size, size,
                                           accessor.sparse_count, element + " sparse values");
        }
        return accessor;
    }

    /// The bytes of a buffer view from `offset` on, which hold `count` elements of `size` bytes.
    std::string_view slice(std::size_t index, std::size_t offset, std::size_t stride,
                           std::size_t size, std::size_t count, const std::string& element) const
    {
        const tinygltf::BufferView& view = model_.bufferViews[index];
        const std::string_view buffer = asset_.buffers[static_cast<std::size_t>(view.buffer)].bytes;
        if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
            fail(element + ":", numbered("bufferView", index) + " ends at byte " +
                                    std::to_string(view.byteOffset + view.byteLength) + ", but " +
                                    numbered("buffer", static_cast<std::size_t>(view.buffer)) +
                                    " has " + std::to_string(buffer.size()));
        // count elements end at offset + stride * (count - 1) + size
        const bool fits =
            count == 0 || (offset <= view.byteLength && size <= view.byteLength - offset &&
                           count - 1 <= (view.byteLength - offset - size) / stride);
        if (!fits)
            fail(element + ":", std::to_string(count) + " elements from byte " +
                                    std::to_string(offset) + " on do not fit into " +
                                    numbered("bufferView", index) + " of " +
                                    std::to_string(view.byteLength) + " bytes");
        return count == 0 ? std::string_view() : buffer.substr(view.byteOffset + offset);
    }

    [[noreturn]] void fail_expanded(std::size_t node, const std::string& what) const
    {
        fail(numbered("node", node), "brings the scene to more than " +
                                         std::to_string(element_limit_) + ' ' + what +
                                         ", far more than a file of this size may stand for");
    }

    const tinygltf::Model& model_;
    GltfAsset& asset_;
    Scene& scene_;
    std::uint64_t element_limit_ = 0;
    std::vector<std::vector<Group>> groups_;  // per mesh
};

}  // namespace

Scene read_gltf(const fs::path& path, std::string contents)
{
    const auto asset = std::make_shared<GltfAsset>();
    load_gltf_asset(path, std::move(contents), *asset);
    const tinygltf::Model model = parse_model(*asset);
    Scene scene;
    scene.name = path.filename().string();
    SceneBuilder(model, *asset, scene).build();
    scene.asset = asset;
    return scene;
}

}  // namespace surfelao
