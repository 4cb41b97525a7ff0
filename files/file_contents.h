/// file_contents.h: a whole file in memory. Internal to the readers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace surfelao {

/// All bytes of a regular file that is not empty. Throws InputError, "subject: fault". Read at
/// once: a file that shrinks meanwhile is short, where a mapping would crash.
[[nodiscard]] std::string read_contents(const std::filesystem::path& path,
                                        const std::string& subject);

/// How many bytes those are, for a file that another program is to read; throws likewise.
[[nodiscard]] std::uint64_t contents_size(const std::filesystem::path& path,
                                          const std::string& subject);

}  // namespace surfelao
