/// part.h: keys are parted into two ranges without a branch that depends on a key: half of such
/// branches would be guessed wrong, and a wrong guess costs more than moving several keys.
#pragma once

#include "surfels/for_all.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace surfelao {

constexpr std::size_t kPartBlock = 4096;  ///< keys of one task
constexpr std::size_t kPartMany = 32768;  ///< fewer keys are left to one thread

/// `keys` in blocks: work(block, index) on all threads.
template <class Key, class Work>
void for_blocks(std::span<Key> keys, const Work& work)
{
    if (keys.size() <= kPartBlock)
        return work(keys, 0);
    for_tasks((keys.size() + kPartBlock - 1) / kPartBlock, [&](std::size_t i) {
        const std::size_t begin = i * kPartBlock;
        work(keys.subspan(begin, std::min(kPartBlock, keys.size() - begin)), i);
    });
}

/// Writes the keys for which below(key) to out[left...], the others to out[..., right - 1] from the
/// end on. Returns how many are below. `out` must not overlap `keys`.
template <class Key, class Below>
std::size_t part(std::span<const Key> keys, const Below& below, Key* out, std::size_t left,
                 std::size_t right)
{
    const std::size_t first = left;
    for (const Key& key : keys) {
        const std::size_t is_below = below(key) ? 1 : 0;
        out[(right - 1) + (left - (right - 1)) * is_below] = key;
        left += is_below;
        right -= 1 - is_below;
    }
    return left - first;
}

/// The same into out[0, keys.size()), many keys by all threads: each goes where it would go in one
/// pass.
template <class Key, class Below>
std::size_t part(std::span<const Key> keys, const Below& below, Key* out)
{
    if (keys.size() < kPartMany)
        return part(keys, below, out, 0, keys.size());
    std::vector<std::size_t> below_before(keys.size() / kPartBlock + 2, 0);
    for_blocks(keys, [&](std::span<const Key> block, std::size_t i) {
        std::size_t count = 0;
        for (const Key& key : block)
            count += below(key) ? 1 : 0;
        below_before[i + 1] = count;
    });
    for (std::size_t i = 1; i < below_before.size(); ++i)
        below_before[i] += below_before[i - 1];
    for_blocks(keys, [&](std::span<const Key> block, std::size_t i) {
        const std::size_t others_before = i * kPartBlock - below_before[i];
        part(block, below, out, below_before[i], keys.size() - others_before);
    });
    return below_before.back();
}

}  // namespace surfelao
