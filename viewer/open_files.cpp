#include "viewer/open_files.h"

#include <algorithm>

namespace surfelao {

void OpenFiles::add(const std::filesystem::path& file)
{
    if (std::ranges::find(files_, file) == files_.end())
        files_.push_back(file);
}

void OpenFiles::forget(const std::filesystem::path& file)
{
    std::erase(files_, file);
    off_.erase(file);
}

void OpenFiles::turn(const std::filesystem::path& file, bool on)
{
    if (on)
        off_.erase(file);
    else
        off_.insert(file);
}

OpenFiles::Paths OpenFiles::beside(const std::filesystem::path& file) const
{
    Paths others;
    for (const std::filesystem::path& other : files_) {
        if (are_together && other != file && is_on(other))
            others.push_back(other);
    }
    return others;
}

}  // namespace surfelao
