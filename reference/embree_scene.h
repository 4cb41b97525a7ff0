/// embree_scene.h: what stands behind a RayScene, for the sources of this folder alone.
#pragma once

#include "reference/rays.h"

#include <cstddef>

// Embree's own: its headers stay out of ours
struct RTCDeviceTy;
struct RTCGeometryTy;
struct RTCSceneTy;

namespace surfelao {

struct RayScene::Impl {
    RTCSceneTy* scene = nullptr;
    bool wide = false;  ///< packets of 16 are native

    /// Without meshes, not committed. moves: each mesh gets a hierarchy of its own, and one is over
    /// them; else Embree builds one of all triangles at every commit.
    Impl(RTCDeviceTy* device, Build build, bool moves);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
};

/// One device per instruction set for the whole process: its start is not part of anyone's build.
/// Throws std::runtime_error where Embree cannot start.
[[nodiscard]] RTCDeviceTy* device_for(RayScene::Isa isa);

/// A triangle mesh, and its buffers, which are to be filled. The caller releases it.
struct EmbreeMesh {
    RTCGeometryTy* geometry = nullptr;
    glm::vec3* vertices = nullptr;
    glm::uvec3* triangles = nullptr;
};
/// Throws std::runtime_error where there is no memory.
[[nodiscard]] EmbreeMesh new_mesh(RTCDeviceTy* device, std::size_t vertices, std::size_t triangles);

/// Throws std::runtime_error for what the device has met since it was last asked.
void check_device(RTCDeviceTy* device);

/// TBB gives to all its threads, for good, the floating-point mode that a thread has at its first
/// parallel loop. Embree's commit changes the mode and then starts one: ours comes first.
void keep_floating_point_mode();

}  // namespace surfelao
