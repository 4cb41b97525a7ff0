#include "files/obj_materials.h"

#include "files/file_contents.h"
#include "files/sidecars.h"
#include "surfels/errors.h"

#include <algorithm>
#include <fstream>
#include <set>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMaterialsHead = "# surfelao: materials with a map of occlusion\n";
constexpr std::string_view kMapKeyword = "map_Ka";
constexpr std::string_view kBlanksInLine = " \t\r";

std::string_view trimmed(std::string_view text)
{
    const std::size_t begin = std::min(text.find_first_not_of(kBlanksInLine), text.size());
    const std::size_t end = text.find_last_not_of(kBlanksInLine);
    return begin == text.size() ? std::string_view() : text.substr(begin, end + 1 - begin);
}

void append_map(std::string& text, std::string_view map, std::string_view line_end)
{
    text.append(kMapKeyword).append(" ").append(map).append(line_end);
}

/// Puts the lines of one library behind one another.
class MaterialLines {
public:
    MaterialLines(const fs::path& folder, std::string_view map, ObjMaterials& materials,
                  std::vector<std::string>& missing)
        : folder_(folder), map_(map), materials_(materials), missing_(missing)
    {
    }

    void add(const fs::path& library)
    {
        const std::string contents = read_contents(library, library.string());
        std::string_view rest = contents;
        if (rest.starts_with(kMaterialsHead))
            rest.remove_prefix(kMaterialsHead.size());
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
            add_line(rest.substr(0, end), library.parent_path());
            rest.remove_prefix(end);
        }
        if (!materials_.text.ends_with('\n'))
            materials_.text += '\n';
    }

    std::set<std::string, std::less<>> names;  ///< of materials that are there

private:
    void add_line(std::string_view line, const fs::path& from)
    {
        const std::string_view words = trimmed(line.substr(0, line.find('\n')));
        const std::string_view keyword = words.substr(0, words.find_first_of(kBlanksInLine));
        const std::string_view value = trimmed(words.substr(keyword.size()));
        if (keyword == kMapKeyword) {
            materials_.replaced += value == map_ ? 0 : 1;
            return;
        }
        if (words.starts_with("# surfelao "))  // the mark of an older result
            return;
        if (keyword == "newmtl") {
            names.emplace(value);
            materials_.text.append(line.ends_with('\n') ? line : std::string(line) + '\n');
            append_map(materials_.text, map_, line.ends_with("\r\n") ? "\r\n" : "\n");
            return;
        }
        if (!names_texture(keyword) || value.empty()) {
            materials_.text += line;
            return;
        }
        const std::size_t begin = static_cast<std::size_t>(value.data() - line.data());
        std::vector<std::string> no_files;  // options of the texture among them
        materials_.text.append(line.substr(0, begin))
            .append(names_from(folder_, from, value, no_files))
            .append(line.substr(begin + value.size()));
        const std::vector<NamedFile> named = files_named(from, value);
        if (std::ranges::all_of(named, [](const NamedFile& one) { return one.file.empty(); }))
            missing_.emplace_back(value);
    }

    const fs::path& folder_;
    std::string_view map_;
    ObjMaterials& materials_;
    std::vector<std::string>& missing_;
};

}  // namespace

ObjMaterials obj_materials(const fs::path& folder, std::span<const fs::path> libraries,
                           std::span<const std::string> used, std::string_view map,
                           std::string_view mark, std::vector<std::string>& missing)
{
    ObjMaterials materials;
    materials.text = kMaterialsHead;
    if (!mark.empty())
        materials.text.append("# ").append(mark).append("\n");
    MaterialLines lines(folder, map, materials, missing);
    for (const fs::path& library : libraries)
        lines.add(library);
    for (const std::string& name : used) {
        if (lines.names.contains(name))
            continue;
        lines.names.insert(name);
        materials.text.append("newmtl ").append(name).append("\nKa 1 1 1\nKd 1 1 1\n");
        append_map(materials.text, map, "\n");
    }
    return materials;
}

bool is_our_materials(const fs::path& path, std::string_view map)
{
    std::ifstream file(path, std::ios::binary);
    std::string line;
    if (!std::getline(file, line) || line + '\n' != kMaterialsHead)
        return false;
    while (std::getline(file, line)) {
        const std::string_view words = trimmed(line);
        if (words.starts_with(kMapKeyword) && trimmed(words.substr(kMapKeyword.size())) == map)
            return true;
    }
    return false;
}

}  // namespace surfelao
