/// owner_ranges.h: sums that triangles give to what they touch, by all threads.
///
/// Internal: for the folders' own sources.
#pragma once

#include "surfels/for_all.h"

#include <cstddef>
#include <cstdint>

namespace surfelao {

/// Consecutive owners: vertices or places.
struct OwnerRange {
    std::uint32_t begin, end;
    [[nodiscard]] bool has(std::uint32_t owner) const { return owner - begin < end - begin; }
};

/// Calls body(range) for ranges that make up 0 to count - 1, one a thread. Each call goes over all
/// triangles and gives to owners in its range only: every owner gets its summands in the order of
/// the triangles, so that sums have the same bytes for any number of threads, and nothing is stored
/// for it. What is near in a mesh mostly has near numbers: little is computed twice.
template <class Body>
void for_owner_ranges(std::size_t count, const Body& body)
{
    constexpr std::size_t kFewOwners = 4096;  // a thread's start takes longer
    const std::size_t ranges = count < kFewOwners ? 1 : loop_threads();
    for_tasks(ranges, [&](std::size_t i) {
        body(OwnerRange{static_cast<std::uint32_t>(count * i / ranges),
                        static_cast<std::uint32_t>(count * (i + 1) / ranges)});
    });
}

}  // namespace surfelao
