/// reference_cache.h: what all others are measured against: robust rays, many of them, kept on
/// disk.
///
/// Also says what the reference itself is worth: its own noise, and where the question has no
/// answer.
#pragma once

#include "reference/well_defined.h"
#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace surfelao {

struct ReferenceOptions {
    Definition definition = {};
    std::uint32_t rays = 4096;  ///< per receiver, an even number from 2 to kMostRays
    bool use_cache = true;
    bool find_ill_defined = true;  ///< else no `change`, which costs 1280 rays a receiver
};

struct Reference {
    std::vector<Occlusion> occlusion;    ///< one per receiver: the mean of two independent halves
    std::vector<float> half_difference;  ///< one per receiver: half of the first half's occlusion
                                         ///< less the second's. As noisy as `occlusion` is, and
                                         ///< independent of it
    std::vector<float> change;  ///< one per receiver: placement_change (well_defined.h); or empty
    double noise = 0.0;         ///< RMS error of `occlusion` by sampling: RMS of half_difference
    bool from_cache = false;

    bool well_defined(std::size_t i) const { return change.empty() || change[i] <= kIllDefined; }
};

/// Traces the reference, or reads it from the user's cache folder when the same geometry, receivers
/// and options were traced before (by content hash). A cache file that is cut, damaged or of
/// another version is traced anew and replaced; a cache folder that cannot be written is done
/// without. Throws SettingsError where an option is out of its range, Cancelled.
[[nodiscard]] Reference trace_reference(const Geometry& geometry,
                                        std::span<const Receiver> receivers,
                                        const ReferenceOptions& options,
                                        const Progress& progress = {});

/// $XDG_CACHE_HOME/surfelao, else $HOME/.cache/surfelao; empty where neither is set. Kept below
/// kCacheBytes by removing the files that were written first.
[[nodiscard]] std::filesystem::path cache_folder();

inline constexpr std::uint64_t kCacheBytes = std::uint64_t{1} << 30;

}  // namespace surfelao
