#include "reference/moving_rays.h"

#include "reference/embree_scene.h"
#include "surfels/errors.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <glm/vec4.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

struct RayBody {
    std::vector<std::uint32_t> vertices;  ///< of the geometry, in the order of the buffer
    std::vector<glm::vec3> at_rest;       ///< the same
    RTCGeometry mesh = nullptr;           ///< null where it has no triangles
    glm::vec3* buffer = nullptr;
    bool shown = true;
};

/// Triangles over the body's own vertices.
std::vector<std::vector<glm::uvec3>> split_bodies(const Geometry& geometry,
                                                  std::span<const std::uint32_t> body_of_triangle,
                                                  std::vector<RayBody>& bodies)
{
    std::vector<std::vector<glm::uvec3>> triangles(bodies.size());
    for (std::size_t t = 0; t < body_of_triangle.size(); ++t)
        triangles[body_of_triangle[t]].push_back(geometry.triangles[t]);
    constexpr std::uint32_t kNobody = 0xffffffff;
    std::vector<std::uint32_t> owner(geometry.positions.size(), kNobody), place(owner.size());
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        RayBody& body = bodies[b];
        for (glm::uvec3& triangle : triangles[b]) {
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = triangle[corner];
                if (std::exchange(owner[vertex], b) != b) {
                    place[vertex] = static_cast<std::uint32_t>(body.vertices.size());
                    body.vertices.push_back(vertex);
                    body.at_rest.push_back(geometry.positions[vertex]);
                }
                triangle[corner] = place[vertex];
            }
        }
    }
    return triangles;
}

}  // namespace

struct MovingRayScene::Impl {
    RTCDevice device;
    RayScene scene;
    std::vector<RayBody> bodies;
    bool changed = true;

    /// Low quality means: a hierarchy for each mesh, and one over them. Without it Embree builds
    /// one of all triangles at every commit.
    explicit Impl(RTCDevice of)
        : device(of),
          scene(std::make_unique<RayScene::Impl>(of, RTC_SCENE_FLAG_DYNAMIC, RTC_BUILD_QUALITY_LOW))
    {
    }
    ~Impl()
    {
        for (const RayBody& body : bodies) {
            if (body.mesh != nullptr)
                rtcReleaseGeometry(body.mesh);
        }
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    /// Puts the vertices of a body where `position` says, for each by its place in the buffer.
    template <class Position>
    void move(std::uint32_t index, const Position& position)
    {
        RayBody& body = bodies.at(index);
        if (body.mesh == nullptr)
            return;
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, body.vertices.size(), 4096),
                          [&](const auto& some) {
                              for (std::size_t i = some.begin(); i < some.end(); ++i)
                                  body.buffer[i] = position(body, i);
                          });
        rtcSetGeometryBuildQuality(body.mesh, RTC_BUILD_QUALITY_REFIT);
        rtcUpdateGeometryBuffer(body.mesh, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(body.mesh);
        if (!std::exchange(body.shown, true))
            rtcEnableGeometry(body.mesh);
        changed = true;
    }
};

MovingRayScene::MovingRayScene(const Geometry& geometry,
                               std::span<const std::uint32_t> body_of_triangle, RayScene::Isa isa)
{
    keep_floating_point_mode();
    impl_ = std::make_unique<Impl>(device_for(isa));
    std::uint32_t count = 1;
    for (const std::uint32_t body : body_of_triangle)
        count = std::max(count, body + 1);
    impl_->bodies.resize(count);
    const auto triangles = split_bodies(geometry, body_of_triangle, impl_->bodies);
    for (std::uint32_t b = 0; b < count; ++b) {
        if (triangles[b].empty())
            continue;
        RayBody& body = impl_->bodies[b];
        const EmbreeMesh mesh = new_mesh(impl_->device, body.vertices.size(), triangles[b].size());
        body.mesh = mesh.geometry;
        body.buffer = mesh.vertices;
        std::ranges::copy(body.at_rest, mesh.vertices);
        std::ranges::copy(triangles[b], mesh.triangles);
        rtcSetGeometryBuildQuality(body.mesh, RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitGeometry(body.mesh);
        rtcAttachGeometry(impl_->scene.impl().scene, body.mesh);
    }
    static_cast<void>(now());
}
MovingRayScene::~MovingRayScene() = default;
MovingRayScene::MovingRayScene(MovingRayScene&&) noexcept = default;
MovingRayScene& MovingRayScene::operator=(MovingRayScene&&) noexcept = default;

void MovingRayScene::place(std::uint32_t body, const glm::dmat4& matrix)
{
    impl_->move(body, [&](const RayBody& of, std::size_t i) {
        return glm::vec3(matrix * glm::dvec4(glm::dvec3(of.at_rest[i]), 1.0));
    });
}

void MovingRayScene::hide(std::uint32_t body)
{
    RayBody& hidden = impl_->bodies.at(body);
    if (hidden.mesh == nullptr || !std::exchange(hidden.shown, false))
        return;
    rtcDisableGeometry(hidden.mesh);
    impl_->changed = true;
}

void MovingRayScene::deform(std::uint32_t body, std::span<const glm::vec3> positions)
{
    impl_->move(body, [&](const RayBody& of, std::size_t i) { return positions[of.vertices[i]]; });
}

const RayScene& MovingRayScene::now()
{
    if (std::exchange(impl_->changed, false)) {
        rtcCommitScene(impl_->scene.impl().scene);
        check_device(impl_->device);
    }
    return impl_->scene;
}

}  // namespace surfelao
