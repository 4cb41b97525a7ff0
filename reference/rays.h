/// rays.h: the independent witness: occlusion by ray casting with Embree. Shares nothing with
/// tree/.
///
/// Also the opponent of every speed comparison, so it is built to be fast: cosine-weighted
/// Owen-scrambled Sobol points with a scramble of its own for each receiver, packets of rays of one
/// receiver sorted to fill one Sobol cell (below 16 rays: one ray each of neighbouring receivers),
/// receivers in Morton order, MEDIUM build, FTZ/DAZ on.
///
/// Based on:
///   Burley. Practical Hash-based Owen Scrambling. JCGT 9(4). 2020
///   Shirley, Chiu. A Low Distortion Map Between Disk and Square. JGT 2(3). 1997
///   Duff et al. Building an Orthonormal Basis, Revisited. JCGT 6(1). 2017
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "surfels/share.h"

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
        quick,   ///< robust, but for few rays: built five times as fast, by Morton order, and a
                 ///< tenth slower to trace
    };
    enum class Isa {
        best,  ///< the widest that the machine has
        avx2,  ///< at most AVX2: what most machines have
    };

    /// Copies what it needs. O(n log n), all cores. A geometry without triangles occludes nothing.
    /// Throws std::runtime_error where Embree refuses (out of memory, processor without SSE2).
    RayScene(const Geometry& geometry, Build build, Isa isa = Isa::best);
    ~RayScene();
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    struct Impl;
    explicit RayScene(std::unique_ptr<Impl> impl);  ///< for the sources of this folder
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

struct RayOptions {
    Definition definition = {};
    std::uint32_t rays = 256;  ///< per receiver, 1 to kMostRays; powers of two are the most exact
    std::uint32_t seed = 0;    ///< another seed, another independent estimate
    Share share = {};          ///< of the runs of neighbours; others but those without a normal get
                               ///< kUnsolved
};

inline constexpr std::uint32_t kMostRays = 1u << 20;

/// One Occlusion per receiver, in the receivers' order. The error is noise without bias, about
/// 0.4 * rays^-0.73 RMS on a detailed mesh. All cores, same bytes for any number of threads.
/// Receivers without a normal get occlusion 0. Throws SettingsError where an option is out of its
/// range, Cancelled.
[[nodiscard]] std::vector<Occlusion> trace_occlusion(const RayScene& scene,
                                                     std::span<const Receiver> receivers,
                                                     const RayOptions& options,
                                                     const Progress& progress = {});

}  // namespace surfelao
