#include "viewer/model.h"

#include "surfels/surfel.h"
#include "tree/octree.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace surfelao {
namespace {

constexpr float kGroundGap =
    1e-3f;  // below the lowest point, so that flat undersides do not flicker

/// Disks lie in the planes of vertex normals, not of triangles: where the surface bends they need
/// to be larger than covering_radii to meet.
constexpr float kSplatMargin = 1.2f;

/// See covering_radii. Squared sides: a2 is opposite to corner A.
float cover_radius(float a2, float b2, float c2)
{
    if (a2 > c2)
        std::swap(a2, c2);
    if (b2 > c2)
        std::swap(b2, c2);
    const double a = a2, b = b2, c = c2;
    if (a + b > c) {
        const double area16 = 4.0 * a * b - (a + b - c) * (a + b - c);  // (4 * area)^2, Heron
        return static_cast<float>(std::sqrt(a * b * c / area16));
    }
    // b / (2 cos A) with cos A = (b^2 + c^2 - a^2) / (2 b c), and the same at B
    return static_cast<float>(std::sqrt(c) * std::max(b / (b + c - a), a / (a + c - b)));
}

Ground make_ground(const std::vector<glm::vec3>& seen, glm::vec3 up)
{
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const glm::vec3& p : seen) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 size = high - low;
    const float height = glm::dot(size, up);
    // half the footprint's larger side, and room for the shadow of what stands on it
    const glm::vec3 flat = size - height * up;
    const float half = 0.75f * std::max({flat.x, flat.y, flat.z}) + 0.5f * height;
    const glm::vec3 side(1.0f, 0.0f, 0.0f);
    const glm::vec3 across = glm::cross(up, side);

    Ground ground;
    ground.up = up;
    ground.axis_x = 2.0f * half * side;
    ground.axis_y = 2.0f * half * across;
    const glm::vec3 middle = 0.5f * (low + high);
    ground.corner = middle - (0.5f * height + kGroundGap) * up - half * (side + across);
    return ground;
}

/// Depth of the leaf that holds each surfel of the octree's input.
std::vector<float> leaf_levels(const Octree& octree)
{
    std::vector<float> levels(octree.source.size(), 0.0f);
    std::vector<std::uint32_t> ends;  // where the subtrees of the node's ancestors end
    for (std::uint32_t i = 0; i < octree.nodes.size(); ++i) {
        const OctreeNode& node = octree.nodes[i];
        while (!ends.empty() && ends.back() <= i)
            ends.pop_back();
        if (node.next != i + 1) {
            ends.push_back(node.next);
            continue;
        }
        for (std::uint32_t s = 0; s < node.surfel_count; ++s)
            levels[octree.source[node.first_surfel + s]] = static_cast<float>(ends.size());
    }
    return levels;
}

}  // namespace

glm::vec2 level_range(const Model& model)
{
    if (model.levels.empty())
        return {0.0f, 1.0f};
    const auto [low, high] = std::minmax_element(model.levels.begin(), model.levels.end());
    return {*low, std::max(*high, *low + 1.0f)};
}

std::vector<float> covering_radii(const Geometry& geometry)
{
    std::vector<float> radii(geometry.positions.size(), 0.0f);
    for (const glm::uvec3 triangle : geometry.triangles) {
        const glm::vec3 a = geometry.positions[triangle[0]];
        const glm::vec3 b = geometry.positions[triangle[1]];
        const glm::vec3 c = geometry.positions[triangle[2]];
        const float radius =
            cover_radius(glm::dot(c - b, c - b), glm::dot(a - c, a - c), glm::dot(b - a, b - a));
        for (int corner = 0; corner < 3; ++corner) {
            float& at_position = radii[geometry.welded[triangle[corner]]];
            at_position = std::max(at_position, radius);
        }
    }
    for (std::size_t v = 0; v < radii.size(); ++v)
        radii[v] = radii[geometry.welded[v]];
    return radii;
}

Model make_model(Geometry geometry, UpAxis up, float offset)
{
    Model model;
    model.geometry = std::move(geometry);
    model.up = up;
    const Geometry& g = model.geometry;

    std::vector<bool> is_seen(g.positions.size(), false);
    for (const glm::uvec3 triangle : g.triangles)
        for (int corner = 0; corner < 3; ++corner)
            is_seen[triangle[corner]] = true;
    for (std::size_t v = 0; v < g.positions.size(); ++v) {
        if (is_seen[v])
            model.seen.push_back(g.positions[v]);
    }
    if (model.seen.empty())
        model.seen = g.positions;

    const std::vector<float> radii = covering_radii(g);
    for (std::uint32_t v = 0; v < g.positions.size(); ++v) {
        if (g.areas[v] > 0.0f) {
            model.splats.push_back(v);
            model.splat_radii.push_back(kSplatMargin * radii[v]);
        }
    }
    model.levels = leaf_levels(build_octree(surfels_at_vertices(g)));

    model.ground = make_ground(model.seen, up_direction(up));
    model.receivers = receivers_at_vertices(g, offset);
    const Ground& ground = model.ground;
    for (int y = 0; y <= kGroundCells; ++y) {
        for (int x = 0; x <= kGroundCells; ++x) {
            const float cell = 1.0f / static_cast<float>(kGroundCells);
            const glm::vec3 place = ground.corner + static_cast<float>(x) * cell * ground.axis_x +
                                    static_cast<float>(y) * cell * ground.axis_y;
            model.receivers.push_back({place + offset * ground.up, ground.up});
        }
    }
    return model;
}

}  // namespace surfelao
