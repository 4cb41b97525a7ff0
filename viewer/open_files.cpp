#include "viewer/open_files.h"

#include <algorithm>
#include <iterator>

namespace surfelao {

void OpenFiles::add(const std::filesystem::path& file)
{
    if (std::ranges::find(files_, file) == files_.end())
        files_.push_back(file);
}

void OpenFiles::forget(const std::filesystem::path& file)
{
    std::erase(files_, file);
}

OpenFiles::Paths OpenFiles::occluders_of(const std::filesystem::path& file) const
{
    Paths others = occluders_;
    if (are_together)
        std::ranges::remove_copy(files_, std::back_inserter(others), file);
    return others;
}

}  // namespace surfelao
