/// ply_file.h: a PLY file as its reader and its writer both see it: the header, and rows of
/// numbers. Internal to ply_reader.cpp and ply_writer.cpp.
#pragma once

#include "files/table_rows.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao::ply {

using namespace table;

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
    std::size_t data_begin = 0;    ///< first byte behind the header
    std::uint64_t line_count = 0;  ///< lines of the header
    std::string newline;
    std::optional<glm::dvec3> viewpoint;  ///< of a comment `viewpoint X Y Z`

    [[nodiscard]] RowForm form() const { return {format, line_count + 1, {}}; }
};

/// Throws InputError with the line for anything that is no PLY header.
[[nodiscard]] Header read_header(const std::string& file_name, std::string_view contents);

/// Null when there is none.
[[nodiscard]] const Element* find_element(const Header& header, std::string_view name);

/// Which property of the element is the list of vertex indices; none: past the last.
[[nodiscard]] std::size_t index_list_of(const Element& element);

/// The byte behind the end of a line (LF, CRLF or CR) that stands at `offset`.
[[nodiscard]] std::size_t line_after(std::string_view contents, std::size_t offset);

/// The file itself, for the writer.
class PlySource : public RowSource {
public:
    std::string contents;
    Header header;
    std::size_t vertices_begin = 0;  ///< bytes of the vertex rows, counted from the data's first
    std::size_t vertices_end = 0;
    std::size_t faces_begin = 0;  ///< likewise; 0 and 0 without any
    std::size_t faces_end = 0;

    [[nodiscard]] std::string_view data() const
    {
        return std::string_view(contents).substr(header.data_begin);
    }
    [[nodiscard]] const Element& vertices() const override
    {
        return *find_element(header, "vertex");
    }
    [[nodiscard]] std::string_view vertex_rows() const override
    {
        return data().substr(vertices_begin, vertices_end - vertices_begin);
    }
    [[nodiscard]] RowForm form() const override { return header.form(); }

    [[nodiscard]] std::string_view face_rows() const
    {
        return data().substr(faces_begin, faces_end - faces_begin);
    }
};

}  // namespace surfelao::ply
