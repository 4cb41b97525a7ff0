/// lzf.h: the LZF compression of Marc Lehmann's LibLZF, as PCD uses it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace surfelao {

/// A byte of compressed data stands for no more than so many: 3 bytes copy up to 264.
inline constexpr std::size_t kLargestLzfRatio = 88;

/// The bytes that were compressed, exactly `size`; none where the data are something else. Reads
/// and copies within them alone. O(size); asks for no memory beyond kLargestLzfRatio times the
/// data.
[[nodiscard]] std::optional<std::string> unpack_lzf(std::string_view packed, std::size_t size);

}  // namespace surfelao
