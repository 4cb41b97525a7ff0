#include "files/gltf_pose.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace surfelao {
namespace {

constexpr std::size_t kJointsInSet = 4;

/// What `read` makes of an accessor, with the element's name in what it throws.
template <typename Read>
auto read_named(const NamedAccessor& named, const AccessorResolver& resolver, Read&& read)
{
    try {
        return read(named.accessor);
    } catch (const AccessorError& error) {
        resolver.fail(named.element + ":", error.what());
    }
}

/// Which vertices the triangles of a group have. Indices out of range are refused elsewhere.
std::vector<bool> used_vertices(const Group& group, const AccessorResolver& resolver)
{
    std::vector<bool> used(group.positions.accessor.count, false);
    for (const Primitive& primitive : group.primitives) {
        const std::size_t corners = primitive.corner_count();
        if (!primitive.indices) {
            std::fill_n(used.begin(), corners, true);
            continue;
        }
        const std::vector<std::uint32_t> indices =
            read_named(*primitive.indices, resolver, read_indices);
        for (const std::uint32_t index : std::span(indices).first(corners)) {
            if (index < used.size())
                used[index] = true;
        }
    }
    return used;
}

bool is_finite(const glm::dvec3& position)
{
    return std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z);
}

/// Positions, or displacements of them. What is not finite and no triangle has becomes zero and is
/// noted in `lost`; the rest is refused.
std::vector<glm::dvec3> read_places(const NamedAccessor& named, const Group& group,
                                    const AccessorResolver& resolver, std::set<std::size_t>& lost)
{
    std::vector<glm::dvec3> places = read_named(named, resolver, read_vectors);
    if (std::ranges::all_of(places, is_finite))
        return places;
    const std::vector<bool> used = used_vertices(group, resolver);
    for (std::size_t v = 0; v < places.size(); ++v) {
        if (is_finite(places[v]))
            continue;
        if (used[v])
            resolver.fail(named.element + ":", "element " + std::to_string(v) + " is not finite");
        places[v] = glm::dvec3(0.0);
        lost.insert(v);
    }
    return places;
}

/// At unit length; zero where there is no direction.
glm::vec3 unit_or_zero(const glm::dvec3& direction)
{
    const double length = glm::length(direction);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(direction / length) : glm::vec3(0.0f);
}

}  // namespace

void add_scaled(std::vector<glm::dvec3>& sums, const std::vector<glm::dvec3>& vectors,
                double weight)
{
    for (std::size_t i = 0; i < sums.size(); ++i)
        sums[i] += weight * vectors[i];
}

MeshVertices read_vertices(const Group& group, std::span<const double> weights,
                           const AccessorResolver& resolver)
{
    MeshVertices vertices;
    std::set<std::size_t> lost;
    vertices.positions = read_places(group.positions, group, resolver, lost);
    // exporters leave NaN where triangles have no area: such a normal is none, no fault
    if (group.normals)
        vertices.normals = read_named(*group.normals, resolver, read_vectors);
    if (group.tangents)
        vertices.tangents = read_named(*group.tangents, resolver, read_quadruples);
    for (std::size_t t = 0; t < std::min(weights.size(), group.targets.size()); ++t) {
        const MorphTarget& target = group.targets[t];
        if (weights[t] == 0.0)
            continue;
        if (target.positions)
            add_scaled(vertices.positions, read_places(*target.positions, group, resolver, lost),
                       weights[t]);
        if (target.normals && group.normals)
            add_scaled(vertices.normals, read_named(*target.normals, resolver, read_vectors),
                       weights[t]);
        if (target.tangents && group.tangents) {
            const std::vector<glm::dvec3> shifts =
                read_named(*target.tangents, resolver, read_vectors);
            for (std::size_t v = 0; v < shifts.size(); ++v)
                vertices.tangents[v] += glm::dvec4(weights[t] * shifts[v], 0.0);
        }
    }
    if (!lost.empty()) {
        const std::vector<bool> used = used_vertices(group, resolver);
        const auto first = std::ranges::find(used, true) - used.begin();
        vertices.stand_in = static_cast<std::size_t>(first) % used.size();
        for (const std::size_t vertex : lost)
            vertices.positions[vertex] = vertices.positions[vertices.stand_in];
        vertices.lost.assign(lost.begin(), lost.end());
    }
    return vertices;
}

std::vector<Displacements> read_displacements(const Group& group, const AccessorResolver& resolver)
{
    std::vector<Displacements> displacements;
    std::set<std::size_t> lost;
    for (const MorphTarget& target : group.targets) {
        Displacements& added = displacements.emplace_back();
        if (target.positions)
            added.positions = read_places(*target.positions, group, resolver, lost);
        if (target.normals && group.normals)
            added.normals = read_named(*target.normals, resolver, read_vectors);
    }
    return displacements;
}

std::vector<glm::dmat4> joint_matrices(const tinygltf::Model& model, std::size_t skin,
                                       std::span<const glm::dmat4> world,
                                       const AccessorResolver& resolver)
{
    const tinygltf::Skin& source = model.skins[skin];
    std::vector<glm::dmat4> matrices;
    for (const int joint : source.joints)
        matrices.push_back(world[static_cast<std::size_t>(joint)]);
    if (source.inverseBindMatrices < 0)
        return matrices;

    NamedAccessor named = resolver.resolve(source.inverseBindMatrices,
                                           numbered("skin", skin) + " inverseBindMatrices");
    GltfAccessor& accessor = named.accessor;
    if (accessor.dimension != 16)
        resolver.fail(named.element, "is not of type MAT4");
    if (accessor.component != GltfComponent::float32 || accessor.normalized)
        resolver.fail(named.element, "is not float");
    // more than there are joints is allowed; but many skins may use one long accessor
    if (accessor.count > matrices.size() && accessor.sparse_count == 0)
        accessor.count = matrices.size();
    resolver.check_count(named, matrices.size(), "joints");
    const std::vector<double> numbers = read_named(named, resolver, read_numbers);
    for (std::size_t j = 0; j < matrices.size(); ++j) {
        glm::dmat4 inverse_bind(1.0);
        for (std::size_t i = 0; i < 16; ++i) {
            if (i % 4 != 3)  // the last row is 0 0 0 1 by definition
                inverse_bind[static_cast<int>(i / 4)][static_cast<int>(i % 4)] =
                    numbers[16 * j + i];
        }
        matrices[j] = matrices[j] * inverse_bind;
    }
    return matrices;
}

Influences read_influences(const Group& group, std::size_t joint_count,
                           const AccessorResolver& resolver)
{
    struct Numbers {
        const InfluenceSet* set;
        std::vector<double> joints, weights;
    };
    std::vector<Numbers> sets;
    for (const InfluenceSet& set : group.influences)
        sets.push_back({&set, read_named(set.joints, resolver, read_numbers),
                        read_named(set.weights, resolver, read_numbers)});
    const auto checked = [&](const InfluenceSet& set, std::size_t vertex, double number) {
        if (number >= static_cast<double>(joint_count))
            resolver.fail(set.joints.element + ":",
                          numbered("vertex", vertex) + " uses joint " +
                              std::to_string(static_cast<std::uint64_t>(number)) +
                              ", but the skin has " + std::to_string(joint_count));
        return static_cast<std::uint32_t>(number);
    };
    Influences influences;
    for (std::size_t vertex = 0; vertex < group.positions.accessor.count; ++vertex) {
        influences.first.push_back(influences.all.size());
        for (const Numbers& numbers : sets) {
            for (std::size_t i = kJointsInSet * vertex; i < kJointsInSet * (vertex + 1); ++i) {
                if (numbers.weights[i] > 0.0)  // joints without weight may be anything
                    influences.all.push_back(
                        {checked(*numbers.set, vertex, numbers.joints[i]), numbers.weights[i]});
            }
        }
        if (influences.all.size() == influences.first.back())
            influences.all.push_back(
                {checked(*sets[0].set, vertex, sets[0].joints[kJointsInSet * vertex]), 1.0});
    }
    influences.first.push_back(influences.all.size());
    return influences;
}

std::vector<glm::dmat4> vertex_matrices(const Influences& influences,
                                        std::span<const glm::dmat4> joints)
{
    std::vector<glm::dmat4> matrices;
    matrices.reserve(influences.first.size() - 1);
    for (std::size_t vertex = 0; vertex + 1 < influences.first.size(); ++vertex) {
        glm::dmat4 matrix(0.0);
        double sum = 0.0;
        for (std::size_t i = influences.first[vertex]; i < influences.first[vertex + 1]; ++i) {
            matrix += influences.all[i].weight * joints[influences.all[i].joint];
            sum += influences.all[i].weight;
        }
        matrices.push_back(matrix / sum);
    }
    return matrices;
}

glm::dmat3 scaled_to_one(const glm::dmat3& matrix)
{
    double largest = 0.0;
    for (int i = 0; i < 9; ++i)
        largest = std::max(largest, std::abs(matrix[i / 3][i % 3]));
    return largest > 0.0 ? matrix / largest : matrix;
}

NormalMatrix::NormalMatrix(const glm::dmat3& to_world)
{
    // the cofactors are the inverse transpose times the determinant: the same direction, and still
    // there where a node flattens the mesh
    const glm::dmat3 m = scaled_to_one(to_world);
    matrix_ = {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
    if (glm::determinant(m) < 0.0)
        matrix_ = -matrix_;
}

glm::vec3 NormalMatrix::operator()(const glm::dvec3& normal) const
{
    return unit_or_zero(matrix_ * normal);
}

glm::vec4 tangent_in_world(const glm::dmat3& to_world, const glm::dvec4& tangent)
{
    const glm::dmat3 m = scaled_to_one(to_world);
    const glm::vec3 direction = unit_or_zero(m * glm::dvec3(tangent));
    if (direction == glm::vec3(0.0f))
        return glm::vec4(0.0f);
    const bool is_turned = (tangent.w < 0.0) != (glm::determinant(m) < 0.0);
    return {direction, is_turned ? -1.0f : 1.0f};
}

}  // namespace surfelao
