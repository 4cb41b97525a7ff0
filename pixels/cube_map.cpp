#include "pixels/cube_map.h"

#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace surfelao {
namespace {

std::size_t texels_of_face(int size)
{
    return static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
}

std::uint8_t byte_of(float share)
{
    return static_cast<std::uint8_t>(std::lround(255.0f * glm::clamp(share, 0.0f, 1.0f)));
}

glm::vec2 folded(glm::vec2 p)
{
    return (1.0f - glm::vec2(std::abs(p.y), std::abs(p.x))) *
           glm::vec2(p.x < 0.0f ? -1.0f : 1.0f, p.y < 0.0f ? -1.0f : 1.0f);
}

glm::vec3 place_of(const Geometry& geometry, const SurfacePoint& point)
{
    const glm::uvec3 t = geometry.triangles[point.triangle];
    return (1.0f - point.at.x - point.at.y) * geometry.positions[t.x] +
           point.at.x * geometry.positions[t.y] + point.at.y * geometry.positions[t.z];
}

bool is_seen_from_behind(const Geometry& geometry, std::uint32_t triangle, glm::vec3 eye)
{
    const glm::uvec3 t = geometry.triangles[triangle];
    const glm::vec3 a = geometry.positions[t.x];
    const glm::vec3 face = glm::cross(geometry.positions[t.y] - a, geometry.positions[t.z] - a);
    return glm::dot(face, eye - a) < 0.0f;
}

using OnFace = std::function<void(const GBuffer& face, const SeenPixels& seen)>;

/// Face after face: each is handed over while it is drawn.
CubeSight sight_of(const GlContext& context, const Mesh& mesh, const DrawnMesh& drawn,
                   glm::vec3 centre, int size, const Offset& offset, const OnFace& on_face)
{
    require(size >= kLeastCubeSize && size <= kMostCubeSize,
            "a cube map's size is " + std::to_string(kLeastCubeSize) + " to " +
                std::to_string(kMostCubeSize));
    CubeSight sight;
    sight.centre = centre;
    sight.size = size;
    sight.is_inside = true;
    GBuffer buffer(context, size, size);
    for (int face = 0; face < kCubeFaces; ++face) {
        const View view = face_view(centre, face);
        buffer.draw(drawn, view);
        const SeenPixels seen =
            seen_pixels(mesh, view, size, size, buffer.read_triangles(), offset);
        sight.is_inside &= seen.pixels.size() == texels_of_face(size);
        for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
            const SurfacePoint& point = seen.points[i];
            sight.texels.push_back(static_cast<std::uint32_t>(face * size * size) + seen.pixels[i]);
            sight.distances.push_back(glm::distance(place_of(mesh.geometry, point), centre));
            sight.is_inside &= is_seen_from_behind(mesh.geometry, point.triangle, centre);
        }
        sight.receivers.insert(sight.receivers.end(), seen.receivers.begin(), seen.receivers.end());
        on_face(buffer, seen);
    }
    return sight;
}

std::vector<Occlusion> answers_of(const CubeWorld& world, const CubeSight& sight,
                                  const EngineSettings& engine, const Definition& definition,
                                  const Progress& progress)
{
    const EngineSettings here = engine_of(world, engine, definition);
    return solve(world.occluders.prepared_for(here), sight.receivers, here, progress).occlusion;
}

}  // namespace

View face_view(glm::vec3 centre, int face)
{
    SURFELAO_CHECK(face >= 0 && face < kCubeFaces);
    const int axis = face / 2;
    const bool is_negative = face % 2 == 1;
    glm::vec3 next(0.0f), last(0.0f);
    next[(axis + 1) % 3] = 1.0f;
    last[(axis + 2) % 3] = 1.0f;
    View view;
    view.eye = centre;
    view.forward = glm::vec3(0.0f);
    view.forward[axis] = is_negative ? -1.0f : 1.0f;
    view.right = is_negative ? next : last;  // right x up = -forward
    view.up = is_negative ? last : next;
    return view;
}

std::size_t CubeMap::bytes() const
{
    return distances.size() * sizeof(float) + occlusion.size() +
           normals.size() * sizeof(normals[0]);
}

glm::u8vec2 octahedral_of(glm::vec3 direction)
{
    const glm::vec3 size = glm::abs(direction);
    glm::vec2 p = glm::vec2(direction) / (size.x + size.y + size.z);
    if (direction.z < 0.0f)
        p = folded(p);
    return {byte_of(0.5f + 0.5f * p.x), byte_of(0.5f + 0.5f * p.y)};
}

glm::vec3 direction_of(glm::u8vec2 octahedral)
{
    const glm::vec2 p = glm::vec2(octahedral) / 127.5f - 1.0f;
    const float z = 1.0f - std::abs(p.x) - std::abs(p.y);
    return glm::normalize(glm::vec3(z < 0.0f ? folded(p) : p, z));
}

CubeSight look_around(const GlContext& context, const Mesh& mesh, const DrawnMesh& drawn,
                      glm::vec3 centre, int size, const Offset& offset)
{
    return sight_of(context, mesh, drawn, centre, size, offset,
                    [](const GBuffer&, const SeenPixels&) {});
}

CubeMap cube_map_of(const CubeSight& sight, std::span<const Occlusion> answers)
{
    SURFELAO_CHECK(answers.size() == sight.texels.size());
    const std::size_t texels = kCubeFaces * texels_of_face(sight.size);
    CubeMap map{sight.centre, sight.size, std::vector<float>(texels, kNothingThere),
                std::vector<std::uint8_t>(texels, 0), std::vector<glm::u8vec2>(texels)};
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const std::uint32_t texel = sight.texels[i];
        map.distances[texel] = sight.distances[i];
        map.occlusion[texel] = byte_of(answers[i].occlusion);
        map.normals[texel] = octahedral_of(sight.receivers[i].normal);
    }
    return map;
}

EngineSettings engine_of(const CubeWorld& world, EngineSettings engine,
                         const Definition& definition)
{
    if (engine.device == Device::gpu)
        engine.context = &world.context;
    engine.definition = definition;
    return engine;
}

ScreenSettings cube_horizon()
{
    constexpr int kDirections = 15, kSteps = 15;  // what the thesis recommends
    ScreenSettings settings = screen_settings(ScreenMethod::hbao, kDirections * kSteps);
    settings.directions = kDirections;
    settings.bias = 0.0f;
    return settings;
}

CubeMap make_cube_map(const CubeWorld& world, glm::vec3 centre, const CubeSettings& settings,
                      CubeSeconds& seconds, const Progress& progress)
{
    Stopwatch watch;
    const auto* method = std::get_if<ScreenSettings>(&settings.engine);
    std::vector<Occlusion> answers;
    double solving = 0.0;
    const CubeSight sight =
        sight_of(world.context, world.mesh, world.drawn, centre, settings.size, settings.offset,
                 [&](const GBuffer& face, const SeenPixels& seen) {
                     if (method == nullptr)
                         return;
                     Stopwatch pass;
                     const Framebuffer target = world.screen.make_target(face);
                     world.screen.draw(face, *method, settings.definition, target);
                     const std::vector<float> picture = target.read_red(target.rect());
                     for (const std::uint32_t pixel : seen.pixels)
                         answers.push_back({picture[pixel], glm::vec3(0.0f)});
                     solving += pass.lap();
                 });
    if (sight.texels.empty())
        throw InputError("a cube map sees nothing from where it is");
    if (sight.is_inside)
        throw InputError("a cube map lies inside of a body: all that it sees are back sides");
    seconds.draw += watch.lap() - solving;
    if (method == nullptr)
        answers = answers_of(world, sight, std::get<EngineSettings>(settings.engine),
                             settings.definition, progress);
    seconds.solve += watch.lap() + solving;
    return cube_map_of(sight, answers);
}

}  // namespace surfelao
