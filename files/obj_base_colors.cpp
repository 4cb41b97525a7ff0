#include "files/file_contents.h"
#include "files/obj_file.h"
#include "files/sidecars.h"
#include "surfels/errors.h"

#include <algorithm>
#include <functional>
#include <map>

namespace surfelao {
namespace {

/// Materials by name, each with Kd and map_Kd; the options of a map count as words before its name.
class MaterialFiles {
public:
    explicit MaterialFiles(BaseColors& colors) : colors_(colors) {}

    void read(const std::filesystem::path& path)
    {
        const std::string text = read_contents(path, path.string());
        TextCursor cursor(path.string(), text, {.comment = '#'});
        while (cursor.next_line()) {
            const std::string_view statement = cursor.word();
            if (statement == "newmtl") {
                by_name_.insert_or_assign(std::string(cursor.rest_of_line()),
                                          static_cast<std::uint32_t>(colors_.materials.size()));
                colors_.materials.emplace_back();
            } else if (statement == "Kd" && !by_name_.empty()) {
                for (int k = 0; k < 3; ++k) {
                    const auto number = number_in(cursor.word());
                    colors_.materials.back().factor[k] = number ? linear_of(*number) : 1.0f;
                }
            } else if (statement == "map_Kd" && !by_name_.empty()) {
                add_picture(path.parent_path(), cursor.rest_of_line());
            }
        }
    }

    /// White for a name that no file has.
    [[nodiscard]] std::uint32_t number_of(std::string_view name) const
    {
        const auto found = by_name_.find(name);
        return found == by_name_.end() ? 0 : found->second;
    }

private:
    void add_picture(const std::filesystem::path& folder, std::string_view words)
    {
        for (const NamedFile& named : files_named(folder, words)) {
            if (named.file.empty())
                continue;
            colors_.materials.back().picture = static_cast<std::uint32_t>(colors_.pictures.size());
            colors_.pictures.push_back({named.file.filename().string(), named.file, {}});
            return;
        }
    }

    BaseColors& colors_;
    std::map<std::string, std::uint32_t, std::less<>> by_name_;
};

}  // namespace

BaseColors ObjSource::base_colors() const
{
    BaseColors colors;
    colors.materials.emplace_back();  // of faces without one
    MaterialFiles files(colors);
    std::uint32_t material = 0;
    TextCursor cursor("", text, kObjRules);
    while (cursor.next_line()) {
        const std::string_view statement = cursor.word();
        if (statement == "mtllib") {
            for (const NamedFile& named : files_named(folder, cursor.rest_of_line())) {
                try {
                    if (!named.file.empty())
                        files.read(named.file);
                } catch (const InputError&) {  // its materials are white
                }
            }
        } else if (statement == "usemtl") {
            material = files.number_of(cursor.rest_of_line());
        } else if (statement == "f" || statement == "fo") {
            std::size_t corners = 0;
            for (; !cursor.at_line_end(); ++corners)
                cursor.word();
            colors.triangles.insert(colors.triangles.end(), corners < 3 ? 0 : corners - 2,
                                    material);
        }
    }
    return colors;
}

}  // namespace surfelao
