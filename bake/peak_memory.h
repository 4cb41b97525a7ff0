/// peak_memory.h: bytes of a run.
#pragma once

#include <cstdint>

namespace surfelao {

/// The most memory this process has held at once.
[[nodiscard]] std::uint64_t peak_rss_bytes();

}  // namespace surfelao
