/// union_find.h: sets of things that are connected.
///
/// Internal: for the folders' own sources.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace surfelao {

/// Things 0 to count - 1, at first each a set of its own. A set is named by its lowest member, so
/// nothing depends on the order of calls. Nearly O(1) a call, by halving of the ways.
class UnionFind {
public:
    explicit UnionFind(std::size_t count) : parent_(count)
    {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    /// The set that i is in.
    std::uint32_t root(std::uint32_t i)
    {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b)
    {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace surfelao
