/// share.h: one of several equal shares of a job's receivers, for machines that do a share each.
///
/// Receivers are solved in groups of neighbours, so a share is a share of the groups that the whole
/// list makes, not of the list: every machine has all receivers, and its answers are the bytes that
/// a single machine would give.
#pragma once

#include <cstddef>
#include <cstdint>

namespace surfelao {

struct Share {
    std::uint32_t index = 0;  ///< below count
    std::uint32_t count = 1;  ///< >= 1; 1: all
    bool operator==(const Share&) const = default;
};

/// Of n things in a row a share has those from `begin` up to `end`: as many as all others, to one.
struct ShareRange {
    std::size_t begin, end;
};
[[nodiscard]] inline ShareRange range_of(const Share& share, std::size_t n)
{
    const auto at = [&](std::uint64_t index) {
        return static_cast<std::size_t>(n / share.count * index +
                                        n % share.count * index / share.count);
    };
    return {at(share.index), at(std::uint64_t{share.index} + 1)};
}

}  // namespace surfelao
