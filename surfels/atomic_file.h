/// atomic_file.h: a file that appears complete or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace surfelao {

/// Throws InputError with one sentence when no file can appear at `path`: its folder is missing, is
/// no folder or may not be written; `path` is a folder, a device, or a file without write
/// permission. A symbolic link stands for the file it leads to.
void check_writable(const std::filesystem::path& path);

/// Calls `produce` with a temporary path in the folder of `path` (same extension, empty file), then
/// flushes what it wrote to the disk and renames it to `path`, which keeps its permissions if it
/// exists. When `produce` throws, the temporary file is removed, an existing `path` is untouched,
/// and the exception goes on. Throws what check_writable throws, and std::runtime_error naming
/// `path` and the system's reason when the file cannot be created, flushed or renamed. Any number
/// of threads and processes may write the same path: one of the complete files wins.
///
/// `produce` must report its own failed writes (a full disk) by throwing.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& produce);

/// The same for contents that are at hand.
void write_atomically(const std::filesystem::path& path, std::string_view contents);

/// Removes the temporary files of all write_atomically calls that are under way in this process.
/// For a signal handler that ends the process at once (async-signal-safe). A handler that lets the
/// work end by Cancelled does not need it: exceptions clean up.
void remove_temporary_files() noexcept;

}  // namespace surfelao
