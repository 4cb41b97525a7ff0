/// atomic_file.h: a file that appears complete or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace surfelao {

/// Calls `produce` with a temporary path in the folder of `path` (same extension), then renames
/// what it wrote to `path`. When `produce` throws, the temporary file is removed, an existing
/// `path` is untouched, and the exception goes on. Throws std::runtime_error naming `path` and the
/// system's reason when the file cannot be created, flushed to the disk or renamed.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& produce);

/// The same for contents that are at hand.
void write_atomically(const std::filesystem::path& path, std::string_view contents);

}  // namespace surfelao
