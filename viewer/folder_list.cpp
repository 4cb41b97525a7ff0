#include "viewer/folder_list.h"

#include <algorithm>
#include <system_error>
#include <tuple>

namespace surfelao {
namespace {

std::string lower_name(std::string name)
{
    std::ranges::transform(name, name.begin(), [](char sign) {
        return sign >= 'A' && sign <= 'Z' ? static_cast<char>(sign - 'A' + 'a') : sign;
    });
    return name;
}

bool is_before(const FolderEntry& a, const FolderEntry& b)
{
    return std::tuple(!a.is_folder, lower_name(a.name), a.name) <
           std::tuple(!b.is_folder, lower_name(b.name), b.name);
}

}  // namespace

std::vector<FolderEntry> entries_of(const std::filesystem::path& folder, const FileFilter& wants,
                                    std::string& fault)
{
    namespace fs = std::filesystem;
    std::vector<FolderEntry> entries;
    std::error_code error;
    fs::directory_iterator at(folder, error);
    for (; !error && at != fs::directory_iterator(); at.increment(error)) {
        const std::string name = at->path().filename().string();
        std::error_code ignored;
        const bool is_folder = at->is_directory(ignored);
        const bool is_shown = is_folder || (at->is_regular_file(ignored) && wants(at->path()));
        if (is_shown && !name.starts_with('.'))
            entries.push_back({name, is_folder});
    }
    fault = error ? folder.string() + " cannot be read: " + error.message() : std::string();
    std::ranges::sort(entries, is_before);
    return entries;
}

}  // namespace surfelao
