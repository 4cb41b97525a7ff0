/// output_files.h: which files a run may write without a question, so that nothing is lost that a
/// user owns.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace surfelao {

/// Absolute, without "." and "..": one name for one place, as it is shown to users.
[[nodiscard]] std::filesystem::path whole_path(const std::filesystem::path& path);

/// What stands where a file is to be written.
enum class Standing {
    nothing,
    written,  ///< by this run: it may be replaced without a question
    foreign,  ///< not by this run: it is replaced only when its owner agrees
    input,    ///< read by this run: it is never replaced
};

/// The files that a run has read and written. Two paths are one file where they lead to the same
/// one, by links or otherwise.
class OutputFiles {
public:
    void add_input(const std::filesystem::path& path);
    void add_written(const std::filesystem::path& path);

    /// A file that was written and then read is an input.
    [[nodiscard]] Standing standing_of(const std::filesystem::path& path) const;

    /// In the order of their first writing, each once.
    const std::vector<std::filesystem::path>& written() const { return written_; }

private:
    std::vector<std::filesystem::path> inputs_, written_;
};

/// All that is written for a file of that name.
using FilesOf = std::function<std::vector<std::filesystem::path>(const std::filesystem::path&)>;

/// folder/name-2.ply for folder/name.ply, or the first number above 2 for which none of its files
/// stands there.
[[nodiscard]] std::filesystem::path next_free_name(const std::filesystem::path& path,
                                                   const FilesOf& files_of);

}  // namespace surfelao
