/// embree_scene.h: what stands behind a RayScene, for the sources of this folder alone.
#pragma once

#include "reference/rays.h"

#include <embree3/rtcore.h>

#include <cstddef>

namespace surfelao {

struct RayScene::Impl {
    RTCScene scene = nullptr;
    bool wide = false;  ///< packets of 16 are native

    Impl(RTCDevice device, RTCSceneFlags flags, RTCBuildQuality quality);
    ~Impl() { rtcReleaseScene(scene); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
};

/// One device per instruction set for the whole process: its start is not part of anyone's build.
/// Throws std::runtime_error where Embree cannot start.
[[nodiscard]] RTCDevice device_for(RayScene::Isa isa);

/// A triangle mesh, and its buffers, which are to be filled. The caller releases it.
struct EmbreeMesh {
    RTCGeometry geometry = nullptr;
    glm::vec3* vertices = nullptr;
    glm::uvec3* triangles = nullptr;
};
/// Throws std::runtime_error where there is no memory.
[[nodiscard]] EmbreeMesh new_mesh(RTCDevice device, std::size_t vertices, std::size_t triangles);

/// Throws std::runtime_error for what the device has met since it was last asked.
void check_device(RTCDevice device);

/// TBB gives to all its threads, for good, the floating-point mode that a thread has at its first
/// parallel loop. Embree's commit changes the mode and then starts one: ours comes first.
void keep_floating_point_mode();

}  // namespace surfelao
