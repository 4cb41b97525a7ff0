#include "files/sidecars.h"

#include "files/file_type.h"
#include "files/foreign_io.h"
#include "files/gltf_strings.h"
#include "files/gltf_uri.h"
#include "files/text_cursor.h"
#include "surfels/errors.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// A comment of a PLY that names a file stands in its header, and few headers are so long.
constexpr std::size_t kMostHeaderLines = 1000;

/// Longest name of a file, in words.
constexpr std::size_t kMostWords = 16;

constexpr std::size_t kMostListed = 4;

constexpr std::string_view kBlanks = " \t\r";

/// The file of this name, which may have been written with backslashes; empty where there is none.
fs::path file_named(const fs::path& folder, std::string_view name)
{
    std::string slashed(name);
    std::ranges::replace(slashed, '\\', '/');
    for (const std::string_view spelling : {name, std::string_view(slashed)}) {
        std::error_code error;
        if (fs::is_regular_file(folder / spelling, error))
            return folder / spelling;
    }
    return {};
}

/// The longest name at the beginning of `words` that is a file; else the first word.
NamedFile first_named(const fs::path& folder, std::string_view words)
{
    std::vector<std::size_t> ends;
    for (std::size_t end = 0; end < words.size() && ends.size() < kMostWords;) {
        end = std::min(words.find_first_of(kBlanks, end), words.size());
        ends.push_back(end);
        end = std::min(words.find_first_not_of(kBlanks, end), words.size());
    }
    NamedFile found;
    for (; !ends.empty() && found.file.empty(); ends.pop_back()) {
        found.name = words.substr(0, ends.back());
        found.file = file_named(folder, found.name);
    }
    return found;
}

void add_named(const fs::path& folder, std::string_view names, std::vector<fs::path>& files)
{
    for (const NamedFile& named : files_named(folder, names)) {
        if (!named.file.empty())
            files.push_back(named.file);
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
        if (keyword == "comment" && rest.find(kTextureKeyword) != rest.npos)
            add_named(mesh.parent_path(), rest, files);
        return keyword != "end_header" && ++lines < kMostHeaderLines;
    });
}

/// Adds the files that the strings of the mesh's glTF name.
VisitString add_uris(const fs::path& mesh, std::vector<fs::path>& files)
{
    return [&](std::span<const std::string> keys, const std::string& text) {
        if (!keys.empty() && keys.back() == "uri" && !is_data_uri(text)) {
            if (const std::optional<fs::path> file = locate_uri(mesh.parent_path(), text))
                files.push_back(*file);
        }
        return true;
    };
}

void add_of_foreign(const fs::path& mesh, std::vector<fs::path>& files)
{
    try {
        visit_gltf_strings_in(import_file(mesh).glb, add_uris(mesh, files));
    } catch (const InputError&) {
        // names nothing that we know of
    }
}

}  // namespace

bool names_texture(std::string_view keyword)
{
    constexpr std::string_view kKeywords[] = {"bump", "disp", "decal", "refl", "norm"};
    return keyword.starts_with("map_") || std::ranges::find(kKeywords, keyword) != kKeywords + 5;
}

std::vector<NamedFile> files_named(const fs::path& folder, std::string_view names)
{
    std::vector<NamedFile> found;
    while (true) {
        names.remove_prefix(std::min(names.find_first_not_of(kBlanks), names.size()));
        if (names.empty())
            return found;
        found.push_back(first_named(folder, names));
        names.remove_prefix(found.back().name.size());
    }
}

std::string path_from(const fs::path& folder, const fs::path& file)
{
    // of the folders only: what a link to a file stands beside is what its user sees
    const fs::path way =
        fs::relative(fs::absolute(file).parent_path(), fs::absolute(folder.empty() ? "." : folder));
    return (way / file.filename()).lexically_normal().generic_string();
}

std::string names_from(const fs::path& to, const fs::path& from, std::string_view names,
                       std::vector<std::string>& missing)
{
    std::error_code error;
    if (fs::equivalent(to.empty() ? "." : to, from, error))
        return std::string(names);
    std::string text;
    std::size_t copied = 0;
    for (const NamedFile& named : files_named(from, names)) {
        if (named.file.empty())
            missing.emplace_back(named.name);
        if (named.file.empty() || fs::path(named.name).is_absolute())
            continue;
        const std::size_t begin = static_cast<std::size_t>(named.name.data() - names.data());
        text.append(names.substr(copied, begin - copied)).append(path_from(to, named.file));
        copied = begin + named.name.size();
    }
    return text.append(names.substr(copied));
}

void note_missing(const std::vector<std::string>& missing, std::vector<std::string>& notes)
{
    if (missing.empty())
        return;
    std::string note = "named in the file and not found: ";
    for (std::size_t i = 0; i < std::min(missing.size(), kMostListed); ++i)
        note.append(i > 0 ? ", " : "").append(surfelao::quoted(missing[i]));
    if (missing.size() > kMostListed)
        note += " and " + std::to_string(missing.size() - kMostListed) + " more";
    notes.push_back(std::move(note));
}

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
        visit_gltf_strings(mesh, add_uris(mesh, files));
    else if (type == FileType::foreign)
        add_of_foreign(mesh, files);
    return files;
}

}  // namespace surfelao
