#include "viewer/model.h"

#include "bake/surface_error.h"
#include "pixels/seen.h"
#include "surfels/surfel.h"
#include "tree/disks/octree.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

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
constexpr float kInsideMargin = 1.05f;  ///< inside of a triangle nothing bends
/// Of a point's own area: with less there are holes between points that lie at random, which the
/// masks close but a picture does not.
constexpr float kPointSplat = 2.2f;
constexpr std::size_t kMostSplatsInside = 400'000;

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

/// at: its height along up; empty: a little below all that is seen.
ShadowSquare make_ground(const std::vector<glm::vec3>& seen, glm::vec3 up, std::optional<float> at)
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

    ShadowSquare ground;
    ground.up = up;
    ground.axis_x = 2.0f * half * side;
    ground.axis_y = 2.0f * half * across;
    const glm::vec3 middle = 0.5f * (low + high);
    const float below = at ? glm::dot(middle, up) - *at : 0.5f * height + kGroundGap;
    ground.corner = middle - below * up - half * (side + across);
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

float cover_radius(glm::vec3 a, glm::vec3 b, glm::vec3 c)
{
    return cover_radius(glm::dot(c - b, c - b), glm::dot(a - c, a - c), glm::dot(b - a, b - a));
}

/// Disks inside of the triangles that need more than `most`: cut in two across their longest edge
/// until a disk about the middle of a piece is no larger. False when that makes too many.
bool cover_from_inside(const Geometry& geometry, float most, std::vector<Splat>& splats,
                       std::vector<float>& radii)
{
    struct Piece {
        glm::vec3 corner[3];
        glm::vec2 place[3];  ///< shares of the triangle's second and third vertex
    };
    std::vector<Piece> pieces;
    for (const glm::uvec3 triangle : geometry.triangles) {
        const glm::vec3 a = geometry.positions[triangle.x];
        const glm::vec3 b = geometry.positions[triangle.y];
        const glm::vec3 c = geometry.positions[triangle.z];
        if (!(cover_radius(a, b, c) > most) || glm::cross(b - a, c - a) == glm::vec3(0.0f))
            continue;
        pieces.push_back({{a, b, c}, {{0, 0}, {1, 0}, {0, 1}}});
        while (!pieces.empty()) {
            const Piece piece = pieces.back();
            pieces.pop_back();
            const glm::vec3 middle = (piece.corner[0] + piece.corner[1] + piece.corner[2]) / 3.0f;
            float radius = 0.0f;
            for (const glm::vec3& corner : piece.corner)
                radius = std::max(radius, glm::distance(corner, middle));
            if (radius <= most) {
                if (splats.size() == kMostSplatsInside)
                    return false;
                const glm::uvec2 place(glm::round(
                    65535.0f / 3.0f * (piece.place[0] + piece.place[1] + piece.place[2])));
                splats.push_back({triangle, place.x | place.y << 16});
                radii.push_back(kInsideMargin * radius);
                continue;
            }
            // across the longest edge, from corner i to i + 1
            int longest = 0;
            float length = 0.0f;
            for (int i = 0; i < 3; ++i) {
                const float edge = glm::distance(piece.corner[i], piece.corner[(i + 1) % 3]);
                if (edge > length) {
                    longest = i;
                    length = edge;
                }
            }
            const int next = (longest + 1) % 3;
            const glm::vec3 corner = 0.5f * (piece.corner[longest] + piece.corner[next]);
            const glm::vec2 place = 0.5f * (piece.place[longest] + piece.place[next]);
            for (const int replaced : {longest, next}) {
                Piece& half = pieces.emplace_back(piece);
                half.corner[replaced] = corner;
                half.place[replaced] = place;
            }
        }
    }
    return true;
}

void make_splats(Model& model, float largest)
{
    const Geometry& geometry = model.geometry();
    while (!cover_from_inside(geometry, largest, model.splats, model.splat_radii)) {
        model.splats.clear();
        model.splat_radii.clear();
        largest *= 1.5f;
    }
    const std::vector<float> radii = covering_radii(geometry, largest);
    for (const std::uint32_t vertex : model.surfels) {
        if (radii[vertex] > 0.0f) {
            model.splats.push_back({glm::uvec3(vertex), 0});
            model.splat_radii.push_back(kSplatMargin * radii[vertex]);
        }
    }
}

/// The square that shows the shadow, in the height of the ground that occludes, if any.
void add_ground(Model& model, const Offset& offset)
{
    std::optional<float> height_of_ground;
    if (model.occluding_ground)
        height_of_ground = model.occluding_ground->height;
    model.ground = make_ground(model.seen, up_direction(model.up), height_of_ground);
    const float height = offset.value_or(kMostOffset);
    const ShadowSquare& ground = model.ground;
    for (int y = 0; y <= kGroundCells; ++y) {
        for (int x = 0; x <= kGroundCells; ++x) {
            const float cell = 1.0f / static_cast<float>(kGroundCells);
            const glm::vec3 place = ground.corner + static_cast<float>(x) * cell * ground.axis_x +
                                    static_cast<float>(y) * cell * ground.axis_y;
            model.ground_receivers.push_back({place + height * ground.up, ground.up, height});
        }
    }
}

}  // namespace

glm::vec2 level_range(const Model& model)
{
    if (model.levels.empty())
        return {0.0f, 1.0f};
    const auto [low, high] = std::minmax_element(model.levels.begin(), model.levels.end());
    return {*low, std::max(*high, *low + 1.0f)};
}

std::vector<float> covering_radii(const Geometry& geometry, float most)
{
    std::vector<float> radii(geometry.positions.size(), 0.0f);
    for (const glm::uvec3 triangle : geometry.triangles) {
        const float radius =
            cover_radius(geometry.positions[triangle[0]], geometry.positions[triangle[1]],
                         geometry.positions[triangle[2]]);
        if (!(radius <= most))
            continue;
        for (int corner = 0; corner < 3; ++corner) {
            float& at_position = radii[geometry.welded[triangle[corner]]];
            at_position = std::max(at_position, radius);
        }
    }
    for (std::size_t v = 0; v < radii.size(); ++v)
        radii[v] = radii[geometry.welded[v]];
    return radii;
}

Model make_model(Mesh mesh, UpAxis up, const TargetSettings& settings, float largest_splat,
                 const std::optional<GroundPlane>& plane)
{
    Model model;
    model.mesh = std::make_shared<const Mesh>(std::move(mesh));
    model.settings = settings;
    model.target = std::make_shared<const VertexTarget>(model.mesh, settings);
    model.up = up;
    const Geometry& g = model.geometry();

    model.seen = framed_points(g);

    for (std::uint32_t v = 0; v < g.positions.size(); ++v) {
        if (g.areas[v] > 0.0f)
            model.surfels.push_back(v);
    }
    make_splats(model, largest_splat);
    model.levels = leaf_levels(build_octree(surfels_at_vertices(g)));

    const Offset offset = offset_of(settings, g.frame);
    model.points = surface_points(g, kModelPoints);
    model.point_receivers = receivers_at(g, model.mesh->surface, model.points, offset);

    model.ground_plane = plane;
    model.occluding_ground =
        ground_of(plane, {g, model.occluding()}, largest_offset_of(settings, g.frame));
    add_ground(model, offset);
    return model;
}

Model make_cloud_model(Scene scene, UpAxis up, const TargetSettings& settings,
                       const std::optional<GroundPlane>& plane)
{
    Model model;
    auto target = std::make_shared<const PointTarget>(make_point_target(scene, settings));
    const PointCloud& cloud = target->cloud;
    model.mesh = std::make_shared<const Mesh>(point_mesh(std::move(scene), target));
    model.cloud = target;
    model.settings = settings;
    model.up = up;
    model.seen = cloud.positions;
    const Geometry& geometry = model.geometry();
    // lone points are drawn as wide as others
    const auto usual =
        static_cast<float>(cloud.spacing / cloud.frame.diagonal / std::sqrt(glm::pi<double>()));
    const float least = cloud.spacing > 0.0 ? 0.0f : kLargestSplat;
    for (std::uint32_t i = 0; i < cloud.positions.size(); ++i) {
        if (geometry.areas[i] > 0.0f)
            model.surfels.push_back(i);
        const float radius = std::min(cloud.radii[i], kOutlier * usual);
        model.splats.push_back({glm::uvec3(i), 0});
        model.splat_radii.push_back(std::max(kPointSplat * radius, least));
    }
    model.levels = leaf_levels(build_octree(surfels_at_vertices(geometry)));
    model.ground_plane = plane;
    model.occluding_ground = ground_below(*target, plane);
    add_ground(model, target->offset);
    return model;
}

Model model_of(Scene scene, UpAxis up, const TargetSettings& settings, const ModelChoice& choice)
{
    check_target(scene, settings, choice.parts);
    if (scene.triangles.empty())
        return make_cloud_model(std::move(scene), up, settings, choice.ground);
    return make_model(
        mesh_of(std::move(scene), choice.others, settings.normals, choice.parts, choice.frame), up,
        settings, kLargestSplat, choice.ground);
}

}  // namespace surfelao
