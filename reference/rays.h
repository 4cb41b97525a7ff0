/// rays.h: the independent witness: occlusion by ray casting with Embree. Shares nothing with
/// tree/.
///
/// Also the opponent of every speed comparison, so it is built to be fast: cosine-weighted
/// Owen-scrambled Sobol points, packets of 16 rays of one receiver sorted to fill one Sobol cell,
/// receivers in Morton order, MEDIUM build, FTZ/DAZ on.
///
/// Based on:
///   Burley. Practical Hash-based Owen Scrambling. JCGT 9(4). 2020
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace surfelao {

/// An Embree scene over the geometry's triangles. Immutable once built; any number of threads.
class RayScene {
public:
    enum class Build {
        fast,    ///< the opponent: medium quality, no robust flag
        robust,  ///< the witness: watertight intersections
    };
    RayScene(const Geometry& geometry, Build build);
    ~RayScene();
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

struct RayOptions {
    Definition definition;
    std::uint32_t rays = 256;  ///< per receiver, >= 1
    std::uint32_t seed = 0;
};

/// One Occlusion per receiver; noise about 0.4 * rays^-0.73 RMS. All cores, same bytes for any
/// number of threads. Throws Cancelled.
[[nodiscard]] std::vector<Occlusion> trace_occlusion(const RayScene& scene,
                                                     std::span<const Receiver> receivers,
                                                     const RayOptions& options,
                                                     const Progress& progress = {});

}  // namespace surfelao
