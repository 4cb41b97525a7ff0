/// off_file.h: an OFF file as its reader and its writer both see it. Internal to off_io.cpp and
/// off_writer.cpp.
#pragma once

#include "files/mesh_source.h"
#include "files/own_colors.h"
#include "files/text_cursor.h"

namespace surfelao {

inline constexpr TextRules kOffRules{.comment = '#'};

struct OffHeader {
    std::uint64_t vertices = 0;  ///< how many
    std::uint64_t faces = 0;
    std::string_view keyword;   ///< as it stands in the text; empty: there is none
    bool is_glued = false;      ///< the number of vertices stands right behind the keyword
    bool has_normals = false;   ///< behind the coordinates, where a vertex has so many numbers
    bool has_textures = false;  ///< two numbers, the last of a vertex
    bool has_colors = false;    ///< at some vertex, whatever the keyword says
    std::size_t end = 0;        ///< byte behind the counts

    /// How many of the numbers that stand behind a vertex' normal are its colour. A single one is a
    /// number of a list that nobody has.
    [[nodiscard]] int color_words(int numbers) const
    {
        const int count = has_textures || numbers > 4 ? numbers - 2 : numbers;
        return count == 3 || count == 4 ? count : 0;
    }
};

/// The file itself, for the writer.
class OffSource : public MeshSource {
public:
    std::string text;
    OffHeader header;

    struct Own {
        std::string_view text;  ///< without the mark and the comments that keep colours
        ColorWords colors;      ///< of each vertex; empty where the file has none of its own
    };
    [[nodiscard]] Own own() const;
    [[nodiscard]] std::vector<glm::vec4> own_colors() const override
    {
        return own().colors.linear();
    }
};

}  // namespace surfelao
