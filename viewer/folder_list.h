/// folder_list.h: what a user may choose from in a folder.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace surfelao {

struct FolderEntry {
    std::string name;
    bool is_folder = false;
    bool operator==(const FolderEntry&) const = default;
};

using FileFilter = std::function<bool(const std::filesystem::path& file)>;

/// Folders, then files that are wanted, each in the order of their names regardless of case; none
/// that are hidden. Where the folder cannot be read `fault` says why, in one sentence. O(n log n).
[[nodiscard]] std::vector<FolderEntry> entries_of(const std::filesystem::path& folder,
                                                  const FileFilter& wants, std::string& fault);

}  // namespace surfelao
