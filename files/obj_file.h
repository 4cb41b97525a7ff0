/// obj_file.h: an OBJ file as its reader and its writer both see it. Internal to obj_io.cpp and
/// obj_writer.cpp.
#pragma once

#include "files/mesh_source.h"
#include "files/own_colors.h"
#include "files/text_cursor.h"

namespace surfelao {

inline constexpr TextRules kObjRules{.comment = '#', .continuation = true};

/// The file itself, for the writer.
class ObjSource : public MeshSource {
public:
    std::string text;
    std::size_t vertex_count = 0;
    bool has_colors = false;             ///< at some vertex
    std::vector<std::string> libraries;  ///< what stands behind each `mtllib`

    struct Own {
        std::string_view text;  ///< without the comments that keep colours
        ColorWords colors;      ///< of each vertex; empty where the file has none of its own
    };
    [[nodiscard]] Own own() const;
    [[nodiscard]] std::vector<glm::vec4> own_colors() const override
    {
        return own().colors.linear();
    }
    [[nodiscard]] BaseColors base_colors() const override;  // obj_base_colors.cpp
    [[nodiscard]] bool has_openings() const override;       // the same
};

}  // namespace surfelao
