#include "moving_stage.h"

#include "surfels/surface.h"
#include "tests/scenes.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

namespace surfelao {
namespace {

using scenes::operator+;
using scenes::operator+=;

/// From places in the world to places in the unit frame.
Placement in_frame(const Placement& world, const Frame& frame)
{
    return {world.rotation, world.scale,
            (placed_point(frame.centre, world) - frame.centre) / frame.diagonal};
}

glm::dmat3 about_x(double angle)
{
    const double c = std::cos(angle), s = std::sin(angle);
    return {{1.0, 0.0, 0.0}, {0.0, c, s}, {0.0, -s, c}};
}

Placement turned_about(glm::dvec3 joint, const glm::dmat3& rotation)
{
    return {rotation, 1.0, joint - rotation * joint};
}

/// The triangles alone, as one part: no normals, looks or nodes of a file.
Scene bare(const Scene& scene)
{
    Scene result;
    result.positions = scene.positions;
    result.triangles = scene.triangles;
    Part part;
    part.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    part.triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
    result.parts = {part};
    return result;
}

}  // namespace

MovingStage::MovingStage(std::string title, const std::vector<Scene>& parts,
                         const std::vector<std::vector<Placement>>& world_poses, float crease)
    : name(std::move(title))
{
    Scene scene;
    std::vector<std::uint32_t> body_of_scene_triangle;
    Box box;
    for (std::uint32_t b = 0; b < parts.size(); ++b) {
        scene = b == 0 ? bare(parts[b]) : scene + bare(parts[b]);
        body_of_scene_triangle.insert(body_of_scene_triangle.end(), parts[b].triangles.size(), b);
        body_of_vertex.insert(body_of_vertex.end(), parts[b].positions.size(), b);
        for (const std::vector<Placement>& pose : world_poses)
            for (const glm::dvec3 p : parts[b].positions)
                box.include(placed_point(p, pose[b]));
    }
    geometry = make_geometry(scene, {.frame = frame_of(box)});
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t)
        body_of_triangle.push_back(body_of_scene_triangle[geometry.scene_triangle(t)]);
    const Surface surface = make_surface(scene, geometry, {.crease = crease});
    receivers = receivers_at_wedges(geometry, surface);
    corners = surface.corners(geometry);
    for (std::uint32_t wedge = 0; wedge < receivers.size(); ++wedge)
        body_of_receiver.push_back(body_of_vertex[surface.vertex_of(wedge)]);
    for (const std::vector<Placement>& pose : world_poses) {
        poses.emplace_back();
        for (const Placement& placement : pose)
            poses.back().push_back(in_frame(placement, geometry.frame));
    }

    std::vector<glm::vec3> low(parts.size(), glm::vec3(1.0f)), high(parts.size(), glm::vec3(-1.0f));
    for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
        const std::uint32_t b = body_of_vertex[v];
        low[b] = glm::min(low[b], geometry.positions[v]);
        high[b] = glm::max(high[b], geometry.positions[v]);
    }
    for (std::size_t b = 0; b < parts.size(); ++b)
        balls_.push_back({0.5f * (low[b] + high[b]), 0.5f * glm::distance(low[b], high[b])});

    std::vector<std::set<std::uint32_t>> around(receivers.size());
    for (const glm::uvec3 t : corners) {
        for (int corner = 0; corner < 3; ++corner) {
            around[t[corner]].insert(t[(corner + 1) % 3]);
            around[t[corner]].insert(t[(corner + 2) % 3]);
        }
    }
    first_neighbour_.push_back(0);
    for (const std::set<std::uint32_t>& each : around) {
        neighbours_.insert(neighbours_.end(), each.begin(), each.end());
        first_neighbour_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
    }
}

const Placement& MovingStage::pose(std::uint32_t body, int frame) const
{
    return poses[static_cast<std::size_t>(frame) % poses.size()][body];
}

void MovingStage::place(MovingScene& scene, int frame) const
{
    for (std::uint32_t body = 1; body < bodies(); ++body)
        scene.place(body, pose(body, frame));
}

Receiver MovingStage::receiver_at(std::size_t receiver, int frame) const
{
    const std::uint32_t body = body_of_receiver[receiver];
    return body == 0 ? receivers[receiver] : placed(receivers[receiver], pose(body, frame));
}

Geometry MovingStage::geometry_at(int frame) const
{
    Geometry moved = geometry;
    for (std::size_t v = 0; v < moved.positions.size(); ++v) {
        const std::uint32_t body = body_of_vertex[v];
        if (body == 0)
            continue;
        const Receiver vertex =
            placed({geometry.positions[v], geometry.normals[v], 0.0f}, pose(body, frame));
        moved.positions[v] = vertex.position;
        moved.normals[v] = vertex.normal;
    }
    return moved;
}

bool MovingStage::is_untouched(std::size_t receiver, int frame) const
{
    const float limit = std::sqrt(MovingSettings().tolerance);
    for (std::uint32_t body = 1; is_static(receiver) && body < bodies(); ++body) {
        const glm::vec3 centre =
            placed({balls_[body].centre, {}, 0.0f}, pose(body, frame)).position;
        if (balls_[body].radius > limit * glm::distance(centre, receivers[receiver].position))
            return false;
    }
    return is_static(receiver);
}

void MovingStage::smooth(std::vector<Occlusion>& answers, int passes) const
{
    std::vector<float> from(answers.size()), to(answers.size());
    for (std::size_t i = 0; i < answers.size(); ++i)
        to[i] = answers[i].occlusion;
    for (int pass = 0; pass < passes; ++pass) {
        std::swap(from, to);
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, to.size(), 4096), [&](const auto& some) {
                for (std::size_t i = some.begin(); i < some.end(); ++i) {
                    const std::uint32_t begin = first_neighbour_[i], end = first_neighbour_[i + 1];
                    float sum = 0.0f;
                    for (std::uint32_t k = begin; k < end; ++k)
                        sum += from[neighbours_[k]];
                    to[i] = begin == end ? from[i]
                                         : 0.5f * (from[i] + sum / static_cast<float>(end - begin));
                }
            });
    }
    for (std::size_t i = 0; i < answers.size(); ++i)
        answers[i].occlusion = to[i];
}

void MovingStage::draw(std::span<const Occlusion> answers, int frame, glm::ivec2 corner,
                       glm::ivec2 size, Image& image) const
{
    const glm::vec3 ahead = glm::normalize(glm::vec3(-0.6f, 0.75f, -0.28f));
    const glm::vec3 right = glm::normalize(glm::cross(ahead, glm::vec3(0.0f, 0.0f, 1.0f)));
    const glm::vec3 up = glm::cross(right, ahead);
    const float scale = 1.22f * static_cast<float>(size.y);  // pixels a diagonal
    std::vector<glm::vec3> seen(receivers.size());           // x and y in pixels, depth
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const glm::vec3 p = receiver_at(i, frame).position;
        seen[i] = {0.5f * static_cast<float>(size.x) + scale * glm::dot(p, right),
                   0.55f * static_cast<float>(size.y) - scale * glm::dot(p, up),
                   glm::dot(p, ahead)};
    }
    std::vector<float> depth(static_cast<std::size_t>(size.x * size.y),
                             std::numeric_limits<float>::max());
    const auto area = [](glm::vec3 a, glm::vec3 b, glm::vec2 p) {
        return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    };
    for (const glm::uvec3 t : corners) {
        const glm::vec3 a = seen[t.x], b = seen[t.y], c = seen[t.z];
        const float whole = area(a, b, {c.x, c.y});
        const glm::ivec2 low(glm::max(glm::floor(glm::min(glm::min(a, b), c)), glm::vec3(0.0f)));
        const glm::ivec2 high(glm::max(glm::max(a, b), c));
        for (int y = low.y; whole != 0.0f && y <= std::min(high.y, size.y - 1); ++y) {
            for (int x = low.x; x <= std::min(high.x, size.x - 1); ++x) {
                const glm::vec2 p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                const glm::vec3 w = glm::vec3(area(b, c, p), area(c, a, p), area(a, b, p)) / whole;
                const float z = w.x * a.z + w.y * b.z + w.z * c.z;
                float& nearest = depth[static_cast<std::size_t>(y * size.x + x)];
                if (glm::any(glm::lessThan(w, glm::vec3(0.0f))) || z >= nearest)
                    continue;
                nearest = z;
                const glm::vec3 occlusion(answers[t.x].occlusion, answers[t.y].occlusion,
                                          answers[t.z].occlusion);
                const float grey =
                    srgb_decode(std::clamp(1.0f - glm::dot(w, occlusion), 0.0f, 1.0f));
                image.at(corner.x + x, corner.y + y) = {grey, grey, grey, 1.0f};
            }
        }
    }
}

MovingStage crossing_stage(const std::string& name, const Scene& world, Scene body, double share)
{
    constexpr int kPoses = 12;
    const Frame of_world = frame_of(box_of(world)), of_body = frame_of(box_of(body));
    const double size = of_world.diagonal, scale = share * size / of_body.diagonal;
    const glm::dvec3 middle = of_world.centre - glm::dvec3(0.0, 0.1 * size, 0.0);
    body = scenes::moved(std::move(body),
                         [&](glm::dvec3 p) { return middle + scale * (p - of_body.centre); });
    std::vector<std::vector<Placement>> poses;
    for (int k = 0; k < kPoses; ++k) {
        Placement pose = turned_about(middle, about_x(0.02 * k));
        pose.translation += size * glm::dvec3(0.002 * k, 0.0, 0.001 * k);
        poses.push_back({{}, pose});
    }
    return MovingStage(name, {world, body}, poses, 180.0f);
}

namespace {

constexpr int kPartCells = 20;

/// Upright: a sphere whose halves are drawn apart.
Scene capsule(glm::dvec3 centre, double radius, double half)
{
    return scenes::moved(scenes::sphere({0, 0, 0}, 1.0, kPartCells), [=](glm::dvec3 p) {
        const double apart = p.z > 1e-9 ? half : p.z < -1e-9 ? -half : 0.0;
        return centre + radius * p + glm::dvec3(0.0, 0.0, apart);
    });
}

Scene block(glm::dvec3 centre, glm::dvec3 half)
{
    return scenes::box(centre - half, centre + half, kPartCells);
}

}  // namespace

MovingStage robot_stage()
{
    // upright along z; limbs first on the one side, then on the other
    std::vector<Scene> parts = {scenes::sheet({-0.8, -0.8, 0.0}, {1.6, 0, 0}, {0, 1.6, 0}, 24),
                                block({0, 0, 1.0}, {0.18, 0.12, 0.09}),
                                block({0, 0, 1.36}, {0.22, 0.14, 0.22}),
                                scenes::sphere({0, 0, 1.77}, 0.15, kPartCells)};
    for (const double side : {-1.0, 1.0}) {
        parts.push_back(capsule({0.31 * side, 0, 1.36}, 0.07, 0.13));
        parts.push_back(capsule({0.31 * side, 0, 1.01}, 0.06, 0.13));
        parts.push_back(capsule({0.11 * side, 0, 0.70}, 0.09, 0.13));
        parts.push_back(capsule({0.11 * side, 0, 0.28}, 0.07, 0.16));
    }
    constexpr int kPoses = 24;  // a second
    std::vector<std::vector<Placement>> poses;
    for (int k = 0; k < kPoses; ++k) {
        const double phase = 2.0 * std::numbers::pi * k / kPoses;
        const Placement hip{glm::dmat3(1.0), 1.0, {0.0, 0.0, 0.02 * std::cos(2.0 * phase)}};
        const Placement torso =
            hip * turned_about({0, 0, 1.1}, about_x(0.06 * std::sin(2.0 * phase)));
        const Placement head =
            torso * turned_about({0, 0, 1.6}, about_x(-0.1 * std::sin(2.0 * phase)));
        std::vector<Placement> pose = {{}, hip, torso, head};
        for (const double side : {-1.0, 1.0}) {
            const double swing = side * std::sin(phase), lift = 1.0 + side * std::cos(phase);
            const Placement arm =
                torso * turned_about({0.31 * side, 0, 1.53}, about_x(0.6 * swing));
            const Placement thigh =
                hip * turned_about({0.11 * side, 0, 0.92}, about_x(-0.5 * swing));
            pose.push_back(arm);
            pose.push_back(arm * turned_about({0.31 * side, 0, 1.18}, about_x(0.3 + 0.2 * swing)));
            pose.push_back(thigh);
            pose.push_back(thigh * turned_about({0.11 * side, 0, 0.49}, about_x(-0.35 * lift)));
        }
        poses.push_back(std::move(pose));
    }
    return MovingStage("robot", parts, poses, NormalSettings().crease);
}

MovingStage small_stage()
{
    return crossing_stage("small", scenes::bumpy_sphere(16), generated_body());
}

Scene generated_body()
{
    return scenes::bumpy_sphere(16);
}

Scene generated_ground()
{
    return scenes::height_field(160, [](double x, double y) {
        return 0.1 * std::sin(12.0 * x) * std::cos(9.0 * y) + 0.02 * std::sin(50.0 * x + 31.0 * y);
    });
}

Scene generated_scan()
{
    return scenes::bumpy_sphere(98);
}

Scene generated_room()
{
    Scene room = scenes::room({0, 0, 0}, {4.0, 3.0, 2.4}, 20);
    room += scenes::box({0.4, 0.3, 0.01}, {1.6, 1.1, 0.7}, 8);
    room += scenes::box({2.8, 1.9, 0.01}, {3.8, 2.8, 1.1}, 8);
    return room;
}

}  // namespace surfelao
