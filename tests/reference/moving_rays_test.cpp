#include "reference/moving_rays.h"

#include "differences.h"
#include "reference/embree_scene.h"
#include "scenes.h"
#include "tests/vertex_receivers.h"

#include <embree3/rtcore.h>

#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace surfelao {
namespace {

/// Refuses all memory that is asked for while it lives.
struct NoMemory {
    RTCDevice device = device_for(RayScene::Isa::best);

    NoMemory()
    {
        const auto refuse = [](void*, ssize_t bytes, bool) { return bytes <= 0; };
        rtcSetDeviceMemoryMonitorFunction(device, refuse, nullptr);
    }
    ~NoMemory() { rtcSetDeviceMemoryMonitorFunction(device, nullptr, nullptr); }
    NoMemory(const NoMemory&) = delete;
    NoMemory& operator=(const NoMemory&) = delete;
};

TEST(MovingRays, AHierarchyThatFailedIsBuiltAtTheNextCall)
{
    const Geometry ball = make_geometry(scenes::bumpy_sphere(12));
    const std::vector<std::uint32_t> body(ball.triangles.size(), 1);
    MovingRayScene scene(ball, split_bodies(ball, body));
    const glm::dmat4 away = glm::translate(glm::dmat4(1.0), glm::dvec3(0.5, 0.0, 0.0));
    scene.place(1, away);
    {
        const NoMemory none;
        EXPECT_THROW(static_cast<void>(scene.now()), std::runtime_error);
    }
    Geometry moved = ball;
    for (glm::vec3& p : moved.positions)
        p.x += 0.5f;
    const std::vector<Receiver> receivers = vertex_receivers(moved);
    EXPECT_LT(rms_difference(trace_occlusion(RayScene(moved, RayScene::Build::fast), receivers, {}),
                             trace_occlusion(scene.now(), receivers, {})),
              1e-3);
}

}  // namespace
}  // namespace surfelao
