#include "files/gltf_io.h"

#include "files/gltf_accessor.h"
#include "files/gltf_asset.h"
#include "files/gltf_schema.h"
#include "surfels/errors.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <string>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// Entries of the last row of a node's matrix may be this far from 0 0 0 1 (rounding of exporters).
constexpr double kAffineTolerance = 1e-6;

constexpr std::int32_t kNoParent = -1;

/// The checked document as tinygltf's structs. tinygltf trusts what it reads and opens files, so it
/// is handed neither more than geometry_text() lets through nor any uri.
tinygltf::Model parse_model(const GltfAsset& asset)
{
    const std::string text = geometry_text(*asset.document, asset.path);
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

/// The parent of each node. Refuses everything that is not a forest.
std::vector<std::int32_t> find_parents(const tinygltf::Model& model, const fs::path& path)
{
    std::vector<std::int32_t> parents(model.nodes.size(), kNoParent);
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        for (const int child : model.nodes[i].children) {
            std::int32_t& parent = parents[static_cast<std::size_t>(child)];
            if (parent != kNoParent)
                fail_gltf(path, numbered("node", static_cast<std::size_t>(child)),
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
        for (const int child : model.nodes[node].children)
            pending.push_back(static_cast<std::size_t>(child));
    }
    const auto cyclic = std::find(reached.begin(), reached.end(), false);
    if (cyclic != reached.end())
        fail_gltf(path, numbered("node", static_cast<std::size_t>(cyclic - reached.begin())),
                  "is on or below a cycle of nodes");
    return parents;
}

/// The nodes that the scene begins with.
std::vector<std::size_t> find_roots(const tinygltf::Model& model,
                                    const std::vector<std::int32_t>& parents, const fs::path& path)
{
    std::vector<std::size_t> roots;
    if (model.scenes.empty()) {
        for (std::size_t i = 0; i < parents.size(); ++i) {
            if (parents[i] == kNoParent)
                roots.push_back(i);
        }
        return roots;
    }
    const auto scene = static_cast<std::size_t>(std::max(model.defaultScene, 0));
    std::vector<bool> listed(parents.size(), false);
    for (const int entry : model.scenes[scene].nodes) {
        const auto node = static_cast<std::size_t>(entry);
        if (parents[node] != kNoParent)
            fail_gltf(path, numbered("scene", scene),
                      "lists " + numbered("node", node) + ", which is a child of node " +
                          std::to_string(parents[node]));
        if (listed[node])
            fail_gltf(path, numbered("scene", scene), "lists " + numbered("node", node) + " twice");
        listed[node] = true;
        roots.push_back(node);
    }
    return roots;
}

/// The node's transform; its last row is exactly 0 0 0 1.
glm::dmat4 local_matrix(const tinygltf::Model& model, std::size_t index, const fs::path& path)
{
    const tinygltf::Node& node = model.nodes[index];
    if (!node.matrix.empty()) {
        glm::dmat4 matrix;
        for (int i = 0; i < 16; ++i)
            matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
        for (int column = 0; column < 4; ++column) {
            const double expected = column == 3 ? 1.0 : 0.0;
            if (!(std::abs(matrix[column][3] - expected) <= kAffineTolerance))
                fail_gltf(path, numbered("node", index) + ": matrix",
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
            fail_gltf(path, numbered("node", index) + ": rotation",
                      "has a length of zero or infinity");
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

/// A node that uses a mesh, and its transform to world space.
struct Use {
    std::size_t node;
    std::size_t mesh;
    glm::dmat4 world;
};

/// All uses in the scene, a node before its children.
std::vector<Use> find_uses(const tinygltf::Model& model, const fs::path& path)
{
    struct Visit {
        std::size_t node;
        glm::dmat4 parent;
    };
    std::vector<Use> uses;
    std::vector<Visit> pending;
    for (const std::size_t root : find_roots(model, find_parents(model, path), path))
        pending.push_back({root, glm::dmat4(1.0)});
    std::ranges::reverse(pending);
    while (!pending.empty()) {
        const Visit visit = pending.back();
        pending.pop_back();
        const tinygltf::Node& node = model.nodes[visit.node];
        const glm::dmat4 world = visit.parent * local_matrix(model, visit.node, path);
        for (int i = 0; i < 16; ++i) {
            if (!std::isfinite(world[i / 4][i % 4]))
                fail_gltf(path, numbered("node", visit.node), "has a transform that is not finite");
        }
        if (node.mesh >= 0)
            uses.push_back({visit.node, static_cast<std::size_t>(node.mesh), world});
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            pending.push_back({static_cast<std::size_t>(*child), world});
    }
    return uses;
}

/// One primitive that draws triangles.
struct Primitive {
    std::size_t index;                    // in its mesh
    std::string indices_element;          // for messages
    std::optional<GltfAccessor> indices;  // without: the vertices in order
    int mode;
    std::size_t triangle_count;
};

/// Primitives of one mesh that share their vertices: a part of the scene for each use of the mesh.
struct Group {
    std::string positions_element;
    GltfAccessor positions;
    std::vector<Primitive> primitives;
};

/// Finds and checks what a mesh is made of; reads no element yet.
class MeshResolver {
public:
    MeshResolver(const tinygltf::Model& model, GltfAsset& asset) : model_(model), asset_(asset) {}

    std::vector<Group> resolve_mesh(std::size_t mesh)
    {
        std::vector<Group> groups;
        std::map<int, std::size_t> group_of;  // by POSITION accessor
        const std::vector<tinygltf::Primitive>& primitives = model_.meshes[mesh].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const std::string element = numbered("mesh", mesh) + numbered(" primitive", p);
            const int mode = primitives[p].mode;
            if (mode > TINYGLTF_MODE_TRIANGLE_FAN)
                fail(element, "has the unknown mode " + std::to_string(mode));
            const auto position = primitives[p].attributes.find("POSITION");
            // without positions there is nothing to draw, says the specification
            if (mode < TINYGLTF_MODE_TRIANGLES || position == primitives[p].attributes.end())
                continue;
            const auto [entry, is_new] = group_of.try_emplace(position->second, groups.size());
            if (is_new)
                groups.push_back(resolve_positions(position->second, element));
            Group& group = groups[entry->second];
            group.primitives.push_back(
                resolve_primitive(primitives[p], p, group.positions.count, element));
            find_colors(primitives[p], group.positions.count, element);
        }
        return groups;
    }

private:
    [[noreturn]] void fail(const std::string& element, const std::string& fault) const
    {
        fail_gltf(asset_.path, element, fault);
    }

    Group resolve_positions(int index, const std::string& primitive) const
    {
        const auto accessor_index = static_cast<std::size_t>(index);
        const std::string element = primitive + numbered(" POSITION accessor", accessor_index);
        const GltfAccessor accessor = resolve(accessor_index, element);
        if (accessor.dimension != 3)
            fail(element, "is not of type VEC3");
        if (accessor.component == GltfComponent::uint32)
            fail(element, "has componentType 5125 (unsigned int), which no position may have");
        if (accessor.normalized && accessor.component == GltfComponent::float32)
            fail(element, "is float and normalized at once");
        return {element, accessor, {}};
    }

    Primitive resolve_primitive(const tinygltf::Primitive& source, std::size_t index,
                                std::size_t vertex_count, const std::string& element) const
    {
        Primitive primitive{index, {}, {}, source.mode, 0};
        std::size_t count = vertex_count;
        if (source.indices >= 0) {
            const auto accessor_index = static_cast<std::size_t>(source.indices);
            primitive.indices_element = element + numbered(" indices accessor", accessor_index);
            primitive.indices = resolve(accessor_index, primitive.indices_element);
            if (primitive.indices->dimension != 1)
                fail(primitive.indices_element, "is not of type SCALAR");
            if (!is_index_type(primitive.indices->component))
                fail(primitive.indices_element, "is not of an unsigned integer type");
            if (primitive.indices->normalized)
                fail(primitive.indices_element, "is normalized, which no index may be");
            count = primitive.indices->count;
        }
        if (source.mode == TINYGLTF_MODE_TRIANGLES)
            primitive.triangle_count = count / 3;
        else
            primitive.triangle_count = count < 3 ? 0 : count - 2;
        return primitive;
    }

    /// Leaves word of existing vertex colours for the writer.
    void find_colors(const tinygltf::Primitive& primitive, std::size_t vertex_count,
                     const std::string& primitive_element)
    {
        const auto color = primitive.attributes.find("COLOR_0");
        if (color == primitive.attributes.end())
            return;
        const auto accessor_index = static_cast<std::size_t>(color->second);
        const std::string element =
            primitive_element + numbered(" COLOR_0 accessor", accessor_index);
        const GltfAccessor accessor = resolve(accessor_index, element);
        if (accessor.dimension != 3 && accessor.dimension != 4)
            fail(element, "is neither of type VEC3 nor VEC4");
        if (accessor.count != vertex_count)
            fail(element, "has " + std::to_string(accessor.count) + " elements for " +
                              std::to_string(vertex_count) + " vertices");
        asset_.colors.insert_or_assign(accessor_index, accessor);
    }

    /// Where the accessor's elements lie. All that can be wrong with their place is found here.
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
            if (!is_index_type(accessor.sparse_component))
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

    const tinygltf::Model& model_;
    GltfAsset& asset_;
};

/// Fills the scene; holds what all steps need.
class SceneBuilder {
public:
    SceneBuilder(const tinygltf::Model& model, GltfAsset& asset, Scene& scene)
        : model_(model), asset_(asset), scene_(scene), meshes_(model.meshes.size())
    {
    }

    void build()
    {
        const std::vector<Use> uses = find_uses(model_, asset_.path);
        MeshResolver resolver(model_, asset_);
        for (const Use& use : uses) {
            if (!meshes_[use.mesh])
                meshes_[use.mesh] = resolver.resolve_mesh(use.mesh);
        }
        reserve(uses);
        for (const Use& use : uses) {
            for (const Group& group : *meshes_[use.mesh])
                add_part(use, group);
        }
        if (uses.empty())
            fail("", "has no node with a mesh in its scene");
        if (scene_.triangles.empty())
            fail("", "has meshes of points and lines only, no triangles");
    }

private:
    [[noreturn]] void fail(const std::string& element, const std::string& fault) const
    {
        fail_gltf(asset_.path, element, fault);
    }

    /// Makes room for all uses, or refuses before any is taken.
    void reserve(const std::vector<Use>& uses)
    {
        const std::uint64_t limit =
            std::min<std::uint64_t>(kInstancingBase + kInstancingPerByte * asset_.byte_count,
                                    std::numeric_limits<std::uint32_t>::max());
        std::uint64_t vertices = 0;
        std::uint64_t triangles = 0;
        std::uint64_t copied_bytes = 0;  // the writer gives each use a copy of the mesh's JSON
        std::vector<std::uint64_t> mesh_bytes(meshes_.size(), 0);
        for (const Use& use : uses) {
            copied_bytes += mesh_bytes[use.mesh];
            if (copied_bytes > limit)
                fail(numbered("node", use.node),
                     "repeats " + numbered("mesh", use.mesh) + " of " +
                         std::to_string(mesh_bytes[use.mesh]) +
                         " bytes of JSON: there are more repetitions than a file of this size may "
                         "stand for");
            if (mesh_bytes[use.mesh] == 0)
                mesh_bytes[use.mesh] = mesh_text_size(asset_, use.mesh);
            for (const Group& group : *meshes_[use.mesh]) {
                vertices += group.positions.count;
                for (const Primitive& primitive : group.primitives)
                    triangles += primitive.triangle_count;
                if (vertices > limit || triangles > limit)
                    fail(numbered("node", use.node),
                         "brings the scene to more than " + std::to_string(limit) +
                             (vertices > limit ? " vertices" : " triangles") +
                             ", far more than a file of this size may stand for");
            }
        }
        scene_.positions.reserve(vertices);
        scene_.triangles.reserve(triangles);
    }

    void add_part(const Use& use, const Group& group)
    {
        const std::string& node_name = model_.nodes[use.node].name;
        Part part;
        part.name = shortened(node_name.empty() ? model_.meshes[use.mesh].name : node_name);
        part.node = static_cast<std::int32_t>(use.node);
        part.mesh = static_cast<std::int32_t>(use.mesh);
        part.primitive = static_cast<std::int32_t>(group.primitives.front().index);
        part.first_vertex = static_cast<std::uint32_t>(scene_.positions.size());
        part.first_triangle = static_cast<std::uint32_t>(scene_.triangles.size());
        add_vertices(use, group);
        part.vertex_count = static_cast<std::uint32_t>(group.positions.count);
        const bool mirrored = glm::determinant(glm::dmat3(use.world)) < 0.0;
        for (const Primitive& primitive : group.primitives)
            add_triangles(primitive, part, mirrored);
        part.triangle_count =
            static_cast<std::uint32_t>(scene_.triangles.size()) - part.first_triangle;
        scene_.parts.push_back(std::move(part));
        asset_.part_matrices.emplace_back(use.world);
    }

    void add_vertices(const Use& use, const Group& group)
    {
        const std::size_t first = scene_.positions.size();
        try {
            append_vectors(group.positions, scene_.positions);
        } catch (const AccessorError& error) {
            fail(group.positions_element + ":", error.what());
        }
        for (std::size_t i = first; i < scene_.positions.size(); ++i) {
            glm::dvec3& position = scene_.positions[i];
            position = glm::dvec3(use.world * glm::dvec4(position, 1.0));
            if (!std::isfinite(position.x) || !std::isfinite(position.y) ||
                !std::isfinite(position.z))
                fail(numbered("node", use.node), "moves vertex " + std::to_string(i - first) +
                                                     " of " + numbered("mesh", use.mesh) +
                                                     " to infinity");
        }
    }

    void add_triangles(const Primitive& primitive, const Part& part, bool mirrored)
    {
        std::vector<std::uint32_t> indices;
        if (primitive.indices)
            indices = load_indices(primitive, part.vertex_count);
        const auto vertex = [&](std::size_t i) {
            return part.first_vertex +
                   (primitive.indices ? indices[i] : static_cast<std::uint32_t>(i));
        };
        const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
        const bool strip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
        for (std::size_t i = 0; i < primitive.triangle_count; ++i) {
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

    std::vector<std::uint32_t> load_indices(const Primitive& primitive,
                                            std::size_t vertex_count) const
    {
        std::vector<std::uint32_t> indices;
        try {
            indices = read_indices(*primitive.indices);
        } catch (const AccessorError& error) {
            fail(primitive.indices_element + ":", error.what());
        }
        const std::uint32_t restart = largest_index(primitive.indices->component);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (indices[i] >= vertex_count)
                fail(primitive.indices_element + ":",
                     "index " + std::to_string(i) + " is " + std::to_string(indices[i]) +
                         ", but there are " + std::to_string(vertex_count) + " vertices");
            if (indices[i] == restart)
                fail(primitive.indices_element + ":",
                     "index " + std::to_string(i) + " is " + std::to_string(restart) +
                         ", the primitive restart value, which glTF does not allow");
        }
        return indices;
    }

    const tinygltf::Model& model_;
    GltfAsset& asset_;
    Scene& scene_;
    std::vector<std::optional<std::vector<Group>>> meshes_;  // those that are used
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
