/// union_find.h: sets of things that are connected.
///
/// Internal: for the folders' own sources.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace surfelao {

/// Things 0 to count - 1, at first each a set of its own. A set is named by its lowest member, so
/// nothing depends on the order of calls. Any number of threads at once (Anderson, Woll. Wait-Free
/// Parallel Algorithms for the Union-Find Problem. 1991); the names are right when all have joined.
/// Nearly O(1) a call, by halving of the ways.
class UnionFind {
public:
    explicit UnionFind(std::size_t count) : parent_(count)
    {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    /// The set that i is in.
    std::uint32_t root(std::uint32_t i)
    {
        for (std::uint32_t parent = at(i).load(kRelaxed); parent != i;) {
            const std::uint32_t next = at(parent).load(kRelaxed);
            if (next != parent)
                at(i).store(next, kRelaxed);  // the way up, whoever else shortens it
            i = parent;
            parent = next;
        }
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b)
    {
        for (;;) {
            a = root(a);
            b = root(b);
            std::uint32_t high = std::max(a, b);
            if (a == b || at(high).compare_exchange_strong(high, std::min(a, b), kRelaxed))
                return;
        }
    }

private:
    static constexpr std::memory_order kRelaxed = std::memory_order_relaxed;

    std::atomic_ref<std::uint32_t> at(std::uint32_t i) { return std::atomic_ref(parent_[i]); }

    std::vector<std::uint32_t> parent_;
};

}  // namespace surfelao
