/// recent_files.h: the files that were opened last, across runs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace surfelao {

inline constexpr std::size_t kMostRecent = 10;

/// $XDG_STATE_HOME/surfelao/recent, or ~/.local/state/surfelao/recent where that is not set; empty
/// where there is neither (XDG Base Directory Specification).
[[nodiscard]] std::filesystem::path recent_list_path();

/// A list in a file, a path a line, the last first. Whatever fails is no fault: the list is a
/// convenience.
class RecentFiles {
public:
    /// list: empty means that nothing is kept.
    explicit RecentFiles(std::filesystem::path list);

    /// Those that are still there, absolute, kMostRecent at most.
    const std::vector<std::filesystem::path>& files() const { return files_; }

    /// Puts it first and writes the list, with what other windows have put there meanwhile.
    void add(const std::filesystem::path& file);

private:
    void read();
    std::filesystem::path list_;
    std::vector<std::filesystem::path> files_;
};

}  // namespace surfelao
