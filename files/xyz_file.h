/// xyz_file.h: a cloud of points in a text file as its reader and its writer both see it. Internal
/// to xyz_io.cpp and xyz_writer.cpp.
#pragma once

#include "files/table_rows.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao::xyz {

using namespace table;

/// What a result says of its columns, behind its points.
inline constexpr std::string_view kColumnsComment = "# columns ";

/// The file itself, for the writer.
class XyzSource : public RowSource {
public:
    std::string text;
    Element points;
    RowForm row_form;
    std::size_t rows_begin = 0;    ///< bytes of the text
    std::size_t rows_end = 0;      ///< before what an earlier result says of itself
    bool has_count = false;        ///< on a line in front of them
    bool is_list = false;          ///< .pts
    bool header_says_all = false;  ///< it gives every column the name that it has
    std::string_view header;       ///< the names of the columns in the text; empty: it has none

    [[nodiscard]] const Element& vertices() const override { return points; }
    [[nodiscard]] std::string_view vertex_rows() const override
    {
        return std::string_view(text).substr(rows_begin, rows_end - rows_begin);
    }
    [[nodiscard]] RowForm form() const override { return row_form; }
};

/// The names in a line: between commas or semicolons where it has any, else between blanks.
[[nodiscard]] std::vector<std::string_view> names_in(std::string_view line);

}  // namespace surfelao::xyz
