#include "files/file_contents.h"
#include "files/obj_file.h"
#include "files/sidecars.h"
#include "surfels/errors.h"

#include <algorithm>
#include <functional>
#include <map>

namespace surfelao {
namespace {

/// Materials by name, each with Kd, map_Kd, d (or Tr) and map_d; the options of a map count as
/// words before its name.
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
                const std::string name(cursor.rest_of_line());
                by_name_.insert_or_assign(name,
                                          static_cast<std::uint32_t>(colors_.materials.size()));
                colors_.materials.emplace_back().name = name;
            } else if (by_name_.empty()) {
                continue;
            } else if (statement == "Kd") {
                for (int k = 0; k < 3; ++k) {
                    const auto number = number_in(cursor.word());
                    colors_.materials.back().factor[k] = number ? linear_of(*number) : 1.0f;
                }
            } else if (statement == "map_Kd") {
                colors_.materials.back().picture =
                    picture_in(path.parent_path(), cursor.rest_of_line());
            } else if (statement == "map_d") {
                BaseColor& material = colors_.materials.back();
                material.alpha_picture = picture_in(path.parent_path(), cursor.rest_of_line());
                material.grey_is_alpha = true;
                material.opacity = material.alpha_picture ? Opacity::cut : material.opacity;
            } else if (statement == "d" || statement == "Tr") {
                set_opacity(colors_.materials.back(), statement == "Tr", cursor);
            }
        }
    }

    /// Those behind `mtllib`. The materials of what cannot be read are white.
    void read_named(const std::filesystem::path& folder, std::string_view words)
    {
        for (const NamedFile& named : files_named(folder, words)) {
            try {
                if (!named.file.empty())
                    read(named.file);
            } catch (const InputError&) {
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
    /// The number of the first file there that is one.
    std::optional<std::uint32_t> picture_in(const std::filesystem::path& folder,
                                            std::string_view words)
    {
        for (const NamedFile& named : files_named(folder, words)) {
            if (named.file.empty())
                continue;
            colors_.pictures.push_back({named.file.filename().string(), named.file, {}});
            return static_cast<std::uint32_t>(colors_.pictures.size() - 1);
        }
        return {};
    }

    /// `d OPACITY`, `d -halo OPACITY` or `Tr TRANSPARENCY`. With holes by map_d those count.
    static void set_opacity(BaseColor& material, bool is_transparency, TextCursor& cursor)
    {
        std::string_view word = cursor.word();
        if (word == "-halo")
            word = cursor.word();
        const auto number = number_in(word);
        if (!number || material.opacity == Opacity::cut)
            return;
        const double opacity = is_transparency ? 1.0 - *number : *number;
        material.opacity = opacity < 1.0 ? Opacity::clear : Opacity::solid;
        material.alpha = static_cast<float>(std::clamp(opacity, 0.0, 1.0));
    }

    BaseColors& colors_;
    std::map<std::string, std::uint32_t, std::less<>> by_name_;
};

}  // namespace

bool ObjSource::has_openings() const
{
    BaseColors colors;
    MaterialFiles files(colors);
    for (const std::string& words : libraries)
        files.read_named(folder, words);
    return std::ranges::any_of(colors.materials, [](const BaseColor& material) {
        return material.opacity != Opacity::solid;
    });
}

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
            files.read_named(folder, cursor.rest_of_line());
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
