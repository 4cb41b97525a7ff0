#include "viewer/model_pose.h"

#include "surfels/errors.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace surfelao {
namespace {

/// The same map between points of the unit frame.
glm::dmat4 in_unit_frame(const glm::dmat4& world, const Frame& frame)
{
    glm::dmat4 unit = world;
    const glm::dvec3 centre = frame.centre;
    unit[3] =
        glm::dvec4((glm::dvec3(world * glm::dvec4(centre, 1.0)) - centre) / frame.diagonal, 1.0);
    return unit;
}

glm::vec3 turned(const glm::dmat3& by, glm::vec3 direction)
{
    const glm::dvec3 there = by * glm::dvec3(direction);
    const double length = glm::length(there);
    return length > 0.0 ? glm::vec3(there / length) : glm::vec3(0.0f);
}

/// A pose under way: all at rest, but for what was set.
class Posing {
public:
    Posing(const Model& base, const Bodies& bodies)
        : base_(base), bodies_(bodies), scales_(bodies.list.size(), 1.0f)
    {
        pose_.bodies.resize(bodies.list.size());
        const Geometry& geometry = base.geometry();
        pose_.shape = {geometry.positions, geometry.normals, base.mesh->surface.normals,
                       base.splat_radii};
    }

    void place(std::uint32_t body, const Placement& placement)
    {
        pose_.bodies[body].placement = placement;
        if (placement == Placement{})
            return;
        scales_[body] = static_cast<float>(placement.scale);
        const glm::dmat3& rotation = placement.rotation;
        for (const std::uint32_t v : bodies_.vertices[body]) {
            glm::vec3& p = pose_.shape.positions[v];
            p = glm::vec3(placed_point(p, placement));
            pose_.shape.normals[v] = turned(rotation, pose_.shape.normals[v]);
        }
        for (const std::uint32_t wedge : bodies_.wedges[body]) {
            glm::vec3& normal = pose_.shape.wedge_normals[wedge];
            normal = turned(rotation, normal);
        }
    }

    void hide(std::uint32_t body)
    {
        pose_.bodies[body].state = BodyState::gone;
        scales_[body] = 0.0f;
        for (const std::uint32_t v : bodies_.vertices[body])
            pose_.shape.positions[v] = base_.geometry().positions[bodies_.vertices[body].front()];
    }

    /// place: of a vertex, unit frame.
    void deform(std::uint32_t body, const std::function<glm::dvec3(std::uint32_t)>& place)
    {
        pose_.bodies[body].state = BodyState::deformed;
        for (const std::uint32_t v : bodies_.vertices[body])
            pose_.shape.positions[v] = glm::vec3(place(v));
        is_deformed_ = true;
    }

    ModelPose finish()
    {
        if (is_deformed_)
            make_normals();
        for (std::size_t i = 0; i < base_.splats.size(); ++i)
            pose_.shape.splat_radii[i] *= scales_[bodies_.of_vertex[base_.splats[i].vertices.x]];
        return std::move(pose_);
    }

private:
    /// Of deformed bodies: sums over what was one smooth place at rest, weighted by angles.
    void make_normals()
    {
        const Geometry& geometry = base_.geometry();
        const Surface& surface = base_.mesh->surface;
        std::vector<glm::dvec3> sums(surface.normals.size(), glm::dvec3(0.0));
        for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
            if (!is_deformed(bodies_.of_triangle[t]))
                continue;
            glm::dvec3 p[3];
            for (int k = 0; k < 3; ++k)
                p[k] = pose_.shape.positions[geometry.triangles[t][k]];
            const glm::dvec3 face = glm::cross(p[1] - p[0], p[2] - p[0]);
            const double length = glm::length(face);
            if (!(length > 0.0))
                continue;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
                const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
                sums[bodies_.smooth_places[surface.corners(geometry)[t][k]]] +=
                    angle / length * face;
            }
        }
        for (std::uint32_t body = 1; body < bodies_.list.size(); ++body) {
            if (!is_deformed(body))
                continue;
            for (const std::uint32_t wedge : bodies_.wedges[body]) {
                const glm::dvec3 sum = sums[bodies_.smooth_places[wedge]];
                if (sum == glm::dvec3(0.0))
                    continue;
                pose_.shape.wedge_normals[wedge] = glm::vec3(glm::normalize(sum));
                pose_.shape.normals[surface.vertex_of(wedge)] = pose_.shape.wedge_normals[wedge];
            }
        }
    }
    bool is_deformed(std::uint32_t body) const
    {
        return pose_.bodies[body].state == BodyState::deformed;
    }

    const Model& base_;
    const Bodies& bodies_;
    ModelPose pose_;
    std::vector<float> scales_;
    bool is_deformed_ = false;
};

/// Wedges whose vertices lie in one place of one body and whose normals are the same.
std::vector<std::uint32_t> smooth_places_of(const Mesh& mesh, const Bodies& bodies)
{
    using Place = std::tuple<std::uint32_t, std::uint32_t, float, float, float>;
    std::map<Place, std::uint32_t> numbers;
    std::vector<std::uint32_t> places;
    for (std::uint32_t wedge = 0; wedge < mesh.surface.normals.size(); ++wedge) {
        const std::uint32_t vertex = mesh.surface.vertex_of(wedge);
        const glm::vec3 n = mesh.surface.normals[wedge];
        const Place place{mesh.geometry.welded[vertex], bodies.of_vertex[vertex], n.x, n.y, n.z};
        places.push_back(
            numbers.try_emplace(place, static_cast<std::uint32_t>(numbers.size())).first->second);
    }
    return places;
}

}  // namespace

Bodies bodies_of(const Model& base, const Movables& movables, std::span<const std::uint32_t> moved,
                 const Motion* motion)
{
    const Scene& scene = base.mesh->scene;
    std::vector<std::uint32_t> index_of(movables.list.size(), Body::kNone);
    for (std::uint32_t i = 0; i < moved.size(); ++i)
        index_of[moved[i]] = i;
    std::map<std::uint32_t, std::uint32_t> first_part;  // of Motion::bodies()
    std::vector<Body> of_vertex;
    of_vertex.reserve(scene.positions.size());
    for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
        const Part& part = scene.parts[p];
        std::uint32_t alike = Body::kNone;  // the first part that moves as it does
        if (motion && motion->bodies()[p] != 0)
            alike = motion->deforms()[p]
                        ? p
                        : first_part.try_emplace(motion->bodies()[p], p).first->second;
        for (std::uint32_t v = 0; v < part.vertex_count; ++v) {
            const std::uint32_t movable = movables.of_vertex[part.first_vertex + v];
            of_vertex.push_back(
                {alike, movable == Movables::kNone ? Body::kNone : index_of[movable]});
        }
    }
    // only what has triangles is a body
    Bodies bodies;
    bodies.list.emplace_back();
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers{
        {{Body::kNone, Body::kNone}, 0}};
    for (const glm::uvec3 triangle : base.geometry().triangles) {
        const Body& body = of_vertex[triangle.x];
        const auto next = static_cast<std::uint32_t>(bodies.list.size());
        const auto [entry, is_new] = numbers.try_emplace(std::pair(body.part, body.movable), next);
        if (is_new)
            bodies.list.push_back(body);
        bodies.of_triangle.push_back(entry->second);
    }
    for (const Body& body : bodies.list)
        bodies.deforms.push_back(body.part != Body::kNone && motion->deforms()[body.part]);
    for (const Body& body : of_vertex) {
        const auto found = numbers.find(std::pair(body.part, body.movable));
        bodies.of_vertex.push_back(found == numbers.end() ? 0 : found->second);
    }
    bodies.vertices.resize(bodies.list.size());
    bodies.wedges.resize(bodies.list.size());
    for (std::uint32_t v = 0; v < bodies.of_vertex.size(); ++v) {
        if (bodies.of_vertex[v] != 0)
            bodies.vertices[bodies.of_vertex[v]].push_back(v);
    }
    const Surface& surface = base.mesh->surface;
    for (std::uint32_t wedge = 0; wedge < surface.normals.size(); ++wedge) {
        const std::uint32_t body = bodies.of_vertex[surface.vertex_of(wedge)];
        if (body != 0)
            bodies.wedges[body].push_back(wedge);
    }
    if (motion)
        bodies.smooth_places = smooth_places_of(*base.mesh, bodies);
    return bodies;
}

PosedBodies bodies_at_rest(std::shared_ptr<const Model> base, std::shared_ptr<const Bodies> bodies)
{
    std::vector<BodyPose> poses;
    for (const bool deforms : bodies->deforms)
        poses.push_back({deforms ? BodyState::deformed : BodyState::placed});
    return {std::move(base), std::move(bodies), std::move(poses)};
}

Placement placement_of(const PartMove& move, glm::dvec3 middle)
{
    Placement placement;
    placement.rotation = glm::mat3_cast(move.rotation);
    placement.scale = move.scale;
    placement.translation = middle + move.translation - move.scale * (placement.rotation * middle);
    return placement;
}

ModelPose pose_of(const Model& base, const Bodies& bodies, const Movables& movables,
                  std::span<const std::uint32_t> moved, std::span<const PartMove> moves,
                  std::span<const PartPose> parts)
{
    const Frame& frame = base.geometry().frame;
    Posing posing(base, bodies);
    std::vector<glm::dvec3> middles;
    for (const std::uint32_t movable : moved)
        middles.emplace_back(movables.list[movable].middle());
    for (std::uint32_t b = 1; b < bodies.list.size(); ++b) {
        const Body& body = bodies.list[b];
        const PartPose at_rest;
        const PartPose& part = body.part < parts.size() ? parts[body.part] : at_rest;
        if (part.is_gone) {
            posing.hide(b);
            continue;
        }
        const glm::dmat4 animated = in_unit_frame(part.from_rest, frame);
        Placement by_hand;
        if (body.movable != Body::kNone) {
            glm::dvec3& middle = middles[body.movable];
            middle =
                glm::dvec3(animated * glm::dvec4(movables.list[moved[body.movable]].middle(), 1.0));
            by_hand = placement_of(moves[body.movable], middle);
        }
        const std::optional<Placement> placement =
            animated == glm::dmat4(1.0) ? by_hand : placement_of(matrix_of(by_hand) * animated);
        if (placement && part.positions.empty()) {
            posing.place(b, *placement);
            continue;
        }
        posing.deform(b, [&](std::uint32_t v) {
            const Scene& scene = base.mesh->scene;
            const glm::dvec3 world =
                part.positions.empty()
                    ? glm::dvec3(part.from_rest * glm::dvec4(scene.positions[v], 1.0))
                    : part.positions[v - scene.parts[body.part].first_vertex];
            return placed_point((world - frame.centre) / frame.diagonal, by_hand);
        });
    }
    ModelPose pose = posing.finish();
    pose.middles = std::move(middles);
    return pose;
}

std::vector<Receiver> receivers_on(const Model& base, const VertexTarget& target,
                                   const ModelShape& shape)
{
    Geometry geometry = base.geometry();
    geometry.positions = shape.positions;
    geometry.normals = shape.normals;
    Surface surface = base.mesh->surface;
    surface.normals = shape.wedge_normals;
    const Offset offset = offset_of(base.settings, geometry.frame);
    const SurfaceSamples* samples = target.samples();
    if (!samples)
        return receivers_at_wedges(geometry, surface, offset);
    std::vector<Receiver> receivers = receivers_at(geometry, surface, samples->points, offset);
    const auto lone = target.receivers().subspan(receivers.size());
    receivers.insert(receivers.end(), lone.begin(), lone.end());
    return receivers;
}

std::vector<std::uint32_t> bodies_of_receivers(const Model& base, const VertexTarget& target,
                                               const Bodies& bodies)
{
    std::vector<std::uint32_t> found;
    found.reserve(target.receivers().size());
    if (const SurfaceSamples* samples = target.samples()) {
        for (const SurfacePoint& point : samples->points)
            found.push_back(bodies.of_triangle[point.triangle]);
        found.resize(target.receivers().size(), 0);
        return found;
    }
    const Surface& surface = base.mesh->surface;
    for (std::uint32_t wedge = 0; wedge < surface.normals.size(); ++wedge)
        found.push_back(bodies.of_vertex[surface.vertex_of(wedge)]);
    return found;
}

namespace {

/// Directions of the file turn with what they are on: values that several bodies share part.
void turn_normals(Scene& scene, const Bodies& bodies, const ModelPose& pose)
{
    const auto rotation_of = [&](std::uint32_t vertex) -> const glm::dmat3& {
        return pose.bodies[bodies.of_vertex[vertex]].placement.rotation;
    };
    CornerNormals& normals = scene.normals;
    if (normals.empty())
        return;
    if (normals.corners.empty()) {
        for (std::uint32_t v = 0; v < normals.values.size(); ++v) {
            const bool is_deformed = pose.bodies[bodies.of_vertex[v]].state == BodyState::deformed;
            normals.values[v] = is_deformed
                                    ? pose.shape.normals[v]
                                    : glm::vec3(rotation_of(v) * glm::dvec3(normals.values[v]));
        }
        return;
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;
    std::vector<glm::vec3> values;
    for (std::size_t t = 0; t < normals.corners.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& corner = normals.corners[t][k];
            if (corner == CornerNormals::kNone)
                continue;
            const std::uint32_t vertex = scene.triangles[t][k];
            const auto next = static_cast<std::uint32_t>(values.size());
            const auto [entry, is_new] =
                numbers.try_emplace(std::pair(corner, bodies.of_vertex[vertex]), next);
            if (is_new)
                values.emplace_back(rotation_of(vertex) * glm::dvec3(normals.values[corner]));
            corner = entry->second;
        }
    }
    normals.values = std::move(values);
}

Scene posed_scene(const Model& base, const Bodies& bodies, const ModelPose& pose)
{
    const Frame& frame = base.geometry().frame;
    Scene scene = base.mesh->scene;
    scene.free_vertices = false;  // its vertices have parted already
    for (std::uint32_t v = 0; v < scene.positions.size(); ++v) {
        const BodyPose& body = pose.bodies[bodies.of_vertex[v]];
        if (body == BodyPose{})
            continue;
        const glm::dvec3 unit =
            body.state == BodyState::placed
                ? placed_point((scene.positions[v] - frame.centre) / frame.diagonal, body.placement)
                : glm::dvec3(pose.shape.positions[v]);
        scene.positions[v] = frame.centre + frame.diagonal * unit;
    }
    turn_normals(scene, bodies, pose);
    for (std::uint32_t v = 0; v < scene.tangents.size(); ++v) {
        glm::vec4& tangent = scene.tangents[v];
        const glm::dmat3& rotation = pose.bodies[bodies.of_vertex[v]].placement.rotation;
        tangent = glm::vec4(glm::vec3(rotation * glm::dvec3(tangent)), tangent.w);
    }
    for (Part& part : scene.parts) {
        if (part.vertex_count > 0)
            part.to_world =
                pose.bodies[bodies.of_vertex[part.first_vertex]].placement.rotation * part.to_world;
    }
    return scene;
}

}  // namespace

Model posed_model(const Model& base, const Bodies& bodies, const ModelPose& pose)
{
    SURFELAO_CHECK(!base.cloud);
    Model model = make_model(make_mesh(posed_scene(base, bodies, pose), base.settings.normals,
                                       {.frame = base.geometry().frame}),
                             base.up, base.settings);
    model.ground_plane = base.ground_plane;
    model.occluding_ground = base.occluding_ground;
    model.ground = base.ground;
    model.ground_receivers = base.ground_receivers;
    return model;
}

}  // namespace surfelao
