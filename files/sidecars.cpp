#include "files/sidecars.h"

#include "files/file_type.h"
#include "files/gltf_strings.h"
#include "files/gltf_uri.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// Longest name of a file, in words: options of a texture may stand in front of it.
constexpr std::size_t kMostWords = 16;

/// A comment of a PLY that names a file stands in its header, and few headers are so long.
constexpr std::size_t kMostHeaderLines = 1000;

constexpr std::string_view kBlanks = " \t\r";

/// Adds the files in `folder` that any run of words at the end, or any word, of `names` means.
void add_named(const fs::path& folder, std::string_view names, std::vector<fs::path>& files)
{
    const auto add = [&](std::string_view name) {
        std::error_code error;
        if (fs::is_regular_file(folder / name, error))
            files.push_back(folder / name);
    };
    names = names.substr(0, std::min(names.find_last_not_of(kBlanks), names.size() - 1) + 1);
    for (std::size_t word = 0; word < kMostWords; ++word) {
        names.remove_prefix(std::min(names.find_first_not_of(kBlanks), names.size()));
        if (names.empty())
            return;
        add(names);
        const std::size_t end = std::min(names.find_first_of(kBlanks), names.size());
        if (end < names.size())
            add(names.substr(0, end));
        names.remove_prefix(end);
    }
}

/// Calls visit(keyword, rest) for the lines of a text file; false ends it.
template <class Visit>
void for_each_line(const fs::path& path, const Visit& visit)
{
    std::ifstream file(path, std::ios::binary);
    for (std::string line; std::getline(file, line);) {
        const std::string_view text = line;
        const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
        const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
        if (!visit(text.substr(begin, end - begin), text.substr(end)))
            return;
    }
}

bool names_texture(std::string_view keyword)
{
    constexpr std::string_view kKeywords[] = {"bump", "disp", "decal", "refl", "norm"};
    return keyword.starts_with("map_") || std::ranges::find(kKeywords, keyword) != kKeywords + 5;
}

void add_of_obj(const fs::path& mesh, std::vector<fs::path>& files)
{
    const fs::path folder = mesh.parent_path();
    for_each_line(mesh, [&](std::string_view keyword, std::string_view rest) {
        if (keyword == "mtllib")
            add_named(folder, rest, files);
        return true;
    });
    const std::vector<fs::path> materials = files;
    for (const fs::path& material : materials) {
        for_each_line(material, [&](std::string_view keyword, std::string_view rest) {
            if (names_texture(keyword))
                add_named(material.parent_path(), rest, files);
            return true;
        });
    }
}

void add_of_ply(const fs::path& mesh, std::vector<fs::path>& files)
{
    std::size_t lines = 0;
    for_each_line(mesh, [&](std::string_view keyword, std::string_view rest) {
        if (keyword == "comment" && rest.find("TextureFile") != rest.npos)
            add_named(mesh.parent_path(), rest, files);
        return keyword != "end_header" && ++lines < kMostHeaderLines;
    });
}

void add_of_gltf(const fs::path& mesh, std::vector<fs::path>& files)
{
    visit_gltf_strings(mesh, [&](std::span<const std::string> keys, const std::string& text) {
        if (!keys.empty() && keys.back() == "uri" && !is_data_uri(text)) {
            if (const std::optional<fs::path> file = locate_uri(mesh.parent_path(), text))
                files.push_back(*file);
        }
        return true;
    });
}

}  // namespace

std::vector<fs::path> sidecars_of(const fs::path& mesh)
{
    std::vector<fs::path> files;
    std::error_code error;
    if (!fs::is_regular_file(mesh, error))
        return files;
    const FileType type = type_of(mesh);
    if (type == FileType::obj)
        add_of_obj(mesh, files);
    else if (type == FileType::ply)
        add_of_ply(mesh, files);
    else if (is_gltf(type))
        add_of_gltf(mesh, files);
    return files;
}

}  // namespace surfelao
