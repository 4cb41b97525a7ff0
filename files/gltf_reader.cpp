#include "files/gltf_io.h"

#include "files/gltf_animation.h"
#include "files/gltf_asset.h"
#include "files/gltf_instances.h"
#include "files/gltf_json.h"
#include "files/gltf_mesh.h"
#include "files/gltf_model.h"
#include "files/gltf_nodes.h"
#include "files/gltf_notes.h"
#include "files/gltf_old_results.h"
#include "files/gltf_pose.h"
#include "files/gltf_schema.h"
#include "surfels/errors.h"
#include "surfels/labels.h"
#include "surfels/number_text.h"

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <nlohmann/json.hpp>

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// What a small file could multiply without end, counted before any of it is made.
class Amounts {
public:
    Amounts(const GltfAsset& asset, std::size_t mesh_count)
        : asset_(asset),
          limit_(std::min<std::uint64_t>(kInstancingBase + kInstancingPerByte * asset.byte_count,
                                         std::numeric_limits<std::uint32_t>::max())),
          mesh_bytes_(mesh_count, 0)
    {
    }

    /// Adds a node's mesh, `instances` times. Throws InputError beyond the limit.
    void add(const MeshNode& use, std::optional<std::size_t> instance_count,
             std::span<const Group> groups, std::span<const double> weights)
    {
        const std::uint64_t instances = instance_count.value_or(1);
        check(use, instances, "instances");
        add_copies(use, instances, instance_count ? node_text_size(asset_, use.node) : 0);
        for (const Group& group : groups) {
            // each factor is below 2^32 once it is checked
            const std::uint64_t vertices = group.positions.accessor.count;
            check(use, vertices, "vertices");
            check(use, vertices_ += vertices * instances, "vertices");
            for (const Primitive& primitive : group.primitives) {
                check(use, primitive.triangle_count, "triangles");
                check(use, triangles_ += primitive.triangle_count * instances, "triangles");
            }
            for (std::size_t set = 0; set < kMostUvSets; ++set)
                check(use, uvs_[set] += vertices * instances * group.uvs[set].size(),
                      "texture coordinates");
            const std::size_t targets = std::min(weights.size(), group.targets.size());
            const auto morphs =
                static_cast<std::uint64_t>(targets) -
                static_cast<std::uint64_t>(std::ranges::count(weights.first(targets), 0.0));
            const std::uint64_t sets = use.skin ? group.influences.size() : 0;
            check(use, displacements_ += vertices * (morphs + sets),
                  "displacements of morph targets and skins");
        }
    }

    std::uint64_t vertices() const { return vertices_; }
    std::uint64_t triangles() const { return triangles_; }
    /// Values of TEXCOORD_n.
    std::uint64_t uvs(std::size_t set) const { return uvs_[set]; }

private:
    void check(const MeshNode& use, std::uint64_t amount, const char* what) const
    {
        if (amount > limit_)
            fail_gltf(asset_.path, numbered("node", use.node),
                      "brings the scene to more than " + std::to_string(limit_) + ' ' + what +
                          ", far more than a file of this size may stand for");
    }

    /// The writer gives each use a copy of the mesh's JSON, and instances a node as well.
    void add_copies(const MeshNode& use, std::uint64_t instances, std::uint64_t node_bytes)
    {
        std::uint64_t& bytes = mesh_bytes_[use.mesh];
        const bool is_first = bytes == 0;
        if (is_first)
            bytes = mesh_text_size(asset_, use.mesh);
        const std::uint64_t copies = is_first && instances > 0 ? instances - 1 : instances;
        copied_bytes_ += bytes * copies + node_bytes * instances;
        if (copied_bytes_ > limit_)
            fail_gltf(asset_.path, numbered("node", use.node),
                      "repeats " + numbered("mesh", use.mesh) + " of " +
                          std::to_string(bytes + node_bytes) +
                          " bytes of JSON: there are more repetitions than a file of this size may "
                          "stand for");
    }

    const GltfAsset& asset_;
    std::uint64_t limit_;
    std::vector<std::uint64_t> mesh_bytes_;
    std::uint64_t vertices_ = 0;
    std::uint64_t triangles_ = 0;
    std::uint64_t displacements_ = 0;
    std::array<std::uint64_t, kMostUvSets> uvs_{};
    std::uint64_t copied_bytes_ = 0;
};

/// Fills the scene; holds what all steps need.
class SceneBuilder {
public:
    SceneBuilder(const tinygltf::Model& model, GltfAsset& asset, Scene& scene)
        : model_(model),
          asset_(asset),
          scene_(scene),
          resolver_(asset),
          nodes_(place_nodes(model, asset.path)),
          meshes_(model.meshes.size()),
          joints_(model.skins.size())
    {
    }

    void build()
    {
        asset_.group_of_primitive.resize(meshes_.size());
        for (const MeshNode& use : nodes_.mesh_nodes) {
            if (!meshes_[use.mesh])
                meshes_[use.mesh] = resolve_mesh(model_, use.mesh, asset_);
        }
        reserve();
        for (const MeshNode& use : nodes_.mesh_nodes) {
            first_triangles_.push_back(static_cast<std::uint32_t>(scene_.triangles.size()));
            add_uses(use);
        }
        first_triangles_.push_back(static_cast<std::uint32_t>(scene_.triangles.size()));
        if (nodes_.mesh_nodes.empty())
            fail("", nodes_.hidden_count > 0 ? "hides all that its scene holds"
                                             : "has no node with a mesh in its scene");
        if (scene_.triangles.empty())
            fail("", "has meshes of points and lines only, no triangles");
        scene_.labels = labels();
        scene_.notes = gltf_notes(asset_, nodes_);
        drop_own_corners();
        if (lost_count_ > 0)
            scene_.notes.push_back(count_text(lost_count_, "vertex|vertices") +
                                   " without a finite place, but in no triangle, passed over");
    }

private:
    [[noreturn]] void fail(const std::string& element, const std::string& fault) const
    {
        fail_gltf(asset_.path, element, fault);
    }

    /// The default weights of morph targets.
    const std::vector<double>& weights_of(const MeshNode& use) const
    {
        const std::vector<double>& weights = model_.nodes[use.node].weights;
        return weights.empty() ? model_.meshes[use.mesh].weights : weights;
    }

    /// Makes room for all uses, or refuses before any is taken.
    void reserve()
    {
        Amounts amounts(asset_, meshes_.size());
        for (const MeshNode& use : nodes_.mesh_nodes) {
            const std::vector<Group>& groups = *meshes_[use.mesh];
            const std::optional<std::size_t> instances = instance_count(model_, use, resolver_);
            amounts.add(use, instances, groups, weights_of(use));
            for (const Group& group : groups) {
                has_normals_ = has_normals_ || group.normals;
                has_tangents_ = has_tangents_ || group.tangents;
            }
        }
        scene_.positions.reserve(amounts.vertices());
        scene_.triangles.reserve(amounts.triangles());
        if (has_normals_)
            scene_.normals.values.reserve(amounts.vertices());
        if (has_tangents_)
            scene_.tangents.reserve(amounts.vertices());
        for (std::size_t set = 0; set < kMostUvSets; ++set) {
            if (amounts.uvs(set) == 0)
                continue;
            scene_.uvs.resize(set + 1);
            scene_.uvs[set].values.reserve(amounts.uvs(set));
            scene_.uvs[set].corners.reserve(amounts.triangles());
        }
    }

    /// Where all vertices have their own texture coordinates, these need no corners; sets below
    /// the last one that nobody has are empty.
    void drop_own_corners()
    {
        for (UvSet& uvs : scene_.uvs) {
            if (uvs.empty() ||
                (uvs.values.size() == scene_.positions.size() && uvs.corners == scene_.triangles))
                uvs.corners = {};
        }
    }

    /// Nodes with all that lies below them, meshes, and the materials of primitives. O(nodes +
    /// parts log parts).
    std::vector<Label> labels() const
    {
        LabelMaker maker;
        const auto add = [&](LabelKind kind, const std::string& name, std::uint32_t begin,
                             std::uint32_t end) { maker.add(kind, name, begin, end - begin); };
        for (const NodeBranch& branch : nodes_.branches)
            add(LabelKind::node, model_.nodes[branch.node].name, first_triangles_[branch.first_use],
                first_triangles_[branch.end_use]);
        for (std::size_t use = 0; use < nodes_.mesh_nodes.size(); ++use)
            add(LabelKind::mesh, model_.meshes[nodes_.mesh_nodes[use].mesh].name,
                first_triangles_[use], first_triangles_[use + 1]);
        for (const GltfPart& part : asset_.parts) {
            const nlohmann::json& primitives =
                (*asset_.document)["meshes"][asset_.uses[part.use].mesh]["primitives"];
            for (const GltfTriangles& of_primitive : part.primitives) {
                const nlohmann::json& material =
                    entry(*asset_.document, "materials",
                          member(primitives[of_primitive.primitive], "material"));
                const nlohmann::json& name = member(material, "name");
                if (name.is_string())
                    maker.add(LabelKind::material, name.get_ref<const std::string&>(),
                              of_primitive.first, of_primitive.count);
            }
        }
        return maker.finish();
    }

    /// The parts of one node: the groups of its mesh, for each instance.
    void add_uses(const MeshNode& use)
    {
        const std::vector<Group>& groups = *meshes_[use.mesh];
        const std::optional<std::size_t> instances = instance_count(model_, use, resolver_);
        if (groups.empty() || instances == std::size_t{0})
            return;
        if (!instances) {
            asset_.uses.push_back({use.node, use.mesh, {}});
            for (const Group& group : groups)
                add_part(use, group, read_vertices(group, weights_of(use), resolver_));
            return;
        }
        std::vector<MeshVertices> vertices;
        for (const Group& group : groups)
            vertices.push_back(read_vertices(group, weights_of(use), resolver_));
        for (const GltfPlacement& instance : read_instances(model_, use, resolver_)) {
            asset_.uses.push_back({use.node, use.mesh, instance});
            for (std::size_t g = 0; g < groups.size(); ++g)
                add_part(use, groups[g], vertices[g]);
        }
    }

    /// A part of the use that was added last. The vertices are taken, as a large mesh's make the
    /// peak of memory.
    void add_part(const MeshNode& use, const Group& group, MeshVertices vertices)
    {
        const std::string& node_name = model_.nodes[use.node].name;
        Part part;
        part.name = shortened(node_name.empty() ? model_.meshes[use.mesh].name : node_name);
        part.node = static_cast<std::int32_t>(use.node);
        part.mesh = static_cast<std::int32_t>(use.mesh);
        part.primitive = static_cast<std::int32_t>(group.primitives.front().index);
        part.first_vertex = static_cast<std::uint32_t>(scene_.positions.size());
        part.first_triangle = static_cast<std::uint32_t>(scene_.triangles.size());
        part.vertex_count = static_cast<std::uint32_t>(vertices.positions.size());
        lost_count_ += vertices.lost.size();
        asset_.parts.push_back({asset_.uses.size() - 1, glm::dmat3(1.0), {}, {}, {}});
        part_uvs_ = {};
        // without joints the node moves the mesh, skin or not
        if (use.skin && !group.influences.empty()) {
            const std::vector<bool> mirrored = add_skinned(use, group, vertices);
            vertices = {};
            for (const Primitive& primitive : group.primitives)
                add_triangles(group, primitive, part, [&](glm::uvec3 triangle) {
                    triangle -= part.first_vertex;
                    return mirrored[triangle.x] + mirrored[triangle.y] + mirrored[triangle.z] > 1;
                });
        } else {
            const glm::dmat4 world = world_of(use);
            part.to_world = scaled_to_one(glm::dmat3(world));
            add_rigid(use, vertices, world);
            vertices = {};
            const bool mirrored = glm::determinant(part.to_world) < 0.0;
            for (const Primitive& primitive : group.primitives)
                add_triangles(group, primitive, part, [&](glm::uvec3) { return mirrored; });
        }
        part.triangle_count =
            static_cast<std::uint32_t>(scene_.triangles.size()) - part.first_triangle;
        scene_.parts.push_back(std::move(part));
    }

    /// From the mesh of the use that was added last to the world.
    glm::dmat4 world_of(const MeshNode& use) const
    {
        const std::optional<GltfPlacement>& instance = asset_.uses.back().instance;
        const glm::dmat4& node = nodes_.world[use.node];
        return instance ? node * matrix_of(*instance) : node;
    }

    void add_rigid(const MeshNode& use, const MeshVertices& vertices, const glm::dmat4& world)
    {
        asset_.parts.back().to_world = glm::dmat3(world);
        const NormalMatrix normal_matrix{glm::dmat3(world)};
        for (std::size_t v = 0; v < vertices.positions.size(); ++v) {
            add_position(use, v, world, vertices.positions[v]);
            add_directions(vertices, v, normal_matrix, glm::dmat3(world));
        }
    }

    /// Returns which vertices' surroundings are mirrored.
    std::vector<bool> add_skinned(const MeshNode& use, const Group& group,
                                  const MeshVertices& vertices)
    {
        std::optional<std::vector<glm::dmat4>>& joints = joints_[*use.skin];
        if (!joints)
            joints = joint_matrices(model_, *use.skin, nodes_.world, resolver_);
        const std::vector<glm::dmat4> matrices =
            vertex_matrices(read_influences(group, joints->size(), resolver_), *joints);
        std::vector<bool> mirrored;
        for (std::size_t v = 0; v < matrices.size(); ++v) {
            add_position(use, v, matrices[v], vertices.positions[v]);
            const glm::dmat3 linear = scaled_to_one(glm::dmat3(matrices[v]));
            mirrored.push_back(glm::determinant(linear) < 0.0);
            asset_.parts.back().vertices_to_world.emplace_back(linear);
            add_directions(vertices, v, NormalMatrix(linear), linear);
        }
        return mirrored;
    }

    /// The vertex' normal and tangent, if the scene has any.
    void add_directions(const MeshVertices& vertices, std::size_t vertex,
                        const NormalMatrix& normal_matrix, const glm::dmat3& to_world)
    {
        if (has_normals_)
            scene_.normals.values.push_back(vertices.normals.empty()
                                                ? glm::vec3(0.0f)
                                                : normal_matrix(vertices.normals[vertex]));
        if (has_tangents_)
            scene_.tangents.push_back(vertices.tangents.empty()
                                          ? glm::vec4(0.0f)
                                          : tangent_in_world(to_world, vertices.tangents[vertex]));
    }

    void add_position(const MeshNode& use, std::size_t vertex, const glm::dmat4& world,
                      const glm::dvec3& in_mesh)
    {
        const glm::dvec3 position(world * glm::dvec4(in_mesh, 1.0));
        if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z))
            fail(numbered("node", use.node), "moves " + numbered("vertex", vertex) + " of " +
                                                 numbered("mesh", use.mesh) + " to infinity");
        scene_.positions.push_back(position);
    }

    /// Where the values of the primitive's vertices begin in each set; kNone: it has none.
    /// Primitives of the part that have an accessor in common share its values.
    std::vector<std::uint32_t> uv_begins(const Group& group, const Primitive& primitive)
    {
        std::vector<std::uint32_t> begins(scene_.uvs.size(), UvSet::kNone);
        for (std::size_t set = 0; set < begins.size(); ++set) {
            const int index = primitive.uvs[set];
            if (index == kNoUvs)
                continue;
            std::vector<glm::dvec2>& values = scene_.uvs[set].values;
            const auto [entry, is_new] =
                part_uvs_[set].try_emplace(index, static_cast<std::uint32_t>(values.size()));
            begins[set] = entry->second;
            if (!is_new)
                continue;
            const NamedAccessor& named = group.uvs[set].at(index);
            try {
                const std::vector<glm::dvec2> pairs = read_pairs(named.accessor);
                values.insert(values.end(), pairs.begin(), pairs.end());
            } catch (const AccessorError& error) {
                fail(named.element + ":", error.what());
            }
        }
        return begins;
    }

    template <typename IsMirrored>
    void add_triangles(const Group& group, const Primitive& primitive, const Part& part,
                       IsMirrored&& is_mirrored)
    {
        const std::vector<std::uint32_t> uvs = uv_begins(group, primitive);
        GltfPart& in_file = asset_.parts.back();
        const auto first = static_cast<std::uint32_t>(scene_.triangles.size());
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
            in_file.turned.push_back(is_mirrored(triangle));
            if (in_file.turned.back())
                std::swap(triangle.y, triangle.z);
            scene_.triangles.push_back(triangle);
            for (std::size_t set = 0; set < uvs.size(); ++set)
                scene_.uvs[set].corners.push_back(uvs[set] == UvSet::kNone
                                                      ? glm::uvec3(UvSet::kNone)
                                                      : triangle - part.first_vertex + uvs[set]);
        }
        const auto end = static_cast<std::uint32_t>(scene_.triangles.size());
        in_file.primitives.push_back({primitive.index, first, end - first});
    }

    std::vector<std::uint32_t> load_indices(const Primitive& primitive,
                                            std::size_t vertex_count) const
    {
        std::vector<std::uint32_t> indices;
        try {
            indices = read_indices(primitive.indices->accessor);
        } catch (const AccessorError& error) {
            fail(primitive.indices->element + ":", error.what());
        }
        const std::uint32_t restart = largest_index(primitive.indices->accessor.component);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (indices[i] >= vertex_count)
                fail(primitive.indices->element + ":",
                     "index " + std::to_string(i) + " is " + std::to_string(indices[i]) +
                         ", but there are " + std::to_string(vertex_count) + " vertices");
            if (indices[i] == restart)
                fail(primitive.indices->element + ":",
                     "index " + std::to_string(i) + " is " + std::to_string(restart) +
                         ", the primitive restart value, which glTF does not allow");
        }
        return indices;
    }

    const tinygltf::Model& model_;
    GltfAsset& asset_;
    Scene& scene_;
    AccessorResolver resolver_;
    PlacedNodes nodes_;
    bool has_normals_ = false;
    bool has_tangents_ = false;
    /// Of the part that is being added: where the values of each set's accessors begin.
    std::array<std::map<int, std::uint32_t>, kMostUvSets> part_uvs_;
    std::uint64_t lost_count_ = 0;
    std::vector<std::uint32_t> first_triangles_;  // of nodes_.mesh_nodes, and where the last ends
    std::vector<std::optional<std::vector<Group>>> meshes_;       // those that are used
    std::vector<std::optional<std::vector<glm::dmat4>>> joints_;  // per skin that is used
};

}  // namespace

Scene read_gltf(const fs::path& path, std::string contents, const std::optional<Moment>& moment,
                bool is_played)
{
    const auto asset = std::make_shared<GltfAsset>();
    load_gltf_asset(path, std::move(contents), *asset);
    const Animations animations = moment ? Animations::kept : Animations::left_out;
    std::string text = geometry_text(*asset->document, path, animations);
    if (drop_old_results(*asset))
        text = geometry_text(*asset->document, path, animations);
    tinygltf::Model model = parse_model(*asset, text);
    asset->moment = moment;
    asset->is_played = is_played || moment;
    std::string played;
    if (moment)
        played = pose_model(model, AccessorResolver(*asset), *moment);
    Scene scene;
    scene.name = path.filename().string();
    SceneBuilder(model, *asset, scene).build();
    if (moment)
        scene.notes.push_back("the pose is that of " + played);
    scene.asset = asset;
    return scene;
}

}  // namespace surfelao
