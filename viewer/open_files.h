/// open_files.h: the files of a window, of which one is shown.
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

namespace surfelao {

/// All paths absolute, as whole_path() gives them (output_files.h).
class OpenFiles {
public:
    using Paths = std::vector<std::filesystem::path>;

    /// occluders: they occlude whatever is shown (PartChoice::occluders).
    explicit OpenFiles(Paths occluders) : occluders_(std::move(occluders)) {}

    /// In the order in which they came, each once.
    const Paths& all() const { return files_; }
    void add(const std::filesystem::path& file);
    void forget(const std::filesystem::path& file);

    /// Whether they stand in one world, in which all occlude each other.
    bool are_together = false;

    /// What occludes one of them besides its own parts.
    [[nodiscard]] Paths occluders_of(const std::filesystem::path& file) const;

private:
    Paths occluders_, files_;
};

}  // namespace surfelao
