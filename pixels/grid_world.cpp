#include "pixels/grid_world.h"

#include "surfels/bodies.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/labels.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

constexpr std::size_t kGridGrain = 1024;  // receivers of one task
/// Poses of one object's parts agree to this share of the scene.
constexpr double kSamePose = 1e-6;

/// Scene triangles of each object.
std::vector<std::vector<bool>> triangles_of(const Scene& scene, std::span<const NodeGrid> grids)
{
    std::vector<std::vector<bool>> all;
    std::vector<bool> taken(scene.triangles.size(), false);
    for (const NodeGrid& grid : grids) {
        std::vector<bool> found(1, !grid.triangles.empty());
        all.push_back(found[0] ? grid.triangles : triangles_called(scene, {&grid.node, 1}, found));
        if (!found[0]) {
            std::string near;
            for (const std::string& name : names_near(scene.labels, grid.node))
                near += (near.empty() ? "" : ", ") + name;
            throw InputError(scene.name + ": no part is called " + grid.node +
                             ", whose grid is given" +
                             (near.empty() ? "" : " (near it: " + near + ")"));
        }
        for (std::size_t t = 0; t < taken.size(); ++t) {
            if (!all.back()[t])
                continue;
            if (taken[t])
                throw InputError(scene.name + ": two grids are given for parts of " + grid.node);
            taken[t] = true;
        }
    }
    return all;
}

/// Whether the part has triangles of the object.
bool has_some(const Part& part, const std::vector<bool>& triangles)
{
    const auto first = triangles.begin() + static_cast<std::ptrdiff_t>(part.first_triangle);
    return std::find(first, first + static_cast<std::ptrdiff_t>(part.triangle_count), true) !=
           first + static_cast<std::ptrdiff_t>(part.triangle_count);
}

/// What the pose of an object does to places of its frame at rest, as far as it is measured.
double pose_difference(const glm::dmat4& a, const glm::dmat4& b, const Frame& frame)
{
    double largest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec4 place(frame.centre + frame.diagonal * (side - 0.5), 1.0);
        largest = std::max(largest, glm::length(glm::dvec3(a * place - b * place)));
    }
    return largest / frame.diagonal;
}

/// From rest to now; empty where the object is gone.
std::optional<glm::dmat4> pose_of(const Scene& scene, const Frame& frame, const NodeGrid& grid,
                                  const std::vector<bool>& triangles,
                                  const std::vector<PartPose>& poses)
{
    if (poses.empty())
        return glm::dmat4(1.0);
    std::optional<glm::dmat4> pose;
    for (std::size_t p = 0; p < scene.parts.size(); ++p) {
        if (!has_some(scene.parts[p], triangles) || poses[p].is_gone)
            continue;
        if (!poses[p].positions.empty() ||
            (pose && pose_difference(*pose, poses[p].from_rest, frame) > kSamePose))
            throw InputError(scene.name + ": " + grid.node +
                             " does not move as one piece: give each of its parts a grid");
        pose = pose.value_or(poses[p].from_rest);
    }
    return pose;
}

/// From the world to the unit frame.
glm::dmat4 into_frame(const Frame& frame)
{
    glm::dmat4 matrix(1.0 / frame.diagonal);
    matrix[3] = glm::dvec4(-frame.centre / frame.diagonal, 1.0);
    return matrix;
}

/// A name for the triangles of all objects, which nothing in a file has.
const std::string kWithGrids = "\x01 with grids";

Label label_of(const std::vector<std::vector<bool>>& triangles)
{
    Label label{LabelKind::object, kWithGrids, {}};
    for (std::uint32_t t = 0; t < triangles.front().size(); ++t) {
        if (std::ranges::none_of(triangles, [&](const auto& of_one) { return of_one[t]; }))
            continue;
        if (label.ranges.empty() || label.ranges.back().first + label.ranges.back().count != t)
            label.ranges.push_back({t, 0});
        ++label.ranges.back().count;
    }
    return label;
}

/// What is left where only these triangles of the scene are baked.
Mesh baked_alone(Scene scene, std::span<const Scene> others, PartChoice choice,
                 const std::vector<std::vector<bool>>& triangles, const Frame& frame)
{
    scene.labels.push_back(label_of(triangles));
    choice.receivers = {kWithGrids};
    return mesh_of(std::move(scene), others, {.source = NormalSource::flat}, choice, frame);
}

/// All that occludes but the objects: as if they alone were baked, and did not occlude.
std::shared_ptr<const Geometry> rest_of(const Mesh& mesh, std::span<const Scene> others,
                                        PartChoice choice,
                                        const std::vector<std::vector<bool>>& triangles)
{
    if (triangles.empty())
        return std::make_shared<const Geometry>(mesh.occluding());
    choice.exclude.push_back(kWithGrids);
    return baked_alone(mesh.scene, others, std::move(choice), triangles, mesh.geometry.frame)
        .occluders;
}

/// Over its own vertices alone.
std::shared_ptr<const Geometry> geometry_of(const Geometry& whole, BodyMesh body)
{
    Scene scene;
    for (const std::uint32_t vertex : body.vertices)
        scene.positions.push_back(whole.frame.centre +
                                  whole.frame.diagonal * glm::dvec3(whole.positions[vertex]));
    scene.triangles = std::move(body.triangles);
    return std::make_shared<const Geometry>(make_geometry(scene, {.frame = whole.frame}));
}

/// Each object by itself. of_triangle: GridSurfaces'. O(n); where something is cut or left out, for
/// each object.
std::vector<std::shared_ptr<const Geometry>> surfaces_of(
    const Mesh& mesh, PartChoice choice, std::span<const std::vector<bool>> triangles,
    std::vector<std::uint32_t> of_triangle)
{
    std::vector<std::shared_ptr<const Geometry>> surfaces;
    if (!mesh.occluders) {
        std::vector<BodyMesh> bodies = split_bodies(mesh.geometry, of_triangle);
        bodies.resize(triangles.size() + 1);
        for (std::size_t i = 1; i < bodies.size(); ++i)
            surfaces.push_back(geometry_of(mesh.geometry, std::move(bodies[i])));
        return surfaces;
    }
    choice.alone = true;
    for (const std::vector<bool>& of_one : triangles) {
        const Mesh alone = baked_alone(mesh.scene, {}, choice, {of_one}, mesh.geometry.frame);
        const Geometry& whole = alone.occluding();
        of_triangle.assign(whole.triangles.size(), 0);
        surfaces.push_back(geometry_of(whole, std::move(split_bodies(whole, of_triangle).front())));
    }
    return surfaces;
}

void darken(Occlusion& value, float visibility)
{
    value.occlusion = 1.0f - (1.0f - value.occlusion) * visibility;
}

/// Both hide what is left out: deviations from the normal add up.
glm::vec3 joined_bent(const Occlusion& a, const Occlusion& b, glm::vec3 normal)
{
    const glm::vec3 sum = a.bent_normal + b.bent_normal - normal;
    const float length = glm::length(sum);
    return length > 0.0f ? sum / length : normal;
}

}  // namespace

GridWorld::GridWorld(std::vector<PlacedGrid> objects, std::shared_ptr<const Geometry> rest,
                     GridSurfaces surfaces)
    : objects_(std::move(objects)),
      rest_(std::move(rest)),
      surfaces_(std::move(surfaces)),
      occluders_(*rest_)
{
    for (const std::shared_ptr<const Geometry>& geometry : surfaces_.list)
        own_occluders_.emplace_back(*geometry);
}

std::vector<std::uint32_t> GridWorld::surfaces_at(std::span<const SurfacePoint> points) const
{
    if (surfaces_.list.empty())
        return {};
    std::vector<std::uint32_t> surfaces(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        surfaces[i] = surfaces_.of_triangle[points[i].triangle];
    return surfaces;
}

void GridWorld::prepare(const EngineChoice& choice)
{
    if (!rest_->triangles.empty())
        static_cast<void>(occluders_.prepared_for(choice));
    for (Occluders& own : own_occluders_) {
        if (!own.geometry().triangles.empty())
            static_cast<void>(own.prepared_for(choice));
    }
}

std::vector<Occlusion> GridWorld::solve(std::span<const Receiver> receivers,
                                        std::span<const std::uint32_t> own,
                                        const EngineSettings& engine, const Progress& progress)
{
    std::vector<Occlusion> answers = solve_rest(receivers, engine, progress);
    if (!own.empty())
        add_own(receivers, own, engine, answers);
    return answers;
}

void GridWorld::add_own(std::span<const Receiver> receivers, std::span<const std::uint32_t> own,
                        const EngineSettings& engine, std::span<Occlusion> answers)
{
    EngineSettings alone = engine;
    alone.definition.ground.reset();  // which the rest has
    std::vector<std::vector<std::size_t>> members(own_occluders_.size());
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (own[i] != 0)
            members[own[i] - 1].push_back(i);
    }
    for (std::size_t surface = 0; surface < members.size(); ++surface) {
        const std::vector<std::size_t>& of_one = members[surface];
        Occluders& occluders = own_occluders_[surface];
        if (of_one.empty() || occluders.geometry().triangles.empty())
            continue;
        std::vector<Receiver> asked;
        for (const std::size_t i : of_one)
            asked.push_back(receivers[i]);
        const std::vector<Occlusion> found =
            surfelao::solve(occluders.prepared_for(alone), asked, alone).occlusion;
        for (std::size_t k = 0; k < found.size(); ++k) {
            Occlusion& answer = answers[of_one[k]];
            answer.bent_normal = joined_bent(answer, found[k], asked[k].normal);
            darken(answer, 1.0f - found[k].occlusion);
        }
    }
}

std::vector<Occlusion> GridWorld::solve_rest(std::span<const Receiver> receivers,
                                             const EngineSettings& engine, const Progress& progress)
{
    if (!rest_->triangles.empty())
        return surfelao::solve(occluders_.prepared_for(engine), receivers, engine, progress)
            .occlusion;
    std::vector<Occlusion> answers;
    const std::optional<Ground>& ground = engine.definition.ground;
    if (ground && std::isfinite(engine.definition.max_distance))
        throw InputError("a ground and a limit of the distance need a part without a grid");
    for (const Receiver& receiver : receivers) {
        // of an endless plane that a receiver stands over: a wedge's share
        const float hidden = ground ? 0.5f * (1.0f - glm::dot(receiver.normal, ground->up)) : 0.0f;
        answers.push_back({receiver.normal == glm::vec3(0.0f) ? 0.0f : hidden, receiver.normal});
    }
    return answers;
}

std::shared_ptr<GridWorld> grid_world_of(const Mesh& mesh, std::span<const Scene> others,
                                         const PartChoice& choice, const GridSources& sources,
                                         const std::optional<Moment>& moment)
{
    const std::vector<NodeGrid>& grids = sources.grids;
    const Frame& frame = mesh.geometry.frame;
    const auto triangles = triangles_of(mesh.scene, grids);
    std::vector<PartPose> poses;
    if (sources.motion && moment)
        poses = sources.motion->at(moment->seconds);
    std::vector<PlacedGrid> objects;
    std::vector<std::vector<bool>> placed;  // triangles of the objects
    GridSurfaces surfaces;
    surfaces.of_triangle.assign(mesh.geometry.triangles.size(), 0);
    for (std::size_t i = 0; i < grids.size(); ++i) {
        const auto pose = pose_of(mesh.scene, frame, grids[i], triangles[i], poses);
        if (!pose)
            continue;
        const auto placement = placement_of(into_frame(frame) * *pose);
        if (!placement)
            throw InputError(mesh.scene.name + ": " + grids[i].node +
                             " is sheared or scaled unevenly: its grid does not follow that");
        const auto number = static_cast<std::uint32_t>(objects.size() + 1);
        for (std::size_t t = 0; t < surfaces.of_triangle.size(); ++t) {
            if (triangles[i][mesh.geometry.scene_triangle(t)])
                surfaces.of_triangle[t] = number;
        }
        objects.push_back({.grid = grids[i].grid, .placement = *placement, .surface = number});
        placed.push_back(triangles[i]);
    }
    surfaces.list = surfaces_of(mesh, choice, placed, surfaces.of_triangle);
    return std::make_shared<GridWorld>(std::move(objects), rest_of(mesh, others, choice, triangles),
                                       std::move(surfaces));
}

std::vector<Occlusion> solve_with_grids(GridPass& pass, const GBuffer& drawing,
                                        const GridPixels& settings,
                                        std::span<const Receiver> receivers,
                                        std::span<const std::uint32_t> own,
                                        std::span<const std::uint32_t> pixels,
                                        const Progress& progress)
{
    std::vector<Occlusion> values = settings.world->solve(receivers, own, settings.rest, progress);
    const Framebuffer target = pass.make_target(drawing.width(), drawing.height());
    std::optional<Texture2D> own_picture;
    if (!own.empty()) {
        std::vector<glm::vec2> texels(
            static_cast<std::size_t>(drawing.width()) * static_cast<std::size_t>(drawing.height()),
            glm::vec2(1.0f, 0.0f));
        for (std::size_t i = 0; i < own.size(); ++i)
            texels[pixels[i]].y = static_cast<float>(own[i]);
        own_picture.emplace(pass.context(), drawing.width(), drawing.height(), TexelFormat::rg32f,
                            std::span<const glm::vec2>(texels));
    }
    pass.draw(drawing, settings.world->objects(), settings.merge, target,
              own_picture ? &*own_picture : nullptr);
    const std::vector<float> visibility = target.read_red(target.rect());
    for (std::size_t i = 0; i < values.size(); ++i)
        darken(values[i], visibility[pixels[i]]);
    return values;
}

std::vector<Occlusion> solve_with_grids(const GridPixels& settings,
                                        std::span<const Receiver> receivers,
                                        std::span<const std::uint32_t> own,
                                        const Progress& progress)
{
    std::vector<Occlusion> values = settings.world->solve(receivers, own, settings.rest, progress);
    for_all(receivers.size(), kGridGrain, [&](std::size_t i) {
        darken(values[i],
               visibility_at(settings.world->objects(), settings.merge, receivers[i].position,
                             receivers[i].normal, own.empty() ? 0 : own[i]));
    });
    return values;
}

}  // namespace surfelao
