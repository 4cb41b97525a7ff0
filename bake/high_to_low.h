/// high_to_low.h: what a fine mesh shows, asked at the points of a coarse one: the way in which
/// games get the detail of a sculpture onto a model.
///
/// From a point of the low mesh one goes out along its shading normal by the *cage* and looks back,
/// twice as far. What is met first with its outside is what the point shows: there occlusion is
/// asked, with the high mesh's own normal, and only the high mesh occludes. Where only back sides
/// are met, the first of them is taken, seen from this side. A ray that meets nothing is a miss:
/// the low point itself is asked, among the high mesh.
///
/// Parts match by name as artists do it: what lies on a part NAME_low looks for parts NAME_high
/// (and NAME_high_1 and so on, in any case) where there are some, else for all. A part without a
/// name has its file's.
#pragma once

#include "surfels/receiver.h"
#include "surfels/surface.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace surfelao {

/// Of the low mesh's diagonal.
inline constexpr double kCageShare = 0.02;

/// Immutable once built; any number of threads.
class HighDetail {
public:
    /// Both must outlive it. cage: > 0, in the units of the files. Throws SettingsError. O(n log n)
    /// of the high mesh, all cores.
    HighDetail(const Mesh& low, const Mesh& high, double cage);
    ~HighDetail();

    [[nodiscard]] const Mesh& mesh() const { return high_; }

    /// Receivers in the unit frame of the high mesh, one per point of the low one. offset: in that
    /// frame. misses: gets the number of misses added.
    [[nodiscard]] std::vector<Receiver> receivers(std::span<const SurfacePoint> low_points,
                                                  const Offset& offset,
                                                  std::uint64_t* misses = nullptr) const;

    /// Low parts that found high parts of their name.
    [[nodiscard]] std::size_t matched_parts() const { return matched_parts_; }

private:
    struct Group;

    const Mesh& low_;
    const Mesh& high_;
    double cage_;
    std::vector<std::unique_ptr<Group>> groups_;  ///< the first has all triangles
    std::vector<std::uint32_t> group_of_;         ///< per triangle of the low mesh
    std::size_t matched_parts_ = 0;
};

}  // namespace surfelao
