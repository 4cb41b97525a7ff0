/// pcd_file.h: a PCD file as its reader and its writer both see it. Internal to pcd_io.cpp and
/// pcd_writer.cpp.
#pragma once

#include "files/table_rows.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao::pcd {

using namespace table;

/// Numbers of each point that stand side by side.
struct Field {
    std::string name;
    std::size_t size = 4;  ///< bytes of a number in binary data
    char kind = 'F';       ///< I, U or F
    std::uint64_t count = 1;
    std::size_t property = 0;  ///< its first in PcdSource::points
};

enum class Kind { ascii, binary, compressed };

/// The file itself, for the writer.
class PcdSource : public RowSource {
public:
    std::string contents;
    std::vector<Field> fields;
    Element points;  ///< a property for each number: a name where the field is a single one
    Kind kind = Kind::ascii;
    std::uint64_t header_lines = 0;
    std::size_t data_begin = 0;  ///< bytes of the contents
    std::string_view rows;       ///< in the contents, or in `unpacked`
    std::string unpacked;        ///< of compressed data, point by point

    [[nodiscard]] const Element& vertices() const override { return points; }
    [[nodiscard]] std::string_view vertex_rows() const override { return rows; }
    [[nodiscard]] RowForm form() const override
    {
        return {kind == Kind::ascii ? Format::ascii : Format::little_endian, header_lines + 1, {}};
    }
};

}  // namespace surfelao::pcd
