/// sample.h: a part that stands for the whole.
#pragma once

#include <cstdint>
#include <vector>

namespace surfelao {

/// `wanted` of the indices below `count` (all of them for wanted = 0 or >= count), ascending: one
/// at a hashed place in each of as many equal stretches. Even, and no accident of the file's order.
[[nodiscard]] std::vector<std::uint32_t> sample_of(std::uint64_t count, std::uint64_t wanted);

}  // namespace surfelao
