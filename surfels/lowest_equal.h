/// lowest_equal.h: which of many things are equal, by a hash.
///
/// Internal: for the folders' own sources.
#pragma once

#include "surfels/for_all.h"

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace surfelao {

/// For each of things 0 to count - 1 the lowest that equals it. hash(i): 64 bits of which the low
/// ones differ; equal(i, j). O(count) expected. All threads put things into one table: once a slot
/// has a thing it keeps things that equal it, and in the end the lowest of them.
template <class Hash, class Equal>
[[nodiscard]] std::vector<std::uint32_t> lowest_equal(std::size_t count, const Hash& hash,
                                                      const Equal& equal)
{
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    const std::size_t slot_count = std::bit_ceil(count * 2 + 1);
    std::vector<std::uint32_t> slots(slot_count, kNone);
    std::vector<std::uint32_t> slot_of(count);
    for_all(count, [&](std::size_t index) {
        const auto i = static_cast<std::uint32_t>(index);
        for (std::size_t at = hash(i);; ++at) {
            const std::size_t slot = at & (slot_count - 1);
            const std::atomic_ref<std::uint32_t> held(slots[slot]);
            std::uint32_t other = held.load(std::memory_order_relaxed);
            if (other == kNone && held.compare_exchange_strong(other, i, std::memory_order_relaxed))
                other = i;
            if (other != i && !equal(other, i))
                continue;
            while (i < other && !held.compare_exchange_weak(other, i, std::memory_order_relaxed)) {
            }
            slot_of[i] = static_cast<std::uint32_t>(slot);
            return;
        }
    });
    for_all(count, [&](std::size_t i) { slot_of[i] = slots[slot_of[i]]; });
    return slot_of;
}

}  // namespace surfelao
