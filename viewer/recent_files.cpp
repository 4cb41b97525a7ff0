#include "viewer/recent_files.h"

#include "surfels/atomic_file.h"
#include "viewer/output_files.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <system_error>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

}  // namespace

fs::path recent_list_path()
{
    const char* state = std::getenv("XDG_STATE_HOME");
    if (state != nullptr && fs::path(state).is_absolute())
        return fs::path(state) / "surfelao" / "recent";
    const char* home = std::getenv("HOME");
    if (home == nullptr || !fs::path(home).is_absolute())
        return {};
    return fs::path(home) / ".local" / "state" / "surfelao" / "recent";
}

RecentFiles::RecentFiles(fs::path list) : list_(std::move(list))
{
    read();
}

void RecentFiles::read()
{
    files_.clear();
    std::ifstream lines(list_);
    std::string line;
    while (files_.size() < kMostRecent && std::getline(lines, line)) {
        const fs::path file = line;
        std::error_code error;
        if (file.is_absolute() && fs::is_regular_file(file, error) &&
            std::ranges::find(files_, file) == files_.end())
            files_.push_back(file);
    }
}

void RecentFiles::add(const fs::path& file)
{
    const fs::path added = whole_path(file);
    const bool is_one_line = added.string().find('\n') == std::string::npos;
    if (list_.empty() || !is_one_line)
        return;
    read();
    std::erase(files_, added);
    files_.insert(files_.begin(), added);
    files_.resize(std::min(files_.size(), kMostRecent));
    std::string text;
    for (const fs::path& known : files_)
        text += known.string() + '\n';
    try {
        fs::create_directories(list_.parent_path());
        write_atomically(list_, text);
    } catch (const std::exception&) {  // a full or read-only home: nothing is kept
    }
}

}  // namespace surfelao
