#include "surfels/repeated.h"

#include "surfels/for_all.h"

#include <algorithm>
#include <atomic>

namespace surfelao {
namespace {

/// Bits that threads set.
class BitSet {
public:
    explicit BitSet(std::size_t bits) : words_(bits / 64 + 1, 0) {}

    /// Returns whether it was set.
    bool set(std::size_t bit)
    {
        const std::uint64_t mask = std::uint64_t{1} << bit % 64;
        const std::atomic_ref<std::uint64_t> word(words_[bit / 64]);
        return (word.fetch_or(mask, std::memory_order_relaxed) & mask) != 0;
    }
    [[nodiscard]] bool has(std::size_t bit) const
    {
        return (words_[bit / 64] >> bit % 64 & 1) != 0;
    }

private:
    std::vector<std::uint64_t> words_;
};

/// One of 64 for each lowest vertex: what is near in the file is then near in memory too.
std::size_t bit_of(glm::uvec3 key)
{
    const std::uint64_t hash = (std::uint64_t{key.y} << 32 | key.z) * 0x9E3779B97F4A7C15u;
    return std::size_t{key.x} * 64 + (hash >> 58);
}

}  // namespace

glm::uvec3 positions_of(glm::uvec3 t, const std::vector<std::uint32_t>& welded)
{
    t = {welded[t.x], welded[t.y], welded[t.z]};
    const std::uint32_t low = std::min({t.x, t.y, t.z}), high = std::max({t.x, t.y, t.z});
    return {low, t.x ^ t.y ^ t.z ^ low ^ high, high};
}

std::vector<std::uint32_t> maybe_repeated(const std::vector<glm::uvec3>& triangles,
                                          const std::vector<std::uint32_t>& welded)
{
    const std::size_t bits = welded.size() * 64;
    BitSet met(bits), met_again(bits);
    std::atomic<bool> is_any{false};
    for_all(triangles.size(), [&](std::size_t t) {
        const std::size_t bit = bit_of(positions_of(triangles[t], welded));
        if (!met.set(bit))
            return;
        met_again.set(bit);
        is_any.store(true, std::memory_order_relaxed);
    });
    std::vector<std::uint32_t> found;
    if (!is_any)
        return found;
    std::vector<std::uint8_t> is_found(triangles.size());
    for_all(triangles.size(), [&](std::size_t t) {
        is_found[t] = met_again.has(bit_of(positions_of(triangles[t], welded)));
    });
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        if (is_found[t] != 0)
            found.push_back(t);
    }
    return found;
}

}  // namespace surfelao
