/// sampled_cloud.h: points of a mesh as a scanner would give them, for tests and benchmarks.
#pragma once

#include "surfels/scene.h"
#include "surfels/surface.h"

#include <cstdint>
#include <vector>

namespace surfelao::scenes {

struct CloudSampling {
    std::uint32_t points = 50'000;
    double noise = 0.0;  ///< standard deviation along each axis, in spacings: sqrt(area / points)
    bool has_normals = true;  ///< the cloud tells the mesh's
    std::uint32_t seed = 1;
};

struct SampledCloud {
    Scene cloud;                        ///< in the mesh's units
    std::vector<SurfacePoint> samples;  ///< of the mesh, where each point comes from
    double spacing = 0.0;
};

/// Points at random all over the mesh, in equal stretches of its area. The same bytes every time.
[[nodiscard]] SampledCloud sampled(const Mesh& mesh, const CloudSampling& sampling);

}  // namespace surfelao::scenes
