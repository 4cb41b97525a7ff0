#include "viewer/output_files.h"

#include <algorithm>
#include <string>
#include <system_error>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

bool holds(const std::vector<fs::path>& files, const fs::path& path)
{
    return std::any_of(files.begin(), files.end(), [&](const fs::path& file) {
        std::error_code error;
        return fs::equivalent(file, path, error);
    });
}

}  // namespace

fs::path whole_path(const fs::path& path)
{
    std::error_code error;
    const fs::path whole = fs::absolute(path, error);
    return (error ? path : whole).lexically_normal();
}

void OutputFiles::add_input(const fs::path& path)
{
    inputs_.push_back(path);
}

void OutputFiles::add_written(const fs::path& path)
{
    if (!holds(written_, path))
        written_.push_back(path);
}

Standing OutputFiles::standing_of(const fs::path& path) const
{
    std::error_code error;
    if (!fs::exists(path, error))
        return Standing::nothing;
    if (holds(inputs_, path))
        return Standing::input;
    return holds(written_, path) ? Standing::written : Standing::foreign;
}

fs::path next_free_name(const fs::path& path, const FilesOf& files_of)
{
    for (int number = 2;; ++number) {
        fs::path name = path.stem();
        name += '-';
        name += std::to_string(number);
        name += path.extension();
        const fs::path candidate = path.parent_path() / name;
        const bool is_free = std::ranges::none_of(files_of(candidate), [](const fs::path& file) {
            std::error_code error;
            return fs::exists(fs::symlink_status(file, error));
        });
        if (is_free)
            return candidate;
    }
}

}  // namespace surfelao
