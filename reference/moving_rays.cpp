#include "reference/moving_rays.h"

#include "reference/embree_scene.h"
#include "surfels/for_all.h"

#include <embree3/rtcore.h>
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

}  // namespace

struct MovingRayScene::Impl {
    RTCDevice device;
    RayScene scene{nullptr};
    std::vector<RayBody> bodies;
    bool changed = true;  ///< since the last commit
    bool whole = false;   ///< Embree crashes where it goes on with a scene whose commit failed

    explicit Impl(RTCDevice of) : device(of) {}
    ~Impl()
    {
        for (const RayBody& body : bodies) {
            if (body.mesh != nullptr)
                rtcReleaseGeometry(body.mesh);
        }
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void assemble()
    {
        scene = RayScene(std::make_unique<RayScene::Impl>(device, RayScene::Build::fast, true));
        for (const RayBody& body : bodies) {
            if (body.mesh != nullptr)
                rtcAttachGeometry(scene.impl().scene, body.mesh);
        }
    }

    /// Puts the vertices of a body where `position` says, for each by its place in the buffer.
    template <class Position>
    void move(std::uint32_t index, const Position& position)
    {
        RayBody& body = bodies.at(index);
        if (body.mesh == nullptr)
            return;
        for_all(body.vertices.size(), [&](std::size_t i) { body.buffer[i] = position(body, i); });
        rtcSetGeometryBuildQuality(body.mesh, RTC_BUILD_QUALITY_REFIT);
        rtcUpdateGeometryBuffer(body.mesh, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(body.mesh);
        if (!std::exchange(body.shown, true))
            rtcEnableGeometry(body.mesh);
        changed = true;
    }
};

MovingRayScene::MovingRayScene(const Geometry& geometry, std::vector<BodyMesh> bodies,
                               RayScene::Isa isa)
{
    keep_floating_point_mode();
    impl_ = std::make_unique<Impl>(device_for(isa));
    for (BodyMesh& from : bodies) {
        RayBody& body = impl_->bodies.emplace_back();
        if (from.triangles.empty())
            continue;
        for (const std::uint32_t vertex : from.vertices)
            body.at_rest.push_back(geometry.positions[vertex]);
        const EmbreeMesh mesh = new_mesh(impl_->device, body.at_rest.size(), from.triangles.size());
        body.mesh = mesh.geometry;
        body.buffer = mesh.vertices;
        std::ranges::copy(body.at_rest, mesh.vertices);
        std::ranges::copy(from.triangles, mesh.triangles);
        body.vertices = std::move(from.vertices);
        rtcSetGeometryBuildQuality(body.mesh, RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitGeometry(body.mesh);
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
    if (impl_->changed) {
        if (!std::exchange(impl_->whole, false))
            impl_->assemble();
        rtcCommitScene(impl_->scene.impl().scene);
        check_device(impl_->device);
        impl_->changed = false;
        impl_->whole = true;
    }
    return impl_->scene;
}

}  // namespace surfelao
