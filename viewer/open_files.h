/// open_files.h: the files of a window: one is shown, or several together.
#pragma once

#include <filesystem>
#include <set>
#include <vector>

namespace surfelao {

/// All paths absolute, as whole_path() gives them (output_files.h).
class OpenFiles {
public:
    using Paths = std::vector<std::filesystem::path>;

    /// In the order in which they came, each once.
    const Paths& all() const { return files_; }
    void add(const std::filesystem::path& file);
    void forget(const std::filesystem::path& file);

    /// Whether they stand in one world, in which all that are switched on are shown and occlude
    /// each other.
    bool are_together = false;
    /// At first all are on.
    [[nodiscard]] bool is_on(const std::filesystem::path& file) const
    {
        return !off_.contains(file);
    }
    void turn(const std::filesystem::path& file, bool on);

    /// What is shown with one of them.
    [[nodiscard]] Paths beside(const std::filesystem::path& file) const;

private:
    Paths files_;
    std::set<std::filesystem::path> off_;
};

}  // namespace surfelao
