#include "bake/sample.h"

#include <algorithm>

namespace surfelao {

std::vector<std::uint32_t> sample_of(std::uint64_t count, std::uint64_t wanted)
{
    std::vector<std::uint32_t> result;
    const std::uint64_t parts = wanted == 0 ? count : std::min(wanted, count);
    for (std::uint64_t i = 0; i < parts; ++i) {
        const std::uint64_t from = i * count / parts, to = (i + 1) * count / parts;
        const std::uint64_t hash = (i + 1) * 0x9E3779B97F4A7C15u >> 32;
        result.push_back(static_cast<std::uint32_t>(from + hash % (to - from)));
    }
    return result;
}

}  // namespace surfelao
