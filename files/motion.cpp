#include "files/motion.h"

#include "files/gltf_animation.h"
#include "files/gltf_asset.h"
#include "files/gltf_io.h"
#include "files/gltf_json.h"
#include "files/gltf_mesh.h"
#include "files/gltf_model.h"
#include "files/gltf_nodes.h"
#include "files/gltf_pose.h"
#include "files/gltf_schema.h"
#include "files/scene_io.h"
#include "surfels/errors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace surfelao {
namespace {

/// A part this much smaller than its distance from the origin, or this much flatter than wide, has
/// lost too many of a double's 16 digits for its shape to be told from its positions at rest.
constexpr double kMostLost = 1e-6;

/// Extents below this share of the whole are rounding.
constexpr double kRounding = 1e-12;

/// The vertices of a mesh that deforms, as they are stored. Uses of the mesh share it.
struct SoftMesh {
    MeshVertices vertices;                     ///< without morphs
    std::vector<Displacements> displacements;  ///< of morph targets
    Influences influences;                     ///< of a skin; empty without
};

struct MovingPart {
    std::size_t node = 0;
    std::optional<std::size_t> skin;  ///< that moves it
    std::optional<GltfPlacement> instance;
    std::size_t mover = 0;             ///< rigid parts of bodies from 1: the node that moves them
    std::vector<double> mesh_weights;  ///< where the node has none
    std::shared_ptr<const SoftMesh> soft;  ///< null: rigid
};

const GltfAsset& asset_of(const Scene& scene, const char* wanted)
{
    const auto* asset = dynamic_cast<const GltfAsset*>(scene.asset.get());
    if (asset == nullptr)
        throw InputError(scene.name + ": only .gltf and .glb have " + wanted);
    return *asset;
}

/// Whether the value is the same at all keys, and is what the node has without them, as floats.
bool is_idle(const KeyFrames& keys, std::span<const double> at_rest)
{
    if (at_rest.size() != keys.width)
        return false;
    const bool is_cubic = keys.blend == KeyBlend::cubic;
    for (std::size_t i = 0; i < keys.values.size(); ++i) {
        const std::size_t slot = i / keys.width;
        // tangents of a spline that stays where it is are zero
        const bool is_tangent = is_cubic && slot % 3 != 1;
        const double wanted = is_tangent ? 0.0 : at_rest[i % keys.width];
        if (static_cast<float>(keys.values[i]) != static_cast<float>(wanted))
            return false;
    }
    return true;
}

/// What the node has of a value before anything is played.
std::vector<double> value_at_rest(const tinygltf::Node& node, NodeValue value,
                                  const std::vector<double>& mesh_weights)
{
    const auto or_else = [](const std::vector<double>& stored, std::vector<double> otherwise) {
        return stored.empty() ? otherwise : stored;
    };
    switch (value) {
        case NodeValue::translation:
            return or_else(node.translation, {0, 0, 0});
        case NodeValue::rotation:
            return or_else(node.rotation, {0, 0, 0, 1});
        case NodeValue::scale:
            return or_else(node.scale, {1, 1, 1});
        case NodeValue::weights:
            break;
    }
    return or_else(node.weights, mesh_weights);
}

/// At most a line is left of what the matrix moves.
bool leaves_nothing(const glm::dmat4& matrix)
{
    const glm::dmat3 m = scaled_to_one(glm::dmat3(matrix));
    const double area =
        std::max({glm::length(glm::cross(m[0], m[1])), glm::length(glm::cross(m[1], m[2])),
                  glm::length(glm::cross(m[2], m[0]))});
    return area <= kRounding;
}

bool is_flat(const glm::dmat4& matrix)
{
    const glm::dmat3 m = scaled_to_one(glm::dmat3(matrix));
    return !(std::abs(glm::determinant(m)) > kMostLost);
}

struct Extent {
    double size = 0.0;      ///< of the longest side
    double farthest = 0.0;  ///< largest coordinate, either way
};

Extent extent_of(std::span<const glm::dvec3> positions)
{
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const glm::dvec3& position : positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    if (positions.empty())
        return {};
    const glm::dvec3 size = high - low, farthest = glm::max(glm::abs(low), glm::abs(high));
    return {std::max({size.x, size.y, size.z}), std::max({farthest.x, farthest.y, farthest.z})};
}

}  // namespace

struct Motion::Impl {
    Impl(const Scene& rest, const std::string& wanted)
        : asset(rest.asset), gltf(asset_of(rest, "animations")), resolver(gltf)
    {
        tinygltf::Model model =
            parse_model(gltf, geometry_text(*gltf.document, gltf.path, Animations::kept));
        if (gltf.moment)
            pose_model(model, resolver, *gltf.moment);
        animation = read_animation(model, resolver, wanted);
        name = animation.name.empty() ? std::to_string(animation.number) : animation.name;
        if (animation.channels.empty())
            resolver.fail(numbered("animation", animation.number), "moves no node");
        first_seconds = std::numeric_limits<double>::infinity();
        last_seconds = -first_seconds;
        for (const KeyFrames& keys : animation.keys) {
            first_seconds = std::min(first_seconds, keys.seconds.front());
            last_seconds = std::max(last_seconds, keys.seconds.back());
        }
        world_at_rest = place_nodes(model, gltf.path).world;
        find_movers(model);
        add_parts(model, rest);
        skeleton.nodes = std::move(model.nodes);
        skeleton.skins = std::move(model.skins);
        skeleton.scenes = std::move(model.scenes);
        skeleton.defaultScene = model.defaultScene;
    }

    /// Per node the nearest one that a channel moves, from itself upwards.
    void find_movers(const tinygltf::Model& model)
    {
        constexpr std::int32_t kStill = -1;
        movers.assign(model.nodes.size(), kStill);
        morphs.assign(model.nodes.size(), false);
        std::vector<bool> is_moved(model.nodes.size(), false);
        for (const GltfAnimation::Channel& channel : animation.channels) {
            const tinygltf::Node& node = model.nodes[channel.node];
            const std::vector<double> of_mesh =
                node.mesh >= 0 ? model.meshes[static_cast<std::size_t>(node.mesh)].weights
                               : std::vector<double>();
            if (is_idle(animation.keys[channel.keys], value_at_rest(node, channel.value, of_mesh)))
                continue;
            if (channel.value == NodeValue::weights)
                morphs[channel.node] = true;
            else
                is_moved[channel.node] = true;
        }
        // place_nodes() has found a forest
        std::vector<bool> is_child(model.nodes.size(), false);
        for (const tinygltf::Node& node : model.nodes) {
            for (const int child : node.children)
                is_child[static_cast<std::size_t>(child)] = true;
        }
        std::vector<std::size_t> pending;
        const auto visit = [&](std::size_t node, std::int32_t above) {
            movers[node] = is_moved[node] ? static_cast<std::int32_t>(node) : above;
            pending.push_back(node);
        };
        for (std::size_t root = 0; root < model.nodes.size(); ++root) {
            if (!is_child[root])
                visit(root, kStill);
        }
        while (!pending.empty()) {
            const std::size_t node = pending.back();
            pending.pop_back();
            for (const int child : model.nodes[node].children)
                visit(static_cast<std::size_t>(child), movers[node]);
        }
    }

    void add_parts(const tinygltf::Model& model, const Scene& rest)
    {
        std::map<std::size_t, std::vector<Group>> meshes;
        std::map<std::tuple<char, std::size_t>, std::uint32_t> numbers;
        for (std::size_t p = 0; p < rest.parts.size(); ++p) {
            const Part& in_scene = rest.parts[p];
            const GltfUse& use = gltf.uses[gltf.parts[p].use];
            auto mesh = meshes.find(use.mesh);
            if (mesh == meshes.end())
                mesh = meshes.emplace(use.mesh, resolve_mesh(model, use.mesh, gltf)).first;
            const auto group = std::ranges::find_if(mesh->second, [&](const Group& candidate) {
                return candidate.primitives.front().index ==
                       static_cast<std::size_t>(in_scene.primitive);
            });
            add_part(model, rest, p, use, *group, numbers);
        }
    }

    void add_part(const tinygltf::Model& model, const Scene& rest, std::size_t index,
                  const GltfUse& use, const Group& group,
                  std::map<std::tuple<char, std::size_t>, std::uint32_t>& numbers)
    {
        MovingPart part;
        part.node = use.node;
        part.instance = use.instance;
        part.mesh_weights = model.meshes[use.mesh].weights;
        const int skin = model.nodes[use.node].skin;
        if (skin >= 0 && !group.influences.empty())
            part.skin = static_cast<std::size_t>(skin);
        const bool is_morphed = morphs[use.node] && !group.targets.empty();
        const std::int32_t mover = movers[use.node];
        const bool is_moved =
            part.skin ? std::ranges::any_of(
                            model.skins[*part.skin].joints,
                            [&](int joint) { return movers[static_cast<std::size_t>(joint)] >= 0; })
                      : mover >= 0;
        bool is_soft = is_morphed || (is_moved && part.skin);
        if (is_moved && !is_soft) {
            part.mover = static_cast<std::size_t>(mover);
            const Part& in_scene = rest.parts[index];
            const Extent extent = extent_of(
                std::span(rest.positions).subspan(in_scene.first_vertex, in_scene.vertex_count));
            is_soft =
                is_flat(world_at_rest[part.mover]) || extent.size < kMostLost * extent.farthest;
        }
        std::uint32_t body = 0;
        if (is_soft) {
            part.soft = soft_mesh(model, use, group, part.skin);
            const auto key = part.skin ? std::tuple{'s', *part.skin} : std::tuple{'n', part.node};
            body = numbers.try_emplace(key, count).first->second;
        } else if (is_moved) {
            body = numbers.try_emplace({'r', part.mover}, count).first->second;
        }
        count = std::max(count, body + 1);
        bodies.push_back(body);
        deforms.push_back(is_soft);
        parts.push_back(std::move(part));
    }

    std::shared_ptr<const SoftMesh> soft_mesh(const tinygltf::Model& model, const GltfUse& use,
                                              const Group& group, std::optional<std::size_t> skin)
    {
        const std::uint64_t limit = kInstancingBase + kInstancingPerByte * gltf.byte_count;
        const std::uint64_t vertices = group.positions.accessor.count;
        amount += vertices * (1 + group.targets.size() + (skin ? group.influences.size() : 0));
        if (amount > limit)
            resolver.fail(numbered("node", use.node),
                          "brings the motion to more than " + std::to_string(limit) +
                              " displacements of morph targets and skins, far more than a file of "
                              "this size may stand for");
        const std::size_t primitive = group.primitives.front().index;
        std::shared_ptr<const SoftMesh>& known = soft_meshes[{use.mesh, primitive, skin}];
        if (known)
            return known;
        const auto soft = std::make_shared<SoftMesh>();
        soft->vertices = read_vertices(group, {}, resolver);
        soft->vertices.tangents = {};
        soft->displacements = read_displacements(group, resolver);
        if (skin)
            soft->influences = read_influences(group, model.skins[*skin].joints.size(), resolver);
        known = soft;
        return known;
    }

    /// Positions in mesh space, and normals, at the node's weights.
    MeshVertices morphed(const MovingPart& part, const tinygltf::Node& node) const
    {
        MeshVertices vertices = part.soft->vertices;
        const std::vector<double>& weights =
            node.weights.empty() ? part.mesh_weights : node.weights;
        const std::vector<Displacements>& targets = part.soft->displacements;
        for (std::size_t t = 0; t < std::min(weights.size(), targets.size()); ++t) {
            if (weights[t] == 0.0)
                continue;
            if (!targets[t].positions.empty())
                add_scaled(vertices.positions, targets[t].positions, weights[t]);
            if (!targets[t].normals.empty())
                add_scaled(vertices.normals, targets[t].normals, weights[t]);
        }
        for (const std::size_t vertex : vertices.lost)
            vertices.positions[vertex] = vertices.positions[vertices.stand_in];
        return vertices;
    }

    void deform(const MovingPart& part, const tinygltf::Node& node, const glm::dmat4& world,
                std::span<const glm::dmat4> joints, PartPose& pose) const
    {
        const MeshVertices vertices = morphed(part, node);
        std::vector<glm::dmat4> matrices;
        if (part.skin)
            matrices = vertex_matrices(part.soft->influences, joints);
        else
            matrices = {part.instance ? world * matrix_of(*part.instance) : world};
        const auto matrix = [&](std::size_t vertex) -> const glm::dmat4& {
            return matrices[part.skin ? vertex : 0];
        };
        pose.positions.reserve(vertices.positions.size());
        for (std::size_t v = 0; v < vertices.positions.size(); ++v) {
            const glm::dvec3 position(matrix(v) * glm::dvec4(vertices.positions[v], 1.0));
            if (!std::isfinite(position.x + position.y + position.z))
                resolver.fail(numbered("node", part.node),
                              "moves " + numbered("vertex", v) + " to infinity");
            pose.positions.push_back(position);
        }
        const Extent extent = extent_of(pose.positions);
        pose.is_gone = extent.size <= kRounding * extent.farthest;
        std::optional<NormalMatrix> normal_matrix;
        for (std::size_t v = 0; v < vertices.normals.size(); ++v) {
            if (v == 0 || part.skin)
                normal_matrix.emplace(glm::dmat3(matrix(v)));
            pose.normals.push_back((*normal_matrix)(vertices.normals[v]));
        }
    }

    std::vector<PartPose> at(double seconds) const
    {
        tinygltf::Model model = skeleton;
        pose_nodes(model.nodes, animation, seconds);
        const std::vector<glm::dmat4> world = place_nodes(model, gltf.path).world;
        std::map<std::size_t, std::vector<glm::dmat4>> joints;
        std::vector<PartPose> poses(parts.size());
        for (std::size_t p = 0; p < parts.size(); ++p) {
            const MovingPart& part = parts[p];
            if (bodies[p] == 0)
                continue;
            if (part.soft) {
                if (part.skin && !joints.contains(*part.skin))
                    joints[*part.skin] = joint_matrices(model, *part.skin, world, resolver);
                deform(part, model.nodes[part.node], world[part.node],
                       part.skin ? joints[*part.skin] : std::vector<glm::dmat4>(), poses[p]);
                continue;
            }
            const glm::dmat4& now = world[part.mover];
            const glm::dmat4& rest = world_at_rest[part.mover];
            poses[p].is_gone = leaves_nothing(now);
            if (now == rest)
                continue;
            poses[p].from_rest = now * glm::inverse(rest);
            for (int i = 0; i < 16; ++i) {
                if (!std::isfinite(poses[p].from_rest[i / 4][i % 4]))
                    resolver.fail(numbered("node", part.mover),
                                  "is too small at rest for its motion to be a finite one");
            }
        }
        return poses;
    }

    std::shared_ptr<const SourceAsset> asset;
    const GltfAsset& gltf;  ///< the same
    AccessorResolver resolver;
    GltfAnimation animation;
    std::string name;
    double first_seconds = 0.0, last_seconds = 0.0;
    tinygltf::Model skeleton;  ///< nodes, skins and scenes
    std::vector<glm::dmat4> world_at_rest;
    std::vector<std::int32_t> movers;  ///< per node, -1: nothing moves it
    std::vector<bool> morphs;          ///< per node
    std::vector<MovingPart> parts;
    std::vector<std::uint32_t> bodies;
    std::vector<bool> deforms;
    std::uint32_t count = 1;
    std::uint64_t amount = 0;
    std::map<std::tuple<std::size_t, std::size_t, std::optional<std::size_t>>,
             std::shared_ptr<const SoftMesh>>
        soft_meshes;
};

Motion::Motion(const Scene& rest, const std::string& animation)
    : impl_(std::make_unique<const Impl>(rest, animation))
{
}
Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;
Motion& Motion::operator=(Motion&&) noexcept = default;

const std::string& Motion::name() const
{
    return impl_->name;
}

std::string Motion::text_at(double seconds) const
{
    return pose_text(impl_->animation, seconds);
}

double Motion::first_seconds() const
{
    return impl_->first_seconds;
}

double Motion::last_seconds() const
{
    return impl_->last_seconds;
}

const std::vector<std::uint32_t>& Motion::bodies() const
{
    return impl_->bodies;
}

std::uint32_t Motion::body_count() const
{
    return impl_->count;
}

const std::vector<bool>& Motion::deforms() const
{
    return impl_->deforms;
}

std::vector<PartPose> Motion::at(double seconds) const
{
    return impl_->at(seconds);
}

std::vector<std::string> animations_of(const Scene& scene)
{
    std::vector<std::string> names;
    const auto* asset = dynamic_cast<const GltfAsset*>(scene.asset.get());
    if (asset == nullptr)
        return names;
    const nlohmann::json& animations = member(*asset->document, "animations");
    if (!animations.is_array())
        return names;
    for (const nlohmann::json& animation : animations) {
        const nlohmann::json& name = member(animation, "name");
        names.push_back(name.is_string() ? name.get<std::string>() : std::string());
    }
    return names;
}

}  // namespace surfelao
